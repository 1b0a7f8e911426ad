#include "tool_path.h"

#include <math.h>
#include <string.h>

#include "bounds.h"
#include "el_extremes.h"
#include "elementary.h"

enum { STEPS = 8 }; /* into which a segment is divided to sample its joints */

/* Share of a joint's acceleration limit that q'' v^2, the part from the curvature of the joint's
 * path q(s), may take where it limits the speed v; the rest is left for changes of speed. */
static const double BENT = 0.6;

/* Largest ratio of the limits of acceleration within a segment, of speed TOOL_PATH_UNEVEN. If the
 * path then has more segments than there is room for, the square of these ratios is tried, then the
 * 4th power, and so on until the power is above WIDE. */
static const double UNEVEN_ACC = 1.5;

static const double WIDE = 64.0;

/* Share of the joints' acceleration limits that is used at the samples, as the joints may need more
 * between them. */
static const double MARGIN = 0.99;

/* If the speed falls below this share of the feed anywhere on the path, look-ahead takes no mean of
 * the speed: it would spread the slow part over the whole distance that is looked ahead. */
static const double SLOW = 0.5;

/* Largest turn of a joint from one sample to the next; beyond it the segment is halved. [rad] */
static const double STEP = 0.2;

/* Shortest segment. [mm] */
static const double LEAST = 1e-7;

/* Share of a joint's acceleration limit that a corner may take, in any direction of the tool. */
static const double CORNER = 0.6;

/* A corner that leaves less than this share of the acceleration of the segment beside it becomes a
 * stop: that costs two ramps, while crawling through the corner would take much longer. */
static const double CRAWL = 0.02;

/* Length of the segment that a corner gets on either side, in units of its zone: as much as a
 * corner of 12 degrees needs. */
static const double LONG = 10.0;

/* The proof of a segment's limits by bounds halves it so often before limits that do not hold are
 * lowered (FINE), before bounds are given up beside a singular place that is met (CORE). DEEP is
 * the most, to come near to the limit of a joint. */
enum { FINE = 6, CORE = 10, DEEP = 40 };

/* Farthest that a joint may go while its latest position still identifies it: no other branch and
 * no other whole turn is nearer. [rad] */
static const double KNOWN = 1.0;

/* Bounds may lower the acceleration of a segment to no less than this share; else it is halved. */
static const double LOWERED = 0.5;

/* Error of a joint by rounding beside a singular place. [rad] */
static const double LEAP = 1e-4;

/* A factor of manipulator_factors() below this is 0 within rounding: the place is singular. */
static const double MET = 1e-9;

/* The path that is cut, with all that this needs. */
struct survey {
    struct mechanism arm;
    const struct arm_geometry *g;
    const struct tool_path_limits *l;
    const struct path *path;
    double wide; /* power of TOOL_PATH_UNEVEN and UNEVEN_ACC that is allowed now */
    struct tool_path_fault *fault;
    double origin[OPW_JOINTS]; /* [rad] at the start of the path */
};

/* A segment as its samples show it. */
struct look {
    double q[STEPS + 1][OPW_JOINTS]; /* [rad] joints at the samples */
    double cap, acc;                 /* [mm/s], [mm/s^2] limits along the path on all of it */
    bool even;                       /* the limits differ little enough within it, and are proved */
    bool met;                        /* it meets a singular place, beside which no bounds hold */
};

static bool joints_at(const struct survey *s, double part, double joint[OPW_JOINTS])
{
    double place[AXES], slope[AXES];
    path_at(s->path, part * s->path->length, place, slope);
    return mechanism_joints(&s->arm, place, joint);
}

/* True if joints at two places in a row lie on different sides of a singular place. */
static bool flips(const struct survey *s, const double a[OPW_JOINTS], const double b[OPW_JOINTS])
{
    return manipulator_branch(s->g->arm, a) != manipulator_branch(s->g->arm, b);
}

/* The joints flip between parts a and b of the path. True if the path meets the singular place, so
 * that the joints go on smoothly; false if it passes by, so that they turn quickly. Bisection down
 * to LEAST tells which. */
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

static enum tool_path_status fault(const struct survey *s, enum tool_path_status why, double part,
                                   const double joint[OPW_JOINTS], int which)
{
    s->fault->part = part;
    s->fault->which = which;
    memcpy(s->fault->joint, joint, sizeof s->fault->joint);
    return why;
}

