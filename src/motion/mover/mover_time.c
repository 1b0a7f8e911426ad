#include "mover_inside.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

/* The older command has ended. */
static void retire(struct mover *p)
{
    const struct command ended = p->mix.move[0].command;

    mix_retire(&p->mix);
    if (p->mix.count == 0) {
        mover_rest_at(p, ended.path.end, p->motion == MOVER_AXES);
        p->confirming = p->confirm && ended.type != COMMAND_DELAY;
        p->leave = false;
    }
}

void mover_leave(struct mover *p, const struct ring *r)
{
    double at[AXES], velocity[AXES];

    p->leave = p->motion == MOVER_MIX && p->mix.count == 1;
    mover_replan(p);
    if (p->leave && mover_resting(p, r)) {
        mover_place(p, r, at, velocity);
        mover_rest_at(p, at, false);
        p->confirming = p->confirm;
        p->leave = false;
    }
}

/* Whether the next command may begin, now or in the deceleration of the one under way. */
static bool may_start(const struct mover *p, const struct ring *r)
{
    const struct command *next = ring_head(r);
    if (!next || p->motion != MOVER_MIX || mover_brakes(p) || p->stopped || p->confirming ||
        mover_blocked(p, r)) {
        return false;
    }
    return p->mix.count == 0 || (mix_open(&p->mix) && command_blends(next));
}

/* A command begins: its outputs and its line count from now on. Index 0: it takes no time. */
static void begin(struct mover *p, const struct shape_mark *k)
{
    p->outputs.digital = (p->outputs.digital | k->set) & ~k->clear;
    for (int i = 0; i < OUTPUTS_ANALOG; i++) {
        p->outputs.analog[i] = k->analog.set >> i & 1 ? k->analog.value[i] : p->outputs.analog[i];
    }
    p->line = p->block = k->line;
    p->allowed = false;
    p->started = k->index > 0 ? k->index : p->started;
}

static void begin_command(struct mover *p, const struct command *c)
{
    const struct shape_mark k = {
        .index = command_lasts(c) ? c->index : 0, .line = c->line, .set = c->set,
        .clear = c->clear, .analog = c->analog
    };
    begin(p, &k);
}

static void begin_axes(struct mover *p, const struct command *c,
                       const struct axes_limits l[AXES])
{
    axes_start(&p->axes, c->path.start, mover_share(p, true));
    for (int i = 0; i < AXES; i++) {
        if (c->path.end[i] != c->path.start[i]) {
            axes_go(&p->axes, i, c->path.end[i], &l[i]);
        }
    }
    p->mix.move[p->mix.count++].command = *c;
    p->motion = MOVER_AXES;
    mover_wait_for_axes(p);
}

static void begin_next(struct mover *p, const struct mover_beside *b)
{
    struct ring *r = b->ring;
    const struct command *c = ring_head(r);

    if (p->mix.count == 0 && !p->single && b->curve && curve_begins(r)) {
        curve_start(&p->curve, b->curve, r);
        p->motion = MOVER_CURVE;
        return;
    }
    if (p->mix.count == 0 && !p->single && track_begins(r)) {
        track_start(&p->track, r);
        p->motion = MOVER_CHAIN;
        return;
    }
    begin_command(p, c);
    if (c->type == COMMAND_PTP_ASYN) {
        begin_axes(p, c, ring_peek(r, 0)->axis);
    } else if (command_lasts(c)) {
        mix_begin(&p->mix, c, mover_share(p, is_ptp(c)));
    } else if (c->type == COMMAND_OUTPUTS) {
        p->outputs.spindle = c->spindle;
        p->surface = c->surface;
        p->outputs.coolant = c->coolant;
        p->outputs.tool = c->tool;
        p->overrides = c->overrides;
        p->untold = true;
    } else {
        p->outputs.asks = c->changes;
        p->outputs.asked = c->tool;
        p->stopped = p->untold = true;
    }
    ring_pop(r);
}

static void begin_chained(struct mover *p, const struct ring *r)
{
    const struct command *c;
    while ((c = track_begun(&p->track, r)) != NULL) {
        begin_command(p, c);
    }
}

static void begin_curved(struct mover *p, const struct curve_plan *m)
{
    const struct shape_mark *k;
    while ((k = curve_begun(&p->curve, m)) != NULL) {
        begin(p, k);
    }
}

/* The motion that has looked ahead is over. */
static void end_ahead(struct mover *p, struct ring *r, const double place[AXES])
{
    mover_rest_at(p, place, false);
    p->confirming = p->confirm;
    if (p->abort) {
        mover_stop(p, r);       /* the ramp of the abort was that to its end */
    }
}

static double advance_curve(struct mover *p, const struct mover_beside *b, double dt)
{
    if (curve_waits(&p->curve)) {
        if (p->confirming || mover_brakes(p) || mover_waits(p, b->ring)) {
            return 0.0;
        }
        curve_go(&p->curve, b->curve, p->single);
    }
    const double left = curve_advance(&p->curve, b->curve, b->ring, mover_share(p, false), dt);
    p->confirming = p->confirm && curve_waits(&p->curve);
    if (curve_done(&p->curve, b->curve)) {
        begin_curved(p, b->curve);
        end_ahead(p, b->ring, b->curve->end);
    }
    return left;
}

