#include "pace_plan.h"

#include <math.h>
#include <stddef.h>

#include "el_extremes.h"
#include "elementary.h"

/* Most steps of a look ahead, tries at a ramp of constant jerk and their times' shares of the time
 * in which the jerk reaches the acceleration, and bisections of b. */
enum { STEPS = 200, RAMPS = 12, HALVES = 5 };
static const double LONGEST = 0.7, SHORTER = 0.7;

/* Most steps back of a plan, and the share that is left of a state to which no step leads. */
enum { ROUNDS = 4 * PACE_NODES };
static const double SHARE = 0.97;

/* The ramp to rest at the end takes at most this part of the way. */
static const double END_PART = 0.3;

/* A node is far if it is so many strides away. */
static const double FAR = 2.5;

/* An x counts as met again if it differs by such a share. */
static const double SAME = 1e-12;

/* Limits count as kept, and a state as met again, to such a share. */
static const double NEARLY = 1e-9;

/* Share by which way and jerk of a landing may be off from a state that is met again: the jerk goes
 * as b^2, the way as 1/b. */
static const double LANDS = 4e-9;

/* A state at the most speed whose b is steeper than this share of the next one's is made flatter:
 * mere shares might never become level. */
static const double STEEP = 0.97;

/* A state that is made to fit a box takes at most this share of the jerk. */
static const double ROOM = 0.8;

const struct pace_box *pace_road_box(const struct pace_road *r, int32_t i)
{
    return &r->ring[(uint32_t)(r->head + i) % (uint32_t)r->size].box;
}

double pace_road_end(const struct pace_road *r, int32_t i)
{
    const struct pace_box *g = pace_road_box(r, i);
    return i + 1 < r->count ? pace_road_box(r, i + 1)->from : g->from + g->length;
}

double pace_road_top(const struct pace_road *r, const struct pace_box *g)
{
    const double v = r->override < 0.0 ? g->cap : el_min(g->feed * r->override, g->brisk);
    return v * v;
}

struct pace_spot pace_plan_spot(const struct pace_plan *p, const struct pace_road *r, double at,
                                struct pace_state state)
{
    int32_t box = 0, low = p->first, high = PACE_NODES;

