#include "joint_curve.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

/* Steps of a piece in which its quintic is compared; parts of a step by which its length is
 * summed. */
enum { STEPS = 8, SUMS = 4 };

/* Derivatives at a node come from places this part of a piece apart. */
static const double APART = 1.0 / 64.0;

/* Where the feed limits the speed, the ratio of the joints' speeds to the tool's changes in a piece
 * by no more than this. If that takes more pieces than there are, the square of it is tried, and so
 * on until the power is above WIDE. */
static const double UNEVEN = 1.02, WIDE = 300.0;

/* A spline whose joints are off in a piece this short comes too near to a singular place. [mm] */
static const double LEAP = 1e-2;

/* A spline's piece this short is as slow as its slowest place: where the tip turns back its speed
 * falls to 0, and shorter pieces would have bends of rounding. [mm] */
static const double FINE = 0.1;

/* Where a spline hardly goes on, it does so at this rate. */
static const double CUSP = 1e-6;

/* A piece this short is not halved. [mm] */
static const double LEAST = 1e-7;

/* What is followed: a path, or a spline with what becomes of it. */
struct fit {
    const struct tool_path *w;
    const struct arm_geometry *g;
    const struct tool_spline *spline;
    const struct manipulator *arm;
    struct joint_curve_spline *told;
    const struct joint_curve_limits *l;
    double uneven;
    struct segment *piece;
    int32_t count;
};

int32_t joint_curve_line(const double from[OPW_JOINTS], const double to[OPW_JOINTS], double share,
                         const double speed[OPW_JOINTS], struct segment *piece)
{
    double square = 0.0, feed = INFINITY;

    *piece = (struct segment){ .kind = SEGMENT_LINE, .even = true };
    for (int i = 0; i < OPW_JOINTS; i++) {
        piece->start[i] = JOINT_CURVE_LEVER * from[i];
        piece->slope[i] = JOINT_CURVE_LEVER * (to[i] - from[i]);
        square += piece->slope[i] * piece->slope[i];
    }
    piece->length = sqrt(square);
    if (!(piece->length > LEAST)) {
        return 0;
    }
    for (int i = 0; i < OPW_JOINTS; i++) {
        piece->slope[i] /= piece->length;
        feed = el_min(feed, share * JOINT_CURVE_LEVER * speed[i] / fabs(piece->slope[i]));
    }
    piece->feed = piece->cap = feed;
    return 1;
}

static double length_of(const struct fit *f)
{
    return f->spline ? f->spline->length : f->w->path.length;
}

static bool solve(const struct fit *f, double part, enum tool_spline_part which,
                  double q[OPW_JOINTS])
{
    double at[AXES], slope[AXES];

    if (f->spline) {
        const struct pose pose = tool_spline_pose(f->spline, which, part);
        f->told->lost = !manipulator_joints(f->arm, &pose, q);
        f->told->at = part;
        return !f->told->lost;
    }
    path_at(&f->w->path, part * f->w->path.length, at, slope);
    return arm_moves_kinematics().joints(f->g, at, q);
}

/* Joints [mm] at a part of the path, of a spline by its piece `which`; r[] holds the joints of a
 * place nearby. */
static bool place(const struct fit *f, double part, enum tool_spline_part which,
                  double r[OPW_JOINTS])
{
    double q[OPW_JOINTS];

    for (int i = 0; i < OPW_JOINTS; i++) {
        q[i] = r[i] / JOINT_CURVE_LEVER;
    }
    if (!solve(f, part, which, q)) {
        return false;
    }
    for (int i = 0; i < OPW_JOINTS; i++) {
        r[i] = JOINT_CURVE_LEVER * q[i];
    }
    return true;
}

/* Joints at a part of the path, by those at the step before and the one before that, which is NULL
 * at first: where a joint is free it goes on evenly. */
static bool step_on(const struct fit *f, double part, const double before[OPW_JOINTS],
                    const double earlier[OPW_JOINTS], double r[OPW_JOINTS])
{
    for (int i = 0; i < OPW_JOINTS; i++) {
        r[i] = earlier ? 2.0 * before[i] - earlier[i] : before[i];
    }
    return place(f, part, TOOL_SPLINE_WAY, r);
}

/* Set the derivatives of a node from five places around it, or to one side at an end of the path,
 * where a spline has its parabola on both. The stencils are those of fourth order, that of a bend
 * to one side of third. */
