/* expression - a value of a part program: a number, a parameter, a function or [ ].
 *
 * Of two operators the one further down waits, on the same line the one on the right:
 *
 *     **    * / MOD    + -    EQ NE GT GE LT LE    AND OR XOR
 *
 * On Fanuc's controls AND is as firm as MOD, OR and XOR as + and -; all three work on bits. What is
 * vacant there stays so as a whole value, equals nothing but another vacant one, and else is 0.
 */
#ifndef EXPRESSION_H
#define EXPRESSION_H

#include "reading.h"

/* Read a value; `from` is where its text begins, with the letter in front of it. *whole: a number
 * without a point. */
enum fault expression_value(struct reading *s, int32_t from, double *value, bool *whole);

/* expression_value, but the value may be vacant. */
enum fault expression_or_vacant(struct reading *s, int32_t from, double *value, bool *whole);

/* Read [ ... ]. */
enum fault expression_brackets(struct reading *s, double *value);

/* Read what stands behind #1= on Fanuc's controls: values and operations without brackets. It may
 * be vacant. */
enum fault expression_bare(struct reading *s, double *value);

/* Read which parameter a # stands in front of, s behind the #. */
enum fault expression_parameter(struct reading *s, struct parameter *which);

#endif
