/* tool_change - the choice of a tool (T), its change (M6), and M61: the tool is there already. */
#ifndef TOOL_CHANGE_H
#define TOOL_CHANGE_H

#include "gcode.h"
#include "modes.h"

/* Execute T, M6 and M61 Q of a block. M6 stops the spindle; with p->change_stops the program then
 * stops until the operator has changed the tool. FAULT_TOOL: not in the table; FAULT_NO_TOOL: M6
 * without a T; FAULT_MISSING: M61 without Q. */
enum fault tool_change(struct interpreter *in, const struct program *p, const struct block *b,
                       struct fault_report *r);

#endif
