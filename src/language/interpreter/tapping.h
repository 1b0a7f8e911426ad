/* tapping - G33.1: a straight motion at the pitch of a thread, and back to its start with the
 * spindle the other way round. */
#ifndef TAPPING_H
#define TAPPING_H

#include "gcode.h"
#include "modes.h"

/* Execute it: K is the pitch [mm, inch per turn], I the factor of feed and speed on the way back,
 * at least 1. FAULT_TAP_K: no K; FAULT_CYCLE_SPINDLE: the spindle is at rest, or with G96;
 * FAULT_FEED; FAULT_VALUE; FAULT_NO_AXES. */
enum fault tapping_block(struct interpreter *in, const struct program *p, const struct block *b,
                         struct fault_report *r);

#endif
