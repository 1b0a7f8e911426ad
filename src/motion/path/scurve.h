/* scurve - time-optimal, jerk-limited motion of one coordinate.
 *
 *   a ^  __                      at most seven phases of constant jerk to the target, before them
 *     | /  \                     two that bring a start outside the limits inside:
 *     |/    \________     ___    up, hold acc, down, cruise, down, hold -dec, up
 *     |              \   /       or, if the fastest change of speed would lead past the target,
 *     |               \_/        the mirror image of it.
 *     +--------------------> t
 *
 * The acceleration stays within -dec .. acc and the speed within -speed .. speed, whichever way the
 * coordinate moves: a move towards smaller s speeds up with dec and slows down with acc.
 */
#ifndef SCURVE_H
#define SCURVE_H

#include <stdint.h>

enum { SCURVE_PHASES = 9 };

enum scurve_status {
    SCURVE_OK = 0,
    SCURVE_NOT_FINITE = -1, /* a start, target or limit is infinite or not a number */
    SCURVE_LIMITS = -2,     /* a limit is not above 0 */
    SCURVE_TARGET = -3,     /* the target speed is beyond the speed limit */
    SCURVE_RANGE = -4       /* the numbers lie so far apart that the result overflows */
};

struct scurve_limits {
    double speed;    /* [mm/s] */
    double acc, dec; /* [mm/s^2] greatest acceleration, greatest deceleration */
    double jerk;     /* [mm/s^3] */
};

struct scurve_start {
    double s, v, a; /* [mm], [mm/s], [mm/s^2] */
};

/* Constant jerk until `end`; s, v, a are those at the moment t, one of the phase's two ends. */
struct scurve_phase {
    double end, t;  /* [s] since the plan began */
    double s, v, a; /* [mm], [mm/s], [mm/s^2] */
    double j;       /* [mm/s^3] */
};

struct scurve {
    struct scurve_phase phase[SCURVE_PHASES];
    int32_t count; /* phases in use, each longer than 0 */
    double total;  /* [s] */
    double s1, v1; /* [mm], [mm/s] at the end and for ever after; a is 0 there */
};

/* Plan the fastest way to rest at s1. Any start is allowed. One above the speed limit, or bound to
 * exceed it, comes back to it as fast as jerk and acceleration allow, and goes on from there. A
 * start that cannot stop before s1 passes it and comes back. A refused plan rests at the start. */
enum scurve_status scurve_plan(struct scurve *p, const struct scurve_start *from, double s1,
                               const struct scurve_limits *l);

/* Plan the fastest way past s1 with speed v1 (-speed .. speed) and a = 0. Every target can be
 * reached, but one nearer than scurve_way() may need a run-up backwards: see scurve_slowest(). */
enum scurve_status scurve_plan_through(struct scurve *p, const struct scurve_start *from, double s1,
                                       double v1, const struct scurve_limits *l);

/* Plan the fastest way to speed v1 with a = 0, wherever that is: p->s1. For hold (v1 = 0) and
 * override. Neither start nor target need be within the speed limit. */
enum scurve_status scurve_plan_speed(struct scurve *p, const struct scurve_start *from, double v1,
                                     const struct scurve_limits *l);

/* Way of scurve_plan_speed(), signed, without planning it. Limits must be > 0. [mm] */
double scurve_way(const struct scurve_start *from, double v1, const struct scurve_limits *l);

/* Where the motion is at t [s]: [mm], [mm/s], [mm/s^2], [mm/s^3]. Before 0 the start, after the
 * end the end, exactly, and j = 0. */
void scurve_state(const struct scurve *p, double t, double *s, double *v, double *a, double *j);

/* Duration. [s] */
double scurve_total(const struct scurve *p);

/* Least speed of the whole plan, below 0 if it moves backwards. [mm/s] */
double scurve_slowest(const struct scurve *p);

#endif
