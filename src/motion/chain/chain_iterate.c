#include "chain_iterate.h"

#include <string.h>

#include "el_extremes.h"
#include "vector3.h"

enum {
    ROWS = 6,    /* of a residual: place, turning */
    NEWTON = 12, /* steps that suffice, as each doubles the digits */
    WAY = 400,   /* parts of the way to a pose, at most */
    DAMPED = 60, /* steps of the damped method from one start, at most */
    STARTS = 32  /* from which joints are sought, if the way does not lead to them */
};

/* Largest K e of the proof, which rounding does not change. */
static const double PROVED = 0.49;

/* Share of the largest pivot below which a pivot is 0: the place is singular. */
static const double PIVOT = 1e-13;

/* Shortest part of the way to a pose. */
static const double LEAST = 1e-6;

/* Shares of a turn by which starts differ: fractions of the powers of 1/g, g^8 = g + 1, which fill
 * seven dimensions evenly (Roberts 2018). */
static const double EVEN[CHAIN_JOINTS] = { 0.9115923534820549, 0.8310006189269519,
                                           0.7575338099526643, 0.6905620286569770,
                                           0.6295110649287560, 0.5738574732213994,
                                           0.5231240845771608 };

static const double TURN = 6.283185307179586;

/* Trace of a rotation by nearly half a turn. */
static const double NEARLY_OPPOSITE = -0.99;

/* An arm whose joints are sought. */
struct search {
    const struct chain *c;
    int held;
    double size; /* [m] */
    int count;   /* joints that are free */
    int free[CHAIN_JOINTS];
};

/* The residual at joints and how it changes with them. */
struct view {
    double f[ROWS];
    double slope[ROWS][CHAIN_JOINTS]; /* of the free joints, a sliding one in sizes */
    double inverse[CHAIN_JOINTS][ROWS];
    double step[CHAIN_JOINTS]; /* A F */
    double first;              /* e, its largest */
    double bend;               /* K */
    double most;               /* |F| */
};

static struct search search_of(const struct chain *c, int held, double size)
{
    struct search s = { .c = c, .held = held, .size = size };

    for (int i = 0; i < c->joints; i++) {
        if (i != held && s.count < ROWS) {
            s.free[s.count++] = i;
        }
    }
    return s;
}

/* Inverse of m in its place, by Gauss and Jordan with pivots of columns. False: m is singular. */
static bool inverted(int n, double m[CHAIN_JOINTS][CHAIN_JOINTS])
{
    int from[CHAIN_JOINTS];
    double largest = 0.0;

    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k + 1; i < n; i++) {
            best = fabs(m[i][k]) > fabs(m[best][k]) ? i : best;
        }
        const double pivot = m[best][k];
        largest = el_max(largest, fabs(pivot));
        if (!(fabs(pivot) > PIVOT * largest)) {
            return false;
        }
        from[k] = best;
        for (int j = 0; j < n; j++) {
            const double x = m[best][j];
            m[best][j] = m[k][j];
            m[k][j] = x * (1.0 / pivot);
        }
        m[k][k] = 1.0 / pivot;
        for (int i = 0; i < n; i++) {
            const double factor = m[i][k];
            if (i == k) {
                continue;
            }
            m[i][k] = 0.0;
            for (int j = 0; j < n; j++) {
                m[i][j] -= factor * m[k][j];
            }
        }
    }
    for (int k = n - 1; k >= 0; k--) { /* rows in another order are columns of the inverse so */
        for (int i = 0; i < n; i++) {
            const double x = m[i][k];
            m[i][k] = m[i][from[k]];
            m[i][from[k]] = x;
        }
    }
    return true;
}

/* The residual and its derivatives. With Q = R R*^T the turning's is what is skew in Q, and its
 * derivative (tr Q - Q) / 2 times the turning of the flange. Without a pose: of that of the joints
 * themselves. */
static void look(const struct search *s, const struct chain_pose *pose,
                 const double joint[CHAIN_JOINTS], struct view *v)
{
    double column[CHAIN_JOINTS][6], q[3][3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    struct chain_pose at;

    chain_jacobian(s->c, joint, &at, column);
    for (int i = 0; pose && i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            q[i][k] = vector3_dot(at.turn[i], pose->turn[k]);
        }
    }
    const double trace = q[0][0] + q[1][1] + q[2][2];
    for (int i = 0; i < 3; i++) {
        v->f[i] = pose ? (at.at[i] - pose->at[i]) / s->size : 0.0;
        v->f[i + 3] = 0.5 * (q[(i + 2) % 3][(i + 1) % 3] - q[(i + 1) % 3][(i + 2) % 3]);
    }
    v->most = sqrt(vector3_dot(v->f, v->f) + vector3_dot(v->f + 3, v->f + 3));
    for (int n = 0; n < s->count; n++) {
        const double *c = column[s->free[n]];
        double turned[3];
        vector3_by((const double(*)[3])q, c + 3, turned);
        const double unit = s->c->joint[s->free[n]].slides ? 1.0 : 1.0 / s->size;
        for (int i = 0; i < 3; i++) {
            v->slope[i][n] = unit * c[i];
            v->slope[i + 3][n] = 0.5 * (trace * c[i + 3] - turned[i]);
        }
    }
    if (trace < NEARLY_OPPOSITE) { /* half a turn away what is skew in Q is 0, too */
        v->most = INFINITY;
    }
}