/* Find the joints at the samples of a segment. */
static enum tool_path_status walk(const struct survey *s, double from, double size, struct look *k)
{
    for (int n = 1; n <= STEPS; n++) {
        const double part = from + size * n / STEPS, before = from + size * (n - 1) / STEPS;
        double *q = k->q[n];
        for (int i = 0; i < OPW_JOINTS; i++) { /* where a joint is free it goes on evenly */
            q[i] = n > 1 ? 2.0 * k->q[n - 1][i] - k->q[n - 2][i] : k->q[0][i];
        }
        if (!joints_at(s, part, q)) {
            return fault(s, TOOL_PATH_FAR, before, k->q[n - 1], 0);
        }
        bool jumps = false;
        for (int i = 0; i < OPW_JOINTS; i++) {
            jumps = jumps || !(fabs(q[i] - k->q[n - 1][i]) <= STEP);
        }
        if (jumps || (flips(s, k->q[n - 1], q) && !meets(s, before, k->q[n - 1], part, q))) {
            return fault(s, TOOL_PATH_SINGULAR, before, k->q[n - 1], 0);
        }
        const int out = manipulator_outside(s->g->arm, s->origin, q);
        if (out >= 0) {
            return fault(s, TOOL_PATH_OUTSIDE, before, q, out);
        }
    }
    return TOOL_PATH_OK;
}

/* First and second derivative of a joint by the path length s at a sample, from central differences
 * with step h [mm]; at the ends extrapolated from within. [rad/mm], [rad/mm^2] */
static void derivatives(const struct look *k, int n, int i, double h, double *slope, double *bend)
{
    const int m = n == 0 ? 1 : n == STEPS ? STEPS - 1 : n, side = n - m;

    *bend = (k->q[m + 1][i] - 2.0 * k->q[m][i] + k->q[m - 1][i]) / (h * h);
    *slope = (k->q[m + 1][i] - k->q[m - 1][i]) / (2.0 * h) + side * h * *bend;
}

/* Limits along the path that the joints allow on a segment, the least of its samples. With speed v
 * and acceleration a along the path, q(s) the joint:
 *
 *     |q'| v <= speed     |q''| v^2 <= BENT turn     |q'| a + |q''| v^2 <= turn
 *
 * A fault is noted where the joints are slowest. */
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
            acc =
                el_min(acc, (MARGIN * s->l->turn[i] - fabs(bend[i]) * cap * cap) / fabs(slope[i]));
        }
        if (cap < k->cap) {
            k->cap = cap;
            fault(s, TOOL_PATH_SINGULAR, from + size * n / STEPS, k->q[n], 0);
        }
        k->acc = el_min(k->acc, acc);
        most = el_max(most, cap);
        most_acc = el_max(most_acc, acc);
    }
    k->even = most <= el_pow(TOOL_PATH_UNEVEN, s->wide) * k->cap
              && most_acc <= el_pow(UNEVEN_ACC, s->wide) * k->acc;
}

/* True if the limits of a segment hold for these bounds of the joints' derivatives. With `lower`
 * the limits are lowered until they do, if that leaves enough acceleration. */
static bool keeps(const struct survey *s, const struct bounds_pair *d, bool lower, struct look *k)
{
    double cap = k->cap, acc = k->acc;

    for (int i = 0; i < OPW_JOINTS; i++) {
        cap = el_min(cap, s->l->speed[i] / d->slope[i]);
    }
    for (int i = 0; i < OPW_JOINTS; i++) {
        acc = el_min(acc, (s->l->turn[i] - d->bend[i] * cap * cap) / d->slope[i]);
    }
    if (lower && acc >= LOWERED * k->acc) {
        k->cap = cap;
        k->acc = acc;
    }
    return cap >= k->cap && acc >= k->acc;
}

/* True if the joints stay within their limits all over a part, half [mm] long to either side of
 * joint[]. */
static bool within(const struct survey *s, const double joint[OPW_JOINTS], const struct bounds *b,
                   double half)
{
    double up[OPW_JOINTS], down[OPW_JOINTS];

    for (int i = 0; i < OPW_JOINTS; i++) {
        up[i] = joint[i] + b->most.slope[i] * half;
        down[i] = joint[i] - b->most.slope[i] * half;
    }
    return manipulator_outside(s->g->arm, s->origin, up) < 0
           && manipulator_outside(s->g->arm, s->origin, down) < 0;
}

