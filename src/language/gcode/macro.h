/* macro - G65, G66 P L: a subprogram with values by letters, as Fanuc's controls have it; M100 to
 * M199: what a subprogram of the user says. */
#ifndef MACRO_H
#define MACRO_H

#include "modes.h"
#include "tokens.h"

/* Whether a line begins with G65 or G66. */
bool macro_calls(const struct tokens *t);

/* The word M100 .. M199 of a line, or NULL; the call it makes, when the line begins here. */
const struct token *macro_user(const struct tokens *t);
enum fault macro_call_user(struct interpreter *in, const struct program *p, const struct tokens *t,
                           struct oword_place here, struct fault_report *r);

/* Call what P names, L times; behind G66, behind each line that moves the axes. A is #1 and so on
 * to Z, #26; a letter left out is vacant. */
enum fault macro_call(struct interpreter *in, const struct program *p, const struct tokens *t,
                      struct fault_report *r);

#endif