/* A = F'^-1, or of fewer joints (F'^T F')^-1 F'^T. */
static bool invert(const struct search *s, struct view *v)
{
    double m[CHAIN_JOINTS][CHAIN_JOINTS];

    for (int i = 0; i < s->count; i++) {
        for (int k = 0; k < s->count; k++) {
            double sum = s->count == ROWS ? v->slope[i][k] : 0.0;
            for (int r = 0; r < ROWS && s->count < ROWS; r++) {
                sum += v->slope[r][i] * v->slope[r][k];
            }
            m[i][k] = sum;
        }
    }
    if (!inverted(s->count, m)) {
        return false;
    }
    for (int i = 0; i < s->count; i++) {
        for (int k = 0; k < ROWS; k++) {
            double sum = s->count == ROWS ? m[i][k] : 0.0;
            for (int r = 0; r < s->count && s->count < ROWS; r++) {
                sum += m[i][r] * v->slope[k][r];
            }
            v->inverse[i][k] = sum;
        }
    }
    return true;
}

/* Sums over all pairs of joints of what bounds the second derivatives of place (in sizes) and
 * turning. They are: how far the flange can be from the outer one of two turning joints; 1; of a
 * joint that slides behind one that turns 1 and 0. */
static void bends(const struct search *s, const double joint[CHAIN_JOINTS], double sum[2])
{
    double reach = vector3_length(s->c->flange.at) / s->size;
    int turning = 0;

    sum[0] = 0.0;
    for (int n = s->count - 1, i = s->c->joints - 1; i >= 0; i--) {
        const struct chain_joint *j = &s->c->joint[i];
        const bool is_free = n >= 0 && s->free[n] == i;
        n -= is_free;
        if (j->slides) {
            reach += fabs(joint[i]) / s->size + 1.0;
        } else if (is_free) {
            turning++;
        }
        for (int k = 0; is_free && k <= n + 1; k++) {
            const bool both = !j->slides && !s->c->joint[s->free[k]].slides;
            const bool carried = j->slides && !s->c->joint[s->free[k]].slides;
            sum[0] += (s->free[k] == i ? 1.0 : 2.0) * (both ? reach : carried ? 1.0 : 0.0);
        }
        reach += vector3_length(j->origin) / s->size;
    }
    sum[1] = (double)turning * turning;
}

/* The first step and the bound of how the residual bends, of a view that has been looked at. */
static bool judge_view(const struct search *s, const double joint[CHAIN_JOINTS], struct view *v)
{
    double sum[2];

    if (!(v->most < INFINITY) || !invert(s, v)) {
        return false;
    }
    bends(s, joint, sum);
    v->first = v->bend = 0.0;
    for (int i = 0; i < s->count; i++) {
        const double *a = v->inverse[i];
        v->step[i] = vector3_dot(a, v->f) + vector3_dot(a + 3, v->f + 3);
        v->first = el_max(v->first, fabs(v->step[i]));
        v->bend = el_max(v->bend, vector3_length(a) * sum[0] + vector3_length(a + 3) * sum[1]);
    }
    return true;
}

static bool judge(const struct search *s, const struct chain_pose *pose,
                  const double joint[CHAIN_JOINTS], struct view *v)
{
    look(s, pose, joint, v);
    return judge_view(s, joint, v);
}

static void go(const struct search *s, const double step[CHAIN_JOINTS], double part,
               double joint[CHAIN_JOINTS])
{
    for (int n = 0; n < s->count; n++) {
        const int i = s->free[n];
        joint[i] -= part * step[n] * (s->c->joint[i].slides ? s->size : 1.0);
    }
}

/* Newton's method from joints for which v holds. True: a solution is proved, and joint[] is as near
 * to it as rounding allows. */
static bool converge(const struct search *s, const struct chain_pose *pose,
                     double joint[CHAIN_JOINTS], struct view *v)
{
    double best[CHAIN_JOINTS], least = INFINITY;
    bool proof = false;

    for (int n = 0; n < NEWTON && v->most < least; n++) {
        least = v->most;
        memcpy(best, joint, sizeof best);
        proof = proof || v->bend * v->first <= PROVED;
        go(s, v->step, 1.0, joint);
        look(s, pose, joint, v);
        if (v->most < least && !judge_view(s, joint, v)) {
            break;
        }
    }
    memcpy(joint, best, sizeof best);
    return proof && least <= CHAIN_RESIDUAL;
}

bool chain_iterate_close(const struct chain *c, int held, double size,
                         const struct chain_pose *pose, double joint[CHAIN_JOINTS])
{
    const struct search s = search_of(c, held, size);
    double found[CHAIN_JOINTS];
    struct view v;

    memcpy(found, joint, sizeof found);
    if (!judge(&s, pose, found, &v) || !converge(&s, pose, found, &v)) {
        return false;
    }
    memcpy(joint, found, sizeof found);
    return true;
}

