#include "chain_inverse.h"

#include <string.h>

#include "chain_iterate.h"
#include "el_extremes.h"
#include "subproblem.h"
#include "vector3.h"

static const double TURN = 6.283185307179586; /* [rad] 2 pi */

/* An arm of less than six joints reaches a pose if it is this near. [rad], sizes of the arm */
static const double REACHED = 1e-9;

/* A cosine or sine of an angle between axes that is 0 in an arm without rounding. */
static const double IN_LINE = 1e-9;

/* What the steps of a closed form share. */
struct task {
    const struct chain_form *f;
    struct chain_points p;
    double near[CHAIN_JOINTS]; /* in the order of p.lines */
    double angle;              /* [rad] arm angle */
    struct chain_pose motion;  /* of the flange from zero, of points of the base at zero */
    double wrist[3];           /* [m] where the centre of the wrist goes */
};

/* Where joint n takes a point. */
static void moved(const struct task *t, int n, double angle, const double point[3], double out[3])
{
    const double *axis = t->p.lines.axis[n], *on = t->p.lines.point[n];

    vector3_add(point, -1.0, on, out);
    vector3_turn(axis, el_sincos(angle), out, out);
    vector3_add(out, 1.0, on, out);
}

static void from_to(const double a[3], const double b[3], double way[3])
{
    vector3_add(b, -1.0, a, way);
}

static double distance2(const double a[3], const double b[3])
{
    double d[3];

    from_to(a, b, d);
    return vector3_dot(d, d);
}

/* Square of the distance across an axis. */
static double across2(const double h[3], const double a[3], const double b[3])
{
    double d[3];

    from_to(a, b, d);
    vector3_across(h, d, d);
    return vector3_dot(d, d);
}

/* Angle by which joint n takes a point to another. */
static double turn_of(const struct task *t, int n, const double from[3], const double to[3])
{
    const double *on = t->p.lines.point[n];
    double u[3], v[3];

    from_to(on, from, u);
    from_to(on, to, v);
    return subproblem_turn(t->p.lines.axis[n], u, v, t->f->size, t->near[n]);
}

/* Angles of joint n that bring a point as high along k as a place is. */
static bool level_of(const struct task *t, int n, const double point[3], const double k[3],
                     const double place[3], double angle[2])
{
    const double *on = t->p.lines.point[n];
    double u[3], d[3];

    from_to(on, point, u);
    from_to(on, place, d);
    return subproblem_plane(t->p.lines.axis[n], u, k, vector3_dot(k, d), t->f->size, t->near[n],
                            angle);
}

/* Angles of joint n that bring a point, across its axis, to a distance from a place. */
static bool distance_of(const struct task *t, int n, const double point[3], const double place[3],
                        double square, double angle[2])
{
    const double *on = t->p.lines.point[n];
    double u[3], v[3];

    from_to(on, point, u);
    from_to(place, on, v);
    return subproblem_sphere(t->p.lines.axis[n], u, v, square, t->f->size, t->near[n], angle);
}

/* Distance squared across the axis n that is left of one in space between points that do not leave
 * their heights along it. */
static double left_of(const struct task *t, int n, const double point[3], const double place[3],
                      double square)
{
    double d[3];

    from_to(place, point, d);
    const double height = vector3_dot(t->p.lines.axis[n], d);
    return square - height * height;
}

/* Joint 1 turned back: where the wrist lies for the rest of the arm. */
static void behind(const struct task *t, double angle, const double place[3], double out[3])
{
    moved(t, 0, -angle, place, out);
}

/* Branches 2 b and 2 b + 1, one for each angle of joint 3: joint 2 turns what joint 3 has bent to
 * where the wrist is seen from behind joint 1. */
static unsigned second_of(const struct task *t, int b, double first, const double third[2],
                          const double seen[3], double q[4][3])
{
    double bent[3];

    for (int e = 0; e < 2; e++) {
        const int n = 2 * b + e;
        moved(t, 2, third[e], t->p.centre, bent);
        q[n][0] = first;
        q[n][1] = turn_of(t, 1, bent, seen);
        q[n][2] = third[e];
    }
    return 3u << 2 * b;
}

/* Joints 1 to 3 that bring the centre to its place, for arms whose axes 2 and 3 are in parallel:
 * joint 1 by the height along these, joint 3 by the distance from axis 2. A branch is 2 back +
 * elbow; returns a bit each. */
static unsigned by_parallel(const struct task *t, double q[4][3])
{
    const double(*h)[3] = t->p.lines.axis, (*o)[3] = t->p.lines.point;
    double first[2], third[2], seen[3];
    unsigned there = 0;

    /* h2 . R1^T (w - o1) = h2 . (c - o1), the angle taken of the other side's turn. */
    double w[3], d[3];
    from_to(o[0], t->wrist, w);
    from_to(o[0], t->p.centre, d);
    const double back[3] = { -h[0][0], -h[0][1], -h[0][2] };
    if (!subproblem_plane(back, w, h[1], vector3_dot(h[1], d), t->f->size, t->near[0], first)) {
        return 0;
    }
    for (int b = 0; b < 2; b++) {
        behind(t, first[b], t->wrist, seen);
        if (!distance_of(t, 2, t->p.centre, o[1], across2(h[1], o[1], seen), third)) {
            continue;
        }
        there |= second_of(t, b, first[b], third, seen, q);
    }
    return there;
}

