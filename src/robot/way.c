#include "way.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"
#include "elementary.h"

enum { STEPS = 8 };     /* of a piece that is looked at */

/* Share of a joint's acceleration that the bend of its way may take where it limits the speed; the
 * rest changes the speed. */
static const double BENT = 0.6;

/* Most that limits may differ within a piece; with more pieces than there is room the square of
 * that, and so on to a power of WIDE. */
static const double UNEVEN_SPEED = 1.3, UNEVEN_ACC = 1.5;

static const double WIDE = 64.0;

/* The joints keep so much below their accelerations: steps are no places. */
static const double MARGIN = 0.99;

/* Where the speed falls below this share of the feed no mean is taken: it would smear the slow part
 * over all the way on which it is looked ahead. */
static const double SLOW = 0.5;

/* A joint that turns further in a step is looked at more closely. [rad] */
static const double STEP = 0.2;

/* No piece is shorter. [mm] */
static const double LEAST = 1e-7;

/* Share of a joint's acceleration for what a corner asks across the path. */
static const double CORNER = 0.6;

struct survey {
    struct mechanism arm;
    const struct course_geometry *g;
    const struct way_limits *l;
    const struct path *path;
    double wide;                    /* uneven limits that are allowed, as a power */
    struct way_fault *fault;
    double origin[OPW_JOINTS];      /* [rad] at the start of the path */
};

/* A piece looked at. */
struct look {
    double q[STEPS + 1][OPW_JOINTS];
    double cap, acc;
    bool   even;
};

static bool joints_at(const struct survey *s, double part, double joint[OPW_JOINTS])
{
    double place[AXES], slope[AXES];
    path_at(s->path, part * s->path->length, place, slope);
    return mechanism_joints(&s->arm, place, joint);
}

/* Whether two joints in a row are on different sides of a singular place. */
static bool flips(const struct survey *s, const double a[OPW_JOINTS], const double b[OPW_JOINTS])
{
    return opw_branch(&s->g->arm->opw, a) != opw_branch(&s->g->arm->opw, b);
}

/* The way from a to b flips: whether it meets the singular place, so that the joints go on
 * smoothly; or passes it, and the joints turn quickly, which is seen once it is looked at
 * closely. */
static bool meets(const struct survey *s, double a, const double at_a[OPW_JOINTS], double b,
                  const double at_b[OPW_JOINTS])
{
    double first[OPW_JOINTS], last[OPW_JOINTS], mid[OPW_JOINTS];

    memcpy(first, at_a, sizeof first);
    memcpy(last, at_b, sizeof last);
    while ((b - a) * s->path->length > LEAST) {
        const double half = 0.5 * (a + b);
        if (half <= a || half >= b) {
            break;
        }
        memcpy(mid, first, sizeof mid);
        if (!joints_at(s, half, mid)) {
            return false;
        }
        if (flips(s, first, mid)) {
            b = half;
            memcpy(last, mid, sizeof last);
            continue;
        }
        memcpy(first, mid, sizeof first);
        a = half;
        memcpy(last, first, sizeof last);
        if (!joints_at(s, b, last) || !flips(s, first, last)) {
            return false;
        }
    }
    for (int i = 0; i < OPW_JOINTS; i++) {
        if (fabs(last[i] - first[i]) > STEP) {
            return false;
        }
    }
    return true;
}

static enum way_status fault(const struct survey *s, enum way_status why, double part,
                             const double joint[OPW_JOINTS], int which)
{
    s->fault->part = part;
    s->fault->which = which;
    memcpy(s->fault->joint, joint, sizeof s->fault->joint);
    return why;
}

/* Joints at the steps of a piece. */
static enum way_status walk(const struct survey *s, double from, double size, struct look *k)
{
    for (int n = 1; n <= STEPS; n++) {
        const double part = from + size * n / STEPS, before = from + size * (n - 1) / STEPS;
        double *q = k->q[n];
        for (int i = 0; i < OPW_JOINTS; i++) {      /* where a joint is free it goes on evenly */
            q[i] = n > 1 ? 2.0 * k->q[n - 1][i] - k->q[n - 2][i] : k->q[0][i];
        }
        if (!joints_at(s, part, q)) {
            return fault(s, WAY_FAR, before, k->q[n - 1], 0);
        }
        bool jumps = false;
        for (int i = 0; i < OPW_JOINTS; i++) {
            jumps = jumps || !(fabs(q[i] - k->q[n - 1][i]) <= STEP);
        }
        if (jumps || (flips(s, k->q[n - 1], q) && !meets(s, before, k->q[n - 1], part, q))) {
            return fault(s, WAY_SINGULAR, before, k->q[n - 1], 0);
        }
        const int out = manipulator_outside(s->g->arm, s->origin, q);
        if (out >= 0) {
            return fault(s, WAY_OUTSIDE, before, q, out);
        }
    }
    return WAY_OK;
}

