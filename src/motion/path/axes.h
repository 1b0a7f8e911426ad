/* axes - six axes that move independently of one another, each planned anew at any instant.
 *
 * An axis stands, runs at a speed, or goes to a place. Its motion is the fastest that keeps its
 * limits (scurve). One ratio, the override, scales the speeds of all; at 0 they come to rest and
 * keep their orders. Acceleration and jerk do not depend on it.
 *
 * Where an axis has to turn round, the smaller of acceleration and deceleration holds for both.
 */
#ifndef AXES_H
#define AXES_H

#include <stdbool.h>

#include "axis_count.h"
#include "ramp.h"

struct axes_limits {
    double speed;    /* [mm/s] at ratio 1 */
    double cap;      /* [mm/s] highest speed any ratio may bring */
    double acc, dec; /* [mm/s^2] */
    double jerk;     /* [mm/s^3] */
};

enum axes_order { AXES_STAND, AXES_RUN, AXES_GO };

struct axes_axis {
    enum axes_order order;
    double goal; /* [mm/s] signed speed to run at, or [mm] place to go to */
    struct axes_limits limits;
    double side; /* +1, or -1: the plan is in coordinates of the opposite sign */
    struct scurve plan;
    double t; /* [s] since the plan began */
};

struct axes {
    struct axes_axis axis[AXES];
    double ratio;
};

/* Limits of an axis for motion at a speed [mm/s], at no ratio above a cap, with ramps up and down.
 * An S-curve has one jerk, the smaller of both ramps', so that one without limit beside one
 * with is rounded too. */
struct axes_limits axes_limits_of(const struct ramp_rule *up, const struct ramp_rule *down,
                                  double speed, double cap);

/* All axes stand at a place. [mm] */
void axes_start(struct axes *a, const double place[AXES], double ratio);

/* Orders to one axis, from now on. The limits of a run need no speed. An axis under way keeps
 * acceleration, deceleration and jerk of its latest order where those are higher. */
void axes_stand(struct axes *a, int axis);
void axes_run(struct axes *a, int axis, double speed, const struct axes_limits *l);
void axes_go(struct axes *a, int axis, double place, const struct axes_limits *l);

/* New ratio >= 0 for all axes, from now on. */
void axes_set_ratio(struct axes *a, double ratio);

/* Let time pass. [s] */
void axes_advance(struct axes *a, double dt);

/* Where an axis is and how fast: [mm], [mm/s]. */
void axes_state(const struct axes *a, int axis, double *place, double *speed);

/* Bounds of the places where an axis will be [mm]: they may be wide, and have no end if it runs.
 * *acc is a bound of the acceleration of its plan, either way. [mm/s^2] */
void axes_reach(const struct axes *a, int axis, double *low, double *high, double *acc);

/* True if the axis, or every axis, stays where it is until the next order or ratio. */
bool axes_rests(const struct axes *a, int axis);
bool axes_resting(const struct axes *a);

/* True if the axis rests and has carried out its order. */
bool axes_done(const struct axes *a, int axis);

/* The axis that is under way longest. */
int axes_last(const struct axes *a);

/* Time until the last axis rests; axes that run on are left out. [s] */
double axes_left(const struct axes *a);

#endif
