/* uses - which code of a block each word belongs to. */
#ifndef USES_H
#define USES_H

#include "gcode.h"
#include "modes.h"

/* The code of the block, not one of motion, that takes a letter (or '+', the axis words); NULL if
 * none does. */
const struct token *uses_of(const struct gcode *g, char letter);

/* Whether two codes take the same letter, or none one that is there. Axis words without a code are
 * left to what moves. */
enum fault uses_check(const struct interpreter *in, const struct block *b, struct fault_report *r);

#endif
