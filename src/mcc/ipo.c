#include "ipo.h"

#include <math.h>
#include <string.h>

void ipo_start(struct ipo *p)
{
    memset(p, 0, sizeof *p);
    p->override[0] = p->override[1] = 1.0;
}

static double override_of(const struct ipo *p, enum command_type type)
{
    const bool ptp = type == COMMAND_PTP || type == COMMAND_PTP_ASYN;
    return p->hold || p->abort ? 0.0 : p->override[ptp];
}

/* The move under way is the axes mover's. */
static bool asyn(const struct ipo *p)
{
    return p->count > 0 && p->move[0].command.type == COMMAND_PTP_ASYN;
}

bool ipo_follows_paths(const struct ipo *p)
{
    return !p->free && !asyn(p);
}

static bool move_resting(const struct ipo *p, const struct ipo_move *m)
{
    if (m->command.type == COMMAND_DELAY) {
        return p->hold || p->abort;
    }
    return !m->profile.ends && profile_left(&m->profile) <= 0.0;
}

static double chain_override(const struct ipo *p)
{
    return p->hold || p->abort ? 0.0 : p->override[0];
}

bool ipo_busy(const struct ipo *p)
{
    return p->count > 0 || p->track.active || p->free;
}

/* Single block: the next command is the first of a block that has no leave. A block is a line of
 * the program, or one call of the API. */
static bool blocked(const struct ipo *p, const struct ring *r)
{
    const struct command *next = ring_head(r);
    return p->single && !p->leave && next && (next->line == 0 || next->line != p->block);
}

bool ipo_waits(const struct ipo *p, const struct ring *r)
{
    return !ipo_busy(p) && (p->stopped || blocked(p, r));
}

bool ipo_resting(const struct ipo *p, const struct ring *r)
{
    if (p->track.active) {
        return chain_override(p) <= 0.0 && track_rests(&p->track);
    }
    if (p->free) {
        return axes_resting(&p->axes);
    }
    for (int i = 0; i < p->count; i++) {
        if (!move_resting(p, &p->move[i])) {
            return false;
        }
    }
    return p->count > 0 || p->hold || p->abort || p->confirming || ipo_waits(p, r) ||
           r->count == 0;
}

bool ipo_moving(const struct ipo *p)
{
    if (p->track.active) {
        return !track_rests(&p->track);
    }
    if (p->free) {
        return !axes_resting(&p->axes);
    }
    for (int i = 0; i < p->count; i++) {
        if (p->move[i].command.type != COMMAND_DELAY && !move_resting(p, &p->move[i])) {
            return true;
        }
    }
    return false;
}

/* The profile of a move of independent axes is that of the last one's time: a wait. */
static void wait_for_axes(struct ipo *p)
{
    profile_wait(&p->move[0].profile, axes_left(&p->axes));
    p->move[0].profile.ends = p->axes.ratio > 0.0;
}

static void start_asyn(struct ipo *p, const struct axes_limits l[AXES])
{
    const struct command *c = &p->move[0].command;
    axes_start(&p->axes, c->path.start, override_of(p, c->type));
    for (int i = 0; i < AXES; i++) {
        if (c->path.end[i] != c->path.start[i]) {
            axes_go(&p->axes, i, c->path.end[i], &l[i]);
        }
    }
    wait_for_axes(p);
}

/* Plan the newest move afresh from where it is. An older one beside it decelerates to its end. */
static void replan(struct ipo *p)
{
    if (!ipo_follows_paths(p)) {
        axes_set_ratio(&p->axes, override_of(p, COMMAND_PTP_ASYN));
        if (asyn(p)) {
            wait_for_axes(p);
        }
        return;
    }
    if (p->count == 0) {
        return;
    }
    struct ipo_move *m = &p->move[p->count - 1];
    if (m->command.type != COMMAND_DELAY) {
        const struct profile_limits l = {
            command_speed(&m->command, override_of(p, m->command.type)), m->command.ramp
        };
        const struct scurve_start now = profile_state(&m->profile);
        profile_plan(&m->profile, &now, m->command.path.length, &l);
    }
}

void ipo_free(struct ipo *p)
{
    axes_start(&p->axes, p->rest, override_of(p, COMMAND_PTP_ASYN));
    p->free = true;
}

static void place_of_axes(const struct ipo *p, double point[AXES], double velocity[AXES])
{
    for (int i = 0; i < AXES; i++) {
        axes_state(&p->axes, i, &point[i], &velocity[i]);
    }
}