    while (box + 1 < r->count && at >= pace_road_end(r, box)) {
        box++;
    }
    while (low < high) {
        const int32_t middle = (low + high) / 2;
        if (p->node[middle].at > at) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return (struct pace_spot){ at, box, low, state };
}

/* c that leads over a way into the way of the plan behind a node. */
static double into(const struct pace_node *node, struct pace_state from, double way)
{
    const double share = node->state.b / node->state.x;
    return (share * (from.x + from.b * way) - from.b) / (way - 0.5 * share * way * way);
}

double pace_plan_rest(const struct pace_plan *p, const struct pace_road *r,
                      const struct pace_spot *spot)
{
    const double end = pace_road_end(r, spot->box);
    return (spot->node < PACE_NODES ? el_min(end, p->node[spot->node].at) : end) - spot->at;
}

bool pace_plan_steer(const struct pace_plan *p, const struct pace_road *r,
                     const struct pace_spot *spot, double *s, double *c)
{
    const struct pace_box *g = pace_road_box(r, spot->box);
    const struct pace_state from = spot->state;
    const struct pace_node *node = spot->node < PACE_NODES ? &p->node[spot->node] : NULL;
    const double rest = pace_plan_rest(p, r, spot);
    double to = 0.0;

    *s = pace_box_stride(g, from, rest);
    if (node && node->at <= pace_road_end(r, spot->box)) {
        to = into(node, from, rest);
        if (pace_step_to(from, to, rest).x <= node->state.x * (1.0 + SAME)
            && pace_box_keeps(g, from, to, rest)) {
            *s = rest;
            *c = to;
            return true;
        }
    }
    if (!node || rest > FAR * *s) {
        if (from.b == 0.0) {
            *s = rest <= FAR * *s ? rest : rest - *s;
        }
        to = -from.b / *s;
    }
    if (pace_box_keeps(g, from, to, *s)) {
        *c = to;
        return true;
    }
    if (!pace_box_turn(g, from, *s, to < 0.0 ? -1.0 : 1.0, c)) {
        return false;
    }
    *c = to < 0.0 ? el_max(*c, to) : el_min(*c, to);
    return pace_box_keeps(g, from, *c, *s);
}

void pace_plan_pass(const struct pace_plan *p, const struct pace_road *r, struct pace_spot *spot,
                    double s, struct pace_state to)
{
    const double end = pace_road_end(r, spot->box);
    const double node = spot->node < PACE_NODES ? p->node[spot->node].at : INFINITY;
    const double next = el_min(end, node);

    spot->at = spot->at + s < next - SAME * s ? spot->at + s : next;
    spot->state = to;
    spot->box += spot->at >= end && spot->box + 1 < r->count;
    spot->node += spot->at >= node;
}

bool pace_plan_safe(const struct pace_plan *p, const struct pace_road *r, struct pace_spot spot)
{
    for (int n = 0; n < STEPS && spot.node < PACE_NODES; n++) {
        const struct pace_node *node = &p->node[spot.node];
        const struct pace_box *g = pace_road_box(r, spot.box);
        double s, c;
        if (!pace_plan_steer(p, r, &spot, &s, &c)) {
            return false;
        }
        const struct pace_state to = pace_step_to(spot.state, c, s);
        if (pace_step_top(spot.state, c, s) > pace_road_top(r, g) * (1.0 + SAME)) {
            return false;
        }
        const int32_t before = spot.node;
        pace_plan_pass(p, r, &spot, s, to);
        if (spot.node > before) {
            const double share = to.x / node->state.x;
            if (share > 1.0 + SAME) {
                return false;
            }
            const double coarse = spot.node < PACE_NODES ? 1.0 : 0.0; /* the last one lands */
            if (fabs(to.b - share * node->state.b) <= NEARLY * (coarse + fabs(node->state.b))) {
                return true;
            }
        }
    }
    return false;
}

bool pace_road_start(const struct pace_road *r, double at, int32_t box, double sign, double within,
                     int n, struct pace_step *step)
{
    double time = LONGEST * pace_box_rise(pace_road_box(r, box));

    for (int i = 0; i < RAMPS; i++, time *= SHORTER) {
        double jerk = INFINITY, v = 0.0, a = 0.0, way = 0.0;
        for (int k = 0; k < 4; k++) {
            int32_t at_box = box;
            do {
                const struct pace_box *g = pace_road_box(r, at_box);
                jerk = el_min(jerk, pace_box_jerk(g, v, a));
                if (v * v > pace_road_top(r, g)) {
                    jerk = 0.0;
                }
                at_box += sign > 0.0 ? 1 : -1;
            } while (at_box >= 0 && at_box < r->count
                     && (sign > 0.0 ? pace_road_box(r, at_box)->from < at + way
                                    : pace_road_end(r, at_box) > at - way));
            v = 0.5 * jerk * time * time;
            a = jerk * time;
            way = v * time / 3.0;
        }
        if (jerk > 0.0 && way <= within && n-- == 0) {
            *step = pace_step_start(jerk, time);
            return true;
        }
    }
    return false;
}

bool pace_road_lands(const struct pace_road *r, double at, int32_t box, struct pace_state state)
{
    if (!(state.b < 0.0)) {
        return false;
    }
    const struct pace_step s = pace_step_land(state);
    const double end = at + s.way;
    int32_t i = box;

    do {
        const struct pace_box *g = pace_road_box(r, i);
        const double rest = i > box ? (end - g->from) / s.way : 1.0; /* x is as rest^(4/3) */
        if (s.c > pace_box_jerk(g, s.speed, -s.acc) * (1.0 + LANDS)
            || state.x * rest * el_cbrt(rest) > pace_road_top(r, g) * (1.0 + SAME)) {
            return false;
        }
    } while (pace_road_end(r, i) < end - LANDS * s.way && ++i < r->count);
    return i < r->count;
}

struct pace_step pace_road_hop(const struct pace_road *r, double at, int32_t box, double way)
{
    double jerk = INFINITY, v = 0.0, a = 0.0;

    for (int k = 0; k < 100; k++) {
        double most = INFINITY;
        for (int32_t i = box; i < r->count && pace_road_box(r, i)->from < at + way; i++) {
            const struct pace_box *g = pace_road_box(r, i);
            const double here = pace_box_jerk(g, v, a);
            most = el_min(most, v * v > pace_road_top(r, g) ? 0.0 : here);
        }
        if (k > 0 && most >= jerk) {
            break;
        }
        jerk = k == 0 ? most : el_max(most, 0.5 * jerk);
        const double part = el_cbrt(0.5 * way / jerk);
        v = jerk * part * part;
        a = jerk * part;
    }
    return pace_step_hop(jerk, way);
}

/* Whether a box takes a state. */
static bool takes(const struct pace_road *r, const struct pace_box *g, struct pace_state s)
{
    return s.x <= pace_road_top(r, g) * (1.0 + NEARLY) && pace_box_acc(g, s) <= 1.0 + NEARLY
           && pace_box_twist(g, s) <= 1.0 + NEARLY;
}

/* A share of a state that a box takes. */
static struct pace_state fit(const struct pace_road *r, const struct pace_box *g,
                             struct pace_state s)
{
    const double acc = pace_box_acc(g, s), jerk = pace_box_twist(g, s) / ROOM;
    double share = el_min(1.0, pace_road_top(r, g) / s.x);