static bool derive(const struct fit *f, double size, struct joint_curve_node *n)
{
    static const double middle[2][5] = {
        { 1.0 / 12.0, -2.0 / 3.0, 0.0, 2.0 / 3.0, -1.0 / 12.0 },
        { -1.0 / 12.0, 4.0 / 3.0, -2.5, 4.0 / 3.0, -1.0 / 12.0 },
    };
    static const double side[2][5] = {
        { -25.0 / 12.0, 4.0, -3.0, 4.0 / 3.0, -0.25 },
        { 35.0 / 12.0, -26.0 / 3.0, 9.5, -14.0 / 3.0, 11.0 / 12.0 },
    };
    const double step = size * APART;
    const bool first = n->part - 2.0 * step < 0.0, last = n->part + 2.0 * step > 1.0;
    const bool one_side = (first || last) && !f->spline;
    const enum tool_spline_part which = first  ? TOOL_SPLINE_FIRST
                                        : last ? TOOL_SPLINE_SECOND
                                               : TOOL_SPLINE_WAY;
    const double h = last && one_side ? -step : step, mm = h * length_of(f);
    const double(*s)[5] = one_side ? side : middle;
    double r[OPW_JOINTS];

    memset(n->d, 0, sizeof n->d);
    for (int k = 0; k < 5; k++) {
        const int at = one_side ? k : k - 2;
        memcpy(r, n->r, sizeof r);
        if (at != 0 && !place(f, n->part + at * h, which, r)) {
            return false;
        }
        for (int i = 0; i < OPW_JOINTS; i++) { /* differences: small numbers are summed */
            n->d[0][i] += s[0][k] * (r[i] - n->r[i]) / mm;
            n->d[1][i] += s[1][k] * (r[i] - n->r[i]) / (mm * mm);
        }
    }
    return true;
}

static double size_of(const double d[OPW_JOINTS])
{
    double square = 0.0;

    for (int i = 0; i < OPW_JOINTS; i++) {
        square += d[i] * d[i];
    }
    return sqrt(square);
}

/* r' and r'' by the length of the joints' way. */
static struct segment_state by_length(const struct joint_curve_node *n)
{
    struct segment_state s;
    const double size = size_of(n->d[0]);
    double along = 0.0;

    for (int i = 0; i < OPW_JOINTS; i++) {
        along += n->d[0][i] * n->d[1][i];
    }
    for (int i = 0; i < OPW_JOINTS; i++) {
        const double slope = n->d[0][i] / size;
        s.point[i] = n->r[i];
        s.slope[i] = slope;
        s.bend[i] = (n->d[1][i] - along / size * slope) / (size * size);
    }
    return s;
}

/* r' and r'' by the way of the tool. */
static struct segment_state by_tool(const struct joint_curve_node *n)
{
    struct segment_state s;

    memcpy(s.point, n->r, sizeof n->r);
    memcpy(s.slope, n->d[0], sizeof n->d[0]);
    memcpy(s.bend, n->d[1], sizeof n->d[1]);
    return s;
}

/* What a unit rate along the way is of the tool's feed: a path is counted in its own length, a
 * spline from pose to pose, and its turn has a limit, too. */
static double rate_at(const struct fit *f, double part)
{
    double way, turn;

    if (!f->spline) {
        return 1.0;
    }
    tool_spline_rates(f->spline, part, &way, &turn);
    return el_max(CUSP, el_max(way, turn * f->l->feed / f->l->spin));
}

/* What the joints do along a piece, by a quintic over the way of the tool. */
struct course {
    double length[STEPS + 1]; /* [mm] of the joints' way up to each step */
    double least, most;       /* joints' speed for a speed of 1 of the tool */
    bool free;                /* the joints would let the tool have its feed somewhere */
    double slow;              /* 0..1 of the way where they would not; -1: nowhere */
};

/* Sums by Simpson. */
static struct course course_of(const struct fit *f, const struct joint_curve_node *a,
                               const struct joint_curve_node *b)
{
    const double mm = (b->part - a->part) * length_of(f), h = mm / (STEPS * SUMS);
    const struct segment_state from = by_tool(a), to = by_tool(b);
    double before = 0.0;
    struct course c = { .least = INFINITY, .slow = -1.0 };
    struct segment_state s;
    struct segment p;

    segment_between(&p, &from, &to, mm);
    for (int n = 0; n <= 2 * STEPS * SUMS; n++) {
        segment_at(&p, el_min(mm, 0.5 * h * n), &s);
        const double rate = size_of(s.slope);
        const double part = a->part + (b->part - a->part) * n / (2 * STEPS * SUMS);
        const double way = rate_at(f, part);
        const int step = (n + 2 * SUMS - 1) / (2 * SUMS);
        bool free = true;
        for (int i = 0; i < OPW_JOINTS; i++) {
            free =
                free && f->l->feed / way * fabs(s.slope[i]) <= JOINT_CURVE_LEVER * f->l->speed[i];
        }
        c.free = c.free || free;
        c.slow = free || c.slow >= 0.0 ? c.slow : part;
        c.least = el_min(c.least, rate / way);
        c.most = el_max(c.most, rate / way);
        if (n > 0) {
            c.length[step] += h / 6.0 * (n % 2 == 0 ? before + rate : 4.0 * rate);
        }
        before = n % 2 == 0 ? rate : before;
    }
    for (int n = 1; n <= STEPS; n++) {
        c.length[n] += c.length[n - 1];
    }
    return c;
}

