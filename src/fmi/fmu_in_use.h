/* fmu_in_use - rows of data that say which part of a model's arrays is in use; a saved state leaves
 * out the rest.
 *
 * Rings, queues and tables have a fixed size, and most of one is not in use most of the time. A
 * model defines MODEL_IN_USE: rows, one behind the other, in the order in which the arrays stand in
 * struct model. Arrays, counts and flags are members of struct model, by their full path:
 *
 *     FMU_LIST(array, count)               the first `count` elements
 *     FMU_RING(array, first, count, kept)  `count` from element `first` on, which may go on at the
 *                                          begin, and `kept` before these
 *     FMU_BETWEEN(array, from, to, more)   a ring whose elements are numbered without end:
 *                                          `to` - `from` + `more` elements from number `from` on
 *     FMU_TO_END(array, first)             the elements from `first` to the end
 *     FMU_FLAGS(array, each, flags)        `each` elements for each of the flags that is not 0
 *     FMU_WHEN(member, flag, low, high)    all of a member while low <= flag <= high, else nothing,
 *                                          whatever later rows for its own members say
 *
 * A part that is not in use may hold anything after a state was restored, so it must not be read
 * before it is written. An array without a row is kept whole.
 */
#ifndef FMU_IN_USE_H
#define FMU_IN_USE_H

#include <stddef.h>
#include <stdint.h>

enum fmu_row_kind { FMU_ROW_RING, FMU_ROW_BETWEEN, FMU_ROW_TO_END, FMU_ROW_FLAGS, FMU_ROW_WHEN };

/* A row; places are bytes in struct state. */
struct fmu_row {
    uint32_t at, each, elements; /* the array: place, [byte] of an element, their number */
    uint32_t first, first_size;  /* the member `first`, `from` or `flags`; size 0: it is 0 */
    uint32_t count, count_size;  /* the member `count`, `to` or `flag` */
    int32_t low, high;           /* of `flag`; low is also `kept`, `more` or `each` */
    enum fmu_row_kind kind;
};

#define FMU_PLACE(member)  ((uint32_t)offsetof(struct state, m.member))
#define FMU_BYTES(member)  ((uint32_t)sizeof(((struct state *)0)->m.member))
#define FMU_MEMBER(member) FMU_PLACE(member), FMU_BYTES(member)
#define FMU_ARRAY(array) \
    FMU_PLACE(array), FMU_BYTES(array[0]), FMU_BYTES(array) / FMU_BYTES(array[0])

#define FMU_LIST(array, count) { FMU_ARRAY(array), 0, 0, FMU_MEMBER(count), 0, 0, FMU_ROW_RING },
#define FMU_RING(array, first, count, kept) \
    { FMU_ARRAY(array), FMU_MEMBER(first), FMU_MEMBER(count), kept, 0, FMU_ROW_RING },
#define FMU_BETWEEN(array, from, to, more) \
    { FMU_ARRAY(array), FMU_MEMBER(from), FMU_MEMBER(to), more, 0, FMU_ROW_BETWEEN },
#define FMU_TO_END(array, first) \
    { FMU_ARRAY(array), FMU_MEMBER(first), 0, 0, 0, 0, FMU_ROW_TO_END },
#define FMU_FLAGS(array, each, flags) \
    { FMU_ARRAY(array), FMU_PLACE(flags), FMU_BYTES(flags[0]), 0, 0, each, 0, FMU_ROW_FLAGS },
#define FMU_WHEN(member, flag, low, high) \
    { FMU_PLACE(member), FMU_BYTES(member), 1, 0, 0, FMU_MEMBER(flag), low, high, FMU_ROW_WHEN },

/* A part of a state that is left out, from .. to [byte], multiples of 8. */
struct fmu_span {
    uint32_t from, to;
};

enum {
    FMU_SPANS = 512,  /* largest number of parts; beyond it they are kept */
    FMU_SPAN_MIN = 64 /* [byte] a shorter part is kept */
};

