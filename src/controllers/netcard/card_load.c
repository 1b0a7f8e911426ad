#include "card_load.h"

#include <string.h>

static const int64_t SECOND = 1000000000, APART = 100000000;

/* The youngest mark that is a second old, else the oldest. */
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

bool card_load_sound(const struct card_load *l, int64_t clock, const int64_t busy[CARD_LOADS])
{
    bool ok = l->latest >= 0 && l->latest < CARD_LOAD_MARKS;

    for (int i = 0; i < CARD_LOAD_MARKS; i++) {
        ok = ok && l->mark[i].clock >= 0 && l->mark[i].clock <= clock;
        for (int k = 0; k < CARD_LOADS; k++) {
            const int64_t since = busy[k] - l->mark[i].busy[k];
            ok = ok && l->mark[i].busy[k] >= 0 && since >= 0 && since <= clock - l->mark[i].clock;
        }
    }
    return ok;
}