/* The same for axes 1 and 2 that meet: joint 3 by the distance from there, joint 2 by the height
 * along axis 1. */
static unsigned by_shoulder(const struct task *t, double q[4][3])
{
    const double(*h)[3] = t->p.lines.axis, *m = t->p.meeting;
    double second[2], third[2], bent[3], raised[3];
    unsigned there = 0;
    const double square = left_of(t, 2, t->p.centre, m, distance2(m, t->wrist));

    if (!distance_of(t, 2, t->p.centre, m, square, third)) {
        return 0;
    }
    for (int e = 0; e < 2; e++) {
        moved(t, 2, third[e], t->p.centre, bent);
        if (!level_of(t, 1, bent, h[0], t->wrist, second)) {
            continue;
        }
        for (int b = 0; b < 2; b++) {
            const int n = 2 * b + e;
            moved(t, 1, second[b], bent, raised);
            q[n][0] = turn_of(t, 0, raised, t->wrist);
            q[n][1] = second[b];
            q[n][2] = third[e];
            there |= 1u << n;
        }
    }
    return there;
}

/* The same for axes 2 and 3 that meet: joint 1 by the distance from there, joint 3 by the height
 * along axis 2. */
static unsigned by_elbow(const struct task *t, double q[4][3])
{
    const double(*h)[3] = t->p.lines.axis, *m = t->p.meeting;
    double first[2], third[2], seen[3];
    unsigned there = 0;
    const double square = left_of(t, 0, t->wrist, m, distance2(m, t->p.centre));

    /* |R1^T (w - o1) - (m - o1)|: joint 1 turned back is one about the opposite axis. */
    const double *o = t->p.lines.point[0];
    double w[3], v[3];
    from_to(o, t->wrist, w);
    from_to(m, o, v);
    const double back[3] = { -h[0][0], -h[0][1], -h[0][2] };
    if (!subproblem_sphere(back, w, v, square, t->f->size, t->near[0], first)) {
        return 0;
    }
    for (int b = 0; b < 2; b++) {
        behind(t, first[b], t->wrist, seen);
        if (!level_of(t, 2, t->p.centre, h[1], seen, third)) {
            continue;
        }
        there |= second_of(t, b, first[b], third, seen, q);
    }
    return there;
}

/* The same for axes 1 and 2 in parallel: joint 3 by the height along them, joint 2 by the distance
 * from axis 1. */
static unsigned by_column(const struct task *t, double q[4][3])
{
    const double(*h)[3] = t->p.lines.axis, (*o)[3] = t->p.lines.point;
    double second[2], third[2], bent[3], raised[3];
    unsigned there = 0;

    if (!level_of(t, 2, t->p.centre, h[0], t->wrist, third)) {
        return 0;
    }
    for (int e = 0; e < 2; e++) {
        moved(t, 2, third[e], t->p.centre, bent);
        if (!distance_of(t, 1, bent, o[0], across2(h[0], o[0], t->wrist), second)) {
            continue;
        }
        for (int b = 0; b < 2; b++) {
            const int n = 2 * b + e;
            moved(t, 1, second[b], bent, raised);
            q[n][0] = turn_of(t, 0, raised, t->wrist);
            q[n][1] = second[b];
            q[n][2] = third[e];
            there |= 1u << n;
        }
    }
    return there;
}

/* What is left of a rotation behind joints from .. to - 1. */
static void rest_of(const struct task *t, const double *q, int from, int to, const double r[3][3],
                    double rest[3][3])
{
    double own[3][3], left[3][3];

    memcpy(rest, r, sizeof left);
    for (int i = from; i < to; i++) {
        vector3_matrix(t->p.lines.axis[i], el_sincos(q[i]), own);
        vector3_back_product((const double(*)[3])own, (const double(*)[3])rest, left);
        memcpy(rest, left, sizeof left);
    }
}

/* Joints from `first` on by the rotation that they are together, in both branches; less than three
 * have one. */
static unsigned wrist(const struct task *t, int first, const double rest[3][3], double q[2][3])
{
    const int count = t->p.lines.count - first;
    const double(*h)[3] = t->p.lines.axis + first;

    if (count == 3) {
        return subproblem_attitude(h, rest, t->near + first, q) ? 3 : 0;
    }
    subproblem_part(count, h, rest, t->near + first, q[0]);
    return 1;
}

