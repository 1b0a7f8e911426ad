/* tapping - G33.1: a line with the spindle, and back with the spindle the other way round. */
#ifndef TAPPING_H
#define TAPPING_H

#include "gcode.h"
#include "modes.h"

/* Execute it: K is the way of a turn, I how much faster it goes back. */
enum fault tapping_block(struct interpreter *in, const struct program *p, const struct block *b,
                         struct fault_report *r);

#endif
