#include "pace_leg.h"

#include <math.h>
#include <string.h>

/* Shares of an axis' acceleration and jerk that turning may take; the rest is for ramps. */
static const double TURN_ACC = 0.95, TURN_JERK = 0.8;

/* Legs become one while that costs less than so much of the time in which the acceleration
 * rises. */
static const double JOIN = 0.05;

/* A ramp whose limits at both ends are so much alike is made as one. */
static const double LIKE = 0.8;

/* Most speeds are found to 2^-STEPS of a range, on the safe side, the least that can be reached to
 * 2^-LOW_STEPS; a way that is met again may be missed by ROUNDING. */
enum { STEPS = 14, LOW_STEPS = 40 };
static const double ROUNDING = 1e-9;

bool pace_by_axes(const struct pace_limits *l)
{
    double sum = 0.0;

    for (int k = 0; k < AXES; k++) {
        sum += l->acc[k];
    }
    return sum > 0.0;
}

static double path_jerk(const struct ramp_limits *r)
{
    return fmin(r->acc_jerk, r->dec_jerk);
}

/* Speed of an axis' turn alone. */
static double turn_speed(double bend, double twist, double acc, double jerk)
{
    const double v = bend > 0.0 ? sqrt(acc / bend) : INFINITY;
    return twist > 0.0 ? fmin(v, cbrt(jerk / twist)) : v;
}

/* Speed whose turn takes shares of the acceleration and jerk. */
static double cap_of(const struct pace_leg *g, const struct pace_limits *l, double acc, double jerk)
{
    double cap = g->cap;

    if (!pace_by_axes(l)) {
        cap = fmin(cap, turn_speed(g->most[1], g->most[2],
                                   acc * fmin(g->ramp.acc, g->ramp.dec),
                                   jerk * path_jerk(&g->ramp)));
    }
    for (int k = 0; k < g->axes; k++) {
        const double most = l->jerk[k] > 0.0 ? l->jerk[k] : INFINITY;
        if (l->acc[k] > 0.0) {
            cap = fmin(cap, turn_speed(g->bound[1][k], g->bound[2][k], acc * l->acc[k],
                                       jerk * most));
        }
        if (l->speed[k] > 0.0 && g->bound[0][k] * cap > l->speed[k]) {
            cap = l->speed[k] / g->bound[0][k];
        }
    }
    return cap;
}

static void limit(struct pace_leg *g, const struct pace_limits *l)
{
    g->cap = cap_of(g, l, 1.0, 1.0);
    g->brisk = cap_of(g, l, TURN_ACC, TURN_JERK);
}

void pace_leg_make(struct pace_leg *g, const struct piece *p, const struct pace_limits *l,
                   double length, const struct piece_bounds *b)
{
    *g = (struct pace_leg){ .length = length, .feed = p->feed / b->most[0],
                            .cap = p->cap / b->most[0], .ramp = p->ramp };
    g->ramp.acc_jerk = p->ramp.acc_jerk > 0.0 ? p->ramp.acc_jerk : INFINITY;
    g->ramp.dec_jerk = p->ramp.dec_jerk > 0.0 ? p->ramp.dec_jerk : INFINITY;
    memcpy(g->most, b->most, sizeof g->most);
    g->axes = b->axes > 0 ? b->axis[b->axes - 1] + 1 : 0;
    for (int n = 0; n < 3; n++) {
        for (int k = 0; k < g->axes; k++) {
            g->bound[n][k] = fmax(fabs(b->low[n][k]), fabs(b->high[n][k]));
        }
    }
    limit(g, l);
    g->ideal = g->length / fmin(g->cap, g->feed);
}