/* True if the bounds b identify the joints all over a part, half [mm] long to either side of its
 * middle, from the joints at its start and middle. */
static bool followed(const struct survey *s, const double start[OPW_JOINTS],
                     const double middle[OPW_JOINTS], const struct bounds *b, double half)
{
    bool good = !flips(s, start, middle) && within(s, middle, b, half);

    for (int i = 0; i < OPW_JOINTS; i++) {
        good = good && 2.0 * half * b->most.slope[i] <= KNOWN;
    }
    return good;
}

/* True if joints go further from the middle to an end of a part than its bounds allow: they leap to
 * another branch of the elbow. */
static bool leaps(const double middle[OPW_JOINTS], const double end[OPW_JOINTS],
                  const struct bounds *b, double half)
{
    bool found = false;

    for (int i = 0; i < OPW_JOINTS; i++) {
        found = found || fabs(end[i] - middle[i]) > b->most.slope[i] * half + LEAP;
    }
    return found;
}

/* True if wrist or shoulder is singular at these joints, within rounding. */
static bool singular(const struct survey *s, const double joint[OPW_JOINTS])
{
    double factor[3];

    manipulator_factors(s->g->arm, joint, factor);
    return fabs(factor[0]) < MET || fabs(factor[2]) < MET;
}

/* Angle by which the whole path turns: that of the tool plus that of the arc. [rad] */
static double turning(const struct survey *s)
{
    const struct arm_moves *c = s->g->moves;
    const double *by = c->move[(c->count - 1) % ARM_MOVES_SIZE].by;
    const double tool = sqrt(by[0] * by[0] + by[1] * by[1] + by[2] * by[2]);
    return tool + (s->path->arc ? fabs(s->path->sweep) : 0.0);
}

/* True if the limits of k hold everywhere between two parts of the path, not only at the samples:
 * bounds prove it for the whole, or for its halves. Where there are no bounds a singular place is
 * met, which the joints pass smoothly, as the samples show. joint[] is moved from the start to the
 * end.
 * CCN 24: a proof by halves: each way to decide an interval, before it is halved. */
static bool proved(const struct survey *s, double from, double to, int depth,
                   double joint[OPW_JOINTS], struct look *k)
{
    const double mid = 0.5 * (from + to), half = 0.5 * (to - from) * s->path->length;
    double middle[OPW_JOINTS], end[OPW_JOINTS];
    struct bounds b;

    memcpy(middle, joint, sizeof middle);
    if (!joints_at(s, mid, middle) || manipulator_outside(s->g->arm, s->origin, middle) >= 0) {
        return false;
    }
    memcpy(end, middle, sizeof end);
    if (bounds_of(s->g, s->path, from, to, middle, &b)) {
        if (followed(s, joint, middle, &b, half)) {
            const bool here = keeps(s, &b.middle, false, k);
            const bool lower = depth >= FINE && (!here || (depth >= CORE && !k->met));
            if (keeps(s, &b.most, lower, k) || (here && k->met && depth >= CORE)) {
                memcpy(joint, end, sizeof end);
                return joints_at(s, to, joint) && !leaps(middle, joint, &b, half);
            }
            if (lower) {
                return false;
            }
        }
    } else if (turning(s) * (to - from) <= KNOWN) {
        if (!joints_at(s, to, end)) {
            return false;
        }
        const bool first = singular(s, joint), last = singular(s, end);
        if (depth >= CORE || (first && last && singular(s, middle))) {
            const bool met = flips(s, joint, end) ? meets(s, from, joint, to, end) : first || last;
            memcpy(joint, end, sizeof end);
            return met;
        }
    }
    return depth < DEEP && proved(s, from, mid, depth + 1, joint, k)
           && proved(s, mid, to, depth + 1, joint, k);
}

/* True if the limits of a sampled segment hold all over it, after they have been lowered if need
 * be. */
