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
    return &p->leg[(uint32_t)(p->head + i) % PACE_CELLS];
}

static const struct pace_leg *leg_peek(const struct pace *p, int32_t i)
{
    return &p->leg[(uint32_t)(p->head + i) % PACE_CELLS];
}

/* Whether a leg may grow to another one: it is not under way, and the motion that has been planned
 * into it finds as much room. */
static bool may_grow(const struct pace *p, const struct pace_leg *g, const struct pace_leg *grown)
{
    if (p->count == 1) {
        return p->rate <= 0.0 && p->left >= g->length;
    }
    return p->planned < p->count ||
           pace_leg_enter(grown, &p->limits, 0.0, grown->cap, grown->length) >=
           pace_leg_enter(g, &p->limits, 0.0, g->cap, g->length);
}

static void append(struct pace *p, const struct pace_leg *g)
{
    if (p->count > 0) {
        struct pace_leg *last = leg_at(p, p->count - 1), both = *last;
        if (pace_leg_join(&both, g, &p->limits) && may_grow(p, last, &both)) {
            *last = both;
            p->left = p->count == 1 ? both.length : p->left;
            p->grown = true;
            return;
        }
    }
    if (p->count == 0) {
        p->left = g->length;
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
    return i + 1 < p->planned ? leg_peek(p, i + 1)->enter : 0.0;
}

/* From the end backwards. */
static void plan(struct pace *p, double override)
{
    const bool all = override != p->override;
    const int32_t known = p->planned;

    p->planned = p->count;
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

    to = pace_leg_stage(g, &p->limits, p->rate, to);
    p->ramp = pace_ramp_make(g, &p->limits, p->rate, to);
    p->ramping = to != p->rate;
    p->spent = 0.0;
    p->before = p->left;
    p->asked = override;
    return p->ramping ? 0.0 : p->left;
}

/* A ramp under way to another override: upwards it ends early if it would go too far, downwards it
 * goes on to less if there is room; both only while its acceleration has not begun to fall. */
static struct pace_ramp change(const struct pace *p, double override)
{
    const struct pace_ramp *r = &p->ramp;
    const double most = feed_limit(leg_peek(p, 0), override);
    struct pace_ramp new = *r;

    if (r->to <= most || !pace_ramp_open(r, p->spent)) {
        return *r;
    }
    if (r->to > r->from) {
        return pace_ramp_cut(r, p->spent);
    }
    new.to = most;
    const struct pace_leg *g = leg_peek(p, 0);
    const double on = pace_leg_way(g, &p->limits, most, fmin(most, end_limit(p, 0)));
    return pace_ramp_way(&new) + on <= p->before ? new : *r;
}

/* A ramp under way to where the chain has been closed: it goes up no further. */
static struct pace_ramp no_further(const struct pace *p)
{
    const struct pace_ramp *r = &p->ramp;
    return r->to > r->from && pace_ramp_open(r, p->spent) ? pace_ramp_cut(r, p->spent) : *r;
}

/* Choose what comes next from a = 0: a ramp, or a way to go on as it is, which is returned. [mm] */
static double choose(struct pace *p, double override)
{
    const struct pace_leg *g = leg_peek(p, 0);
    const double v = p->rate, most = feed_limit(g, override);
    const double leave = override > 0.0 ? fmin(end_limit(p, 0), g->cap) : 0.0;

    if (v > most * (1.0 + SAME)) {
        const double on = pace_leg_way(g, &p->limits, most, fmin(most, leave));
        return begin(p, pace_leg_way(g, &p->limits, v, most) + on <= p->left * (1.0 + SAME) ? most
                 : pace_leg_low(g, &p->limits, v, fmin(most, leave), p->left), override);
    }
    const double peak = v < most * (1.0 - SAME)
        ? pace_leg_peak(g, &p->limits, v, leave, most, p->left) : v;
    if (peak > v * (1.0 + SAME)) {
        return begin(p, peak, override);
    }
    if (leave >= v * (1.0 - SAME)) {
        return p->left;
    }
    const double slack = p->left - pace_leg_way(g, &p->limits, v, leave);
    if (slack > SAME * p->left) {
        return slack;
    }
    return begin(p, pace_leg_low(g, &p->limits, v, leave, p->left), override);
}

/* Go on with a ramp for up to dt; returns the time used. */
static double drive(struct pace *p, double dt)
{
    const double rest = pace_ramp_time(&p->ramp) - p->spent;

    if (rest <= dt) {
        p->left = fmax(0.0, p->before - pace_ramp_way(&p->ramp));
        p->left = p->left > SMALL * (1.0 + p->before) ? p->left : 0.0;
        p->rate = p->ramp.to;
        p->gain = p->twitch = 0.0;
        p->ramping = false;
        return fmax(0.0, rest);
    }
    p->spent += dt;
    const struct pace_motion m = pace_ramp_at(&p->ramp, p->spent);
    p->left = fmax(0.0, p->before - m.way);
    p->rate = m.rate;
    p->gain = m.gain;
    p->twitch = m.jerk;
    return dt;
}

static void cross(struct pace *p)
{
    while (p->left <= 0.0 && p->count > 1 && !p->ramping) {
        p->base += leg_peek(p, 0)->length;
        p->head = (p->head + 1) % PACE_CELLS;
        p->count--;
        p->planned -= p->planned > 0;
        p->left = leg_peek(p, 0)->length;
    }
}

double pace_smooth_advance(struct pace *p, double override, double dt)
{
    cross(p);
    if (override > 0.0 && (override != p->override ||
                           p->grown || PLAN_SHARE * (p->count - p->planned) > p->planned)) {
        plan(p, override);
    }
    if (p->ramping && override != p->asked) {
        p->ramp = p->asked < 0.0 ? no_further(p) : change(p, override);
        p->asked = override;
    }
    while (dt > 0.0 && !pace_at_end(p)) {
        if (p->ramping) {
            dt -= drive(p, dt);
        } else if (p->rate <= 0.0 && override <= 0.0) {
            return 0.0;
        } else {
            const double way = choose(p, override);
            if (!p->ramping && p->rate <= 0.0) {    /* no way but rounding, or no feed */
                p->left = p->left > SMALL * (1.0 + p->before) ? p->left : 0.0;
                dt = p->left > 0.0 ? 0.0 : dt;
            } else if (!p->ramping) {
                const bool all = way >= dt * p->rate;
                p->left = all ? p->left - dt * p->rate : p->left - way;
                dt = all ? 0.0 : dt - way / p->rate;
            }
        }
        cross(p);
    }
    return dt;
}

/* Speed and way left in its leg at the end of a ramp, if one is under way. */
static void settle(const struct pace *p, const struct pace_ramp *r, double *rate, double *left)
{
    *rate = p->ramping ? r->to : p->rate;
    *left = p->ramping ? fmax(0.0, p->before - pace_ramp_way(r)) : p->left;
}

double pace_smooth_stop_way(const struct pace *p)
{
    const struct pace_ramp r = change(p, 0.0);
    double v, left, base = p->base;

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
