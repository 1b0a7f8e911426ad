#include "pace_smooth.h"

#include <math.h>

/* A plan goes through all legs once so many of the planned ones (a fourth) are new. */
enum { PLAN_SHARE = 4 };

/* Speeds that differ by such a share are the same. */
static const double SAME = 1e-9;

/* A way that rounding leaves, of that to go. [mm] */
static const double SMALL = 1e-12;

static struct pace_leg *leg_at(struct pace *p, int32_t i)
{
    return &p->leg[(uint32_t)(p->at.head + i) % PACE_CELLS];
}

static const struct pace_leg *leg_peek(const struct pace *p, int32_t i)
{
    return &p->leg[(uint32_t)(p->at.head + i) % PACE_CELLS];
}

/* Whether a leg may grow to another one: it is not under way, and the motion that has been planned
 * into it finds as much room. */
static bool may_grow(const struct pace *p, const struct pace_leg *g, const struct pace_leg *grown)
{
    if (p->count == 1) {
        return p->at.rate <= 0.0 && p->at.left >= g->length;
    }
    return p->at.planned < p->count ||
           pace_leg_enter(grown, &p->limits, 0.0, grown->cap, grown->length) >=
           pace_leg_enter(g, &p->limits, 0.0, g->cap, g->length);
}

static void append(struct pace *p, const struct pace_leg *g)
{
    if (p->count > 0) {
        struct pace_leg *last = leg_at(p, p->count - 1), both = *last;
        if (pace_leg_join(&both, g, &p->limits) && may_grow(p, last, &both)) {
            *last = both;
            p->at.left = p->count == 1 ? both.length : p->at.left;
            p->grown = true;
            return;
        }
    }
    if (p->count == 0) {
        p->at.left = g->length;
    }
    *leg_at(p, p->count++) = *g;
}

bool pace_smooth_join(struct pace *p, const struct piece *piece)
{
    struct pace_leg g;
    struct piece_bounds b;
    struct piece_rest rest;
    double from = 0.0;

    if (p->closed || p->count + PACE_SPLIT + PACE_KEPT > PACE_CELLS) {
        return false;
    }
    piece_rest_start(&rest, piece);
    piece_rest_bounds(&rest, &b);
    const int32_t n = pace_parts(piece, &b);
    for (int32_t i = 0; i < n; i++) {
        const double to = i + 1 < n ? piece->length * (i + 1) / n : piece->length;
        if (n > 1) {
            piece_rest_cut(&rest, to, &b);
        }
        pace_leg_make(&g, piece, &p->limits, to - from, &b);
        g.last = i + 1 == n;
        append(p, &g);
        from = to;
    }
    p->end += piece->length;
    return true;
}

static double feed_limit(const struct pace_leg *g, double override)
{
    return fmin(g->feed * override, g->cap);
}

/* Most speed at the end of leg i. */
static double end_limit(const struct pace *p, int32_t i)
{
    return i + 1 < p->at.planned ? leg_peek(p, i + 1)->enter : 0.0;
}

/* From the end backwards. */
static void plan(struct pace *p, double override)
{
    const bool all = override != p->override;
    const int32_t known = p->at.planned;

    p->at.planned = p->count;
    p->grown = false;
    for (int32_t i = p->count - 1; i >= 0; i--) {
        struct pace_leg *g = leg_at(p, i);
        const double v = pace_leg_enter(g, &p->limits, end_limit(p, i), feed_limit(g, override),
                                        g->length);
        if (!all && i < known - 1 && v == g->enter) {
            break;
        }
        g->enter = v;
    }
    p->override = override;
}

/* Begin a ramp; returns the way to go on without one: none, or what is left if there is none. */
static double begin(struct pace *p, double to, double override)
{
    const struct pace_leg *g = leg_peek(p, 0);

    to = pace_leg_stage(g, &p->limits, p->at.rate, to);
    p->at.ramp = pace_ramp_make(g, &p->limits, p->at.rate, to);
    p->at.ramping = to != p->at.rate;
    p->at.spent = 0.0;
    p->at.before = p->at.left;
    p->at.asked = override;
    return p->at.ramping ? 0.0 : p->at.left;
}

/* A ramp under way to another override: upwards it ends early if it would go too far, downwards it
 * goes on to less if there is room; both only while its acceleration has not begun to fall. */
static struct pace_ramp change(const struct pace *p, double override)
{
    const struct pace_ramp *r = &p->at.ramp;
    const double most = feed_limit(leg_peek(p, 0), override);
    struct pace_ramp new = *r;

    if (r->to <= most || !pace_ramp_open(r, p->at.spent)) {
        return *r;
    }
    if (r->to > r->from) {
        return pace_ramp_cut(r, p->at.spent);
    }
    new.to = most;
    const struct pace_leg *g = leg_peek(p, 0);
    const double on = pace_leg_way(g, &p->limits, most, fmin(most, end_limit(p, 0)));
    return pace_ramp_way(&new) + on <= p->at.before ? new : *r;
}

/* A ramp under way to where the chain has been closed: it goes up no further. */
static struct pace_ramp no_further(const struct pace *p)
{
    const struct pace_ramp *r = &p->at.ramp;
    return r->to > r->from && pace_ramp_open(r, p->at.spent) ? pace_ramp_cut(r, p->at.spent) : *r;
}

