/* guard - checks that tell when motion must stop: limit switches, change of speed, following error.
 * They have no state; reaction.h acts on them. */
#ifndef GUARD_H
#define GUARD_H

#include "signals.h"

/* First axis whose limit switches block the direction of its displacement way[], in any unit; -1:
 * none. */
int guard_switch(const struct machine *m, const struct signals *s, const double way[AXES]);

/* True if a limit switch that blocks also raises an error. */
bool guard_switch_error(const struct machine *m);

/* First axis whose frame [pulses] differs from the one before by more than max_dda_acc; -1:
 * none. */
int guard_change(const struct machine *m, const int32_t before[AXES], const int32_t frame[AXES]);

/* First axis whose error counter is above its track_limit; -1: none. */
int guard_track(const struct machine *m, const struct signals *s);

/* Used axes, a bit each: those with in_pos, whose commands wait until they are in position; and
 * those whose error counter is within inpos_tol. */
uint32_t guard_watched(const struct machine *m);
uint32_t guard_within(const struct machine *m, const struct signals *s);

#endif
