#include "speed_box.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"
#include "elementary.h"
#include "speed_pull.h"

/* Shares of an axis' acceleration and jerk that turning may take; the rest is to change speed. */
static const double TURN_ACC = 0.97, TURN_JERK = 0.99;

/* Boxes become one while that costs less than so much of the time in which the acceleration rises,
 * and always if one is shorter than SPECK. [mm] */
static const double JOIN = 0.01, SPECK = 1e-6;

/* A step changes b by at most STEEPER of the steepest b, and x by at most FASTER of itself; it need
 * not be shorter than FINEST of a way to rest. */
static const double STEEPER = 0.25, FASTER = 0.12, FINEST = 1.0 / 16.0;

/* From nearly rest c lifts x to so much of itself at most: the jerk grows as c sqrt(x), so that a
 * tenth of c keeps its limit, and HALVES find it. */
static const double LEAP = 1000.0;

/* Most that a step may be above a limit by rounding. */
static const double ROUNDING = 1e-10;

/* Part of the larger bound by which both are widened: more than a float's rounding. */
static const double OUTWARDS = 1e-7;

/* An acceleration whose jerk has no limit is there after this time. [s] */
static const double SOON = 1e-4;

/* If c = 0 does not keep the limits, a c is looked for at SCAN places; HALVES make it better. */
enum { SCAN = 16, HALVES = 5 };

bool speed_by_axes(const struct speed_limits *l)
{
    double sum = 0.0;

    for (int k = 0; k < AXES; k++) {
        sum += l->acc[k];
    }
    return sum > 0.0;
}

/* 1 / jerk; without a limit the acceleration is there in SOON. */
static double inverse(double jerk, double acc)
{
    return jerk > 0.0 ? 1.0 / jerk : SOON / acc;
}

struct range {
    double low, high;
};

static struct range wide(struct speed_bound b)
{
    return (struct range){ b.low, b.high };
}

static struct speed_bound narrow(struct range r)
{
    const double stray = OUTWARDS * el_max(fabs(r.low), fabs(r.high));
    return (struct speed_bound){ (float)(r.low - stray), (float)(r.high + stray) };
}

static struct speed_bound cover(struct speed_bound a, struct speed_bound b)
{
    return (struct speed_bound){ a.low < b.low ? a.low : b.low, a.high > b.high ? a.high : b.high };
}

static double size(struct range r)
{
    return -r.low > r.high ? -r.low : r.high;
}

static struct range times(struct range r, double x)
{
    return x < 0.0 ? (struct range){ r.high * x, r.low * x }
                   : (struct range){ r.low * x, r.high * x };
}

static struct range plus(struct range a, struct range b)
{
    return (struct range){ a.low + b.low, a.high + b.high };
}

static double extent(struct speed_bound b)
{
    return size(wide(b));
}

static struct range scaled(struct speed_bound b, double x)
{
    return times(wide(b), x);
}

/* Speed at which turning alone takes shares `acc` and `jerk` of the limits. */
static double turn_speed(const struct speed_box *g, double acc, double jerk)
{
    double v = g->cap;

    for (int32_t i = 0; i < g->rows; i++) {
        const double a = extent(g->row[i].acc[1]), j = extent(g->row[i].jerk[2]);
        v = a > 0.0 ? el_min(v, sqrt(acc / a)) : v;
        v = j > 0.0 ? el_min(v, el_cbrt(jerk / j)) : v;
    }
    return v;
}

static void finish(struct speed_box *g)
{
    g->cap = turn_speed(g, 1.0, 1.0);
    g->brisk = turn_speed(g, TURN_ACC, TURN_JERK);
}

/* Adds a limit: bounds r of r', r'' and r''' times 1 / acceleration and 1 / jerk. */
static void add_row(struct speed_box *g, const struct range r[3], double acc, double jerk)
{
    struct speed_row *row = &g->row[g->rows++];

    for (int n = 0; n < 3; n++) {
        row->jerk[n] = narrow(times(r[n], jerk));
    }
    row->acc[0] = narrow(times(r[0], acc));
    row->acc[1] = narrow(times(r[1], acc));
}

