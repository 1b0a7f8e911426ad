/* pace_plan - from which speeds along a chain of boxes the rest can be driven with limited jerk.
 *
 *   x ^  o--o--o         o--o-.          o  nodes: from each (x, b) a way is known that keeps all
 *     |         \       /      \            limits and comes to rest at the end
 *     |   __/    o--o--o        o        /  a motion below them goes on as long as it can still
 *     | _/                       \.         turn into a share of such a way: what is possible
 *     +/--------------------------+-> u     with x(u) is possible with any share of it
 */
#ifndef PACE_PLAN_H
#define PACE_PLAN_H

#include "pace_step.h"

enum { PACE_NODES = 2048 };

struct pace_node {
    double at; /* [mm] of the chain */
    struct pace_state state;
};

struct pace_plan {
    double end;    /* [mm] where it comes to rest */
    int32_t first; /* index of the first node; the others follow */
    struct pace_node node[PACE_NODES];
};

/* A short part of a chain: a cell, or a box where jerk is limited. */
union pace_element {
    struct pace_cell cell;
    struct pace_box box;
};

/* Boxes in a ring, from that of the motion on. */
struct pace_road {
    const union pace_element *ring;
    int32_t size, head, count;
    double override; /* of the feeds to be kept; < 0: only the limits are kept */
};

/* A place on the way of a plan. */
struct pace_spot {
    double at;    /* [mm] of the chain */
    int32_t box;  /* from the head */
    int32_t node; /* the first one behind it; PACE_NODES none */
    struct pace_state state;
};

const struct pace_box *pace_road_box(const struct pace_road *r, int32_t i);

/* Where a box ends. [mm] of the chain */
double pace_road_end(const struct pace_road *r, int32_t box);

/* Plan from the end of the boxes back to a place in the first one; false: too many nodes. */
bool pace_plan_make(struct pace_plan *p, const struct pace_road *r, double back_to);

struct pace_spot pace_plan_spot(const struct pace_plan *p, const struct pace_road *r, double at,
                                struct pace_state state);

/* Way to the next node or the end of the box. [mm] */
double pace_plan_rest(const struct pace_plan *p, const struct pace_road *r,
                      const struct pace_spot *spot);

/* The step that turns soonest into the way of the plan: its length and c; false: none keeps the
 * limits. */
bool pace_plan_steer(const struct pace_plan *p, const struct pace_road *r,
                     const struct pace_spot *spot, double *s, double *c);

/* Move a spot on by a step. */
void pace_plan_pass(const struct pace_plan *p, const struct pace_road *r, struct pace_spot *spot,
                    double s, struct pace_state to);

/* Whether such steps lead from a spot into the way of the plan. */
bool pace_plan_safe(const struct pace_plan *p, const struct pace_road *r, struct pace_spot spot);

/* A ramp of constant jerk from rest at a place, forwards or (sign -1) backwards, at most `within`
 * long [mm]: the n-th of those that are tried and keep the limits, the longest first; false: none.
 */
bool pace_road_start(const struct pace_road *r, double at, int32_t box, double sign, double within,
                     int n, struct pace_step *step);

/* Whether a state may come to rest by constant jerk. */
bool pace_road_lands(const struct pace_road *r, double at, int32_t box, struct pace_state state);

/* The step from rest to rest over a way. [mm] */
struct pace_step pace_road_hop(const struct pace_road *r, double at, int32_t box, double way);

/* Most x in a box under the override. */
double pace_road_top(const struct pace_road *r, const struct pace_box *g);

#endif
