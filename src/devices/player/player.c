#include "player.h"

#include <stdlib.h>
#include <string.h>

#include "dda.h"
#include "el_extremes.h"

static const double CLOCK = 1e-9 * PLAYER_CLOCK_NS; /* [s] */

/* All of the period in progress [1/PLAYER_FULL_RATE ticks]. */
static int64_t period_phase(const struct player *p)
{
    return (int64_t)p->job.period * PLAYER_FULL_RATE;
}

/* So much of it up to a clock. */
static int64_t phase_at(const struct player *p, int64_t clock)
{
    return clock > p->base ? p->phase + p->rate * (clock - p->base) : p->phase;
}

/* First clock at which the period's phase is at least `phase`; the rate is not 0. */
static int64_t clock_of(const struct player *p, int64_t phase)
{
    return p->base + (phase - p->phase + p->rate - 1) / p->rate;
}

/* Work out the clock of the period's end anew. */
static void find_end(struct player *p)
{
    p->end = p->begun && p->rate > 0 ? clock_of(p, period_phase(p)) : INT64_MAX;
}

/* Pulses that an axis has put out in the frame in progress up to a phase, signed. */
static int64_t pulses_to(const struct player *p, int axis, int64_t phase)
{
    return dda_pulses(p->frame.command[axis], p->job.period, phase / PLAYER_FULL_RATE);
}

/* Clock of the j-th pulse of the frame, j > 0, which comes behind base. */
static int64_t pulse_clock(const struct player *p, int axis, int64_t j)
{
    const int64_t tick = dda_edge_tick(p->frame.command[axis], p->job.period, (int32_t)j);
    return clock_of(p, tick * PLAYER_FULL_RATE);
}

/* Clock of an axis' latest pulse up to a clock; -1 none yet. */
static int64_t latest(const struct player *p, int axis, int64_t clock)
{
    const int64_t n = pulses_to(p, axis, phase_at(p, clock));
    const bool here = n != pulses_to(p, axis, p->phase);
    return here ? pulse_clock(p, axis, llabs(n)) : p->last[axis];
}

/* The phase counts from this clock on: before its rate changes, or at its end. */
static void rebase(struct player *p, int64_t clock)
{
    for (int i = 0; i < FRAME_AXES; i++) {
        p->last[i] = latest(p, i, clock);
    }
    p->phase = phase_at(p, clock);
    p->base = clock > p->base ? clock : p->base;
}

/* Bits of player_tells, at the player's clock. */
static void tell(struct player *p, uint32_t what)
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
    p->end = INT64_MAX;
}

static bool good_config(const struct player_config *c)
{
    enum { LONGEST = PLAYER_PERIOD_LONGEST };

    return c->depth >= 1 && c->depth <= FRAME_FIFO_LARGEST && c->width >= 1 && c->width <= LONGEST
           && c->setup >= 0 && c->setup <= LONGEST && c->hold >= 0 && c->hold <= LONGEST;
}