/* Arms with a wrist: joints 1 to 3 by its centre, the rest by what is left of the orientation. */
static uint32_t with_wrist(const struct task *t, double joint[CHAIN_BRANCHES][CHAIN_JOINTS])
{
    double q[4][3], hand[2][3], rest[3][3];
    const int level = t->f->chain.joint[t->f->chain.joints - 1].level;
    const enum chain_kind kind = t->f->kind;
    const unsigned arm = kind == CHAIN_WRIST_PARALLEL   ? by_parallel(t, q)
                         : kind == CHAIN_WRIST_SHOULDER ? by_shoulder(t, q)
                         : kind == CHAIN_WRIST_ELBOW    ? by_elbow(t, q)
                                                        : by_column(t, q);
    uint32_t there = 0;

    for (int n = 0; n < 4; n++) {
        if (!(arm >> n & 1)) {
            continue;
        }
        rest_of(t, q[n], 0, 3 - level, t->motion.turn, rest);
        const unsigned both = wrist(t, 3, (const double(*)[3])rest, hand);
        for (int k = 0; k < 2; k++) {
            if (both >> k & 1) {
                double *all = joint[2 * n + k];
                memcpy(all, q[n], sizeof q[n]);
                memcpy(all + 3, hand[k], (size_t)(t->p.lines.count - 3) * sizeof *all);
                there |= 1u << (2 * n + k);
            }
        }
    }
    return there;
}

/* +1, or -1 for an axis against another. */
static double same_way(const double a[3], const double b[3])
{
    return vector3_dot(a, b) < 0.0 ? -1.0 : 1.0;
}

/* Joint 5 and both of what is left, for three parallel axes: joints 2 to 4 together turn by `sum`.
 * Where axis 6 is in line with them joint 6 stays. */
static void hand_of(const struct task *t, const double seen[3][3], double fifth, double *sum,
                    double *sixth)
{
    const double(*h)[3] = t->p.lines.axis;
    double own[3][3], rest[3][3], left[3][3], tip[3], to[3], side[3];

    vector3_turn(h[4], el_sincos(fifth), h[5], tip);
    vector3_by(seen, h[5], to);
    vector3_cross(h[1], to, side);
    if (vector3_length(side) < IN_LINE) {
        /* R = R(h2, sum) R5 R6, of which R6 is known. */
        double hand[3][3];
        *sixth = t->near[5];
        vector3_matrix(h[4], el_sincos(fifth), own);
        vector3_matrix(h[5], el_sincos(*sixth), rest);
        vector3_product((const double(*)[3])own, (const double(*)[3])rest, hand);
        for (int i = 0; i < 3; i++) { /* R (R5 R6)^T */
            for (int k = 0; k < 3; k++) {
                left[i][k] = vector3_dot(seen[i], hand[k]);
            }
        }
        *sum = subproblem_angle(h[1], (const double(*)[3])left);
        return;
    }
    *sum = subproblem_turn(h[1], tip, to, 1.0, 0.0);
    vector3_matrix(h[1], el_sincos(*sum), own);
    vector3_back_product((const double(*)[3])own, seen, rest);
    vector3_matrix(h[4], el_sincos(fifth), own);
    vector3_back_product((const double(*)[3])own, (const double(*)[3])rest, left);
    *sixth = subproblem_angle(h[5], (const double(*)[3])left);
}

/* Joints 2 to 4 in parallel that together turn by `sum` and bring the centre to where it is seen
 * from joint 1: an arm of two links whose end is axis 4. */
static bool links(const struct task *t, const double seen[3], double sum, double q[2][CHAIN_JOINTS])
{
    const double(*h)[3] = t->p.lines.axis, (*o)[3] = t->p.lines.point;
    const double third = same_way(h[1], h[2]), fourth = same_way(h[1], h[3]);
    double hand[3], end[3], bent[3], angle[2];

    from_to(o[3], t->p.centre, hand);
    vector3_turn(h[1], el_sincos(sum), hand, hand);
    vector3_add(seen, -1.0, hand, end);
    if (!distance_of(t, 2, o[3], o[1], across2(h[1], o[1], end), angle)) {
        return false;
    }
    for (int e = 0; e < 2; e++) {
        moved(t, 2, angle[e], o[3], bent);
        q[e][1] = turn_of(t, 1, bent, end);
        q[e][2] = angle[e];
        q[e][3] = fourth * (sum - q[e][1] - third * angle[e]);
    }
    return true;
}

/* Arms with axes 2, 3, 4 in parallel and 5, 6 that meet: joint 1 by the height of the meeting along
 * axis 2, joint 5 by that of axis 6, then an arm of two links. */
