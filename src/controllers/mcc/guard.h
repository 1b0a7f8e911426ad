/* guard - when motion must stop: decisions without a state. */
#ifndef GUARD_H
#define GUARD_H

#include "signals.h"

/* First axis whose limit switch blocks the direction it goes; -1 none. [any unit] */
int guard_switch(const struct machine *m, const struct signals *s, const double way[AXES]);

/* Whether the limit switches generate an error. */
bool guard_switch_error(const struct machine *m);

/* First axis whose frame changes by more than max_dda_acc; -1 none. [pulses] */
int guard_change(const struct machine *m, const int32_t before[AXES], const int32_t frame[AXES]);

/* First axis whose following error is above its limit; -1 none. */
int guard_track(const struct machine *m, const struct signals *s);

/* Used axes, a bit each, whose commands wait for the position; whose error counter lies within the
 * tolerance. */
uint32_t guard_watched(const struct machine *m);
uint32_t guard_within(const struct machine *m, const struct signals *s);

#endif
