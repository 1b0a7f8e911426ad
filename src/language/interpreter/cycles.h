/* cycles - canned cycles: G73, G74, G81 to G89, with G98, G99 and L, in every plane.
 *
 * A block becomes commands one by one, and struct cycle keeps how far it is. So there may be any
 * number of holes and pecks.
 */
#ifndef CYCLES_H
#define CYCLES_H

#include "gcode.h"
#include "modes.h"

/* Whether a code of motion, ten times its number, is that of a canned cycle. */
bool cycles_code(int code);

/* Whether it is tapping, G74 or G84: its feed is pitch times speed, and never cut down. */
bool cycles_taps(int code);

/* Execute G98, G99 of a block; a code of motion that is no canned cycle ends a series of them. */
void cycles_modes(struct interpreter *in, const struct block *b);

/* Begin the canned cycle of a block: take its words, find its first hole and the heights. */
enum fault cycles_block(struct interpreter *in, const struct program *p, const struct block *b,
                        struct fault_report *r);

/* Go on with a cycle that runs, until there is a command or it has ended. */
enum fault cycles_next(struct interpreter *in, const struct program *p, struct fault_report *r);

#endif
