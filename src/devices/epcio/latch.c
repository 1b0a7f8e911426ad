#include "latch.h"

void latch_note(struct latch_moments *m, int source, int64_t clock)
{
    uint32_t bit = (uint32_t)1 << source;
    if (!(m->came & bit) || clock < m->first[source])
        m->first[source] = clock;
    if (!(m->came & bit) || clock > m->last[source])
        m->last[source] = clock;
    m->came |= bit;
}

void latch_arm(struct latch *l, uint32_t source, bool keep_last)
{
    l->source = source;
    l->keep_last = keep_last;
    l->armed = source != 0;
}

int64_t latch_due(const struct latch *l, const struct latch_moments *m)
{
    int64_t due = -1;
    if (!l->armed || !(l->source & m->came))
        return due;
    for (int i = 0; i < LATCH_SOURCES; i++) {
        if (!(l->source & m->came & (uint32_t)1 << i))
            continue;
        int64_t clock = l->keep_last ? m->last[i] : m->first[i];
        bool better = l->keep_last ? clock > due : clock < due;
        if (due < 0 || better)
            due = clock;
    }
    return due;
}

void latch_take(struct latch *l, int64_t value, int64_t clock)
{
    l->armed = l->keep_last;
    l->seen++;
    l->value = value;
    l->clock = clock;
}
