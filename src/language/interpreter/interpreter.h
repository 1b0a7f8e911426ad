/* interpreter - turns a part program in RS-274 into commands, one at a time.
 *
 * The text stays outside: the state is a place in it and the modal values. So a program of any
 * length streams through, and a check of it is one pass with a copy of the state.
 */
#ifndef INTERPRETER_H
#define INTERPRETER_H

#include "modes.h"

/* WAIT: to read on takes an answer that only the machine has, behind all commands so far (an input,
 * a probe); it is given by the functions of waiting.h. */
enum interpreter_result {
    INTERPRETER_COMMAND,
    INTERPRETER_WAIT,
    INTERPRETER_END,
    INTERPRETER_FAULT,
    INTERPRETER_LINES /* lines given by hand are used up, more may come; or the next is p->upto */
};

/* Begin at the first line, at rest in a point (machine coordinates [mm], [deg]), with an F [mm/s]
 * and the origins of G54 .. G59.3. In force are G17 G21 G90 G91.1 G94 G54 G61 G80 G98 M5 M9. */
void interpreter_start(struct interpreter *in, const double point[AXES], double feed,
                       const double origin[INTERPRETER_SYSTEMS][AXES]);

/* Whether what is to be done next is to read a line of the program itself: nothing of the lines
 * before is left but what waits for it. */
bool interpreter_due(const struct interpreter *in);

/* Read on until there is a command; its index is left to the caller. A fault is in *r, and it ends
 * the program. */
enum interpreter_result interpreter_next(struct interpreter *in, const struct program *p,
                                         struct command *c, struct fault_report *r);

enum { CHECK_AGAIN = FLOW_AGAIN }; /* lines read again at which a check stops by default */

/* Read a program to its end, or to its first fault, with a copy of the state; FAULT_NONE in *r if
 * it is good. It may run for ever, so the check ends when loops, calls and M99 have read
 * check_again lines again. Answers of the machine are those of waiting_pass. */
void interpreter_check(const struct interpreter *from, const struct program *p,
                       struct fault_report *r);

/* The same for up to FAULT_LIST faults and all notes: behind a fault it goes on from where the
 * words of the line lead. A fault that only follows from an earlier one is left out. */
void interpreter_check_all(const struct interpreter *from, const struct program *p,
                           struct fault_list *all);

/* As interpreter_next, but a fault does not end the program. */
enum interpreter_result interpreter_read(struct interpreter *in, const struct program *p,
                                         struct command *c, struct fault_report *r);

#endif