void ipo_bind(struct ipo *p)
{
    double velocity[AXES];
    place_of_axes(p, p->rest, velocity);
    p->free = false;
}

void ipo_hold(struct ipo *p, bool on)
{
    if (p->hold != on) {
        p->hold = on;
        replan(p);
    }
}

void ipo_single(struct ipo *p, const struct ring *r, bool on)
{
    if (on && !p->single && p->track.active) {
        track_close(&p->track, r);
    }
    p->stopped = p->stopped || (p->single && !on && ipo_waits(p, r));
    p->leave = p->leave && on;
    p->single = on;
}

void ipo_leave(struct ipo *p)
{
    p->leave = p->single;
}

void ipo_ramp(const struct ipo *p, struct ipo *ramp)
{
    *ramp = *p;
    ramp->abort = true;
    replan(ramp);
}

void ipo_shift(struct ipo *ramp, double dt)
{
    for (int i = 0; i < ramp->count; i++) {
        ramp->move[i].profile.t += dt;
    }
    axes_advance(&ramp->axes, dt);
}

double ipo_left(const struct ipo *ramp)
{
    double left = ipo_follows_paths(ramp) ? 0.0 : axes_left(&ramp->axes);
    for (int i = 0; i < ramp->count; i++) {
        left = fmax(left, profile_left(&ramp->move[i].profile));
    }
    return left;
}

void ipo_continue(struct ipo *p)
{
    p->stopped = false;
    ipo_leave(p);
}

void ipo_override(struct ipo *p, double feed, double ptp)
{
    if (p->override[0] != feed || p->override[1] != ptp) {
        p->override[0] = feed;
        p->override[1] = ptp;
        replan(p);
    }
}

void ipo_place(const struct ipo *p, const struct ring *r, double point[AXES],
               double velocity[AXES])
{
    if (p->track.active) {
        track_place(&p->track, r, point, velocity);
        return;
    }
    if (!ipo_follows_paths(p)) {
        place_of_axes(p, point, velocity);
        return;
    }
    memcpy(point, p->rest, AXES * sizeof *point);
    memset(velocity, 0, AXES * sizeof *velocity);
    for (int i = 0; i < p->count; i++) {
        const struct ipo_move *m = &p->move[i];
        const struct scurve_start now = profile_state(&m->profile);
        double at[AXES], slope[AXES];
        path_at(&m->command.path, now.s, at, slope);
        for (int k = 0; k < AXES; k++) {
            point[k] = i == 0 ? at[k] : point[k] + (at[k] - m->command.path.start[k]);
            velocity[k] += now.v * slope[k];
        }
    }
}

void ipo_stop(struct ipo *p, struct ring *r)
{
    double velocity[AXES], at[AXES];
    ipo_place(p, r, at, velocity);
    memcpy(p->rest, at, sizeof p->rest);
    p->count = 0;
    p->track.active = false;
    p->free = false;
    p->hold = p->abort = p->stopped = p->leave = p->confirming = false;
    p->news = p->news || p->outputs.spindle != 0.0 || p->outputs.coolant != 0;
    p->outputs.spindle = 0.0;
    p->outputs.coolant = 0;
    ring_clear(r);
}

void ipo_abort(struct ipo *p, struct ring *r)
{
    p->abort = true;
    replan(p);
    if (ipo_resting(p, r)) {
        ipo_stop(p, r);
    }
}

/* The older move has ended; the newer takes its place. */
static void retire(struct ipo *p)
{
    memcpy(p->rest, p->move[0].command.path.end, sizeof p->rest);
    if (--p->count) {
        p->move[0] = p->move[1];
    } else {
        p->confirming = p->confirm && p->move[0].command.type != COMMAND_DELAY;
    }
}

static bool may_start(const struct ipo *p, const struct ring *r)
{
    const struct command *next = ring_head(r);
    if (!next || p->track.active || p->free || p->hold || p->abort || p->stopped ||
        p->confirming || p->count == 2 || blocked(p, r)) {
        return false;
    }
    return p->count == 0 || (p->move[0].command.blend && p->move[0].profile.ends &&
                             command_blends(&p->move[0].command) && command_blends(next));
}

/* A command begins. */
static void begin(struct ipo *p, const struct command *c)
{
    p->outputs.digital = (p->outputs.digital | c->set) & ~c->clear;
    p->line = p->block = c->line;
    p->leave = false;
    p->started = command_lasts(c) ? c->index : p->started;
}

