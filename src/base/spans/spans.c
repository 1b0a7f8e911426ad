#include "spans.h"

static void add(struct spans *s, const void *from, const void *to, bool zero)
{
    if (s->count < SPANS_MAX && (uintptr_t)from < (uintptr_t)to) {
        s->span[s->count++] = (struct span){ (uintptr_t)from, (uintptr_t)to, zero };
    }
}

void spans_leave(struct spans *s, const void *from, const void *to)
{
    add(s, from, to, false);
}

void spans_zero(struct spans *s, const void *from, const void *to)
{
    add(s, from, to, true);
}

void spans_ring(struct spans *s, const void *array, size_t size, int32_t elements, int32_t first,
                int32_t used)
{
    const char *at = array;
    const int32_t end = first + used;

    if (end <= elements) {
        spans_leave(s, at, at + size * (size_t)first);
        spans_leave(s, at + size * (size_t)end, at + size * (size_t)elements);
    } else {
        spans_leave(s, at + size * (size_t)(end - elements), at + size * (size_t)first);
    }
}