/* First and second derivative of a joint by the way at a step, from differences; at the ends
 * carried on from within. */
static void derivatives(const struct look *k, int n, int i, double h, double *slope, double *bend)
{
    const int m = n == 0 ? 1 : n == STEPS ? STEPS - 1 : n, side = n - m;
    const int next = m - side;      /* one further in */
    const double b = (k->q[m + 1][i] - 2.0 * k->q[m][i] + k->q[m - 1][i]) / (h * h);

    *slope = (k->q[m + 1][i] - k->q[m - 1][i]) / (2.0 * h) + side * h * b;
    *bend = b;
    if (side != 0) {
        const double c = (k->q[next + 1][i] - 2.0 * k->q[next][i] + k->q[next - 1][i]) / (h * h);
        *bend = fabs(b) > fabs(2.0 * b - c) ? b : 2.0 * b - c;
    }
}

/* What the joints allow on a piece: the least of its steps. A fault is where they are slowest. */
static void allow(const struct survey *s, double from, double size, struct look *k)
{
    const double h = size * s->path->length / STEPS;
    double most = 0.0, most_acc = 0.0;

    k->cap = s->l->feed;
    k->acc = s->l->acc;
    for (int n = 0; n <= STEPS; n++) {
        double cap = s->l->feed, acc = s->l->acc, slope[OPW_JOINTS], bend[OPW_JOINTS];
        for (int i = 0; i < OPW_JOINTS; i++) {
            derivatives(k, n, i, h, &slope[i], &bend[i]);
            cap = el_min(cap, s->l->speed[i] / fabs(slope[i]));
            cap = el_min(cap, sqrt(BENT * MARGIN * s->l->turn[i] / fabs(bend[i])));
        }
        for (int i = 0; i < OPW_JOINTS; i++) {
            acc = el_min(acc,
                         (MARGIN * s->l->turn[i] - fabs(bend[i]) * cap * cap) / fabs(slope[i]));
        }
        if (cap < k->cap) {
            k->cap = cap;
            fault(s, WAY_SINGULAR, from + size * n / STEPS, k->q[n], 0);
        }
        k->acc = el_min(k->acc, acc);
        most = el_max(most, cap);
        most_acc = el_max(most_acc, acc);
    }
    k->even = most <= el_pow(UNEVEN_SPEED, s->wide) * k->cap &&
              most_acc <= el_pow(UNEVEN_ACC, s->wide) * k->acc;
}

/* Pieces from start to end, each as long as its place among the halves of halves and its evenness
 * allow. WAY_PIECES + 1: too many. */
static enum way_status cut(struct way *w, const struct survey *s, double joint[OPW_JOINTS])
{
    double at = 0.0, size = 1.0;
    struct look k;

    w->count = w->next = 0;
    memcpy(k.q[0], joint, sizeof k.q[0]);
    while (at < 1.0) {
        enum way_status status = walk(s, at, size, &k);
        const bool least = size * w->path.length <= LEAST;
        if (status == WAY_OK) {
            allow(s, at, size, &k);
            if (s->l->refuse && (k.even || least) && k.cap < s->l->feed) {
                return WAY_SINGULAR;
            }
        } else if (least) {
            return status;
        }
        if (status != WAY_OK || (!k.even && !least)) {
            size *= 0.5;
            continue;
        }
        at += size;
        if (w->count == WAY_PIECES) {
            w->count++;
            return WAY_OK;
        }
        w->piece[w->count++] = (struct way_piece){ at, k.cap, k.acc };
        memcpy(k.q[0], k.q[STEPS], sizeof k.q[0]);
        while (at < 1.0 && fmod(at, 2.0 * size) == 0.0 && at + 2.0 * size <= 1.0) {
            size *= 2.0;
        }
    }
    memcpy(joint, k.q[0], sizeof k.q[0]);
    return WAY_OK;
}