static uint32_t with_parallel(const struct task *t, double joint[CHAIN_BRANCHES][CHAIN_JOINTS])
{
    const double(*h)[3] = t->p.lines.axis, (*o)[3] = t->p.lines.point;
    const double back[3] = { -h[0][0], -h[0][1], -h[0][2] };
    double w[3], d[3], first[2], seen[3], turned[3][3], q[2][CHAIN_JOINTS];
    uint32_t there = 0;

    from_to(o[0], t->wrist, w);
    from_to(o[0], t->p.centre, d);
    if (!subproblem_plane(back, w, h[1], vector3_dot(h[1], d), t->f->size, t->near[0], first)) {
        return 0;
    }
    for (int b = 0; b < 2; b++) {
        double attitude[2][3], sum, sixth;
        behind(t, first[b], t->wrist, seen);
        rest_of(t, &first[b], 0, 1, t->motion.turn, turned);
        const double axes[3][3] = { { h[1][0], h[1][1], h[1][2] },
                                    { h[4][0], h[4][1], h[4][2] },
                                    { h[5][0], h[5][1], h[5][2] } };
        const double open[3] = { 0.0, t->near[4], t->near[5] };
        if (!subproblem_attitude(axes, (const double(*)[3])turned, open, attitude)) {
            continue;
        }
        for (int k = 0; k < 2; k++) {
            hand_of(t, (const double(*)[3])turned, attitude[k][1], &sum, &sixth);
            if (!links(t, seen, sum, q)) {
                continue;
            }
            for (int e = 0; e < 2; e++) {
                const int n = 4 * b + 2 * e + k;
                q[e][0] = first[b];
                q[e][4] = attitude[k][1];
                q[e][5] = sixth;
                memcpy(joint[n], q[e], sizeof q[e]);
                there |= 1u << n;
            }
        }
    }
    return there;
}

/* Indices of the turning joints of a SCARA, and of the sliding one behind them. */
static void scara_joints(const struct chain_lines *l, int index[4])
{
    int n = 0;

    for (int i = 0; i < 4; i++) {
        if (l->slides[i]) {
            index[3] = i;
        } else {
            index[n++] = i;
        }
    }
}

/* SCARAs: an arm of two links whose end is the third turning axis; the rest of the turn; the
 * height. */
static uint32_t with_links(const struct task *t, double joint[CHAIN_BRANCHES][CHAIN_JOINTS])
{
    const double(*h)[3] = t->p.lines.axis, (*o)[3] = t->p.lines.point;
    double to[3], up[3], bent[3], angle[2];
    int j[4];

    scara_joints(&t->p.lines, j);
    const double *axis = h[j[0]], *end = o[j[2]];
    vector3_by(t->motion.turn, end, to);
    vector3_add(to, 1.0, t->motion.at, to);
    from_to(end, to, up);
    const double height = vector3_dot(h[j[3]], up);
    const double whole = subproblem_angle(axis, t->motion.turn);
    if (!distance_of(t, j[1], end, o[j[0]], across2(axis, o[j[0]], to), angle)) {
        return 0;
    }
    for (int e = 0; e < 2; e++) {
        double *q = joint[2 * e];
        moved(t, j[1], angle[e], end, bent);
        q[j[0]] = turn_of(t, j[0], bent, to);
        q[j[1]] = angle[e];
        q[j[2]] = same_way(axis, h[j[2]]) * (whole - q[j[0]] - same_way(axis, h[j[1]]) * angle[e]);
        q[j[3]] = height;
    }
    return 1u | 1u << CHAIN_ELBOW;
}

/* Gantries: the wrist by the orientation, the slides by what is left of the way. */
static uint32_t with_slides(const struct task *t, double joint[CHAIN_BRANCHES][CHAIN_JOINTS])
{
    const double(*h)[3] = t->p.lines.axis;
    double hand[2][3], way[3], side[3];
    const double volume = vector3_triple(h[0], h[1], h[2]);
    const unsigned both = wrist(t, 3, t->motion.turn, hand);

    for (int k = 0; k < 2; k++) {
        double at[3] = { 0.0, 0.0, 0.0 }, *q = joint[k];
        if (!(both >> k & 1)) {
            continue;
        }
        memcpy(q + 3, hand[k], sizeof hand[k]);
        for (int i = t->p.lines.count - 1; i > 2; i--) {
            moved(t, i, q[i], at, at);
        }
        from_to(at, t->motion.at, way);
        for (int i = 0; i < 3; i++) {
            vector3_cross(h[(i + 1) % 3], h[(i + 2) % 3], side);
            q[i] = vector3_dot(side, way) / volume;
        }
    }
    return both;
}

/* Columns: along a, across it towards b, and what is square to both. False: b is along a. */
static bool frame(const double a[3], const double b[3], double m[3][3])
{
    double x[3], y[3], z[3];
    const double long_a = vector3_length(a);

    for (int i = 0; i < 3; i++) {
        x[i] = a[i] / long_a;
    }
    vector3_across(x, b, y);
    const double long_y = vector3_length(y);
    if (!(long_a > 0.0 && long_y > IN_LINE * vector3_length(b))) {
        return false;
    }
    for (int i = 0; i < 3; i++) {
        y[i] /= long_y;
    }
    vector3_cross(x, y, z);
    for (int i = 0; i < 3; i++) {
        m[i][0] = x[i];
        m[i][1] = y[i];
        m[i][2] = z[i];
    }
    return true;
}