bool player_start(struct player *p, const struct player_config *config)
{
    if (!good_config(config)) {
        return false;
    }
    memset(p, 0, sizeof *p);
    p->config = *config;
    p->job.period = 2;
    p->end = INT64_MAX;
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

static bool good_job(const struct player_job *job)
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
    if (!good_job(job)) {
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

static bool good_frame(const struct player *p, const struct frame *frame)
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
    if (p->whole || !good_frame(p, frame)) {
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

/* The next period begins, at the player's clock. */
static void begin_period(struct player *p)
{
    const bool first_dry = p->playing || !p->begun;

    p->fresh = false;
    if (frame_fifo_pop(&p->fifo, &p->frame)) {
        p->begun = p->playing = true;
        p->frames++;
        tell(p, frame_fifo_fell(&p->fifo) ? PLAYER_HALF : 0);
        if (p->frame.event) {
            tell(p, PLAYER_EVENT);
            p->told.events |= 1u << p->frame.event;
        }
        const int64_t dead = turn(p);
        p->base = p->clock + dead;
        p->dead += dead;
    } else if (p->whole) {
        stand(p);
        tell(p, PLAYER_ENDED);
    } else {
        p->frame = (struct frame){ .event = 0 };
        p->begun = true;
        p->playing = false;
        p->dry++;
        tell(p, first_dry ? PLAYER_DRY : 0);
    }
    find_end(p);
}

/* Largest speeds of what is in the FIFO: in a frame of c pulses, which are rounded, an axis goes
 * no faster than (c + 1) / T and what its acceleration adds within the frame. */
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
        for (int i = 0; i < FRAME_AXES; i++) { /* it goes beyond what is in stock */
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

/* At a step of the rate's grid: up to the next one it has the value of the middle. */
static void step_rate(struct player *p)
{
    const double time = ramp_time(p, p->clock);
    double slope;

    rebase(p, p->clock);
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
        tell(p, p->target ? PLAYER_FULL_SPEED : PLAYER_REST);
    }
    find_end(p);
}

void player_set_target(struct player *p, int32_t target)
{
    const bool same = target == p->target;

    if (p->fresh && target) {
        p->target = target;
        p->rate = PLAYER_FULL_RATE;
        p->base = p->clock;
        tell(p, PLAYER_FULL_SPEED);
        begin_period(p);
    } else if (!p->begun) {
        tell(p, target ? 0 : PLAYER_REST);
    } else if (p->ramping) {
        p->target = target;
        if (!same && !p->braking) {
            rate_ramp_brake(&p->ramp, &p->bounds, ramp_time(p, p->clock));
            p->braking = true;
            p->ramp_begin = p->ramp_step = p->clock;
        }
    } else if (same) {
        tell(p, target ? PLAYER_FULL_SPEED : PLAYER_REST);
    } else {
        p->target = target;
        begin_ramp(p);
    }
}

static void end_period(struct player *p)
{
    rebase(p, p->clock);
    for (int i = 0; i < FRAME_AXES; i++) {
        p->before[i] += p->frame.command[i];
    }
    p->phase -= period_phase(p);
    begin_period(p);
}

void player_clear(struct player *p)
{
    if (p->begun) {
        rebase(p, p->clock);
        for (int i = 0; i < FRAME_AXES; i++) {
            p->before[i] += pulses_to(p, i, p->phase);
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
    if (!good_config(config)) {
        return false;
    }
    player_clear(p);
    p->config = *config;
    frame_fifo_reset(&p->fifo, config->depth);
    return true;
}

int64_t player_next(const struct player *p)
{
    const int64_t step = p->ramping ? p->ramp_step : INT64_MAX;
    return p->end < step ? p->end : step;
}

void player_advance(struct player *p, int64_t clock)
{
    for (int64_t next; (next = player_next(p)) <= clock;) {
        p->clock = next;
        if (p->end == next) {
            end_period(p);
        } else {
            step_rate(p);
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

bool player_at_rest(const struct player *p)
{
    return !p->begun || p->rate == 0;
}

void player_counts(const struct player *p, int64_t clock, int64_t counts[FRAME_AXES])
{
    const int64_t phase = phase_at(p, clock);

    for (int i = 0; i < FRAME_AXES; i++) {
        counts[i] = p->before[i] + pulses_to(p, i, phase);
    }
}

struct lines player_lines(const struct player *p, int axis, int64_t clock)
{
    const int64_t last = latest(p, axis, clock);
    struct lines l = { last >= 0 && clock - last < p->config.width, p->backward[axis] };

    if (clock < p->turned[axis]) {
        l.b = !l.b;
    }
    return l;
}

int64_t player_edge(const struct player *p, int axis, int64_t after)
{
    const int64_t done = llabs(pulses_to(p, axis, phase_at(p, after)));

    if (done == abs(p->frame.command[axis]) || p->rate == 0) {
        return INT64_MAX;
    }
    const int64_t clock = pulse_clock(p, axis, done + 1);
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
