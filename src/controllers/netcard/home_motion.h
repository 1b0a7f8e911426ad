/* home_motion - an axis moved by whole pulses a period, with a speed of trapezoids.
 *
 * Its speed changes by the acceleration from period to period; from rest to the start speed, and
 * from below that to rest, it may change at once. */
#ifndef HOME_MOTION_H
#define HOME_MOTION_H

#include <stdbool.h>
#include <stdint.h>

struct home_motion {
    int64_t commanded; /* [pulses] whole pulses commanded so far */
    double rest;       /* [pulses] 0..1 part of a pulse that is not yet commanded */
    double speed;      /* [pulses/period] signed */
    int32_t still;     /* periods at rest */
};

/* Limits of a motion, in pulses and periods. */
struct home_limits {
    double acc, start;
};

/* Pulses of the next period, |pulses| <= |speed| + 1: towards a speed, or to a target with this
 * speed at most. At the target there is no rest. */
int32_t home_motion_run(struct home_motion *m, const struct home_limits *l, double speed);
int32_t home_motion_to(struct home_motion *m, const struct home_limits *l, int64_t target,
                       double speed);

bool home_motion_at(const struct home_motion *m, int64_t target);

#endif
