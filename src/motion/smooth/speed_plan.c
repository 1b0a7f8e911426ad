#include "speed_plan.h"

#include <math.h>
#include <stddef.h>

#include "el_extremes.h"
#include "elementary.h"

/* Most steps of a look ahead, tries at a ramp of constant jerk and their times' shares of the time
 * in which the jerk reaches the acceleration, and bisections of b. */
enum { STEPS = 200, RAMPS = 12, HALVES = 5 };
static const double LONGEST = 0.7, SHORTER = 0.7;

/* Most steps back of a plan, and the share that is left of a state to which no step leads. */
enum { ROUNDS = 4 * SPEED_NODES };
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

const struct speed_box *speed_road_box(const struct speed_road *r, int32_t i)
{
    return &r->ring[(uint32_t)(r->head + i) % (uint32_t)r->size].box;
}

double speed_road_end(const struct speed_road *r, int32_t i)
{
    const struct speed_box *g = speed_road_box(r, i);
    return i + 1 < r->count ? speed_road_box(r, i + 1)->from : g->from + g->length;
}

double speed_road_top(const struct speed_road *r, const struct speed_box *g)
{
    const double v = r->override < 0.0 ? g->cap : el_min(g->feed * r->override, g->brisk);
    return v * v;
}

struct speed_spot speed_plan_spot(const struct speed_plan *p, const struct speed_road *r, double at,
                                  struct speed_state state)
{
    int32_t box = 0, low = p->first, high = SPEED_NODES;

