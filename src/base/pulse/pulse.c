#include "pulse.h"

#include <stdlib.h>
#include <string.h>

/* Example with divider 4 and width 3 or more: ticks - 1 pulses forward, the last of which is on the
 * boundary, and then as many backward. One column is one clock.
 *
 *     boundary            |
 *     A         __/`\_/`\_/`\_/`\_/`    high for half of 4 clocks
 *     B         ____________/```````    backward, once that pulse has ended
 *
 * Only a pulse on the boundary is high beyond it: one that comes x clocks earlier, x a multiple of
 * the divider, is high for (x + divider) / 2 <= x clocks at most.
 */

/* A pulse on its line. */
struct high {
    int64_t fall; /* [clock] at which it ends */
    bool backward;
};

enum pulse_status pulse_check(const struct pulse_config *c, int32_t widest)
{
    if ((int)c->format < PULSE_DIRECTION || c->format > PULSE_NONE)
        return PULSE_BAD_FORMAT;
    if (c->wiring > (LINES_A_INVERSE | LINES_B_INVERSE | LINES_SWAP))
        return PULSE_BAD_WIRING;
    return c->width < 1 || c->width > widest ? PULSE_BAD_WIDTH : PULSE_OK;
}

/* [clocks] that a pulse is high if the next one comes `distance` clocks later. */
static int32_t high_time(const struct pulse_config *c, int64_t distance)
{
    int64_t half = distance < 2 ? 1 : distance / 2;
    return half < c->width ? (int32_t)half : c->width;
}

/* [clock] of the j-th pulse of the DDA time in progress, stopped or not. */
static int64_t edge(const struct dda *d, int channel, int32_t j)
{
    return d->start + d->divider * dda_edge_tick(d->command[channel], d->ticks, j);
}

/* Number of pulses of the DDA time in progress up to and including `clock`. */
static int32_t pulses_until(const struct dda *d, int channel, int64_t clock)
{
    int64_t tick = ((d->run ? clock : d->stop) - d->start) / d->divider;
    return (int32_t)llabs(dda_pulses(d->command[channel], d->ticks, tick));
}

void pulse_reset(struct pulse *p)
{
    memset(p, 0, sizeof *p); /* clears the padding, too, so that equal states have equal bytes */
    p->last = -1;
}

void pulse_boundary(const struct pulse_config *c, struct pulse *p, const struct dda *d, int channel)
{
    int32_t command = d->command[channel];
    if (command == 0)
        return;
    p->last = edge(d, channel, abs(command));
    p->high = high_time(c, d->next_divider); /* its next pulse comes in the next DDA time */
    p->backward = command < 0;
}

/* The n-th pulse of the DDA time in progress. n = 0: the pulse that the DDA time before put on the
 * boundary; if there was none, one that has ended already, fall = start. */
static struct high nth_pulse(const struct pulse_config *c, const struct pulse *p,
                             const struct dda *d, int channel, int32_t n)
{
    int32_t command = d->command[channel];
    if (n == 0)
        return (struct high){ p->last == d->start ? p->last + p->high : d->start, p->backward };
    int64_t rise = edge(d, channel, n);
    int64_t next = n < abs(command) ? edge(d, channel, n + 1)
                                    : d->start + dda_time(d->ticks, d->divider) + d->divider;
    return (struct high){ rise + high_time(c, next - rise), command < 0 };
}

struct lines pulse_at(const struct pulse_config *c, const struct pulse *p, const struct dda *d,
                      int channel, int64_t clock)
{
    int32_t command = d->command[channel];
    int32_t n = pulses_until(d, channel, clock);
    if (c->format == PULSE_NONE)
        return lines_wired((struct lines){ false, false }, c->wiring);
    if (c->format == PULSE_AB) {
        const int64_t count = d->before[channel] + (command < 0 ? -n : n);
        return lines_wired(lines_of_quarter(count), c->wiring);
    }
    struct high h = nth_pulse(c, p, d, channel, n);
    bool on = (d->run ? clock : d->stop) < h.fall;
    struct lines l = { on && !h.backward, on && h.backward };
    if (c->format == PULSE_DIRECTION)
        l = (struct lines){ on, on || command == 0 ? h.backward : command < 0 };
    return lines_wired(l, c->wiring);
}

int64_t pulse_latest(const struct pulse *p, const struct dda *d, int channel, int64_t clock)
{
    int32_t n = pulses_until(d, channel, clock);
    return n > 0 ? edge(d, channel, n) : p->last;
}
