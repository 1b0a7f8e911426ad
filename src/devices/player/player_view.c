/* Outputs of a player at a clock: counts, lines, next pulse, speed. */
#include "player.h"

#include <stdlib.h>

#include "dda.h"
#include "player_parts.h"

bool player_at_rest(const struct player *p)
{
    return !p->begun || p->rate == 0;
}

void player_counts(const struct player *p, int64_t clock, int64_t counts[FRAME_AXES])
{
    const int64_t phase = player_phase(p, clock);

    for (int i = 0; i < FRAME_AXES; i++) {
        counts[i] = p->before[i] + player_pulses(p, i, phase);
    }
}

struct lines player_lines(const struct player *p, int axis, int64_t clock)
{
    const int64_t last = player_latest(p, axis, clock);
    struct lines l = { last >= 0 && clock - last < p->config.width, p->backward[axis] };

    if (clock < p->turned[axis]) {
        l.b = !l.b;
    }
    return l;
}

int64_t player_edge(const struct player *p, int axis, int64_t after)
{
    const int64_t done = llabs(player_pulses(p, axis, player_phase(p, after)));

    if (done == abs(p->frame.command[axis]) || p->rate == 0) {
        return INT64_MAX;
    }
    const int64_t clock = player_pulse_clock(p, axis, done + 1);
    return clock <= player_next(p) ? clock : INT64_MAX;
}

double player_rate(const struct player *p)
{
    return (double)p->rate / PLAYER_FULL_RATE;
}

double player_velocity(const struct player *p, int axis)
{
    return p->frame.command[axis] * player_rate(p) * 1e9
           / ((double)p->job.period * PLAYER_CLOCK_NS);
}
