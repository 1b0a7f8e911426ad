/* trapezoid - trapezoidal speed profile in fixed point: TRACK, the command position that the
 * position loop follows, moves tick by tick within limits of speed and acceleration.
 *
 * From the speed v with n = ceil(v/a) ticks to rest the braking distance is exactly
 *     S(v) = v + (v - a) + (v - 2a) + ... = n v - a n (n - 1) / 2        (v^2/2a + v/2 if v = n a)
 * A tick takes the largest speed, within v - a .. v + a and the limit, whose S is no longer than
 * the distance that is left. Then the speed never has to fall by more than a, and the last tick
 * covers the rest: TRACK reaches its target exactly, without overshoot, in the least time. */
#ifndef TRAPEZOID_H
#define TRAPEZOID_H

#include <stdbool.h>
#include <stdint.h>

enum { TRAPEZOID_POINT = 16 }; /* bits behind the binary point of all numbers here */

/* Largest number of ticks to rest: a 16-bit word. */
enum { TRAPEZOID_TICKS_MAX = 65535 };

struct trapezoid {
    int64_t place;  /* Q32.16 [counts] TRACK: three 16-bit words */
    int64_t target; /* Q32.16 [counts] */
    int32_t speed;  /* Q16.16 [counts/tick] signed */
    int32_t change; /* Q16.16 [counts/tick] speed minus that of the tick before */
};

/* TRACK in whole counts: its two upper words. */
int64_t trapezoid_counts(const struct trapezoid *t);

/* Set TRACK to a position [counts], at rest. */
void trapezoid_put(struct trapezoid *t, int64_t counts);

/* Stop at once: the target becomes the present position. */
void trapezoid_freeze(struct trapezoid *t);

/* Set a new target [counts]. If the present speed is too high to stop there, TRACK passes it and
 * comes back. */
void trapezoid_go(struct trapezoid *t, int64_t counts);

/* Set the target to where TRACK comes to rest with the deceleration a [Q16.16 counts/tick^2]. */
void trapezoid_stop(struct trapezoid *t, int32_t a);

/* Add `counts` to position and target: the origin has been moved. */
void trapezoid_shift(struct trapezoid *t, int64_t counts);

/* Braking distance S(v) [Q32.16 counts] for speed v >= 0, acceleration a > 0. */
int64_t trapezoid_brake(int32_t v, int32_t a);

/* One tick, with the speed limit [Q16.16 counts/tick] and acceleration a [Q16.16 counts/tick^2]. */
void trapezoid_tick(struct trapezoid *t, int32_t limit, int32_t a);

/* Whether TRACK is at rest at its target. */
bool trapezoid_done(const struct trapezoid *t);

#endif
