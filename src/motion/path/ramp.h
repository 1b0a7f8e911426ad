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

/* Acceleration and deceleration, both > 0, each with its own jerk; a jerk of 0 means unlimited (a
 * trapezium), else the ramp is S-shaped. */
struct ramp_limits {
    double acc, dec;           /* [mm/s^2] */
    double acc_jerk, dec_jerk; /* [mm/s^3] */
};

/* What one change of speed keeps to, given by numbers, or by the time it takes. */
struct ramp_rule {
    double acc;   /* [mm/s^2] */
    double jerk;  /* [mm/s^3]; 0 unlimited */
    double time;  /* [s] > 0: from rest to any speed; acc and jerk follow from it */
    double share; /* 0..1 part of it in which the acceleration changes; 0: at once */
};

/* A rule by numbers that does for a speed [mm/s] what this one does; its own time is 0. */
struct ramp_rule ramp_to(const struct ramp_rule *r, double speed);

/* The limits that both rules give for a speed. */
struct ramp_limits ramp_both(const struct ramp_rule *up, const struct ramp_rule *down,
                             double speed);

struct ramp {
    struct scurve ease, change;
    double total; /* [s] */
    double s1;    /* [mm] where it ends */
};

/* Fastest ramp from a start to a speed >= 0. */
void ramp_plan(struct ramp *r, struct scurve_start from, double speed, const struct ramp_limits *l);

/* Way of that ramp, without planning it. [mm] */
double ramp_way(struct scurve_start from, double speed, const struct ramp_limits *l);

/* Speed with which a start comes to a = 0 by the ease alone. [mm/s] */
double ramp_eased(const struct scurve_start *from, const struct ramp_limits *l);

/* The motion at t, 0 .. total. */
struct scurve_start ramp_state(const struct ramp *r, double t);

#endif