/* The limits along the path and across it; all jerk by r'' and r''' counts as one across. */
static void path_rule(struct speed_box *g, const struct segment *p, const struct segment_bounds *b)
{
    const double acc = 1.0 / el_min(p->ramp.acc, p->ramp.dec);
    const double jerk =
        el_max(inverse(p->ramp.acc_jerk, p->ramp.acc), inverse(p->ramp.dec_jerk, p->ramp.dec));
    struct speed_pull way;
    const double across = speed_pull_path(&way, p, g->length, b);
    struct range along[3], all[3] = { { 0.0, 0.0 } };

    for (int n = 0; n < 3; n++) {
        along[n] = (struct range){ -way.most[n], way.most[n] };
        all[n] = (struct range){ n > 0 ? -b->most[n] : 0.0, n > 0 ? b->most[n] : 0.0 };
    }
    add_row(g, along, acc, jerk);
    add_row(g, all, acc, jerk);
    g->row[1].acc[1] = narrow((struct range){ -across * acc, across * acc });
}

void speed_box_make(struct speed_box *g, const struct segment *p, const struct speed_limits *l,
                    double from, double length, const struct segment_bounds *b)
{
    memset(g, 0, sizeof *g);
    g->from = from;
    g->length = length;
    const double way = p->even ? 1.0 : b->most[0];
    g->feed = p->feed / way;
    g->cap = p->cap / way;
    for (int32_t i = 0; i < b->axes; i++) {
        const int k = b->axis[i];
        struct range r[3];
        for (int n = 0; n < 3; n++) {
            r[n] = (struct range){ b->low[n][k], b->high[n][k] };
        }
        g->cap = l->speed[k] > 0.0 ? el_min(g->cap, l->speed[k] / size(r[0])) : g->cap;
        if (l->acc[k] > 0.0) {
            add_row(g, r, 1.0 / l->acc[k], inverse(l->jerk[k], l->acc[k]));
            g->along[0] = g->along[1] = el_max(g->along[0], size(r[0]) / l->acc[k]);
        }
    }
    if (!speed_by_axes(l)) {
        path_rule(g, p, b);
    }
    for (int n = 0; n < 2; n++) {
        g->along[n] = p->share[n] > 0.0 ? g->along[n] / p->share[n] : 0.0;
    }
    finish(g);
    g->ideal = g->length / el_min(g->brisk, g->feed);
}

double speed_box_rise(const struct speed_box *g)
{
    double time = INFINITY;

    for (int32_t i = 0; i < g->rows; i++) {
        const struct speed_row *r = &g->row[i];
        const double acc = extent(r->acc[0]);
        time = acc > 0.0 ? el_min(time, extent(r->jerk[0]) / acc) : time;
    }
    return time < INFINITY ? time : 0.0;
}

bool speed_box_join(struct speed_box *g, const struct speed_box *next)
{
    struct speed_box one = *g;

    if (g->rows != next->rows) {
        return false;
    }
    for (int32_t i = 0; i < g->rows; i++) {
        const struct speed_row *r = &next->row[i];
        for (int n = 0; n < 2; n++) {
            one.row[i].acc[n] = cover(one.row[i].acc[n], r->acc[n]);
        }
        for (int n = 0; n < 3; n++) {
            one.row[i].jerk[n] = cover(one.row[i].jerk[n], r->jerk[n]);
        }
    }
    for (int n = 0; n < 2; n++) {
        one.along[n] = el_max(one.along[n], next->along[n]);
    }
    one.length += next->length;
    one.feed = el_min(one.feed, next->feed);
    one.cap = el_min(one.cap, next->cap);
    one.ideal += next->ideal;
    finish(&one);
    const double slower = one.length / el_min(one.brisk, one.feed) - one.ideal;
    if (slower > JOIN * speed_box_rise(&one) && el_min(g->length, next->length) > SPECK) {
        return false;
    }
    *g = one;
    return true;
}

