#include "dda.h"

#include <stdlib.h>

/* The hardware adds the command to an accumulator at each tick; at `ticks` it overflows: that is a
 * pulse, and what is left over is carried. The accumulator starts at one half, so the count is the
 * ideal straight line rounded to the nearest pulse: never more than half a pulse off. A DDA time
 * adds exactly `command` overflows and leaves the half again; hence no state is carried from one
 * DDA time to the next, and after i ticks
 *     count = floor((i command + floor(ticks / 2)) / ticks).
 */

int64_t dda_time(int32_t ticks, int32_t divider)
{
    return (int64_t)divider * ticks;
}

int32_t dda_divider(int32_t ticks, double wanted, int32_t largest)
{
    const double exact = wanted / ticks;
    if (!(exact > 1.0))
        return 1;
    const int32_t whole = exact < largest ? (int32_t)exact : largest;
    return whole + (whole < largest && exact - whole >= 0.5);
}

int32_t dda_largest(int32_t ticks)
{
    return ticks - 1;
}

int64_t dda_pulses(int32_t command, int32_t ticks, int64_t tick)
{
    int64_t all = ticks;
    int64_t n = (tick * llabs(command) + (all >> 1)) / all;
    return command < 0 ? -n : n;
}

int64_t dda_edge_tick(int32_t command, int32_t ticks, int32_t j)
{
    /* smallest i with i command >= j ticks - floor(ticks / 2) */
    int64_t size = llabs(command), all = ticks;
    int64_t need = j * all - (all >> 1);
    return (need + size - 1) / size;
}

void dda_reset(struct dda *d, int32_t channels, int32_t ticks, int32_t divider)
{
    *d = (struct dda){ .channels = channels,
                       .ticks = ticks,
                       .divider = divider,
                       .next_ticks = ticks,
                       .next_divider = divider,
                       .run = true };
}

void dda_set_time(struct dda *d, int32_t ticks, int32_t divider, int64_t clock)
{
    d->next_ticks = ticks;
    d->next_divider = divider;
    bool idle = true;
    for (int i = 0; i < d->channels; i++)
        idle = idle && d->command[i] == 0;
    if (idle && (d->run ? clock : d->stop) == d->start) {
        d->ticks = ticks;
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
    return d->run ? d->start + dda_time(d->ticks, d->divider) : INT64_MAX;
}

void dda_begin(struct dda *d, const int32_t *command)
{
    d->start += dda_time(d->ticks, d->divider);
    d->ticks = d->next_ticks;
    d->divider = d->next_divider;
    for (int i = 0; i < d->channels; i++) {
        d->before[i] += d->command[i];
        d->command[i] = command[i];
    }
}

void dda_counts(const struct dda *d, int64_t clock, int64_t *counts)
{
    int64_t tick = ((d->run ? clock : d->stop) - d->start) / d->divider;
    for (int i = 0; i < d->channels; i++) {
        counts[i] = d->before[i];
        if (d->command[i] != 0)
            counts[i] += dda_pulses(d->command[i], d->ticks, tick);
    }
}

int64_t dda_edge_clock(const struct dda *d, int channel, int32_t j)
{
    int32_t command = d->command[channel];
    if (!d->run || j < 1 || j > abs(command))
        return -1;
    return d->start + d->divider * dda_edge_tick(command, d->ticks, j);
}