/* Frame of the line from shoulder to wrist, from which the arm angle counts: with the direction e
 * of the line and the axis h of joint 1, z is across e + h and some direction across h. */
static bool reference(const struct task *t, const double line[3], double m[3][3])
{
    const double *h = t->p.lines.axis[0], *second = t->p.lines.axis[1];
    const double length = vector3_length(line);
    double side[3], from[3], z[3], y[3];

    vector3_across(h, second, side);
    for (int i = 0; i < 3; i++) {
        from[i] = line[i] / length + h[i];
    }
    vector3_cross(from, side, z);
    vector3_cross(z, line, y);
    return length > 0.0 && frame(line, y, m);
}

static void point_of_elbow(const struct task *t, double elbow[3])
{
    const double *h = t->p.lines.axis[3], *o = t->p.lines.point[3];
    double d[3];

    from_to(t->p.meeting, o, d);
    vector3_across(h, d, elbow);
}

/* Seven joints with shoulder and wrist: joint 4 by their distance, joints 1 to 3 by the line
 * between them and the arm angle, joints 5 to 7 by what is left of the orientation. */
static uint32_t with_shoulder(const struct task *t, double joint[CHAIN_BRANCHES][CHAIN_JOINTS])
{
    const double(*h)[3] = t->p.lines.axis, *m = t->p.meeting;
    double fourth[2], line[3], bent[3], elbow[3], arm[2][3], hand[2][3], base[3][3], own[3][3];
    uint32_t there = 0;

    from_to(m, t->wrist, line);
    point_of_elbow(t, elbow);
    const double square = left_of(t, 3, t->p.centre, m, vector3_dot(line, line));
    if (!distance_of(t, 3, t->p.centre, m, square, fourth) || !reference(t, line, base)) {
        return 0;
    }
    const struct el_turn a = el_sincos(t->angle);
    for (int e = 0; e < 2; e++) {
        double side[3], to[3][3], whole[3][3], rest[3][3], left[3][3];
        moved(t, 3, fourth[e], t->p.centre, bent);
        from_to(m, bent, bent);
        for (int i = 0; i < 3; i++) {
            side[i] = a.cosine * base[i][1] + a.sine * base[i][2];
        }
        if (!frame(bent, elbow, own) || !frame(line, side, to)) {
            continue;
        }
        for (int i = 0; i < 3; i++) {
            for (int k = 0; k < 3; k++) {
                whole[i][k] = vector3_dot(to[i], own[k]);
            }
        }
        if (!subproblem_attitude(h, (const double(*)[3])whole, t->near, arm)) {
            continue;
        }
        vector3_back_product((const double(*)[3])whole, t->motion.turn, rest);
        vector3_matrix(h[3], el_sincos(fourth[e]), own);
        vector3_back_product((const double(*)[3])own, (const double(*)[3])rest, left);
        if (!wrist(t, 4, (const double(*)[3])left, hand)) {
            continue;
        }
        for (int n = 0; n < 4; n++) {
            double *q = joint[4 * (n >> 1) + 2 * e + (n & 1)];
            memcpy(q, arm[n >> 1], sizeof arm[0]);
            q[3] = fourth[e];
            memcpy(q + 4, hand[n & 1], sizeof hand[0]);
            there |= 1u << (4 * (n >> 1) + 2 * e + (n & 1));
        }
    }
    return there;
}

/* A forearm that is driven from the base turns by joint 3 alone, that of the forms by both: take
 * joint 2, seen along axis 3, `times` from it. */
static void carry(const struct chain_form *f, double times, const double second, double *third)
{
    const struct chain_joint *j = f->chain.joint;

    if (f->chain.joints > 2 && j[2].level == 1) {
        *third -= times * same_way(j[1].axis, j[2].axis) * second;
    }
}

/* Lines and points for a value of the held joint, and near[] in their order. */
static void begin(const struct chain_form *f, const double near[CHAIN_JOINTS], double value,
                  struct task *t)
{
    struct chain_lines lines;
    int n = 0;

    memset(t, 0, sizeof *t);
    t->f = f;
    t->angle = value;
    if (f->held >= 0) {
        chain_lines_held(&f->chain, f->held, value, &lines);
    } else {
        chain_lines_of(&f->chain, &lines);
    }
    for (int i = 0; i < f->chain.joints; i++) {
        if (i != f->held) {
            t->near[f->reversed ? lines.count - 1 - n : n] = near[i];
            n++;
        }
    }
    if (f->reversed) {
        chain_lines_reverse(&lines);
    }
    carry(f, 1.0, t->near[1], &t->near[2]);
    chain_points_of(f->kind, &lines, f->size, &t->p);
}