static void start(struct ipo *p, struct ring *r)
{
    const struct command *c = ring_head(r);

    if (p->count == 0 && !p->single && track_begins(r)) {
        track_start(&p->track, r);
        return;
    }
    begin(p, c);
    if (command_lasts(c)) {
        struct ipo_move *m = &p->move[p->count++];
        m->command = *c;
        if (c->type == COMMAND_PTP_ASYN) {
            start_asyn(p, ring_peek(r, 0)->axis);
        } else {
            command_start(&m->command, override_of(p, c->type), &m->profile);
        }
    } else if (c->type == COMMAND_OUTPUTS) {
        p->outputs.spindle = c->spindle;
        p->outputs.coolant = c->coolant;
        p->news = true;
    } else {
        p->stopped = p->news = true;
    }
    ring_pop(r);
}

static void begin_chained(struct ipo *p, const struct ring *r)
{
    const struct command *c;
    while ((c = track_begun(&p->track, r)) != NULL) {
        begin(p, c);
    }
}

/* Let time pass in a chain; returns what is left of it once the chain has ended. */
static double advance_chain(struct ipo *p, struct ring *r, double dt)
{
    struct track *t = &p->track;
    const double left = track_advance(t, r, chain_override(p), dt);
    if (left <= 0.0 || (t->smooth > 0.0 && !track_done(t))) {
        return 0.0;         /* the tool has to come after */
    }
    begin_chained(p, r);
    const int32_t last = t->joined - 1;
    memcpy(p->rest, ring_peek(r, last)->command.path.end, sizeof p->rest);
    for (int32_t i = 0; i <= last; i++) {
        ring_pop(r);
    }
    t->active = false;
    p->confirming = p->confirm;
    return left;
}

double ipo_advance(struct ipo *p, struct ring *r, double dt)
{
    if (p->track.active) {
        const double left = advance_chain(p, r, dt);
        if (p->abort && !p->track.active) {
            ipo_stop(p, r);     /* the ramp of the abort was that to the chain's end */
        }
        return left;
    }
    for (;;) {
        const bool startable = may_start(p, r);
        struct profile *old = &p->move[0].profile;

        if (startable && (p->count == 0 || old->t >= old->tail)) {
            start(p, r);
            return dt;
        }
        if (p->count && old->ends && old->t >= old->total) {
            retire(p);
            continue;
        }
        if (ipo_resting(p, r)) {
            if (p->abort) {
                ipo_stop(p, r);
            }
            return dt;
        }
        if (dt <= 0.0) {
            return 0.0;
        }
        if (p->free) {
            axes_advance(&p->axes, dt);
            dt = 0.0;
            continue;
        }
        const double event = startable ? old->tail : old->total;
        const double step = fmin(dt, event - old->t);
        for (int i = 0; i < p->count; i++) {
            p->move[i].profile.t += step;
        }
        if (step < dt) {
            old->t = event;     /* met exactly, whatever the sum rounds to */
        }
        if (asyn(p)) {
            axes_advance(&p->axes, step);
        }
        dt -= step;
    }
}

void ipo_accept(struct ipo *p, struct ring *r, const struct point *point)
{
    memcpy(p->pulses, point->pulses, sizeof p->pulses);
    p->news = false;
    if (p->track.active) {
        track_drop(&p->track, r);
    }
}

void ipo_point(struct ipo *p, struct ring *r, const struct machine *m, struct track_mean *mean,
               struct point *point)
{
    double velocity[AXES];

    if (p->track.active) {
        track_sample(&p->track, mean, r, machine_dda_time(m));
        begin_chained(p, r);
        if (p->abort && track_rests(&p->track)) {
            ipo_stop(p, r);
        }
    }
    ipo_place(p, r, point->place, velocity);
    const double *v = velocity;
    point->feed = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (point->feed == 0.0) {
        point->feed = sqrt(v[3] * v[3] + v[4] * v[4] + v[5] * v[5]);
    }
    for (int i = 0; i < AXES; i++) {
        const double ideal = point->place[i] * machine_pulses_per_mm(&m->axis[i]);
        point->pulses[i] = m->axis[i].used ? (int32_t)lround(ideal) : p->pulses[i];
    }
    point->line = p->count ? p->move[0].command.line : p->line;
    point->command = p->count ? p->move[0].command.index : p->started;
    point->newest = p->count ? p->move[p->count - 1].command.index : p->started;
    point->waits = p->count && p->move[0].command.type == COMMAND_DELAY;
    point->outputs = p->outputs;
}
