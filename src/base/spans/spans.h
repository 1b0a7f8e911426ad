/* spans - parts of a state that need no copy. */
#ifndef SPANS_H
#define SPANS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* More than these are not taken: what is not named is copied. */
enum { SPANS_MAX = 256 };

struct span {
    uintptr_t from, to;     /* addresses */
    bool      zero;         /* all of it is 0; else it may hold anything */
};

struct spans {
    int32_t count;
    struct span span[SPANS_MAX];
};

/* From an address up to another one: never read before it is written, or 0 all over. */
void spans_leave(struct spans *s, const void *from, const void *to);
void spans_zero(struct spans *s, const void *from, const void *to);

/* All of an array of so many elements, of `size` bytes, but `used` ones from `first` on, which may
 * go on at its begin. */
void spans_ring(struct spans *s, const void *array, size_t size, int32_t elements, int32_t first,
                int32_t used);

#endif
