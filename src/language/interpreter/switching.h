/* switching - spindle (S, G96, G97, M3 to M5, M19), coolant (M7 to M9), overrides (M48 to M53) and
 * outputs (M62 to M65, M67, M68) of a block. */
#ifndef SWITCHING_H
#define SWITCHING_H

#include "gcode.h"
#include "modes.h"

/* Execute these words. Makes a command if anything is to be switched at the end of the motion so
 * far; M62, M63 and M67 wait for the next motion. */
enum fault switching_block(struct interpreter *in, const struct program *p, const struct block *b,
                           struct fault_report *r);

/* Make a command with all that in->switches says, and with digital outputs to set and to clear, a
 * bit each. */
void switching_make(struct interpreter *in, uint32_t set, uint32_t clear);

/* Make a command if in->switches asks the machine for anything else than `before`. */
void switching_differs(struct interpreter *in, const struct switches *before);

/* M2, M30: behind the motion of the block spindle and coolant are off, overrides act, G96 ends. */
void switching_end(struct interpreter *in);

#endif
