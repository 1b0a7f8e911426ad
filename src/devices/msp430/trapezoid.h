/* Trapezoidal profile: TRACK, the target that the position loop follows, moved tick by tick with
 * limits of speed and acceleration, and its braking distance known ahead.
 *
 * From speed v with n = ceil(v/a) ticks to rest the way that is left is exactly
 *     S(v) = v + (v - a) + (v - 2a) + ... = n v - a n (n - 1) / 2        (v^2/2a + v/2 if v = n a)
 * A tick takes the largest speed within v - a .. v + a and the limit whose S is not beyond what is
 * left. Then the speed never has to fall by more than a, and the last tick is what is left: TRACK
 * lands on its target, to the count and without overshoot, in the least time. */
#ifndef TRAPEZOID_H
#define TRAPEZOID_H

#include <stdbool.h>
#include <stdint.h>

enum { TRAPEZOID_POINT = 16 }; /* bits behind the binary point of everything here */

/* Ticks to rest are a 16-bit word. */
enum { TRAPEZOID_TICKS_MAX = 65535 };

struct trapezoid {
    int64_t place;  /* Q32.16 [counts] TRACK: three words */
    int64_t target; /* Q32.16 [counts] */
    int32_t speed;  /* Q16.16 [counts/tick] */
    int32_t change; /* Q16.16 [counts/tick] speed less that of the tick before */
};

/* Whole counts of TRACK: the two upper words. */
int64_t trapezoid_counts(const struct trapezoid *t);

/* Stand at a place [counts]. */
void trapezoid_put(struct trapezoid *t, int64_t counts);

/* Stand here at once. */
void trapezoid_freeze(struct trapezoid *t);

/* Move on to a target [counts]; one that cannot be reached with the speed there is, is passed and
 * approached from the other side. */
void trapezoid_go(struct trapezoid *t, int64_t counts);

/* Come to rest as soon as the acceleration a lets it. */
void trapezoid_stop(struct trapezoid *t, int32_t a);

/* The same place by another count: `counts` are added to place and target. */
void trapezoid_shift(struct trapezoid *t, int64_t counts);

/* The way S(v) [counts, Q32.16] for speed v >= 0, acceleration a > 0. */
int64_t trapezoid_brake(int32_t v, int32_t a);

/* One tick with the limits speed [Q16.16 counts/tick] and acceleration a [Q16.16 counts/tick^2]. */
void trapezoid_tick(struct trapezoid *t, int32_t limit, int32_t a);

/* TRACK stands at its target. */
bool trapezoid_done(const struct trapezoid *t);

#endif
