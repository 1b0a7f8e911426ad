/* speed_profile - the way u(t) along a chain of segments, as quick as the limits allow.
 *
 *   x ^     ____          ___         x = (du/dt)^2. From the end of the known cells backwards, the
 *     |    /    \   __   /   \        most x from which the rest can be driven; forwards, the most
 *     |   /      \_/  \_/     \       acceleration that stays below it. The most braking from any
 *     +--+-----+--+----+---+---> u    such x stays below it, too: a lower override, or none, brakes
 *                                     as much as the limits allow, wherever the motion is.
 *
 * The states from which the rest can be driven with a constant acceleration in each cell are all
 * those below that curve. The motion is nearly the quickest one within these bounds: the most speed
 * here may cost some behind (docs/theory/speed.md). Its acceleration is constant in a cell, or
 * changes once or twice. At the end of what is known it can always come to rest. With limited jerk:
 * speed_plan.h.
 */
#ifndef SPEED_PROFILE_H
#define SPEED_PROFILE_H

#include "speed_plan.h"

enum { SPEED_PROFILE_CELLS = 1024, SPEED_PROFILE_KEPT = 256 };

/* Where the motion is. */
struct speed_profile_place {
    int32_t head;              /* its cell */
    int32_t planned;           /* cells from there on that the latest plan knows */
    double base;               /* [mm] start of that cell, from the start of the chain */
    double left;               /* [mm] to the end of that cell */
    double way;                /* [mm] since the start of the chain */
    double rate, gain, twitch; /* [mm/s], [mm/s^2], [mm/s^3] derivatives of the way */

    /* with limited jerk */
    double here;                /* [mm] from the start of the chain */
    struct speed_state state;   /* speed between two steps */
    struct speed_step step;     /* the step under way, if there is one */
    double spent, origin, goal; /* [s] since its start; [mm] its start and end on the chain */
    double asked;               /* the latest override */
};

struct speed_profile {
    struct speed_limits limits;
    bool smooth;   /* jerk is limited: boxes and plans, else cells */
    int32_t reach; /* boxes of the latest plan, if there was no room for all; else 0 */
    int32_t held;  /* index of the plan in force */
    bool pending;  /* the other one will be, as soon as the motion can turn into it */
    struct speed_profile_place at;
    int32_t count;   /* cells from that of the motion on */
    bool closed;     /* no further segment joins */
    double override; /* the one of the latest plan */
    double end;      /* [mm] end of the segments, from the start of the chain */
    union speed_element ring[SPEED_PROFILE_CELLS];
    struct speed_plan plan[2]; /* with limited jerk */
};

/* Back to an earlier place, from which fewer than SPEED_PROFILE_KEPT cells have been crossed. */
void speed_profile_put(struct speed_profile *p, const struct speed_profile_place *place);

/* A chain begins at rest, without segments. Its jerk is limited if one of an axis is given, or,
 * without limits of the axes, by the ramp of its first segment. */
void speed_profile_start(struct speed_profile *p, const struct speed_limits *l);

/* Append a segment; false: no room until the motion has passed others, or it is closed. */
bool speed_profile_join(struct speed_profile *p, const struct segment *segment);

/* Let up to dt seconds pass under an override (>= 0; 0: to rest, as quickly as the limits allow).
 * Returns the time left: above 0 only at rest at the end of the chain. */
double speed_profile_advance(struct speed_profile *p, double override, double dt);

/* Where an override of 0 brings it to rest [mm]. Without a limit of jerk it may do so before. As a
 * bend takes less and less, it can brake harder than this counts with, which is told anew where x
 * has halved. Where a bend helps to brake, a motion that has become slower brakes less, for which
 * a thousandth of the way is added. Of 20,000 motions the way was at most 0.24 of it shorter, none
 * longer (4e-4 of it without that). */
double speed_profile_stop_way(const struct speed_profile *p);

/* Whether the motion, that much further on [mm], brakes for the end of the known segments. */
bool speed_profile_nears_end(const struct speed_profile *p, double further);

/* Whether it rests at the end of the known segments. */
bool speed_profile_at_end(const struct speed_profile *p);

#endif
