/* profile - trapezoidal speed along a path, planned anew from any state of motion.
 *
 *   v ^        ____
 *     |       /    \            at most three phases of constant acceleration:
 *  v0 |......./      \          to the target speed, cruise, to rest
 *     +-------+----+--+--> t
 *     0            tail total
 */
#ifndef PROFILE_H
#define PROFILE_H

#include <stdbool.h>

enum { PROFILE_PHASES = 3 };

struct profile {
    double s0, v0;                  /* [mm], [mm/s] where the plan begins */
    double length;                  /* [mm] end of the path */
    double time[PROFILE_PHASES];    /* [s] duration of each phase */
    double acc[PROFILE_PHASES];     /* [mm/s^2] */
    double t;                       /* [s] since the plan began */
    double tail;                    /* [s] when the deceleration that ends at length begins */
    double total;                   /* [s] */
    bool   ends;                    /* true: total is the end of the path; false: rest before it */
};

struct profile_limits {
    double speed;       /* [mm/s] target; 0 brings the motion to rest on the path */
    double acc, dec;    /* [mm/s^2] both > 0 */
};

/* Plan from s, v (0 <= s <= length, v >= 0) to rest at length, or at once if the target is 0.
 * The deceleration to the end keeps within dec if v^2 / (2 dec) <= length - s, as any state does
 * that an earlier plan with the same dec passed through. */
void profile_plan(struct profile *p, double s, double v, double length,
                  const struct profile_limits *l);

/* A wait of so many seconds, on a path of length 0. */
void profile_wait(struct profile *p, double seconds);

/* Where the motion is at p->t; any t is allowed. */
void profile_state(const struct profile *p, double *s, double *v);

/* Time to the end of the plan. [s] */
double profile_left(const struct profile *p);

#endif