/* How the flange moves from zero to a pose, and where that takes the centre of the wrist. */
static void aim(const struct chain_pose *pose, struct task *t)
{
    const struct chain_pose *home = &t->p.lines.home;
    double way[3];

    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            t->motion.turn[i][k] = vector3_dot(pose->turn[i], home->turn[k]);
        }
    }
    vector3_by((const double(*)[3])t->motion.turn, home->at, way);
    from_to(way, pose->at, t->motion.at);
    if (t->f->reversed) {
        const struct chain_pose forth = t->motion;
        for (int i = 0; i < 3; i++) {
            for (int k = 0; k < 3; k++) {
                t->motion.turn[i][k] = forth.turn[k][i];
            }
        }
        vector3_by((const double(*)[3])t->motion.turn, forth.at, way);
        for (int i = 0; i < 3; i++) {
            t->motion.at[i] = -way[i];
        }
    }
    vector3_by((const double(*)[3])t->motion.turn, t->p.centre, t->wrist);
    vector3_add(t->wrist, 1.0, t->motion.at, t->wrist);
}

/* A turning joint within half a turn of 0. */
static double within_turn(const struct chain_form *f, int i, double joint)
{
    const bool out = !f->chain.joint[i].slides && fabs(joint) > 0.5 * TURN;
    return out ? joint - TURN * round(joint / TURN) : joint;
}

/* The joints of a branch in the order of the arm. */
static void outer(const struct task *t, const double q[CHAIN_JOINTS], double value,
                  double joint[CHAIN_JOINTS])
{
    const struct chain_form *f = t->f;
    int n = 0;

    for (int i = 0; i < f->chain.joints; i++) {
        joint[i] = i == f->held ? value : q[f->reversed ? t->p.lines.count - 1 - n : n];
        n += i != f->held;
    }
    carry(f, -1.0, joint[1], &joint[2]);
    for (int i = 0; i < f->chain.joints; i++) {
        joint[i] = within_turn(f, i, joint[i]);
    }
}

/* Whether joints that a form gave are those of the pose, which an arm of less than six joints or
 * one that misses its form a little may not reach. */
static bool reaches(const struct chain_form *f, const struct chain_pose *pose,
                    double joint[CHAIN_JOINTS])
{
    struct chain_pose at;

    if (f->deviation > CHAIN_EXACT) {
        return chain_iterate_close(&f->chain, f->held, f->size, pose, joint);
    }
    if (f->chain.joints - (f->held >= 0) >= 6) {
        return true;
    }
    chain_forward(&f->chain, joint, &at);
    bool good = sqrt(distance2(at.at, pose->at)) <= REACHED * f->size;
    for (int i = 0; i < 3; i++) {
        good = good && distance2(at.turn[i], pose->turn[i]) <= REACHED * REACHED;
    }
    return good;
}

/* The branch to which joints lead by damped iteration, if it is among those that are missing. */
static uint32_t led_to(const struct chain_form *f, const struct chain_pose *pose,
                       const double start[CHAIN_JOINTS], uint32_t missing,
                       double joint[CHAIN_BRANCHES][CHAIN_JOINTS])
{
    double q[CHAIN_JOINTS];

    memcpy(q, start, sizeof q);
    if (!missing || !chain_iterate_damped(&f->chain, f->held, f->size, pose, q)) {
        return 0;
    }
    const int n = chain_branch(f, q);
    if (!(missing >> n & 1)) {
        return 0;
    }
    for (int i = 0; i < f->chain.joints; i++) {
        joint[n][i] = within_turn(f, i, q[i]);
    }
    return 1u << n;
}

/* Branches that an arm misses whose axes miss its form a little: beside singular places and at the
 * edge of reach the form's joints are too far away, or there are none. Iteration leads to them from
 * near[] and, of those `failed`, from the form's joints. */
static uint32_t by_damping(const struct chain_form *f, const struct chain_pose *pose,
                           const double near[CHAIN_JOINTS], double value, uint32_t failed,
                           uint32_t missing, double joint[CHAIN_BRANCHES][CHAIN_JOINTS])
{
    double start[CHAIN_JOINTS], ends[CHAIN_BRANCHES][CHAIN_JOINTS];

    memcpy(start, near, sizeof start);
    if (f->held >= 0) {
        start[f->held] = value;
    }
    uint32_t there = led_to(f, pose, start, missing, ends);
    for (int n = 0; n < CHAIN_BRANCHES; n++) {
        if (failed >> n & 1) {
            there |= led_to(f, pose, joint[n], missing & ~there & 1u << n, ends);
        }
        if (there >> n & 1) {
            memcpy(joint[n], ends[n], sizeof ends[n]);
        }
    }
    return there;
}

