/* expression - reads a value of a part program: a number, a parameter, a function or an expression
 * in [ ].
 *
 * Operators in falling precedence; those of equal precedence are taken from left to right:
 *
 *     **    * / MOD    + -    EQ NE GT GE LT LE    AND OR XOR
 *
 * On Fanuc's controls AND has the precedence of MOD, OR and XOR that of +; all three act on the
 * bits of whole numbers. A vacant parameter there is a vacant value as long as it stands alone. EQ
 * and NE find it equal to another vacant one only; in every other operation it counts as 0.
 */
#ifndef EXPRESSION_H
#define EXPRESSION_H

#include "reading.h"

/* Read a value; a vacant one counts as 0. `from` is where its text begins in the line, with the
 * letter in front of it, for the place of a fault. *whole: it is a number without a point. */
enum fault expression_value(struct reading *s, int32_t from, double *value, bool *whole);

/* As expression_value, but the value may be vacant (parameters_vacant). */
enum fault expression_or_vacant(struct reading *s, int32_t from, double *value, bool *whole);

/* Read an expression in [ ]; a vacant value counts as 0. */
enum fault expression_brackets(struct reading *s, double *value);

/* Read the right side of #1 = on Fanuc's controls: an expression that needs no brackets. It ends
 * where no operator follows a value, and may be vacant. */
enum fault expression_bare(struct reading *s, double *value);

/* Read the number or <name> behind a #, where s is; the number may be a value itself.
 * FAULT_PARAMETER: it is not a whole number above 0, or no parameters exist (s->in is NULL). On
 * Fanuc's controls 0 becomes PARAMETERS_ZERO. */
enum fault expression_parameter(struct reading *s, struct parameter *which);

#endif
