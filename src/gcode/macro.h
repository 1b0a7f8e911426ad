/* macro - G65 P L: a subprogram with values by letters, as Fanuc's controls have it. */
#ifndef MACRO_H
#define MACRO_H

#include "modes.h"
#include "tokens.h"

/* Whether a line begins with G65. */
bool macro_calls(const struct tokens *t);

/* Call what P names, L times. A is #1 and so on to Z, #26; a letter left out is 0. */
enum fault macro_call(struct interpreter *in, const struct program *p, const struct tokens *t,
                      struct fault_report *r);

#endif
