/* cycles - canned cycles: G73, G74, G81 to G89, with G98, G99 and L, in every plane.
 *
 * A block becomes commands one by one: the state keeps how far it is, so that there may be any
 * number of holes and pecks.
 */
#ifndef CYCLES_H
#define CYCLES_H

#include "gcode.h"
#include "modes.h"

/* Whether a code of motion is a canned cycle. */
bool cycles_code(int code);

/* Whether it is a tap, whose feed is that of its spindle's thread and never cut down. */
bool cycles_taps(int code);

/* G98, G99 of a block; any other code of motion ends a series of cycles. */
void cycles_modes(struct interpreter *in, const struct block *b);

/* Begin the cycle of a block. */
enum fault cycles_block(struct interpreter *in, const struct program *p, const struct block *b,
                        struct fault_report *r);

/* Go on with it, while it is running, up to one command at least or its end. */
enum fault cycles_next(struct interpreter *in, const struct program *p, struct fault_report *r);

#endif
