/* profile - speed along a path, planned anew from any state of motion.
 *
 *   v ^        ____
 *     |       /    \            a ramp to the target speed, cruise, a ramp to rest;
 *  v0 |......./      \          trapezoidal, or with S-shaped ramps
 *     +-------+----+--+--> t
 *     0            tail total
 */
#ifndef PROFILE_H
#define PROFILE_H

#include <stdbool.h>

#include "ramp.h"

enum { PROFILE_PHASES = 3 };

struct profile {
    double s0, v0;               /* [mm], [mm/s] where the plan begins */
    double length;               /* [mm] end of the path */
    double time[PROFILE_PHASES]; /* [s] duration of each phase */
    double acc[PROFILE_PHASES];  /* [mm/s^2] of a trapezoid */
    double t;                    /* [s] since the plan began */
    double tail;                 /* [s] when the deceleration that ends at length begins */
    double total;                /* [s] */
    bool ends;                   /* true: total is the end of the path; false: rest before it */
    bool smooth;                 /* ramps are S-shaped, as below */
    struct ramp rise, fall;
};

struct profile_limits {
    double speed;            /* [mm/s] target; 0 brings the motion to rest on the path */
    struct ramp_limits ramp; /* both jerks 0: a trapezoid */
};

/* Plan from a start (0 <= s <= length, v >= 0) to rest at length, or at once if the target is 0.
 * The deceleration to the end keeps within its limits if the way to rest is no longer than what is
 * left, as in any state that an earlier plan with the same limits passed through. */
void profile_plan(struct profile *p, const struct scurve_start *from, double length,
                  const struct profile_limits *l);

/* A wait of so many seconds, on a path of length 0. */
void profile_wait(struct profile *p, double seconds);

/* Where the motion is at p->t; any t is allowed. */
struct scurve_start profile_state(const struct profile *p);

/* Time to the end of the plan. [s] */
double profile_left(const struct profile *p);

#endif