    share = acc > 1.0 ? el_min(share, 1.0 / acc) : share;
    share = jerk > 1.0 ? el_min(share, el_cbrt(1.0 / (jerk * jerk))) : share;
    return (struct pace_state){ share * (1.0 - SAME) * s.x, share * (1.0 - SAME) * s.b };
}

/* Nearly the fastest of the states that a box takes and from which the plan can be driven. */
static struct pace_state lower(const struct pace_plan *p, const struct pace_road *r, double at,
                               int32_t box, const struct pace_box *g, struct pace_state s)
{
    struct pace_state kept = fit(r, g, s);
    double fails = el_min(s.x, pace_road_top(r, g));

    for (int i = 0; i < HALVES; i++) {
        const double x = i == 0 ? fails : 0.5 * (kept.x + fails);
        const double steep = (1.0 - SAME) * pace_box_steepest(g, x, -1.0);
        const struct pace_spot spot = { at, box, p->first, { x, el_max(s.b, -steep) } };
        if (takes(r, g, spot.state) && pace_plan_safe(p, r, spot)) {
            kept = spot.state;
        } else {
            fails = x;
        }
    }
    return kept;
}

/* A state from which the plan can be driven, made less steep if it can be then, too. */
static struct pace_state ease(const struct pace_plan *p, const struct pace_road *r, double at,
                              int32_t box, struct pace_state s)
{
    struct pace_spot spot = { at, box, p->first, { s.x, 0.0 } };
    double steep = s.b, flat = 0.0;

    if (s.b >= 0.0 || pace_plan_safe(p, r, spot)) {
        return (struct pace_state){ s.x, el_max(s.b, 0.0) };
    }
    for (int i = 0; i < HALVES; i++) {
        spot.state.b = 0.5 * (steep + flat);
        if (pace_plan_safe(p, r, spot)) {
            steep = spot.state.b;
        } else {
            flat = spot.state.b;
        }
    }
    return (struct pace_state){ s.x, steep };
}

static void put(struct pace_plan *p, double at, struct pace_state state)
{
    p->node[--p->first] = (struct pace_node){ at, state };
}

/* One step back from the first node, through a box, to at most its start; false: none. A b above 0
 * becomes 0: that such a state can be driven is seen, not proved (docs/theory/speed.md). */
static bool step_back(struct pace_plan *p, const struct pace_road *r, int32_t box, double to)
{
    const struct pace_box *g = pace_road_box(r, box);
    const struct pace_node *node = &p->node[p->first];
    const double end = node->at, top = pace_road_top(r, g);
    const struct pace_state last = node->state;
    double s = pace_box_stride(g, last, end - to), c;

    if (last.b == 0.0 && last.x >= top * (1.0 - SAME)) {
        put(p, to, last);
        return true;
    }
    const double at = s < end - to ? end - s : to;
    s = end - at;
    if (!pace_box_turn_to(g, last, s, 1.0, &c)) {
        return false;
    }
    struct pace_state found = pace_step_from(last, c, s);
    if (found.x > top) {
        const double level = 2.0 * ((top - last.x) / s + last.b) / s;
        const struct pace_state flat = { top, last.b - level * s };
        if (flat.b <= 0.0 && pace_box_keeps(g, flat, level, s)) {
            found = flat;
        } else {
            found = (struct pace_state){ top, found.b * top / found.x };
            found = found.b < STEEP * last.b ? ease(p, r, at, box, found) : found;
        }
    }
    found.b = el_min(found.b, 0.0);
    put(p, at, found);
    return true;
}

bool pace_plan_make(struct pace_plan *p, const struct pace_road *r, double back_to)
{
    struct pace_step land;
    int32_t box = r->count - 1;

    p->end = pace_road_end(r, box);
    p->first = PACE_NODES;
    if (!pace_road_start(r, p->end, box, -1.0, END_PART * (p->end - back_to), 0, &land)) {
        return true;
    }
    put(p, p->end - land.way, (struct pace_state){ land.to.x, -land.to.b });
    for (int n = 0; n < ROUNDS && p->first > 0 && p->node[p->first].at > back_to; n++) {
        const struct pace_node node = p->node[p->first];
        while (box > 0 && pace_road_box(r, box)->from >= node.at) {
            box--;
        }
        const struct pace_box *g = pace_road_box(r, box);
        if (!takes(r, g, node.state)) {
            const int32_t behind = box + (pace_road_end(r, box) <= node.at);
            p->first++;
            const struct pace_state less = p->first < PACE_NODES
                                               ? lower(p, r, node.at, behind, g, node.state)
                                               : fit(r, g, node.state);
            put(p, node.at, p->first < PACE_NODES ? ease(p, r, node.at, behind, less) : less);
        }
        if (!step_back(p, r, box, el_max(back_to, g->from))) {
            p->node[p->first].state.x *= SHARE; /* a share can be driven, too */
            p->node[p->first].state.b *= SHARE;
        }
    }
    return p->node[p->first].at <= back_to;
}
