/* tool_change - T, M6, M61 of one block. */
#ifndef TOOL_CHANGE_H
#define TOOL_CHANGE_H

#include "gcode.h"
#include "modes.h"

/* T, M6 and M61. M6 stops the spindle; then the program stops for the change, unless that is
 * immediate. */
enum fault tool_change(struct interpreter *in, const struct program *p, const struct block *b,
                       struct fault_report *r);

#endif
