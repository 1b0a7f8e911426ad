#include "tool_path.h"

#include <math.h>
#include <string.h>

#include "bounds.h"
#include "el_extremes.h"
#include "elementary.h"

enum { STEPS = 8 }; /* of a segment that is looked at */

/* Share of a joint's acceleration that the bend of its way may take where it limits the speed; the
 * rest changes the speed. */
static const double BENT = 0.6;

/* Most that limits may differ within a segment; with more segments than there is room the square of
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

/* No segment is shorter. [mm] */
static const double LEAST = 1e-7;

/* Share of a joint's acceleration for what a corner asks across the path. */
static const double CORNER = 0.6;

/* A corner that leaves less than this share of the acceleration of the segment beside it is not
 * driven: a stop costs two ramps, and crawling for it much more. */
static const double CRAWL = 0.02;

/* Way on either side that a corner gets, in its zones: as long as one of 12 degrees needs. */
static const double LONG = 10.0;

/* A segment is halved in thought so often before limits that do not hold are lowered; before bounds
 * are given up beside a singular place that is met; to come near to the limit of a joint. */
enum { FINE = 6, CORE = 10, DEEP = 40 };

/* Farthest that a joint may go while it is known by where it was: no branch and no turn is nearer.
 * [rad] */
static const double KNOWN = 1.0;

/* Least share of an acceleration that is lowered by bounds instead of halving its segment. */
static const double LOWERED = 0.5;

/* What rounding makes of a joint beside a singular place. [rad] */
static const double LEAP = 1e-4;

/* A factor below this is 0 but for rounding. */
static const double MET = 1e-9;

struct survey {
    struct mechanism arm;
    const struct arm_geometry *g;
    const struct tool_path_limits *l;
    const struct path *path;
    double wide; /* uneven limits that are allowed, as a power */
    struct tool_path_fault *fault;
    double origin[OPW_JOINTS]; /* [rad] at the start of the path */
};

/* A segment looked at. */
struct look {
    double q[STEPS + 1][OPW_JOINTS];
    double cap, acc;
    bool even;
    bool met; /* a singular place is met: no bounds hold beside it */
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

static enum tool_path_status fault(const struct survey *s, enum tool_path_status why, double part,
                                   const double joint[OPW_JOINTS], int which)
{
    s->fault->part = part;
    s->fault->which = which;
    memcpy(s->fault->joint, joint, sizeof s->fault->joint);
    return why;
}

/* Joints at the steps of a segment. */
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

/* First and second derivative of a joint by the way at a step, from differences; at the ends
 * carried on from within. */
static void derivatives(const struct look *k, int n, int i, double h, double *slope, double *bend)
{
    const int m = n == 0 ? 1 : n == STEPS ? STEPS - 1 : n, side = n - m;

    *bend = (k->q[m + 1][i] - 2.0 * k->q[m][i] + k->q[m - 1][i]) / (h * h);
    *slope = (k->q[m + 1][i] - k->q[m - 1][i]) / (2.0 * h) + side * h * *bend;
}

/* What the joints allow on a segment: the least of its steps. A fault is where they are slowest. */
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
    k->even = most <= el_pow(UNEVEN_SPEED, s->wide) * k->cap
              && most_acc <= el_pow(UNEVEN_ACC, s->wide) * k->acc;
}

/* Whether the limits of a segment hold for such derivatives; asked to, they are lowered to that. */
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

/* Whether all places within a reach of joints are within their limits. */
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

/* Whether bounds tell the joints all over a part, half [mm] long to either side, by those in its
 * middle and at its start. */
static bool followed(const struct survey *s, const double start[OPW_JOINTS],
                     const double middle[OPW_JOINTS], const struct bounds *b, double half)
{
    bool good = !flips(s, start, middle) && within(s, middle, b, half);

    for (int i = 0; i < OPW_JOINTS; i++) {
        good = good && 2.0 * half * b->most.slope[i] <= KNOWN;
    }
    return good;
}

/* Whether joints leap by the end of a part further than its bounds let them: another elbow. */
static bool leaps(const double middle[OPW_JOINTS], const double end[OPW_JOINTS],
                  const struct bounds *b, double half)
{
    bool found = false;

    for (int i = 0; i < OPW_JOINTS; i++) {
        found = found || fabs(end[i] - middle[i]) > b->most.slope[i] * half + LEAP;
    }
    return found;
}

/* Whether a wrist or shoulder is singular at joints, but for rounding. */
static bool singular(const struct survey *s, const double joint[OPW_JOINTS])
{
    double factor[3];

    opw_factors(&s->g->arm->opw, joint, factor);
    return fabs(factor[0]) < MET || fabs(factor[2]) < MET;
}

/* Angle that the whole path turns by, tool and arc. [rad] */
static double turning(const struct survey *s)
{
    const struct arm_moves *c = s->g->moves;
    const double *by = c->move[(c->count - 1) % ARM_MOVES_SIZE].by;
    const double tool = sqrt(by[0] * by[0] + by[1] * by[1] + by[2] * by[2]);
    return tool + (s->path->arc ? fabs(s->path->sweep) : 0.0);
}

/* Whether limits hold everywhere between two parts of the path, not at the steps only: bounds say
 * it of the whole, or of its halves. Where there are none a singular place is met, which the
 * joints pass smoothly, as the steps see it. joint[] goes on from the start to the end.
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

/* Whether the limits of a segment that was looked at hold all over it, lowered if need be. */
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
    for (int i = 0; i < OPW_JOINTS; i++) { /* the steps have not missed a turn */
        good = good && fabs(joint[i] - k->q[STEPS][i]) <= STEP;
    }
    if (good && k->cap < cap) {
        fault(s, TOOL_PATH_SINGULAR, from + 0.5 * size, k->q[STEPS / 2], 0);
    }
    return good;
}

/* Whether joints leap in a segment that cannot be shorter. */
static bool torn(const struct survey *s, double from, double size, const struct look *k)
{
    const double half = 0.5 * size * s->path->length, *middle = k->q[STEPS / 2];
    struct bounds b;

    return bounds_of(s->g, s->path, from, from + size, middle, &b)
           && (leaps(middle, k->q[0], &b, half) || leaps(middle, k->q[STEPS], &b, half));
}

/* Segments from start to end, each as long as its place among the halves of halves and its evenness
 * allow. TOOL_PATH_SEGMENTS + 1: too many.
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

/* A mean over a time mixes accelerations of places as far apart as the tool goes in it: the least
 * holds for all of them. */
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

/* In a corner the acceleration may have any direction: what it asks of the joints at a place. */
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

/* The segment in which part `at` of the path lies ends there, and another begins. */
static void split(struct tool_path *w, double at)
{
    int n = 0;

    while (n < w->count && w->segment[n].until <= at) {
        n++;
    }
    const double from = n > 0 ? w->segment[n - 1].until : 0.0;
    if (n == w->count || w->count == TOOL_PATH_SEGMENTS || at * w->path.length < LEAST
        || (at - from) * w->path.length < LEAST
        || (w->segment[n].until - at) * w->path.length < LEAST) {
        return;
    }
    memmove(&w->segment[n + 1], &w->segment[n], (size_t)(w->count - n) * sizeof *w->segment);
    w->segment[n].until = at;
    w->count++;
}

/* The corner at one end of a path: a segment beside it that is as short as it needs gets an
 * acceleration that may have any direction; farther off, a mean no longer mixes it with theirs.
 * Short segments get it whole. False, and nothing is lowered, if they would crawl. */
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