void chain_iterate_between(const struct chain_pose *from, const struct chain_pose *to, double part,
                           struct chain_pose *pose)
{
    double q[3][3], axis[3], own[3][3];

    for (int i = 0; i < 3; i++) {
        pose->at[i] = from->at[i] + part * (to->at[i] - from->at[i]);
        for (int k = 0; k < 3; k++) {
            q[i][k] = vector3_dot(to->turn[i], from->turn[k]);
        }
    }
    for (int i = 0; i < 3; i++) {
        axis[i] = 0.5 * (q[(i + 2) % 3][(i + 1) % 3] - q[(i + 1) % 3][(i + 2) % 3]);
    }
    const double sine = vector3_length(axis);
    const double angle = el_atan2(sine, 0.5 * (q[0][0] + q[1][1] + q[2][2] - 1.0));
    memcpy(pose->turn, from->turn, sizeof pose->turn);
    if (sine > 0.0) {
        for (int i = 0; i < 3; i++) {
            axis[i] /= sine;
        }
        vector3_matrix(axis, el_sincos(part * angle), own);
        vector3_product((const double(*)[3])own, from->turn, pose->turn);
    }
}

/* Follow the straight way to a pose in parts that are proved. */
static bool follow(const struct search *s, const struct chain_pose *pose,
                   double joint[CHAIN_JOINTS])
{
    struct chain_pose from, to;
    struct view v;

    for (int n = 0; n < WAY; n++) {
        double part = 1.0;
        chain_forward(s->c, joint, &from);
        to = *pose;
        while (!judge(s, &to, joint, &v) || v.bend * v.first > PROVED) {
            part *= v.most < INFINITY ? el_min(0.5, 0.9 * PROVED / (v.bend * v.first)) : 0.5;
            if (!(part > LEAST)) {
                return false;
            }
            chain_iterate_between(&from, pose, part, &to);
        }
        if (!converge(s, &to, joint, &v)) {
            return false;
        }
        if (part == 1.0) {
            return true;
        }
    }
    return false;
}

/* Newton's method whose steps are halved until the residual falls. */
static bool find(const struct search *s, const struct chain_pose *pose, double joint[CHAIN_JOINTS])
{
    static const double LONGEST = 0.5; /* step of a joint [rad] */
    double next[CHAIN_JOINTS];
    struct view v, w;

    if (!judge(s, pose, joint, &v)) {
        return false;
    }
    for (int n = 0; n < DAMPED && v.bend * v.first > PROVED; n++) {
        double part = el_min(1.0, LONGEST / v.first);
        for (;; part *= 0.5) {
            memcpy(next, joint, sizeof next);
            go(s, v.step, part, next);
            if (judge(s, pose, next, &w) && w.most < v.most) {
                break;
            }
            if (part < LEAST) {
                return false;
            }
        }
        memcpy(joint, next, sizeof next);
        v = w;
    }
    return converge(s, pose, joint, &v);
}

bool chain_iterate_damped(const struct chain *c, int held, double size,
                          const struct chain_pose *pose, double joint[CHAIN_JOINTS])
{
    const struct search s = search_of(c, held, size);
    double found[CHAIN_JOINTS];

    memcpy(found, joint, sizeof found);
    if (!find(&s, pose, found)) {
        return false;
    }
    memcpy(joint, found, sizeof found);
    return true;
}

enum chain_iterate_status chain_iterate(const struct chain *c, int held, double size,
                                        const struct chain_pose *pose, double joint[CHAIN_JOINTS])
{
    const struct search s = search_of(c, held, size);
    double found[CHAIN_JOINTS];

    memcpy(found, joint, sizeof found);
    if (follow(&s, pose, found)) {
        memcpy(joint, found, sizeof found);
        return CHAIN_FOLLOWED;
    }
    for (int start = 0; start < STARTS; start++) {
        memcpy(found, joint, sizeof found);
        for (int n = 0; n < s.count; n++) {
            const double off = start * EVEN[n] - round(start * EVEN[n]);
            found[s.free[n]] += off * (c->joint[s.free[n]].slides ? size : TURN);
        }
        if (find(&s, pose, found)) {
            memcpy(joint, found, sizeof found);
            return CHAIN_FOUND;
        }
    }
    return CHAIN_LOST;
}

double chain_iterate_gain(const struct chain *c, int held, double size,
                          const double joint[CHAIN_JOINTS])
{
    const struct search s = search_of(c, held, size);
    struct view v;
    double most = 0.0;

    look(&s, NULL, joint, &v);
    if (!invert(&s, &v)) {
        return INFINITY;
    }
    for (int i = 0; i < s.count; i++) {
        const double *a = v.inverse[i];
        most = el_max(most, sqrt(vector3_dot(a, a) + vector3_dot(a + 3, a + 3)));
    }
    return most;
}