uint32_t chain_inverse_held(const struct chain_form *f, const struct chain_pose *pose,
                            const double near[CHAIN_JOINTS], double value, uint32_t wanted,
                            double joint[CHAIN_BRANCHES][CHAIN_JOINTS])
{
    double q[CHAIN_BRANCHES][CHAIN_JOINTS];
    struct task t;
    uint32_t there = 0;

    if (f->kind == CHAIN_ITERATED) {
        memcpy(joint[0], near, sizeof joint[0]);
        if (f->held >= 0) {
            joint[0][f->held] = value;
        }
        there =
            wanted & 1 && chain_iterate(&f->chain, f->held, f->size, pose, joint[0]) > CHAIN_LOST;
        for (int i = 0; i < f->chain.joints; i++) {
            joint[0][i] = within_turn(f, i, joint[0][i]);
        }
        return there;
    }
    begin(f, near, value, &t);
    aim(pose, &t);
    switch (f->kind) {
    case CHAIN_THREE_PARALLEL: there = with_parallel(&t, q); break;
    case CHAIN_SCARA:          there = with_links(&t, q); break;
    case CHAIN_GANTRY:         there = with_slides(&t, q); break;
    case CHAIN_SHOULDER_WRIST: there = with_shoulder(&t, q); break;
    default:                   there = with_wrist(&t, q); break;
    }
    there &= wanted;
    uint32_t failed = 0;
    for (int n = 0; n < CHAIN_BRANCHES; n++) {
        if (there >> n & 1) {
            outer(&t, q[n], value, joint[n]);
            failed |= reaches(f, pose, joint[n]) ? 0 : 1u << n;
        }
    }
    there &= ~failed;
    if (f->deviation > CHAIN_EXACT && f->held != CHAIN_ARM_ANGLE) { /* which it would not keep */
        there |= by_damping(f, pose, near, value, failed, wanted & ~there, joint);
    }
    return there;
}

uint32_t chain_inverse(const struct chain_form *f, const struct chain_pose *pose,
                       const double near[CHAIN_JOINTS], uint32_t wanted,
                       double joint[CHAIN_BRANCHES][CHAIN_JOINTS])
{
    const double value = f->held >= 0                 ? near[f->held]
                         : f->held == CHAIN_ARM_ANGLE ? chain_arm_angle(f, near)
                                                      : 0.0;

    return chain_inverse_held(f, pose, near, value, wanted, joint);
}

int chain_nearest(const struct chain_form *f, uint32_t branches,
                  const double all[CHAIN_BRANCHES][CHAIN_JOINTS], const double near[CHAIN_JOINTS],
                  const double low[CHAIN_JOINTS], const double high[CHAIN_JOINTS],
                  double joint[CHAIN_JOINTS])
{
    double least = INFINITY;
    int best = -1;

    for (int n = 0; n < CHAIN_BRANCHES; n++) {
        double q[CHAIN_JOINTS] = { 0.0 }, most = 0.0;
        bool within = branches >> n & 1;
        for (int i = 0; i < f->chain.joints && within && most < least; i++) {
            const bool slides = f->chain.joint[i].slides;
            const double unit = slides ? INFINITY : TURN; /* no turns of a slide */
            double turns = round((near[i] - all[n][i]) / unit);
            const double up = slides ? 0.0 : ceil((low[i] - all[n][i]) / unit);
            const double down = slides ? 0.0 : floor((high[i] - all[n][i]) / unit);
            within = up <= down && !(slides && (all[n][i] < low[i] || all[n][i] > high[i]));
            turns = el_max(up, el_min(down, turns));
            q[i] = slides ? all[n][i] : all[n][i] + TURN * turns;
            most = el_max(most, fabs(q[i] - near[i]) / (slides ? f->size : 1.0));
        }
        if (within && most < least) {
            least = most;
            best = n;
            memcpy(joint, q, sizeof q);
        }
    }
    return best;
}

/* The factor of a turn about h that brings u to heights along k: the derivative of k . R u. */
static double rise(const double k[3], const double h[3], const double on[3], const double u[3])
{
    double d[3];

    from_to(on, u, d);
    return vector3_triple(k, h, d);
}

/* The factor of a turn about h that brings u to distances from a place, by both lengths across
 * h. */
static double stretch(const double place[3], const double h[3], const double on[3],
                      const double u[3])
{
    double v[3], d[3];

    from_to(place, on, v);
    from_to(on, u, d);
    vector3_across(h, v, v);
    vector3_across(h, d, d);
    const double lengths = vector3_length(v) * vector3_length(d);
    return lengths > 0.0 ? vector3_triple(v, h, d) / lengths : 0.0;
}

/* Sine of the wrist's middle joint, of axes a, h, b at zero. */
static double fold(const double a[3], const double h[3], double angle, const double b[3])
{
    double turned[3];

    vector3_turn(h, el_sincos(angle), b, turned);
    return vector3_triple(a, h, turned);
}

/* Factors of shoulder and elbow of an arm with a wrist, at joints in the order of the lines.
 * The elbow's is 1, or the shoulder's in length, where they come from a distance. */
