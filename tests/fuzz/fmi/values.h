/* values - input bytes as values of a variable, legal and not. */
#ifndef VALUES_H
#define VALUES_H

#include "inside.h"

struct bytes {
    const uint8_t *at, *end;
};

/* The next n bytes as a number, 0 behind the end. */
uint32_t take(struct bytes *b, int n);

/* One that set is called with; a string stays until the next. */
union side_value value(struct bytes *b, const struct inside_variable *v, union side_value start);

/* Is it one that the variable may have? */
bool legal(const struct inside_variable *v, union side_value x);

bool equal(int type, union side_value a, union side_value b);

#endif
