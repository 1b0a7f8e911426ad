/* macro - calls that give values to a subprogram: G65 and G66 of Fanuc's controls, with a value by
 * each letter, and M100 to M199, whose meaning a subprogram of the user says. */
#ifndef MACRO_H
#define MACRO_H

#include "modes.h"
#include "tokens.h"

/* Whether a line begins with G65 or G66, behind its line number. */
bool macro_calls(const struct tokens *t);

/* The first word M100 .. M199 of a line, or NULL; and the call that it makes, with P and Q as #1
 * and #2, -1 if not given. `here` is the place of the line. FAULT_GROUP: it has two of them. */
const struct token *macro_user(const struct tokens *t);
enum fault macro_call_user(struct interpreter *in, const struct program *p, const struct tokens *t,
                           struct oword_place here, struct fault_report *r);

/* Execute G65: call the program numbered P, L times; or G66: the same behind each line that moves
 * the axes. Other letters set the local parameters that Fanuc gives them, from A, #1, to Z, #26;
 * I J K may come ten times, up to #33. A parameter whose letter is left out is vacant. */
enum fault macro_call(struct interpreter *in, const struct program *p, const struct tokens *t,
                      struct fault_report *r);

#endif
