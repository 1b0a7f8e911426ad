#include "dda.h"

#include <stdlib.h>

/* The hardware adds the command to an accumulator at each tick; an overflow is a pulse, and what is
 * left over is carried. The accumulator starts at one half, so the count is the ideal straight line
 * rounded to the nearest pulse: never more than half a pulse off. 2^length ticks add exactly
 * `command` overflows and leave the half again; hence no state is carried from one DDA time to the
 * next, and after i ticks
 *     count = floor((i command + 2^(length-1)) / 2^length).
 */

int64_t dda_time(int32_t length, int32_t divider)
{
    return (int64_t)divider << length;
}

int32_t dda_divider(int32_t length, int64_t wanted)
{
    int64_t tick = (int64_t)1 << length;
    int64_t divider = wanted > 0 ? (wanted - 1 + tick / 2) / tick : 1;
    return (int32_t)(divider < 1 ? 1 : divider > DDA_DIVIDER_MAX ? DDA_DIVIDER_MAX : divider);
}

int32_t dda_largest(int32_t length)
{
    return (1 << length) - 1;
}

int64_t dda_pulses(int32_t command, int32_t length, int64_t tick)
{
    int64_t half = (int64_t)1 << (length - 1);
    int64_t n = (tick * llabs(command) + half) >> length;
    return command < 0 ? -n : n;
}

int64_t dda_edge_tick(int32_t command, int32_t length, int32_t j)
{
    /* smallest i with i command >= (j - 1/2) 2^length */
    int64_t size = llabs(command);
    int64_t need = (2 * (int64_t)j - 1) << (length - 1);
    return (need + size - 1) / size;
}

void dda_reset(struct dda *d, int32_t length, int32_t divider)
{
    *d = (struct dda){.length = length, .divider = divider, .next_length = length,
                      .next_divider = divider, .run = true};
}

void dda_set_time(struct dda *d, int32_t length, int32_t divider, int64_t clock)
{
    d->next_length = length;
    d->next_divider = divider;
    bool idle = true;
    for (int i = 0; i < DDA_CHANNELS; i++)
        idle = idle && d->command[i] == 0;
    if (idle && (d->run ? clock : d->stop) == d->start) {
        d->length = length;
        d->divider = divider;
    }
}

void dda_set_run(struct dda *d, bool run, int64_t clock)
{
    if (d->run && !run)
        d->stop = clock;
    if (!d->run && run)
        d->start += clock - d->stop;
    d->run = run;
}

int64_t dda_boundary(const struct dda *d)
{
    return d->run ? d->start + dda_time(d->length, d->divider) : INT64_MAX;
}

void dda_begin(struct dda *d, const int32_t command[DDA_CHANNELS])
{
    d->start += dda_time(d->length, d->divider);
    d->length = d->next_length;
    d->divider = d->next_divider;
    for (int i = 0; i < DDA_CHANNELS; i++) {
        d->before[i] += d->command[i];
        d->command[i] = command[i];
    }
}

void dda_counts(const struct dda *d, int64_t clock, int64_t counts[DDA_CHANNELS])
{
    int64_t tick = ((d->run ? clock : d->stop) - d->start) / d->divider;
    for (int i = 0; i < DDA_CHANNELS; i++) {
        counts[i] = d->before[i];
        if (d->command[i] != 0)
            counts[i] += dda_pulses(d->command[i], d->length, tick);
    }
}

int64_t dda_edge_clock(const struct dda *d, int channel, int32_t j)
{
    int32_t command = d->command[channel];
    if (!d->run || j < 1 || j > abs(command))
        return -1;
    return d->start + d->divider * dda_edge_tick(command, d->length, j);
}
