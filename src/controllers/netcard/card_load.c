#include "card_load.h"

#include <string.h>

static const int64_t SECOND = 1000000000, APART = 100000000;

/* The youngest mark that is at least a second old, else the oldest mark. */
static const struct card_load_mark *before(const struct card_load *l, int64_t clock)
{
    const struct card_load_mark *found = NULL;

    for (int i = 0; i < CARD_LOAD_MARKS; i++) {
        const struct card_load_mark *m = &l->mark[(l->latest + 1 + i) % CARD_LOAD_MARKS];
        if (!found || clock - m->clock >= SECOND) {
            found = m;
        }
    }
    return found;
}

void card_load_tell(struct card_load *l, int64_t clock, const int64_t busy[CARD_LOADS],
                    uint16_t share[CARD_LOADS])
{
    const struct card_load_mark *m = before(l, clock);
    const int64_t all = clock - m->clock;

    for (int i = 0; i < CARD_LOADS; i++) {
        const int64_t had = busy[i] - m->busy[i];
        share[i] = all > 0 ? (uint16_t)(1000.0 * (double)had / (double)all + 0.5) : 0;
    }
    if (clock - l->mark[l->latest].clock >= APART) {
        l->latest = (l->latest + 1) % CARD_LOAD_MARKS;
        l->mark[l->latest].clock = clock;
        memcpy(l->mark[l->latest].busy, busy, sizeof l->mark[l->latest].busy);
    }
}