static double advance_chain(struct mover *p, struct ring *r, double dt)
{
    struct track *t = &p->track;
    const double left = track_advance(t, r, mover_share(p, false), dt);
    if (left <= 0.0 || (t->smooth > 0.0 && !track_done(t))) {
        return 0.0;         /* the tool has to come after */
    }
    begin_chained(p, r);
    const struct command last = ring_peek(r, t->joined - 1)->command;
    for (int32_t i = t->joined; i > 0; i--) {
        ring_pop(r);
    }
    end_ahead(p, r, last.path.end);
    return left;
}

/* Let time pass up to the next end or beginning of a command; returns the time left. */
static double advance_commands(struct mover *p, bool startable, double dt)
{
    struct profile *old = &p->mix.move[0].profile;
    const double event = startable ? old->tail : old->total;
    const double step = el_min(dt, event - old->t);

    mix_shift(&p->mix, step);
    if (step < dt) {
        old->t = event;     /* met exactly, whatever the sum rounds to */
    }
    if (p->motion == MOVER_AXES) {
        axes_advance(&p->axes, step);
    }
    return dt - step;
}

double mover_advance(struct mover *p, const struct mover_beside *b, double dt)
{
    struct ring *r = b->ring;

    if (p->motion == MOVER_CHAIN) {
        return advance_chain(p, r, dt);
    }
    if (p->motion == MOVER_CURVE) {
        return advance_curve(p, b, dt);
    }
    for (;;) {
        const bool startable = may_start(p, r);
        const struct profile *old = &p->mix.move[0].profile;

        if (startable && (p->mix.count == 0 || old->t >= old->tail)) {
            begin_next(p, b);
            return dt;
        }
        if (p->mix.count && old->ends && old->t >= old->total) {
            retire(p);
            continue;
        }
        if (mover_resting(p, r)) {
            if (p->abort) {
                mover_stop(p, r);
            } else if (p->leave) {
                mover_leave(p, r);
            }
            return dt;
        }
        if (dt <= 0.0) {
            return 0.0;
        }
        if (mover_ordered(p)) {
            axes_advance(&p->axes, dt);
            dt = 0.0;
        } else {
            dt = advance_commands(p, startable, dt);
        }
    }
}

void mover_accept(struct mover *p, const struct mover_beside *b, const struct point *point)
{
    memcpy(p->pulses, point->pulses, sizeof p->pulses);
    p->untold = false;
    if (p->motion == MOVER_CHAIN) {
        track_drop(&p->track, b->ring);
    } else if (p->motion == MOVER_CURVE) {
        curve_drop(&p->curve, b->curve);
    }
}

bool mover_joints(const struct mover *p, const struct mechanism *m, const double place[AXES],
                  double joint[AXES])
{
    if (mover_in_joints(p)) {
        memcpy(joint, place, AXES * sizeof *joint);
        return true;
    }
    return mechanism_joints(m, place, joint);
}

/* What looks ahead moves the tool to where the planned motion is. */
static void sample(struct mover *p, const struct mover_beside *b, double dt)
{
    if (p->motion == MOVER_CHAIN) {
        track_sample(&p->track, b->mean, b->ring, dt);
        begin_chained(p, b->ring);
        if (p->abort && track_rests(&p->track)) {
            mover_stop(p, b->ring);
        }
    } else if (p->motion == MOVER_CURVE) {
        curve_sample(&p->curve, b->curve);
        begin_curved(p, b->curve);
        if (p->abort && curve_rests(&p->curve)) {
            mover_stop(p, b->ring);
        }
    }
}

bool mover_point(struct mover *p, const struct mover_beside *b, const struct mechanism *m,
                 double dt, struct point *point)
{
    double velocity[AXES], joint[AXES];

    sample(p, b, dt);
    struct ring *r = b->ring;
    mover_place(p, r, point->place, velocity);
    const double *v = velocity;
    point->feed = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (point->feed == 0.0) {
        point->feed = sqrt(v[3] * v[3] + v[4] * v[4] + v[5] * v[5]);
    }
    mechanism_near(m, p->pulses, joint);
    const bool reached = mover_joints(p, m, point->place, joint);
    if (mover_in_joints(p)) {
        mechanism_place(m, joint, point->place);
    }
    memcpy(point->pulses, p->pulses, sizeof point->pulses);
    if (reached) {
        mechanism_pulses(m, joint, point->pulses);
    }
    const struct command *c = p->mix.count ? &p->mix.move[0].command : NULL;
    point->line = c ? c->line : p->line;
    point->command = c ? c->index : p->started;
    point->newest = c ? p->mix.move[p->mix.count - 1].command.index : p->started;
    point->waits = c && c->type == COMMAND_DELAY;
    point->outputs = p->outputs;
    point->outputs.spindle = outputs_spindle(&p->surface, p->outputs.spindle, point->place[0]);
    return reached;
}
