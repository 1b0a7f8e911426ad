/* ramp - a change of speed that keeps separate rules for speeding up and for slowing down.
 *
 *   a ^  ____
 *     | /    \              ease   brings a start to a = 0, if the ramp goes the other way
 *     |/      \________     change to the new speed, S-shaped or at once
 *     +------------------> t
 */
#ifndef RAMP_H
#define RAMP_H

#include "scurve.h"

/* Acceleration and deceleration, both > 0, each with its own jerk; a jerk of 0 means unlimited ('T'
 * of the library), else the ramp is S-shaped ('S'). */
struct ramp_limits {
    double acc, dec;            /* [mm/s^2] */
    double acc_jerk, dec_jerk;  /* [mm/s^3] */
};

struct ramp {
    struct scurve ease, change;
    double total;               /* [s] */
    double s1;                  /* [mm] where it ends */
};

/* Fastest ramp from a start to a speed >= 0. */
void ramp_plan(struct ramp *r, struct scurve_start from, double speed,
               const struct ramp_limits *l);

/* Its way, without planning it. [mm] */
double ramp_way(struct scurve_start from, double speed, const struct ramp_limits *l);

/* Way and speed of the ease alone: where a start comes to a = 0. */
double ramp_eased(const struct scurve_start *from, const struct ramp_limits *l);    /* [mm/s] */

/* The motion at t, 0 .. total. */
struct scurve_start ramp_state(const struct ramp *r, double t);

#endif
