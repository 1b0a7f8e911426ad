/* What a core says of its state (spans.h) as the FMI layer takes it. */
#ifndef FMU_SPANS_H
#define FMU_SPANS_H

#include "fmu_span.h"
#include "spans.h"

static inline size_t fmu_spans(const struct spans *s, const void *state, struct fmu_span *span)
{
    const uintptr_t base = (uintptr_t)state;
    size_t n = 0;
    for (int32_t i = 0; i < s->count; i++) {
        n = fmu_span_add(span, n, s->span[i].from - base, s->span[i].to - base, s->span[i].zero);
    }
    return n;
}

#endif
