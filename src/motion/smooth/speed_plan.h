/* speed_plan - from which speeds along a chain of boxes the rest can be driven with limited jerk.
 *
 *   x ^  o--o--o         o--o-.          o  nodes: from each (x, b) a way is known that keeps all
 *     |         \       /      \            limits and comes to rest at the end
 *     |   __/    o--o--o        o        /  a motion below them goes on as long as it can still
 *     | _/                       \.         turn into a share of such a way: what is possible
 *     +/--------------------------+-> u     with x(u) is possible with any share of it
 */
#ifndef SPEED_PLAN_H
#define SPEED_PLAN_H

#include "speed_step.h"

enum { SPEED_NODES = 2048 };

struct speed_node {
    double at; /* [mm] of the chain */
    struct speed_state state;
};

struct speed_plan {
    double end;    /* [mm] where it comes to rest */
    int32_t first; /* index of the first node; the others follow */
    struct speed_node node[SPEED_NODES];
};

/* A short part of a chain: a cell, or a box where jerk is limited. */
union speed_element {
    struct speed_cell cell;
    struct speed_box box;
};

/* Boxes in a ring, from that of the motion on. */
struct speed_road {
    const union speed_element *ring;
    int32_t size, head, count;
    double override; /* of the feeds to be kept; < 0: only the limits are kept */
};

/* A place on the way of a plan. */
struct speed_spot {
    double at;    /* [mm] of the chain */
    int32_t box;  /* from the head */
    int32_t node; /* the first one behind it; SPEED_NODES none */
    struct speed_state state;
};

const struct speed_box *speed_road_box(const struct speed_road *r, int32_t i);

/* Where a box ends. [mm] of the chain */
double speed_road_end(const struct speed_road *r, int32_t box);

/* Plan from the end of the boxes back to a place in the first one; false: too many nodes. */
bool speed_plan_make(struct speed_plan *p, const struct speed_road *r, double back_to);

struct speed_spot speed_plan_spot(const struct speed_plan *p, const struct speed_road *r, double at,
                                  struct speed_state state);

/* Way to the next node or the end of the box. [mm] */
double speed_plan_rest(const struct speed_plan *p, const struct speed_road *r,
                       const struct speed_spot *spot);

/* The step that turns soonest into the way of the plan: its length and c; false: none keeps the
 * limits. */
bool speed_plan_steer(const struct speed_plan *p, const struct speed_road *r,
                      const struct speed_spot *spot, double *s, double *c);

/* Move a spot on by a step. */
void speed_plan_pass(const struct speed_plan *p, const struct speed_road *r,
                     struct speed_spot *spot, double s, struct speed_state to);

/* Whether such steps lead from a spot into the way of the plan. */
bool speed_plan_safe(const struct speed_plan *p, const struct speed_road *r,
                     struct speed_spot spot);

/* A ramp of constant jerk from rest at a place, forwards or (sign -1) backwards, at most `within`
 * long [mm]: the n-th of those that are tried and keep the limits, the longest first; false: none.
 */
bool speed_road_start(const struct speed_road *r, double at, int32_t box, double sign,
                      double within, int n, struct speed_step *step);

/* Whether a state may come to rest by constant jerk. */
bool speed_road_lands(const struct speed_road *r, double at, int32_t box, struct speed_state state);

/* The step from rest to rest over a way. [mm] */
struct speed_step speed_road_hop(const struct speed_road *r, double at, int32_t box, double way);

/* Most x in a box under the override. */
double speed_road_top(const struct speed_road *r, const struct speed_box *g);

#endif
