/* saved_modes - M70 to M73: the modes in force are saved, for each depth of calls, and restored. */
#ifndef SAVED_MODES_H
#define SAVED_MODES_H

#include "gcode.h"
#include "modes.h"

/* Execute these of a block: M70 and M73 save, M71 forgets, M72 restores, with a command if that
 * switches anything. FAULT_NO_MODES: nothing is saved; FAULT_RESTORE: not now. */
enum fault saved_modes_block(struct interpreter *in, const struct block *b, struct fault_report *r);

/* Behind the end of a call with M73: restore the modes that it saved. FAULT_RESTORE. */
enum fault saved_modes_return(struct interpreter *in, struct fault_report *r);

#endif