/* Most of the acceleration and jerk of the way at speeds up to v. */
static void room(const struct pace_leg *g, const struct pace_limits *l, double v, double *acc,
                 double *jerk)
{
    double a = INFINITY, j = INFINITY;

    for (int k = 0; k < g->axes; k++) {
        const double p = g->bound[0][k], q = g->bound[1][k];
        if (l->acc[k] > 0.0 && p > 0.0) {
            a = fmin(a, (l->acc[k] - q * v * v) / p);
        }
        if (l->jerk[k] > 0.0 && q > 0.0) {  /* half of what is left for 3 r'' v a */
            a = fmin(a, (l->jerk[k] - g->bound[2][k] * v * v * v) / (6.0 * q * v));
        }
    }
    if (!pace_by_axes(l)) {
        a = fmin(g->ramp.acc, g->ramp.dec) / g->most[0];
        j = path_jerk(&g->ramp) / g->most[0];
    }
    for (int k = 0; k < g->axes; k++) {
        const double p = g->bound[0][k], q = g->bound[1][k];
        if (l->jerk[k] > 0.0 && p > 0.0) {
            j = fmin(j, (l->jerk[k] - g->bound[2][k] * v * v * v - 3.0 * q * v * a) / p);
        }
    }
    *acc = fmax(0.0, a);
    *jerk = fmax(0.0, j);
}

bool pace_leg_join(struct pace_leg *g, const struct pace_leg *next, const struct pace_limits *l)
{
    struct pace_leg both = *g;
    double acc, jerk;

    for (int n = 0; n < 3; n++) {
        both.most[n] = fmax(both.most[n], next->most[n]);
        for (int k = 0; k < AXES; k++) {
            both.bound[n][k] = fmax(both.bound[n][k], next->bound[n][k]);
        }
    }
    both.axes = g->axes > next->axes ? g->axes : next->axes;
    both.length += next->length;
    both.feed = fmin(both.feed, next->feed);
    both.cap = fmin(both.cap, next->cap);
    both.ramp.acc = fmin(both.ramp.acc, next->ramp.acc);
    both.ramp.dec = fmin(both.ramp.dec, next->ramp.dec);
    both.ramp.acc_jerk = fmin(both.ramp.acc_jerk, next->ramp.acc_jerk);
    both.ramp.dec_jerk = fmin(both.ramp.dec_jerk, next->ramp.dec_jerk);
    both.ideal += next->ideal;
    both.last = next->last;
    limit(&both, l);
    room(&both, l, 0.0, &acc, &jerk);
    if (both.length / fmin(both.cap, both.feed) - both.ideal > JOIN * acc / jerk) {
        return false;
    }
    *g = both;
    return true;
}

struct pace_ramp pace_ramp_make(const struct pace_leg *g, const struct pace_limits *l, double from,
                                double to)
{
    struct pace_ramp r = { from, to, 0.0, 0.0 };

    room(g, l, fmax(from, to), &r.acc, &r.jerk);
    return r;
}

/* Time in which the acceleration rises, and in which it stays. */
static void phases(const struct pace_ramp *r, double *rise, double *stay)
{
    const double dv = fabs(r->to - r->from);

    *rise = r->acc / r->jerk;
    if (dv <= 0.0) {
        *rise = *stay = 0.0;
    } else if (dv >= r->acc * *rise) {
        *stay = dv / r->acc - *rise;
    } else {
        *rise = sqrt(dv / r->jerk);
        *stay = 0.0;
    }
}

double pace_ramp_time(const struct pace_ramp *r)
{
    double rise, stay;

    phases(r, &rise, &stay);
    return 2.0 * rise + stay;
}

double pace_ramp_way(const struct pace_ramp *r)
{
    return 0.5 * (r->from + r->to) * pace_ramp_time(r);
}

struct pace_motion pace_ramp_at(const struct pace_ramp *r, double t)
{
    const double sign = r->to < r->from ? -1.0 : 1.0, j = sign * r->jerk;
    double rise, stay;

    phases(r, &rise, &stay);
    if (t < rise) {
        return (struct pace_motion){ t * (r->from + j * t * t / 6.0), r->from + 0.5 * j * t * t,
                                     j * t, j };
    }
    if (t < rise + stay) {
        const double a = j * rise, v = r->from + 0.5 * a * rise, s = t - rise;
        return (struct pace_motion){ rise * (r->from + a * rise / 6.0) + s * (v + 0.5 * a * s),
                                     v + a * s, a, 0.0 };
    }
    const double s = fmax(0.0, 2.0 * rise + stay - t);      /* the rise backwards */
    return (struct pace_motion){ pace_ramp_way(r) - s * (r->to - j * s * s / 6.0),
                                 fmax(0.0, r->to - 0.5 * j * s * s), j * s, -j };
}

