#include "player.h"

#include <stdlib.h>
#include <string.h>

#include "dda.h"
#include "player_parts.h"

int64_t player_period_phase(const struct player *p)
{
    return (int64_t)p->job.period * PLAYER_FULL_RATE;
}

int64_t player_phase(const struct player *p, int64_t clock)
{
    return clock > p->base ? p->phase + p->rate * (clock - p->base) : p->phase;
}

/* First clock at which the period's phase is at least `phase`; the rate is not 0. */
static int64_t clock_of(const struct player *p, int64_t phase)
{
    return p->base + (phase - p->phase + p->rate - 1) / p->rate;
}

int64_t player_pulses(const struct player *p, int axis, int64_t phase)
{
    return dda_pulses(p->frame.command[axis], p->job.period, phase / PLAYER_FULL_RATE);
}

int64_t player_pulse_clock(const struct player *p, int axis, int64_t j)
{
    const int64_t tick = dda_edge_tick(p->frame.command[axis], p->job.period, (int32_t)j);
    return clock_of(p, tick * PLAYER_FULL_RATE);
}

int64_t player_latest(const struct player *p, int axis, int64_t clock)
{
    const int64_t n = player_pulses(p, axis, player_phase(p, clock));
    const bool here = n != player_pulses(p, axis, p->phase);
    return here ? player_pulse_clock(p, axis, llabs(n)) : p->last[axis];
}

void player_rebase(struct player *p, int64_t clock)
{
    for (int i = 0; i < FRAME_AXES; i++) {
        p->last[i] = player_latest(p, i, clock);
    }
    p->phase = player_phase(p, clock);
    p->base = clock > p->base ? clock : p->base;
}

void player_tell(struct player *p, uint32_t what)
{
    p->told.what |= what;
    for (int i = 0; i < PLAYER_TELLS; i++) {
        if (what >> i & 1) {
            p->told.clock[i] = p->clock;
        }
    }
}

static void stand(struct player *p)
{
    p->frame = (struct frame){ .event = 0 };
    p->begun = p->playing = p->fresh = p->ramping = p->braking = false;
    p->rate = p->target = 0;
    p->phase = 0;
}

bool player_good_config(const struct player_config *c)
{
    enum { LONGEST = PLAYER_PERIOD_LONGEST };

    return c->depth >= 1 && c->depth <= FRAME_FIFO_LARGEST && c->width >= 1 && c->width <= LONGEST
           && c->setup >= 0 && c->setup <= LONGEST && c->hold >= 0 && c->hold <= LONGEST;
}

bool player_start(struct player *p, const struct player_config *config)
{
    if (!player_good_config(config)) {
        return false;
    }
    memset(p, 0, sizeof *p);
    p->config = *config;
    p->job.period = 2;
    frame_fifo_reset(&p->fifo, config->depth);
    for (int i = 0; i < FRAME_AXES; i++) {
        p->last[i] = -1;
    }
    return true;
}

int32_t player_largest(const struct player *p, int32_t period)
{
    const int32_t most = period / 2 / p->config.width;
    return most < INT16_MAX ? most : INT16_MAX;
}

bool player_good_job(const struct player_job *job)
{
    bool ok = job->period >= 2 && job->period <= PLAYER_PERIOD_LONGEST
              && job->reserve >= RATE_RAMP_LEAST && job->reserve <= 1.0;

    for (int i = 0; i < FRAME_AXES; i++) {
        ok = ok && job->speed[i] >= 0.0 && job->speed[i] <= 1e9
             && (job->acc[i] == 0.0 || (job->acc[i] >= 1.0 && job->acc[i] <= 1e12))
             && (job->jerk[i] == 0.0 || (job->jerk[i] >= 1.0 && job->jerk[i] <= 1e20));
    }
    return ok;
}

enum player_status player_begin(struct player *p, const struct player_job *job, int64_t clock)
{
    if (!player_good_job(job)) {
        return PLAYER_RANGE;
    }
    player_advance(p, clock);
    player_clear(p);
    p->job = *job;
    p->frames = 0;
    p->fresh = true;
    memset(&p->told, 0, sizeof p->told);
    return PLAYER_OK;
}

bool player_good_frame(const struct player *p, const struct frame *frame)
{
    const int32_t most = player_largest(p, p->job.period);
    bool ok = frame->event <= PLAYER_EVENT_LARGEST;

    for (int i = 0; i < FRAME_AXES; i++) {
        ok = ok && abs(frame->command[i]) <= most;
    }
    return ok;
}

