/* The rate of a player: bounds of its slope, ramps between 0 and 1, its target. */
#include "player.h"

#include <math.h>
#include <stdlib.h>

#include "el_extremes.h"
#include "player_parts.h"

static const double CLOCK = 1e-9 * PLAYER_CLOCK_NS; /* [s] */

/* Largest speed of each axis in the frames of the FIFO. In a frame of c pulses, a rounded number,
 * an axis is no faster than (c + 1) / T plus what its acceleration adds within the frame's time
 * T. */
static void look_ahead(struct player *p)
{
    const double period = p->job.period * CLOCK;
    int32_t largest[FRAME_AXES];

    for (int i = 0; i < FRAME_AXES; i++) {
        largest[i] = abs(p->frame.command[i]);
        for (int32_t n = 0; n < p->fifo.stock; n++) {
            const int32_t size = abs(frame_fifo_at(&p->fifo, n)->command[i]);
            largest[i] = size > largest[i] ? size : largest[i];
        }
        double speed = (largest[i] + 1) / period + (1.0 - p->job.reserve) * p->job.acc[i] * period;
        if (p->job.speed[i] > 0.0) {
            speed = el_min(speed, p->job.speed[i]);
        }
        p->bounds.speed[i] = p->job.acc[i] > 0.0 ? speed : 0.0;
        p->bounds.acc[i] = p->job.acc[i];
        p->bounds.jerk[i] = p->job.jerk[i];
    }
    p->bounds.reserve = p->job.reserve;
}

static void begin_ramp(struct player *p)
{
    const double from = player_rate(p), to = p->target;

    look_ahead(p);
    rate_ramp_make(&p->ramp, &p->bounds, from, to);
    if (!p->whole && rate_ramp_way(&p->ramp) > p->fifo.stock * p->job.period * CLOCK) {
        for (int i = 0; i < FRAME_AXES; i++) { /* the ramp goes on beyond the frames in stock */
            if (p->bounds.speed[i] > 0.0 && p->job.speed[i] > 0.0) {
                p->bounds.speed[i] = p->job.speed[i];
            }
        }
        rate_ramp_make(&p->ramp, &p->bounds, from, to);
    }
    p->ramping = true;
    p->ramp_begin = p->ramp_step = p->clock;
}

static double ramp_time(const struct player *p, int64_t clock)
{
    return (double)(clock - p->ramp_begin) * CLOCK;
}

static int32_t rounded(double rate)
{
    return (int32_t)(el_min(el_max(rate, 0.0), 1.0) * PLAYER_FULL_RATE + 0.5);
}

void player_step_rate(struct player *p)
{
    const double time = ramp_time(p, p->clock);
    double slope;

    player_rebase(p, p->clock);
    if (time < rate_ramp_length(&p->ramp)) {
        p->rate = rounded(rate_ramp_at(&p->ramp, time + 0.5 * CLOCK * PLAYER_GRID, &slope));
        p->ramp_step += PLAYER_GRID;
    } else if (p->braking) {
        p->rate = rounded(rate_ramp_at(&p->ramp, time, &slope));
        p->braking = false;
        begin_ramp(p);
    } else {
        p->rate = p->target * PLAYER_FULL_RATE;
        p->ramping = false;
        player_tell(p, p->target ? PLAYER_FULL_SPEED : PLAYER_REST);
    }
}

void player_set_target(struct player *p, int32_t target)
{
    const bool same = target == p->target;

    if (p->fresh && target) {
        p->target = target;
        p->rate = PLAYER_FULL_RATE;
        p->base = p->clock;
        player_tell(p, PLAYER_FULL_SPEED);
        player_begin_period(p);
    } else if (!p->begun) {
        player_tell(p, target ? 0 : PLAYER_REST);
    } else if (p->ramping) {
        p->target = target;
        if (!same && !p->braking) {
            rate_ramp_brake(&p->ramp, &p->bounds, ramp_time(p, p->clock));
            p->braking = true;
            p->ramp_begin = p->ramp_step = p->clock;
        }
    } else if (same) {
        player_tell(p, target ? PLAYER_FULL_SPEED : PLAYER_REST);
    } else {
        p->target = target;
        begin_ramp(p);
    }
}
