/* uses - finds the code of a block to which each of its words belongs. */
#ifndef USES_H
#define USES_H

#include "gcode.h"
#include "modes.h"

/* The first code of the block, other than one of motion, that takes a letter ('+': the axis words);
 * NULL: none does. */
const struct token *uses_of(const struct gcode *g, char letter);

/* FAULT_SHARED: two codes of the block take the same words; FAULT_UNUSED: none takes one that is
 * there. Axis words that no code takes are left to the motion. */
enum fault uses_check(const struct interpreter *in, const struct block *b, struct fault_report *r);

#endif
