/* What a player shows at a clock, and whether a state can be one's. */
#include "player.h"

#include <math.h>
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
    return p->frame.command[axis] * player_rate(p) * 1e9 /
           ((double)p->job.period * PLAYER_CLOCK_NS);
}

static bool sound_bounds(const struct rate_bounds *b)
{
    bool ok = b->reserve >= 0.0 && b->reserve <= 1.0;

    for (int i = 0; ok && i < RATE_RAMP_AXES; i++) {
        ok = b->speed[i] >= 0.0 && isfinite(b->speed[i]) && b->acc[i] >= 0.0 &&
             isfinite(b->acc[i]) && b->jerk[i] >= 0.0 && isfinite(b->jerk[i]);
    }
    return ok;
}

static bool sound_frames(const struct player *p)
{
    bool ok = player_good_frame(p, &p->frame);

    for (int32_t n = 0; ok && n < p->fifo.stock; n++) {
        ok = player_good_frame(p, frame_fifo_at(&p->fifo, n));
    }
    return ok;
}

bool player_sound(const struct player *p)
{
    const int64_t most = INT64_MAX / 4,
                  wait = (int64_t)p->config.width + p->config.hold + p->config.setup;
    bool ok = player_good_config(&p->config) && p->job.period >= 2 &&
              p->job.period <= PLAYER_PERIOD_LONGEST &&
              (!(p->fresh || p->begun) || player_good_job(&p->job)) &&
              frame_fifo_sound(&p->fifo) && p->fifo.depth == p->config.depth && sound_frames(p) &&
              p->rate >= 0 && p->rate <= PLAYER_FULL_RATE && (p->target == 0 || p->target == 1) &&
              p->clock >= 0 && p->clock < most && p->base >= 0 && p->base <= p->clock + wait &&
              p->phase >= 0 && p->phase < player_period_phase(p) && p->frames >= 0 && p->dry >= 0 &&
              p->refused >= 0 && p->dead >= 0 && !(p->fresh && p->begun) &&
              !(p->playing && !p->begun) && !(p->braking && !p->ramping) &&
              sound_bounds(&p->bounds) && rate_ramp_sound(&p->ramp);

    for (int i = 0; ok && i < FRAME_AXES; i++) {
        ok = llabs(p->before[i]) < most && p->last[i] >= -1 && p->last[i] <= p->clock &&
             p->turned[i] >= 0 && p->turned[i] <= p->clock + wait &&
             (p->playing || p->frame.command[i] == 0);
    }
    return ok && player_next(p) > p->clock - 1 &&
           (!p->ramping || (p->ramp_begin >= 0 && p->ramp_begin <= p->clock &&
                            p->ramp_step <= p->clock + PLAYER_GRID &&
                            p->ramp_step >= p->ramp_begin));
}
