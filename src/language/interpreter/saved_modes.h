/* saved_modes - M70 to M73: what is in force is kept for a call, and comes into force again. */
#ifndef SAVED_MODES_H
#define SAVED_MODES_H

#include "gcode.h"
#include "modes.h"

/* Execute them. Makes a command if something is to be switched. */
enum fault saved_modes_block(struct interpreter *in, const struct block *b, struct fault_report *r);

/* A call that had M73 has ended: its caller's modes are in force again. */
enum fault saved_modes_return(struct interpreter *in, struct fault_report *r);

#endif
