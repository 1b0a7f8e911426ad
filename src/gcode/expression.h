/* expression - a value of a part program: a number, a parameter, a function or [ ].
 *
 * Of two operators the one further down waits, on the same line the one on the right:
 *
 *     **    * / MOD    + -    EQ NE GT GE LT LE    AND OR XOR
 */
#ifndef EXPRESSION_H
#define EXPRESSION_H

#include "reading.h"

/* Read a value; `from` is where its text begins, with the letter in front of it. *whole: a number
 * without a point. */
enum fault expression_value(struct reading *s, int32_t from, double *value, bool *whole);

/* Read [ ... ]. */
enum fault expression_brackets(struct reading *s, double *value);

/* Read which parameter a # stands in front of, s behind the #. */
enum fault expression_parameter(struct reading *s, struct parameter *which);

#endif