static bool certain(const struct survey *s, double from, double size, struct look *k)
{
    const double cap = k->cap;
    double joint[OPW_JOINTS];

    memcpy(joint, k->q[0], sizeof joint);
    k->met = singular(s, joint);
    for (int n = 1; n <= STEPS; n++) {
        k->met = k->met || singular(s, k->q[n]) || flips(s, k->q[n - 1], k->q[n]);
    }
    bool good = proved(s, from, from + size, 0, joint, k);
    for (int i = 0; i < OPW_JOINTS; i++) { /* the samples have not missed a turn */
        good = good && fabs(joint[i] - k->q[STEPS][i]) <= STEP;
    }
    if (good && k->cap < cap) {
        fault(s, TOOL_PATH_SINGULAR, from + 0.5 * size, k->q[STEPS / 2], 0);
    }
    return good;
}

/* True if joints leap within a segment of the shortest length. */
static bool torn(const struct survey *s, double from, double size, const struct look *k)
{
    const double half = 0.5 * size * s->path->length, *middle = k->q[STEPS / 2];
    struct bounds b;

    return bounds_of(s->g, s->path, from, from + size, middle, &b)
           && (leaps(middle, k->q[0], &b, half) || leaps(middle, k->q[STEPS], &b, half));
}

/* Cut the path into segments from start to end. Each is 2^-n of the path, begins at a multiple of
 * that, and is as long as its limits are even. w->count is TOOL_PATH_SEGMENTS + 1 if there are too
 * many.
 * CCN 18: a size is taken, halved, doubled again or refused, and a refusal needs the least one. */
static enum tool_path_status cut(struct tool_path *w, const struct survey *s,
                                 double joint[OPW_JOINTS])
{
    double at = 0.0, size = 1.0;
    struct look k;

    w->count = w->next = 0;
    memcpy(k.q[0], joint, sizeof k.q[0]);
    while (at < 1.0) {
        enum tool_path_status status = walk(s, at, size, &k);
        const bool least = size * w->path.length <= LEAST;
        if (status == TOOL_PATH_OK) {
            allow(s, at, size, &k);
            k.even = k.even && certain(s, at, size, &k);
            if (least && torn(s, at, size, &k)) {
                return fault(s, TOOL_PATH_SINGULAR, at, k.q[0], 0);
            }
            if (s->l->refuse && (k.even || least) && k.cap < s->l->feed) {
                return TOOL_PATH_SINGULAR;
            }
        } else if (least) {
            return status;
        }
        if (status != TOOL_PATH_OK || (!k.even && !least)) {
            size *= 0.5;
            continue;
        }
        at += size;
        if (w->count == TOOL_PATH_SEGMENTS) {
            w->count++;
            return TOOL_PATH_OK;
        }
        w->segment[w->count++] = (struct tool_path_segment){ at, k.cap, k.acc };
        memcpy(k.q[0], k.q[STEPS], sizeof k.q[0]);
        while (at < 1.0 && fmod(at, 2.0 * size) == 0.0 && at + 2.0 * size <= 1.0) {
            size *= 2.0;
        }
    }
    memcpy(joint, k.q[0], sizeof k.q[0]);
    return TOOL_PATH_OK;
}

/* The mean of look-ahead over a time `smooth` [s] mixes the accelerations of places that are as far
 * apart as the tool goes in that time. So each segment gets the least acceleration of those within
 * that reach. */
static void spread(struct tool_path *w, double smooth)
{
    double acc[TOOL_PATH_SEGMENTS];

    for (int n = 0; n < w->count; n++) {
        acc[n] = w->segment[n].acc;
    }
    for (int n = 0; n < w->count; n++) {
        const double reach = w->segment[n].cap * smooth / w->path.length;
        for (int k = n - 1; k >= 0 && w->segment[n - 1].until - w->segment[k].until < reach; k--) {
            w->segment[k].acc = el_min(w->segment[k].acc, acc[n]);
        }
        for (int k = n + 1; k < w->count && w->segment[k - 1].until - w->segment[n].until < reach;
             k++) {
            w->segment[k].acc = el_min(w->segment[k].acc, acc[n]);
        }
    }
}

/* In a corner the tool's acceleration may have any direction. Returns the highest acceleration, at
 * most acc [mm/s^2], that the joints allow in every direction at a place. */