bool pace_ramp_open(const struct pace_ramp *r, double t)
{
    double rise, stay;

    phases(r, &rise, &stay);
    return t <= rise + stay;
}

struct pace_ramp pace_ramp_cut(const struct pace_ramp *r, double t)
{
    const struct pace_motion m = pace_ramp_at(r, t);
    struct pace_ramp cut = *r;

    cut.to = m.rate + m.gain * fabs(m.gain) / (2.0 * r->jerk);
    return cut;
}

double pace_leg_stage(const struct pace_leg *g, const struct pace_limits *l, double from,
                      double to)
{
    static const double parts[] = { 0.5, 0.7, 0.85 };
    const double low = fmin(from, to), high = fmax(from, to);
    struct pace_ramp r = pace_ramp_make(g, l, low, high);
    double best = high, least = pace_ramp_way(&r), acc, jerk;

    room(g, l, low, &acc, &jerk);
    if (r.acc > LIKE * acc && r.jerk > LIKE * jerk) {
        return to;
    }
    for (int i = 0; i < 3; i++) {
        const double v = low + parts[i] * (high - low);
        const struct pace_ramp slow = pace_ramp_make(g, l, low, v);
        const struct pace_ramp fast = pace_ramp_make(g, l, v, high);
        const double way = pace_ramp_way(&slow) + pace_ramp_way(&fast);
        if (way < least) {
            least = way;
            best = v;
        }
    }
    return best < high ? best : to;
}

double pace_leg_way(const struct pace_leg *g, const struct pace_limits *l, double from, double to)
{
    const double stage = pace_leg_stage(g, l, from, to);
    const struct pace_ramp a = pace_ramp_make(g, l, from, stage);
    const struct pace_ramp b = pace_ramp_make(g, l, stage, to);

    return pace_ramp_way(&a) + (stage != to ? pace_ramp_way(&b) : 0.0);
}

double pace_leg_enter(const struct pace_leg *g, const struct pace_limits *l, double to, double most,
                      double way)
{
    double low = fmin(to, most), high = most;

    if (high <= low || pace_leg_way(g, l, high, low) <= way) {
        return high;
    }
    for (int i = 0; i < STEPS; i++) {
        const double v = 0.5 * (low + high);
        *(pace_leg_way(g, l, v, to) <= way ? &low : &high) = v;
    }
    return low;
}

/* Way from one speed to a peak and down to another, with the limits of the peak. */
static double over(const struct pace_leg *g, const struct pace_limits *l, double from, double peak,
                   double to)
{
    return pace_leg_way(g, l, from, peak) + (to < peak ? pace_leg_way(g, l, peak, to) : 0.0);
}

double pace_leg_peak(const struct pace_leg *g, const struct pace_limits *l, double from, double to,
                     double most, double way)
{
    double low = from, high = fmax(from, fmin(most, g->brisk));

    if (over(g, l, from, high, to) <= way) {
        return high;
    }
    for (int i = 0; i < STEPS; i++) {
        const double v = 0.5 * (low + high);
        *(over(g, l, from, v, to) <= way ? &low : &high) = v;
    }
    return low;
}

double pace_leg_low(const struct pace_leg *g, const struct pace_limits *l, double from, double want,
                    double way)
{
    double good = from, bad = want;

    way *= 1.0 + ROUNDING;
    if (pace_leg_way(g, l, from, want) <= way) {
        return want;
    }
    /* To rest takes less way than to a low speed with a = 0: most is needed to from / 3. */
    if (pace_leg_way(g, l, from, 0.0) <= way) {
        good = 0.0;
    }
    for (int i = 0; i < LOW_STEPS; i++) {
        const double v = 0.5 * (good + bad);
        *(pace_leg_way(g, l, from, v) <= way ? &good : &bad) = v;
    }
    return good;
}