/* A mean over a time mixes accelerations of places as far apart as the tool goes in it: the least
 * holds for all of them. */
static void spread(struct way *w, double smooth)
{
    double acc[WAY_PIECES];

    for (int n = 0; n < w->count; n++) {
        acc[n] = w->piece[n].acc;
    }
    for (int n = 0; n < w->count; n++) {
        const double reach = w->piece[n].cap * smooth / w->path.length;
        for (int k = n - 1; k >= 0 && w->piece[n - 1].until - w->piece[k].until < reach; k--) {
            w->piece[k].acc = el_min(w->piece[k].acc, acc[n]);
        }
        for (int k = n + 1; k < w->count && w->piece[k - 1].until - w->piece[n].until < reach;
             k++) {
            w->piece[k].acc = el_min(w->piece[k].acc, acc[n]);
        }
    }
}

/* In a corner the acceleration may have any direction: what it asks of the joints at a place. */
static double any_direction(const struct survey *s, const double joint[OPW_JOINTS], double acc)
{
    const struct course_move *m = &s->g->course->move[(s->g->course->count - 1) % COURSE_SIZE];
    double way[OPW_JOINTS] = { 0 }, turn[OPW_JOINTS] = { 0 }, rate[OPW_JOINTS];

    for (int k = 0; k < 6; k++) {
        double motion[6] = { 0 };
        motion[k] = k < 3 ? 1.0 : 1.0 / COURSE_LEVER;
        if (!manipulator_rates(s->g->arm, joint, motion, rate)) {
            return acc;
        }
        for (int i = 0; i < OPW_JOINTS; i++) {
            *(k < 3 ? &way[i] : &turn[i]) += rate[i] * rate[i];
        }
    }
    for (int i = 0; i < OPW_JOINTS; i++) {
        const double both = sqrt(way[i]) + (m->to > m->from ? sqrt(turn[i]) : 0.0);
        acc = el_min(acc, CORNER * s->l->turn[i] / both);
    }
    return acc;
}

enum way_status way_plan(struct way *w, const struct course_geometry *g,
                         const struct way_limits *l, double joint[OPW_JOINTS],
                         struct way_fault *fault_)
{
    const struct kinematics kinematics = course_kinematics();
    struct survey s = { .arm = { .kinematics = &kinematics, .geometry = g }, .g = g,
                        .l = l, .path = &w->path, .fault = fault_ };
    double q[OPW_JOINTS];

    memcpy(s.origin, joint, sizeof s.origin);
    for (s.wide = 1.0; ; s.wide *= 2.0) {
        memcpy(q, joint, sizeof q);
        const enum way_status status = cut(w, &s, q);
        if (status != WAY_OK) {
            return status;
        }
        if (w->count <= WAY_PIECES) {
            break;
        }
        if (s.wide > WIDE) {
            return fault(&s, WAY_SINGULAR, w->piece[WAY_PIECES - 1].until, q, 0);
        }
    }
    if (l->corner[0]) {
        w->piece[0].acc = any_direction(&s, joint, w->piece[0].acc);
    }
    if (l->corner[1]) {
        w->piece[w->count - 1].acc = any_direction(&s, q, w->piece[w->count - 1].acc);
    }
    double least = l->feed;
    for (int n = 0; n < w->count; n++) {
        least = el_min(least, w->piece[n].cap);
    }
    w->smooth = least < SLOW * l->feed ? 0.0 : l->smooth;
    spread(w, w->smooth);
    memcpy(joint, q, sizeof q);
    return WAY_OK;
}

void way_piece_path(const struct way *w, struct path *piece)
{
    const double from = w->next > 0 ? w->piece[w->next - 1].until : 0.0;
    const double part = w->piece[w->next].until - from, length = w->path.length;
    double slope[AXES];

    *piece = w->path;
    path_at(&w->path, from * length, piece->start, slope);
    path_at(&w->path, w->piece[w->next].until * length, piece->end, slope);
    piece->angle += from * piece->sweep;
    piece->sweep *= part;
    piece->length *= part;
}