double speed_box_steepest(const struct speed_box *g, double x, double sign)
{
    const double along = g->along[sign < 0.0];
    double b = along > 0.0 ? 2.0 / along : INFINITY;

    for (int32_t i = 0; i < g->rows; i++) {
        const struct range p = scaled(g->row[i].acc[0], sign), q = scaled(g->row[i].acc[1], x);
        b = p.high > 0.0 ? el_min(b, 2.0 * (1.0 - q.high) / p.high) : b;
        b = p.low < 0.0 ? el_min(b, 2.0 * (1.0 + q.low) / -p.low) : b;
    }
    return el_max(0.0, b);
}

static struct range acc_of(const struct speed_row *r, struct speed_state s)
{
    return plus(scaled(r->acc[0], 0.5 * s.b), scaled(r->acc[1], s.x));
}

static struct range twist_of(const struct speed_row *r, struct speed_state s)
{
    return plus(scaled(r->jerk[1], 1.5 * s.b), scaled(r->jerk[2], s.x));
}

/* The most c of a state (sign 1) or the least (-1); it may be on the other side of 0. */
static double bend(const struct speed_box *g, struct speed_state s, double sign)
{
    const double all = 1.0 / sqrt(s.x);
    double c = INFINITY;

    for (int32_t i = 0; i < g->rows; i++) {
        const struct range p = scaled(g->row[i].jerk[0], sign), q = twist_of(&g->row[i], s);
        c = p.high > 0.0 ? el_min(c, 2.0 * (all - q.high) / p.high) : c;
        c = p.low < 0.0 ? el_min(c, 2.0 * (all + q.low) / -p.low) : c;
    }
    return sign * c;
}

/* Share of what the way itself may take, by x' = b. */
static double along_of(const struct speed_box *g, double b)
{
    return 0.5 * g->along[b < 0.0] * fabs(b);
}

double speed_box_acc(const struct speed_box *g, struct speed_state s)
{
    double most = along_of(g, s.b);

    for (int32_t i = 0; i < g->rows; i++) {
        most = el_max(most, size(acc_of(&g->row[i], s)));
    }
    return most;
}