/* Whether the joints are within what is allowed of the quintic at every step. */
static bool near(const struct fit *f, const struct joint_curve_node *a,
                 const struct joint_curve_node *b, const struct course *c, const struct segment *p)
{
    double r[STEPS][OPW_JOINTS];
    struct segment_state s;
    bool good = true;

    memcpy(r[0], a->r, sizeof r[0]);
    for (int n = 1; good && n < STEPS; n++) {
        good = step_on(f, a->part + (b->part - a->part) * n / STEPS, r[n - 1],
                       n > 1 ? r[n - 2] : NULL, r[n]);
        segment_at(p, c->length[n], &s);
        for (int i = 0; i < OPW_JOINTS; i++) {
            good = good && fabs(s.point[i] - r[n][i]) <= JOINT_CURVE_LEVER * f->l->off;
        }
    }
    return good;
}

/* Joints at a part of the path, found by steps from a node before it. */
static bool reach(const struct fit *f, const struct joint_curve_node *from, double part,
                  struct joint_curve_node *n)
{
    double r[STEPS + 1][OPW_JOINTS];

    n->part = part;
    memcpy(r[0], from->r, sizeof r[0]);
    for (int k = 1; k <= STEPS; k++) {
        if (!step_on(f, from->part + (part - from->part) * k / STEPS, r[k - 1],
                     k > 1 ? r[k - 2] : NULL, r[k])) {
            return false;
        }
    }
    memcpy(n->r, r[STEPS], sizeof n->r);
    return derive(f, part - from->part, n);
}

/* Append the pieces between two nodes. */
static bool between(struct fit *f, const struct joint_curve_node *a,
                    const struct joint_curve_node *b)
{
    const double mm = (b->part - a->part) * length_of(f);
    const struct course c = course_of(f, a, b);
    const struct segment_state from = by_length(a), to = by_length(b);
    struct segment p = { .even = true };
    struct joint_curve_node middle;

    segment_between(&p, &from, &to, c.length[STEPS]);
    const bool even = c.most <= f->uneven * c.least || (f->spline && mm <= FINE);
    const bool good = (!c.free || even) && near(f, a, b, &c, &p);
    if (good || (mm <= LEAST && !f->spline)) {
        p.feed = p.cap = f->l->feed * c.least;
        if (f->count == JOINT_CURVE_PIECES) {
            return false;
        }
        if (f->spline) {
            f->told->until[f->count] = b->part;
            f->told->slow = f->told->slow < 0.0 ? c.slow : f->told->slow;
        }
        f->piece[f->count++] = p;
        return true;
    }
    if (f->spline && mm <= LEAP) {
        return false;
    }
    return reach(f, a, 0.5 * (a->part + b->part), &middle) && between(f, a, &middle)
           && between(f, &middle, b);
}

int32_t joint_curve_path(const struct tool_path *w, const struct arm_geometry *g,
                         const double start[OPW_JOINTS], const struct joint_curve_limits *l,
                         struct segment piece[JOINT_CURVE_PIECES])
{
    for (double uneven = UNEVEN; uneven < WIDE; uneven *= uneven) {
        struct fit f = { .w = w, .g = g, .l = l, .uneven = uneven, .piece = piece };
        struct joint_curve_node a = { .part = 0.0 }, b;
        bool good = true;
        for (int i = 0; i < OPW_JOINTS; i++) {
            a.r[i] = JOINT_CURVE_LEVER * start[i];
        }
        good = derive(&f, w->segment[0].until, &a);
        for (int32_t k = 0; good && k < w->count; k++) {
            good = reach(&f, &a, w->segment[k].until, &b) && between(&f, &a, &b);
            a = b;
        }
        if (good) {
            return f.count;
        }
    }
    return 0;
}

void joint_curve_spline(const struct tool_spline *s, const struct manipulator *arm,
                        const struct joint_curve_node *start, const struct joint_curve_limits *l,
                        struct joint_curve_spline *c)
{
    c->count = 0;
    for (double uneven = UNEVEN; uneven < WIDE && c->count == 0; uneven *= uneven) {
        struct fit f = { .spline = s, .arm = arm, .told = c, .l = l, .uneven = uneven };
        struct joint_curve_node a = *start;
        f.piece = c->piece;
        c->lost = false;
        c->slow = -1.0;
        const bool known = a.part == 0.0;
        a.part = 0.0;
        c->end.part = 1.0;
        if ((known || derive(&f, 1.0, &a)) && reach(&f, &a, 1.0, &c->end)
            && between(&f, &a, &c->end)) {
            c->count = f.count;
        }
        if (c->lost) {
            return;
        }
    }
}