/* Choose what comes next from a = 0: a ramp, or a way to go on as it is, which is returned. [mm] */
static double choose(struct pace *p, double override)
{
    const struct pace_leg *g = leg_peek(p, 0);
    const double v = p->at.rate, most = feed_limit(g, override);
    const double leave = override > 0.0 ? fmin(end_limit(p, 0), g->cap) : 0.0;

    if (v > most * (1.0 + SAME)) {
        const double on = pace_leg_way(g, &p->limits, most, fmin(most, leave));
        const double way = pace_leg_way(g, &p->limits, v, most) + on;
        return begin(p, way <= p->at.left * (1.0 + SAME) ? most
                 : pace_leg_low(g, &p->limits, v, fmin(most, leave), p->at.left), override);
    }
    const double peak = v < most * (1.0 - SAME)
        ? pace_leg_peak(g, &p->limits, v, leave, most, p->at.left) : v;
    if (peak > v * (1.0 + SAME)) {
        return begin(p, peak, override);
    }
    if (leave >= v * (1.0 - SAME)) {
        return p->at.left;
    }
    const double slack = p->at.left - pace_leg_way(g, &p->limits, v, leave);
    if (slack > SAME * p->at.left) {
        return slack;
    }
    return begin(p, pace_leg_low(g, &p->limits, v, leave, p->at.left), override);
}

/* Go on with a ramp for up to dt; returns the time used. */
static double drive(struct pace *p, double dt)
{
    const double rest = pace_ramp_time(&p->at.ramp) - p->at.spent;

    if (rest <= dt) {
        p->at.left = fmax(0.0, p->at.before - pace_ramp_way(&p->at.ramp));
        p->at.left = p->at.left > SMALL * (1.0 + p->at.before) ? p->at.left : 0.0;
        p->at.rate = p->at.ramp.to;
        p->at.gain = p->at.twitch = 0.0;
        p->at.ramping = false;
        return fmax(0.0, rest);
    }
    p->at.spent += dt;
    const struct pace_motion m = pace_ramp_at(&p->at.ramp, p->at.spent);
    p->at.left = fmax(0.0, p->at.before - m.way);
    p->at.rate = m.rate;
    p->at.gain = m.gain;
    p->at.twitch = m.jerk;
    return dt;
}

static void cross(struct pace *p)
{
    while (p->at.left <= 0.0 && p->count > 1 && !p->at.ramping) {
        p->at.base += leg_peek(p, 0)->length;
        p->at.head = (p->at.head + 1) % PACE_CELLS;
        p->count--;
        p->at.planned -= p->at.planned > 0;
        p->at.left = leg_peek(p, 0)->length;
    }
}

double pace_smooth_advance(struct pace *p, double override, double dt)
{
    cross(p);
    if (override > 0.0 && (override != p->override ||
                           p->grown || PLAN_SHARE * (p->count - p->at.planned) > p->at.planned)) {
        plan(p, override);
    }
    if (p->at.ramping && override != p->at.asked) {
        p->at.ramp = p->at.asked < 0.0 ? no_further(p) : change(p, override);
        p->at.asked = override;
    }
    while (dt > 0.0 && !pace_at_end(p)) {
        if (p->at.ramping) {
            dt -= drive(p, dt);
        } else if (p->at.rate <= 0.0 && override <= 0.0) {
            return 0.0;
        } else {
            const double way = choose(p, override);
            if (!p->at.ramping && p->at.rate <= 0.0) {    /* no way but rounding, or no feed */
                p->at.left = p->at.left > SMALL * (1.0 + p->at.before) ? p->at.left : 0.0;
                dt = p->at.left > 0.0 ? 0.0 : dt;
            } else if (!p->at.ramping) {
                const bool all = way >= dt * p->at.rate;
                p->at.left = all ? p->at.left - dt * p->at.rate : p->at.left - way;
                dt = all ? 0.0 : dt - way / p->at.rate;
            }
        }
        cross(p);
    }
    return dt;
}

/* Speed and way left in its leg at the end of a ramp, if one is under way. */
static void settle(const struct pace *p, const struct pace_ramp *r, double *rate, double *left)
{
    *rate = p->at.ramping ? r->to : p->at.rate;
    *left = p->at.ramping ? fmax(0.0, p->at.before - pace_ramp_way(r)) : p->at.left;
}

double pace_smooth_stop_way(const struct pace *p)
{
    const struct pace_ramp r = change(p, 0.0);
    double v, left, base = p->at.base;

    settle(p, &r, &v, &left);
    for (int32_t i = 0; i < p->count; i++) {
        const struct pace_leg *g = leg_peek(p, i);
        left = i == 0 ? left : g->length;
        const double low = left > 0.0 ? pace_leg_low(g, &p->limits, v, 0.0, left) : v;
        if (low <= 0.0) {
            return base + (g->length - left) + pace_leg_way(g, &p->limits, v, 0.0);
        }
        v = low;
        base += g->length;
    }
    return p->end;
}

bool pace_smooth_can_rest(const struct pace *p, int32_t i)
{
    double v, left, enter = 0.0;

    for (; i > 0; i--) {
        const struct pace_leg *g = leg_peek(p, i);
        enter = pace_leg_enter(g, &p->limits, enter, g->cap, g->length);
    }
    const struct pace_ramp r = no_further(p);
    settle(p, &r, &v, &left);
    return pace_leg_low(leg_peek(p, 0), &p->limits, v, fmin(v, enter), left) <= enter;
}
