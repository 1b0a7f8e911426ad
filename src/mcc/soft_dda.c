#include "soft_dda.h"

#include <stdlib.h>
#include <string.h>

/* Counters of 32 bit wrap. */
static int32_t sum(int32_t a, int32_t b)
{
    return (int32_t)((uint32_t)a + (uint32_t)b);
}

static void measure(struct soft_dda *d, const struct machine *m)
{
    d->length = m->dda_length;
    d->divider = machine_dda_divider(m);
}

void soft_dda_start(struct soft_dda *d, const struct machine *m)
{
    memset(d, 0, sizeof *d);
    measure(d, m);
}

int64_t soft_dda_boundary(const struct soft_dda *d)
{
    return d->begin + ((int64_t)1 << d->length) * d->divider;
}

void soft_dda_next(struct soft_dda *d, const struct machine *m, const int32_t frame[AXES])
{
    d->begin = soft_dda_boundary(d);
    for (int i = 0; i < AXES; i++) {
        d->sum[i] = sum(d->sum[i], d->frame[i]);
        d->frame[i] = frame ? frame[i] : 0;
    }
    measure(d, m);
}

/* k pulses spread over 2^L ticks, nearest to the line: floor((i k + 2^(L-1)) / 2^L) after i. */
void soft_dda_pulses(const struct soft_dda *d, int64_t clock, int32_t pulses[AXES])
{
    const int64_t tick = (clock - d->begin) / d->divider, half = ((int64_t)1 << d->length) >> 1;

    for (int i = 0; i < AXES; i++) {
        const int32_t size = (int32_t)((tick * llabs(d->frame[i]) + half) >> d->length);
        pulses[i] = sum(d->sum[i], d->frame[i] < 0 ? -size : size);
    }
}
