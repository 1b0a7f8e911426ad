/* guard - what may not be commanded, and when motion must stop: decisions without a state.
 *
 * Software limits are compared in whole pulses, so that a target on the limit is within it. Beyond
 * one, only what leads further out is refused; the way back is open.
 */
#ifndef GUARD_H
#define GUARD_H

#include "fault.h"
#include "path.h"
#include "signals.h"

/* FAULT_TRAVEL if a path leads beyond a software limit and further out than it starts; *r then
 * has the axis, how far it leads and the limit [mm]. */
enum fault guard_path(const struct machine *m, const struct path *p, struct fault_report *r);

/* Whether any axis has software limits in force. */
bool guard_limited(const struct machine *m);

/* First axis that would go beyond a software limit and further out; -1 none. [pulses] */
int guard_travel(const struct machine *m, const int32_t from[AXES], const int32_t to[AXES]);

/* The same for bounds of the motion to come. [mm] */
int guard_reach(const struct machine *m, const int32_t from[AXES], const double low[AXES],
                const double high[AXES]);

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