static double any_direction(const struct survey *s, const double joint[OPW_JOINTS], double acc)
{
    const struct arm_move *m = &s->g->moves->move[(s->g->moves->count - 1) % ARM_MOVES_SIZE];
    double way[OPW_JOINTS] = { 0 }, turn[OPW_JOINTS] = { 0 }, rate[OPW_JOINTS];

    for (int k = 0; k < 6; k++) {
        double motion[6] = { 0 };
        motion[k] = k < 3 ? 1.0 : 1.0 / ARM_MOVES_LEVER;
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

/* Split the segment in which part `at` of the path lies, unless a piece would be too short or there
 * is no room. */
static void split(struct tool_path *w, double at)
{
    int n = 0;

    while (n < w->count && w->segment[n].until <= at) {
        n++;
    }
    const double from = n > 0 ? w->segment[n - 1].until : 0.0;
    if (n == w->count || w->count == TOOL_PATH_SEGMENTS || (at - from) * w->path.length < LEAST
        || (w->segment[n].until - at) * w->path.length < LEAST) {
        return;
    }
    memmove(&w->segment[n + 1], &w->segment[n], (size_t)(w->count - n) * sizeof *w->segment);
    w->segment[n].until = at;
    w->count++;
}

/* Prepare a corner at one end of the path (side 0: start): a segment beside it, no longer than the
 * corner needs, gets an acceleration that holds in every direction. A second one behind it keeps
 * the mean of look-ahead from mixing it with the rest. A short segment gets it as a whole. False,
 * and nothing is lowered, if the tool would crawl. */
static bool lead(struct tool_path *w, const struct survey *s, int side,
                 const double joint[OPW_JOINTS])
{
    const struct tool_path_segment *p = &w->segment[side == 0 ? 0 : w->count - 1];
    const double acc = any_direction(s, joint, p->acc), length = s->path->length;
    const double own = LONG * s->l->zone[side] / length;
    const double mean = p->cap * w->smooth / length;

    if (acc < CRAWL * p->acc) {
        return false;
    }
    const double room = side == 0 ? p->until : 1.0 - (w->count > 1 ? p[-1].until : 0.0);
    if (acc < p->acc && 2.0 * (own + mean) < room) {
        split(w, side == 0 ? own + mean : 1.0 - own - mean);
        split(w, side == 0 ? own : 1.0 - own);
    }
    w->segment[side == 0 ? 0 : w->count - 1].acc = acc;
    return true;
}

enum tool_path_status tool_path_plan(struct tool_path *w, const struct arm_geometry *g,
                                     const struct tool_path_limits *l, double joint[OPW_JOINTS],
                                     struct tool_path_fault *fault_)
{
    const struct kinematics kinematics = arm_moves_kinematics();
    struct survey s = { .arm = { .kinematics = &kinematics, .geometry = g },
                        .g = g,
                        .l = l,
                        .path = &w->path,
                        .fault = fault_ };
    double q[OPW_JOINTS];

    memcpy(s.origin, joint, sizeof s.origin);
    for (s.wide = 1.0;; s.wide *= 2.0) {
        memcpy(q, joint, sizeof q);
        const enum tool_path_status status = cut(w, &s, q);
        if (status != TOOL_PATH_OK) {
            return status;
        }
        if (w->count <= TOOL_PATH_SEGMENTS) {
            break;
        }
        if (s.wide > WIDE) {
            return fault(&s, TOOL_PATH_SINGULAR, w->segment[TOOL_PATH_SEGMENTS - 1].until, q, 0);
        }
    }
    double least = l->feed;
    for (int n = 0; n < w->count; n++) {
        least = el_min(least, w->segment[n].cap);
    }
    w->smooth = least < SLOW * l->feed ? 0.0 : l->smooth;
    for (int side = 0; side < 2; side++) {
        w->stop[side] = l->zone[side] > 0.0 && !lead(w, &s, side, side == 0 ? joint : q);
    }
    spread(w, w->smooth);
    memcpy(joint, q, sizeof q);
    return TOOL_PATH_OK;
}

void tool_path_next(const struct tool_path *w, struct path *segment)
{
    const double from = w->next > 0 ? w->segment[w->next - 1].until : 0.0;
    const double part = w->segment[w->next].until - from, length = w->path.length;
    double slope[AXES];

    *segment = w->path;
    path_at(&w->path, from * length, segment->start, slope);
    path_at(&w->path, w->segment[w->next].until * length, segment->end, slope);
    segment->angle += from * segment->sweep;
    segment->sweep *= part;
    segment->length *= part;
}