static void arm_factors(const struct task *t, const double q[CHAIN_JOINTS], double factor[3])
{
    const double(*h)[3] = t->p.lines.axis, (*o)[3] = t->p.lines.point, *m = t->p.meeting;
    const double back[3] = { -h[0][0], -h[0][1], -h[0][2] };
    double bent[3], seen[3];

    moved(t, 2, q[2], t->p.centre, bent);
    moved(t, 1, q[1], bent, seen); /* the wrist as joint 1 sees it */
    switch (t->f->kind) {
    case CHAIN_WRIST_PARALLEL:
        factor[0] = rise(h[1], back, o[0], seen);
        factor[1] = stretch(o[1], h[2], o[2], bent);
        break;
    case CHAIN_WRIST_SHOULDER:
        factor[0] = rise(h[0], h[1], o[1], seen);
        factor[1] = stretch(m, h[2], o[2], bent);
        break;
    case CHAIN_WRIST_ELBOW:
        factor[0] = t->f->size * stretch(m, back, o[0], seen);
        factor[1] = rise(h[1], h[2], o[2], bent) / t->f->size;
        break;
    default:
        factor[0] = t->f->size * stretch(o[0], h[1], o[1], seen);
        factor[1] = rise(h[0], h[2], o[2], bent) / t->f->size;
        break;
    }
    factor[2] = t->p.lines.count == 6 ? fold(h[3], h[4], q[4], h[5]) : 1.0;
}

/* The same of the other forms. */
static void other_factors(const struct task *t, const double q[CHAIN_JOINTS], double factor[3])
{
    const double(*h)[3] = t->p.lines.axis, (*o)[3] = t->p.lines.point;
    double point[3];
    int j[4];

    switch (t->f->kind) {
    case CHAIN_THREE_PARALLEL: {
        const double back[3] = { -h[0][0], -h[0][1], -h[0][2] };
        moved(t, 2, q[2], o[3], point);
        factor[1] = stretch(o[1], h[2], o[2], point);
        memcpy(point, t->p.centre, sizeof point);
        for (int i = 3; i > 0; i--) {
            moved(t, i, q[i], point, point);
        }
        factor[0] = rise(h[1], back, o[0], point);
        factor[2] = fold(h[1], h[4], q[4], h[5]);
        break;
    }
    case CHAIN_SCARA:
        scara_joints(&t->p.lines, j);
        moved(t, j[1], q[j[1]], o[j[2]], point);
        factor[1] = stretch(o[j[0]], h[j[1]], o[j[1]], point);
        break;
    case CHAIN_GANTRY:
        factor[2] = t->p.lines.count == 6 ? fold(h[3], h[4], q[4], h[5]) : 1.0;
        break;
    default:
        moved(t, 3, q[3], t->p.centre, point);
        factor[0] = fold(h[0], h[1], q[1], h[2]);
        factor[1] = stretch(t->p.meeting, h[3], o[3], point);
        factor[2] = fold(h[4], h[5], q[5], h[6]);
        break;
    }
}

/* The flags of an arm's branch by the signs of its factors. */
static int flags_of(const struct chain_form *f, const double factor[3])
{
    return ((factor[0] < 0.0 ? CHAIN_BACK : 0) | (factor[1] < 0.0 ? CHAIN_ELBOW : 0)
            | (factor[2] < 0.0 ? CHAIN_FLIP : 0))
           & (int)f->flags;
}

int chain_factors(const struct chain_form *f, const double joint[CHAIN_JOINTS], double factor[3])
{
    struct task t;

    factor[0] = factor[1] = factor[2] = 1.0;
    if (f->kind == CHAIN_ITERATED) {
        factor[1] = 1.0 / chain_iterate_gain(&f->chain, f->held, f->size, joint);
        return flags_of(f, factor);
    }
    begin(f, joint, f->held >= 0 ? joint[f->held] : 0.0, &t); /* t.near: in the lines' order */
    if (f->kind >= CHAIN_WRIST_PARALLEL && f->kind <= CHAIN_WRIST_COLUMN) {
        arm_factors(&t, t.near, factor);
    } else {
        other_factors(&t, t.near, factor);
    }
    return flags_of(f, factor);
}

int chain_branch(const struct chain_form *f, const double joint[CHAIN_JOINTS])
{
    double factor[3];

    return f->flags == 0 ? 0 : chain_factors(f, joint, factor);
}

double chain_arm_angle(const struct chain_form *f, const double joint[CHAIN_JOINTS])
{
    struct task t;
    double line[3], elbow[3], base[3][3];

    begin(f, joint, 0.0, &t);
    moved(&t, 3, joint[3], t.p.centre, line);
    from_to(t.p.meeting, line, line);
    point_of_elbow(&t, elbow);
    for (int i = 2; i >= 0; i--) {
        vector3_turn(t.p.lines.axis[i], el_sincos(joint[i]), line, line);
        vector3_turn(t.p.lines.axis[i], el_sincos(joint[i]), elbow, elbow);
    }
    if (!reference(&t, line, base)) {
        return 0.0;
    }
    double y = 0.0, z = 0.0;
    for (int i = 0; i < 3; i++) {
        y += base[i][1] * elbow[i];
        z += base[i][2] * elbow[i];
    }
    return el_atan2(z, y);
}
