/* Parts of a state that a saved one leaves out. */
#ifndef FMU_SPAN_H
#define FMU_SPAN_H

#include <stddef.h>
#include <stdint.h>

struct fmu_span {
    uint32_t from, to;  /* [byte] of the state, multiples of 8 */
    uint32_t zero;      /* 1: all of it is 0, and is again when restored; 0: it may hold anything */
    uint32_t reserved;  /* 0 */
};

enum {
    FMU_SPANS    = 512, /* the most; what is not named is kept */
    FMU_SPAN_MIN = 64   /* [byte] a shorter one is not worth its place in the list */
};

/* List one more of `n`: returns how many there are. */
static inline size_t fmu_span_add(struct fmu_span *span, size_t n, size_t from, size_t to,
                                  int zero)
{
    const size_t a = (from + 7u) / 8u * 8u, b = to / 8u * 8u;
    if (n < FMU_SPANS && a + FMU_SPAN_MIN <= b) {
        span[n++] = (struct fmu_span){(uint32_t)a, (uint32_t)b, zero != 0, 0};
    }
    return n;
}

#endif
