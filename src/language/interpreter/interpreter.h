/* interpreter - a part program becomes commands, one at a time.
 *
 * The text stays outside: the state is a place in it and the modal values, so a program of any
 * length streams through, and checking it is one pass with a copy of the state.
 */
#ifndef INTERPRETER_H
#define INTERPRETER_H

#include "modes.h"

/* WAIT: the next line needs something that only the machine can tell behind all commands so far (an
 * input, a probe); who has it clears `waits`. */
enum interpreter_result {
    INTERPRETER_COMMAND,
    INTERPRETER_WAIT,
    INTERPRETER_END,
    INTERPRETER_FAULT
};

/* Begin at the first line, at rest in a point; G17 G21 G90 G91.1 G54 G61 M5 M9 in force. */
void interpreter_start(struct interpreter *in, const double point[AXES], double feed,
                       const double origin[INTERPRETER_SYSTEMS][AXES]);

/* Read on until there is a command (its index is left to the caller). A fault ends the program. */
enum interpreter_result interpreter_next(struct interpreter *in, const struct program *p,
                                         struct command *c, struct fault_report *r);

enum { CHECK_AGAIN = FLOW_AGAIN };

/* Read a whole program to its end, from a copy of the state; FAULT_NONE in *r if it is good. What
 * loops, calls and M99 read again ends the check at check_again lines: a program may run for ever.
 * What only the machine knows, the program finds as where there is none. */
void interpreter_check(const struct interpreter *from, const struct program *p,
                       struct fault_report *r);

/* The same, but going on behind a faulty line from where its words lead, for all faults. */
void interpreter_check_all(const struct interpreter *from, const struct program *p,
                           struct fault_list *all);

/* interpreter_next, but a fault does not end the program. */
enum interpreter_result interpreter_read(struct interpreter *in, const struct program *p,
                                         struct command *c, struct fault_report *r);

#endif
