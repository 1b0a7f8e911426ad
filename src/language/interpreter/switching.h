/* switching - S, G96, G97, M3 to M5, M19, M7 to M9, M48 to M53, M62 to M65, M67, M68 of a block. */
#ifndef SWITCHING_H
#define SWITCHING_H

#include "gcode.h"
#include "modes.h"

/* Execute them. Makes a command if something is to be switched when the motion so far has ended. */
enum fault switching_block(struct interpreter *in, const struct program *p, const struct block *b,
                           struct fault_report *r);

/* Make a command that brings everything in force and switches digital outputs. */
void switching_make(struct interpreter *in, uint32_t set, uint32_t clear);

/* Make a command if the machine is to have anything else than before. */
void switching_differs(struct interpreter *in, const struct switches *before);

/* M2, M30: spindle and coolant off, overrides on, behind the motion of the block. */
void switching_end(struct interpreter *in);

#endif