    while (box + 1 < r->count && at >= speed_road_end(r, box)) {
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
    return (struct speed_spot){ at, box, low, state };
}

/* c that leads over a way into the way of the plan behind a node. */
static double into(const struct speed_node *node, struct speed_state from, double way)
{
    const double share = node->state.b / node->state.x;
    return (share * (from.x + from.b * way) - from.b) / (way - 0.5 * share * way * way);
}

double speed_plan_rest(const struct speed_plan *p, const struct speed_road *r,
                       const struct speed_spot *spot)
{
    const double end = speed_road_end(r, spot->box);
    return (spot->node < SPEED_NODES ? el_min(end, p->node[spot->node].at) : end) - spot->at;
}

bool speed_plan_steer(const struct speed_plan *p, const struct speed_road *r,
                      const struct speed_spot *spot, double *s, double *c)
{
    const struct speed_box *g = speed_road_box(r, spot->box);
    const struct speed_state from = spot->state;
    const struct speed_node *node = spot->node < SPEED_NODES ? &p->node[spot->node] : NULL;
    const double rest = speed_plan_rest(p, r, spot);
    double to = 0.0;

    *s = speed_box_stride(g, from, rest);
    if (node && node->at <= speed_road_end(r, spot->box)) {
        to = into(node, from, rest);
        if (speed_step_to(from, to, rest).x <= node->state.x * (1.0 + SAME)
            && speed_box_keeps(g, from, to, rest)) {
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
    if (speed_box_keeps(g, from, to, *s)) {
        *c = to;
        return true;
    }
    if (!speed_box_turn(g, from, *s, to < 0.0 ? -1.0 : 1.0, c)) {
        return false;
    }
    *c = to < 0.0 ? el_max(*c, to) : el_min(*c, to);
    return speed_box_keeps(g, from, *c, *s);
}

void speed_plan_pass(const struct speed_plan *p, const struct speed_road *r,
                     struct speed_spot *spot, double s, struct speed_state to)
{
    const double end = speed_road_end(r, spot->box);
    const double node = spot->node < SPEED_NODES ? p->node[spot->node].at : INFINITY;
    const double next = el_min(end, node);

    spot->at = spot->at + s < next - SAME * s ? spot->at + s : next;
    spot->state = to;
    spot->box += spot->at >= end && spot->box + 1 < r->count;
    spot->node += spot->at >= node;
}

bool speed_plan_safe(const struct speed_plan *p, const struct speed_road *r, struct speed_spot spot)
{
    for (int n = 0; n < STEPS && spot.node < SPEED_NODES; n++) {
        const struct speed_node *node = &p->node[spot.node];
        const struct speed_box *g = speed_road_box(r, spot.box);
        double s, c;
        if (!speed_plan_steer(p, r, &spot, &s, &c)) {
            return false;
        }
        const struct speed_state to = speed_step_to(spot.state, c, s);
        if (speed_step_top(spot.state, c, s) > speed_road_top(r, g) * (1.0 + SAME)) {
            return false;
        }
        const int32_t before = spot.node;
        speed_plan_pass(p, r, &spot, s, to);
        if (spot.node > before) {
            const double share = to.x / node->state.x;
            if (share > 1.0 + SAME) {
                return false;
            }
            const double coarse = spot.node < SPEED_NODES ? 1.0 : 0.0; /* the last one lands */
            if (fabs(to.b - share * node->state.b) <= NEARLY * (coarse + fabs(node->state.b))) {
                return true;
            }
        }
    }
    return false;
}

bool speed_road_start(const struct speed_road *r, double at, int32_t box, double sign,
                      double within, int n, struct speed_step *step)
{
    double time = LONGEST * speed_box_rise(speed_road_box(r, box));

    for (int i = 0; i < RAMPS; i++, time *= SHORTER) {
        double jerk = INFINITY, v = 0.0, a = 0.0, way = 0.0;
        for (int k = 0; k < 4; k++) {
            int32_t at_box = box;
            do {
                const struct speed_box *g = speed_road_box(r, at_box);
                jerk = el_min(jerk, speed_box_jerk(g, v, sign * a));
                if (v * v > speed_road_top(r, g)) {
                    jerk = 0.0;
                }
                at_box += sign > 0.0 ? 1 : -1;
            } while (at_box >= 0 && at_box < r->count
                     && (sign > 0.0 ? speed_road_box(r, at_box)->from < at + way
                                    : speed_road_end(r, at_box) > at - way));
            v = 0.5 * jerk * time * time;
            a = jerk * time;
            way = v * time / 3.0;
        }
        if (jerk > 0.0 && way <= within && n-- == 0) {
            *step = speed_step_start(jerk, time);
            return true;
        }
    }
    return false;
}

bool speed_road_lands(const struct speed_road *r, double at, int32_t box, struct speed_state state)
{
    if (!(state.b < 0.0)) {
        return false;
    }
    const struct speed_step s = speed_step_land(state);
    const double end = at + s.way;
    int32_t i = box;

    do {
        const struct speed_box *g = speed_road_box(r, i);
        const double rest = i > box ? (end - g->from) / s.way : 1.0; /* x is as rest^(4/3) */
        if (s.c > speed_box_jerk(g, s.speed, s.acc) * (1.0 + LANDS)
            || state.x * rest * el_cbrt(rest) > speed_road_top(r, g) * (1.0 + SAME)) {
            return false;
        }
    } while (speed_road_end(r, i) < end - LANDS * s.way && ++i < r->count);
    return i < r->count;
}

struct speed_step speed_road_hop(const struct speed_road *r, double at, int32_t box, double way)
{
    double jerk = INFINITY, v = 0.0, a = 0.0;

    for (int k = 0; k < 100; k++) {
        double most = INFINITY;
        for (int32_t i = box; i < r->count && speed_road_box(r, i)->from < at + way; i++) {
            const struct speed_box *g = speed_road_box(r, i);
            const double here = el_min(speed_box_jerk(g, v, a), speed_box_jerk(g, v, -a));
            most = el_min(most, v * v > speed_road_top(r, g) ? 0.0 : here);
        }
        if (k > 0 && most >= jerk) {
            break;
        }
        jerk = k == 0 ? most : el_max(most, 0.5 * jerk);
        const double part = el_cbrt(0.5 * way / jerk);
        v = jerk * part * part;
        a = jerk * part;
    }
    return speed_step_hop(jerk, way);
}

/* Whether a box takes a state. */
static bool takes(const struct speed_road *r, const struct speed_box *g, struct speed_state s)
{
    return s.x <= speed_road_top(r, g) * (1.0 + NEARLY) && speed_box_acc(g, s) <= 1.0 + NEARLY
           && speed_box_twist(g, s) <= 1.0 + NEARLY;
}

/* A share of a state that a box takes. */
static struct speed_state fit(const struct speed_road *r, const struct speed_box *g,
                              struct speed_state s)
{
    const double acc = speed_box_acc(g, s), jerk = speed_box_twist(g, s) / ROOM;
    double share = el_min(1.0, speed_road_top(r, g) / s.x);

    share = acc > 1.0 ? el_min(share, 1.0 / acc) : share;
    share = jerk > 1.0 ? el_min(share, el_cbrt(1.0 / (jerk * jerk))) : share;
    return (struct speed_state){ share * (1.0 - SAME) * s.x, share * (1.0 - SAME) * s.b };
}

/* Nearly the fastest of the states that a box takes and from which the plan can be driven. */
static struct speed_state lower(const struct speed_plan *p, const struct speed_road *r, double at,
                                int32_t box, const struct speed_box *g, struct speed_state s)
{
    struct speed_state kept = fit(r, g, s);
    double fails = el_min(s.x, speed_road_top(r, g));

    for (int i = 0; i < HALVES; i++) {
        const double x = i == 0 ? fails : 0.5 * (kept.x + fails);
        const double steep = (1.0 - SAME) * speed_box_steepest(g, x, -1.0);
        const struct speed_spot spot = { at, box, p->first, { x, el_max(s.b, -steep) } };
        if (takes(r, g, spot.state) && speed_plan_safe(p, r, spot)) {
            kept = spot.state;
        } else {
            fails = x;
        }
    }
    return kept;
}

/* A state from which the plan can be driven, made less steep if it can be then, too. */
static struct speed_state ease(const struct speed_plan *p, const struct speed_road *r, double at,
                               int32_t box, struct speed_state s)
{
    struct speed_spot spot = { at, box, p->first, { s.x, 0.0 } };
    double steep = s.b, flat = 0.0;

    if (s.b >= 0.0 || speed_plan_safe(p, r, spot)) {
        return (struct speed_state){ s.x, el_max(s.b, 0.0) };
    }
    for (int i = 0; i < HALVES; i++) {
        spot.state.b = 0.5 * (steep + flat);
        if (speed_plan_safe(p, r, spot)) {
            steep = spot.state.b;
        } else {
            flat = spot.state.b;
        }
    }
    return (struct speed_state){ s.x, steep };
}

static void put(struct speed_plan *p, double at, struct speed_state state)
{
    p->node[--p->first] = (struct speed_node){ at, state };
}

/* One step back from the first node, through a box, to at most its start; false: none. A b above 0
 * becomes 0: that such a state can be driven is seen, not proved (docs/theory/speed.md). */
static bool step_back(struct speed_plan *p, const struct speed_road *r, int32_t box, double to)
{
    const struct speed_box *g = speed_road_box(r, box);
    const struct speed_node *node = &p->node[p->first];
    const double end = node->at, top = speed_road_top(r, g);
    const struct speed_state last = node->state;
    double s = speed_box_stride(g, last, end - to), c;

    if (last.b == 0.0 && last.x >= top * (1.0 - SAME)) {
        put(p, to, last);
        return true;
    }
    const double at = s < end - to ? end - s : to;
    s = end - at;
    if (!speed_box_turn_to(g, last, s, 1.0, &c)) {
        return false;
    }
    struct speed_state found = speed_step_from(last, c, s);
    if (found.x > top) {
        const double level = 2.0 * ((top - last.x) / s + last.b) / s;
        const struct speed_state flat = { top, last.b - level * s };
        if (flat.b <= 0.0 && speed_box_keeps(g, flat, level, s)) {
            found = flat;
        } else {
            found = (struct speed_state){ top, found.b * top / found.x };
            found = found.b < STEEP * last.b ? ease(p, r, at, box, found) : found;
        }
    }
    found.b = el_min(found.b, 0.0);
    put(p, at, found);
    return true;
}

bool speed_plan_make(struct speed_plan *p, const struct speed_road *r, double back_to)
{
    struct speed_step land;
    int32_t box = r->count - 1;

    p->end = speed_road_end(r, box);
    p->first = SPEED_NODES;
    if (!speed_road_start(r, p->end, box, -1.0, END_PART * (p->end - back_to), 0, &land)) {
        return true;
    }
    put(p, p->end - land.way, (struct speed_state){ land.to.x, -land.to.b });
    for (int n = 0; n < ROUNDS && p->first > 0 && p->node[p->first].at > back_to; n++) {
        const struct speed_node node = p->node[p->first];
        while (box > 0 && speed_road_box(r, box)->from >= node.at) {
            box--;
        }
        const struct speed_box *g = speed_road_box(r, box);
        if (!takes(r, g, node.state)) {
            const int32_t behind = box + (speed_road_end(r, box) <= node.at);
            p->first++;
            const struct speed_state less = p->first < SPEED_NODES
                                                ? lower(p, r, node.at, behind, g, node.state)
                                                : fit(r, g, node.state);
            put(p, node.at, p->first < SPEED_NODES ? ease(p, r, node.at, behind, less) : less);
        }
        if (!step_back(p, r, box, el_max(back_to, g->from))) {
            p->node[p->first].state.x *= SHARE; /* a share can be driven, too */
            p->node[p->first].state.b *= SHARE;
        }
    }
    return p->node[p->first].at <= back_to;
}
