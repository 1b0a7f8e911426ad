/* home_motion - the motion of one axis in homing and approach: whole pulses for each DDA period,
 * with a trapezoidal speed profile.
 *
 * From period to period the speed changes by the acceleration at most; but from rest to the start
 * speed, and from below that to rest, it may change at once. */
#ifndef HOME_MOTION_H
#define HOME_MOTION_H

#include <stdbool.h>
#include <stdint.h>

struct home_motion {
    int64_t commanded; /* [pulses] commanded so far */
    double rest;       /* 0..1 part of a pulse that is not yet commanded */
    double speed;      /* [pulses/period] signed */
    int32_t still;     /* number of periods at rest */
};

/* Limits of a motion: acceleration [pulses/period^2] and start speed [pulses/period]. */
struct home_limits {
    double acc, start;
};

/* Pulses of the next period, at most |speed| + 1: towards a speed [pulses/period], or to a target
 * with at most this speed. At the target no part of a pulse is left. */
int32_t home_motion_run(struct home_motion *m, const struct home_limits *l, double speed);
int32_t home_motion_to(struct home_motion *m, const struct home_limits *l, int64_t target,
                       double speed);

/* True if the axis has been commanded to the target, with no part of a pulse left. */
bool home_motion_at(const struct home_motion *m, int64_t target);

#endif