enum player_status player_push(struct player *p, const struct frame *frame)
{
    if (p->whole || !player_good_frame(p, frame)) {
        return PLAYER_RANGE;
    }
    if (!frame_fifo_push(&p->fifo, frame)) {
        p->refused++;
        return PLAYER_FULL;
    }
    frame_fifo_fell(&p->fifo);
    return PLAYER_OK;
}

void player_whole(struct player *p)
{
    p->whole = true;
}

/* Set the directions of the frame that begins. Returns the dead clocks that it needs before it,
 * from the clock of its first pulse at the full rate, the earliest possible. */
static int64_t turn(struct player *p)
{
    int64_t dead = 0;

    for (int i = 0; i < FRAME_AXES; i++) {
        const int32_t command = p->frame.command[i];
        if (command == 0 || (command < 0) == p->backward[i]) {
            continue;
        }
        const int64_t free = p->last[i] < 0 ? 0 : p->last[i] + p->config.width + p->config.hold,
                      first = p->clock + dda_edge_tick(command, p->job.period, 1);
        p->backward[i] = command < 0;
        p->turned[i] = free > p->clock ? free : p->clock;
        if (p->turned[i] + p->config.setup - first > dead) {
            dead = p->turned[i] + p->config.setup - first;
        }
    }
    return dead;
}

void player_begin_period(struct player *p)
{
    const bool first_dry = p->playing || !p->begun;

    p->fresh = false;
    if (frame_fifo_pop(&p->fifo, &p->frame)) {
        p->begun = p->playing = true;
        p->frames++;
        player_tell(p, frame_fifo_fell(&p->fifo) ? PLAYER_HALF : 0);
        if (p->frame.event) {
            player_tell(p, PLAYER_EVENT);
            p->told.events |= 1u << p->frame.event;
        }
        const int64_t dead = turn(p);
        p->base = p->clock + dead;
        p->dead += dead;
    } else if (p->whole) {
        stand(p);
        player_tell(p, PLAYER_ENDED);
    } else {
        p->frame = (struct frame){ .event = 0 };
        p->begun = true;
        p->playing = false;
        p->dry++;
        player_tell(p, first_dry ? PLAYER_DRY : 0);
    }
}

static void end_period(struct player *p)
{
    player_rebase(p, p->clock);
    for (int i = 0; i < FRAME_AXES; i++) {
        p->before[i] += p->frame.command[i];
    }
    p->phase -= player_period_phase(p);
    player_begin_period(p);
}

void player_clear(struct player *p)
{
    if (p->begun) {
        player_rebase(p, p->clock);
        for (int i = 0; i < FRAME_AXES; i++) {
            p->before[i] += player_pulses(p, i, p->phase);
        }
    }
    for (int i = 0; i < FRAME_AXES; i++) {
        if (p->turned[i] > p->clock) { /* take back a change of direction that has not come */
            p->turned[i] = p->clock;
            p->backward[i] = !p->backward[i];
        }
    }
    stand(p);
    p->base = p->clock;
    p->whole = false;
    frame_fifo_reset(&p->fifo, p->config.depth);
}

bool player_power(struct player *p, const struct player_config *config)
{
    if (!player_good_config(config)) {
        return false;
    }
    player_clear(p);
    p->config = *config;
    frame_fifo_reset(&p->fifo, config->depth);
    return true;
}

/* Clock of the period's end; INT64_MAX if no period is in progress or the rate is 0. */
static int64_t boundary(const struct player *p)
{
    return p->begun && p->rate > 0 ? clock_of(p, player_period_phase(p)) : INT64_MAX;
}

int64_t player_next(const struct player *p)
{
    const int64_t end = boundary(p), step = p->ramping ? p->ramp_step : INT64_MAX;
    return end < step ? end : step;
}

void player_advance(struct player *p, int64_t clock)
{
    for (int64_t next; (next = player_next(p)) <= clock;) {
        p->clock = next;
        if (boundary(p) == next) {
            end_period(p);
        } else {
            player_step_rate(p);
        }
    }
    p->clock = clock > p->clock ? clock : p->clock;
}

struct player_told player_take(struct player *p)
{
    const struct player_told told = p->told;

    memset(&p->told, 0, sizeof p->told);
    return told;
}