/* Append a part to the list of n parts, which are in the order of their places. Returns the new
 * number. */
static inline size_t fmu_span_add(struct fmu_span *span, size_t n, size_t from, size_t to)
{
    const size_t a = (from + 7u) / 8u * 8u, b = to / 8u * 8u;
    if (n < FMU_SPANS && a + FMU_SPAN_MIN <= b) {
        span[n++] = (struct fmu_span){ (uint32_t)a, (uint32_t)b };
    }
    return n;
}

/* Value of a member that is a count or a flag, of 1, 4 or 8 bytes; 0 if its size is 0. */
static inline int64_t fmu_row_member(const char *state, uint32_t at, uint32_t size)
{
    switch (size) {
    case sizeof(uint8_t): return *(const uint8_t *)(state + at);
    case sizeof(int32_t): return *(const int32_t *)(const void *)(state + at);
    case sizeof(int64_t): return *(const int64_t *)(const void *)(state + at);
    default:              return 0;
    }
}

/* Leave out the elements of a ring at `at` except `used` elements from `first` on. */
static inline size_t fmu_row_ring(const struct fmu_row *row, size_t at, int64_t first, int64_t used,
                                  struct fmu_span *span, size_t n)
{
    const int64_t elements = row->elements, end = first + used;
    if (used >= elements) {
        return n;
    }
    if (end > elements) {
        return fmu_span_add(span, n, at + (size_t)(end - elements) * row->each,
                            at + (size_t)first * row->each);
    }
    n = fmu_span_add(span, n, at, at + (size_t)first * row->each);
    return fmu_span_add(span, n, at + (size_t)end * row->each, at + (size_t)elements * row->each);
}

/* Leave out the elements whose flag is 0. */
static inline size_t fmu_row_flags(const struct fmu_row *row, size_t at, const char *state,
                                   struct fmu_span *span, size_t n)
{
    const uint32_t each = (uint32_t)row->low, flags = (row->elements + each - 1) / each;
    for (uint32_t i = 0, from = 0; i <= flags; i++) {
        if (i == flags
            || fmu_row_member(state, row->first + i * row->first_size, row->first_size) != 0) {
            const uint32_t to = i < flags ? i * each : row->elements;
            if (from < to) {
                n = fmu_span_add(span, n, at + (size_t)from * row->each,
                                 at + (size_t)to * row->each);
            }
            from = to + each;
        }
    }
    return n;
}

/* Append the parts of a state that are not in use to the list. The state lies at `base` [byte]
 * within the one that is saved. Returns the new number. */
static inline size_t fmu_spans(const void *state, size_t base, const struct fmu_row *rows,
                               size_t count, struct fmu_span *span, size_t n)
{
    const char *s = state;
    for (const struct fmu_row *row = rows; row < rows + count; row++) {
        const size_t at = base + row->at;
        if (n > 0 && at < span[n - 1].to) {
            continue; /* the array lies in a part that is left out already */
        }
        const int64_t first = fmu_row_member(s, row->first, row->first_size);
        const int64_t number = fmu_row_member(s, row->count, row->count_size);
        const int64_t elements = row->elements;
        switch (row->kind) {
        case FMU_ROW_RING:
            n = fmu_row_ring(row, at, (first - row->low + elements) % elements, number + row->low,
                             span, n);
            break;
        case FMU_ROW_BETWEEN:
            n = fmu_row_ring(row, at, first % elements, number - first + row->low, span, n);
            break;
        case FMU_ROW_TO_END:
            n = fmu_row_ring(row, at, first % elements, elements - first, span, n);
            break;
        case FMU_ROW_FLAGS: n = fmu_row_flags(row, at, s, span, n); break;
        case FMU_ROW_WHEN:
            if (number < row->low || number > row->high) {
                n = fmu_span_add(span, n, at, at + row->each);
            }
            break;
        }
    }
    return n;
}

#endif