double speed_box_twist(const struct speed_box *g, struct speed_state s)
{
    double most = 0.0;

    for (int32_t i = 0; i < g->rows; i++) {
        most = el_max(most, size(twist_of(&g->row[i], s)));
    }
    return most * sqrt(s.x);
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

double speed_step_top(struct speed_state from, double c, double s)
{
    const struct speed_state to = speed_step_to(from, c, s);

    return from.b > 0.0 && to.b < 0.0 ? from.x - from.b * from.b / (2.0 * c) : larger(from.x, to.x);
}

/* Most of f + slope u + curve u^2 / 2 over a step. */
static double peak(double f, double slope, double curve, double s)
{
    const double end = f + s * (slope + 0.5 * curve * s);

    return slope > 0.0 && slope + curve * s < 0.0 ? f - 0.5 * slope * slope / curve
                                                  : larger(f, end);
}

/* Most of p b + q x + r over a step with bounds of p and q, where x > 0, and of its negative. */
static double most_of(struct range p, struct range q, struct range r, struct speed_state from,
                      double c, double s)
{
    const double part[2] = { p.low, p.high };
    double most = -INFINITY;

    for (int i = 0; i < 2; i++) {
        const double up = part[i] * from.b + q.high * from.x + r.high;
        const double down = -part[i] * from.b - q.low * from.x - r.low;
        most = larger(most, peak(up, part[i] * c + q.high * from.b, q.high * c, s));
        most = larger(most, peak(down, -part[i] * c - q.low * from.b, -q.low * c, s));
    }
    return most;
}

bool speed_box_keeps(const struct speed_box *g, struct speed_state from, double c, double s)
{
    const struct speed_state to = speed_step_to(from, c, s);
    const struct range none = { 0.0, 0.0 };

    if (!(to.x > 0.0) || !(from.x > 0.0)) {
        return false;
    }
    const double x = speed_step_top(from, c, s), v = sqrt(x);
    const double b = larger(fabs(from.b), fabs(to.b));
    if (larger(along_of(g, from.b), along_of(g, to.b)) > 1.0 + ROUNDING) {
        return false;
    }
    for (int32_t i = 0; i < g->rows; i++) {
        const struct speed_row *r = &g->row[i];
        const struct range of_c = scaled(r->jerk[0], 0.5 * c), of_b = scaled(r->jerk[1], 1.5);
        const double acc = 0.5 * extent(r->acc[0]) * b + extent(r->acc[1]) * x;
        const double jerk = size(of_c) + size(of_b) * b + extent(r->jerk[2]) * x;
        if (acc > 1.0
            && most_of(scaled(r->acc[0], 0.5), wide(r->acc[1]), none, from, c, s)
                   > 1.0 + ROUNDING) {
            return false;
        }
        if (v * jerk > 1.0
            && v * most_of(of_b, wide(r->jerk[2]), of_c, from, c, s) > 1.0 + ROUNDING) {
            return false;
        }
    }
    return true;
}

static bool fits(const struct speed_box *g, struct speed_state known, double c, double s, bool back)
{
    return speed_box_keeps(g, back ? speed_step_from(known, c, s) : known, c, s);
}

static bool turn(const struct speed_box *g, struct speed_state known, double s, double sign,
                 bool back, double *c)
{
    const double most = bend(g, known, sign), least = bend(g, known, -sign);
    double fails = most, kept = 0.0;

    if (fits(g, known, most, s, back)) {
        *c = most;
        return true;
    }
    if (!fits(g, known, kept, s, back)) {
        int i = 1;
        do {
            fails = kept;
            kept = most + (least - most) * i / SCAN;
        } while (!fits(g, known, kept, s, back) && ++i <= SCAN);
        if (i > SCAN) {
            return false;
        }
        fails = i == 1 ? most : fails;
    }
    for (int i = 0; i < HALVES; i++) {
        const double middle = 0.5 * (kept + fails);
        *(fits(g, known, middle, s, back) ? &kept : &fails) = middle;
    }
    *c = kept;
    return true;
}

bool speed_box_turn(const struct speed_box *g, struct speed_state from, double s, double sign,
                    double *c)
{
    return turn(g, from, s, sign, false, c);
}

bool speed_box_turn_to(const struct speed_box *g, struct speed_state to, double s, double sign,
                       double *c)
{
    return turn(g, to, s, sign, true, c);
}

double speed_box_stride(const struct speed_box *g, struct speed_state from, double rest)
{
    const double up = speed_box_steepest(g, from.x, 1.0),
                 down = speed_box_steepest(g, from.x, -1.0);
    const double steep = el_max(el_max(up, down), 1e-9);
    const double c = el_max(1e-9, el_max(bend(g, from, 1.0), -bend(g, from, -1.0)));
    double s = el_max(STEEPER * steep / c, FINEST * from.x / steep);

    s = el_min(s, FASTER * from.x / el_max(fabs(from.b), 1e-300));
    s = el_min(s, sqrt(2.0 * LEAP * from.x / c));
    return rest <= s ? rest : rest / ceil(rest / s);
}

double speed_box_jerk(const struct speed_box *g, double v, double a)
{
    double j = INFINITY;

    if (along_of(g, 2.0 * a) > 1.0) {
        return 0.0;
    }
    a = fabs(a);
    for (int32_t i = 0; i < g->rows; i++) {
        const struct speed_row *r = &g->row[i];
        const double p = extent(r->jerk[0]);
        if (extent(r->acc[0]) * a + extent(r->acc[1]) * v * v > 1.0) {
            return 0.0;
        }
        if (p > 0.0) {
            const double turns = 3.0 * extent(r->jerk[1]) * a + extent(r->jerk[2]) * v * v;
            j = el_min(j, (1.0 - turns * v) / p);
        }
    }
    return el_max(0.0, j);
}
