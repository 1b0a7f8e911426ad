#include "trajectory.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "el_extremes.h"

static bool is_ptp(const struct command *c)
{
    return c->type == COMMAND_PTP || c->type == COMMAND_PTP_ASYN;
}

void trajectory_start(struct trajectory *p)
{
    memset(p, 0, sizeof *p);
    p->override[0] = p->override[1] = p->adaptive = 1.0;
}

void trajectory_copy(struct trajectory *to, const struct trajectory *from)
{
    memcpy(to, from, offsetof(struct trajectory, axes));
    if (from->motion == TRAJECTORY_AXES) {
        to->axes = from->axes;
    }
    to->mix.count = from->mix.count;
    for (int i = 0; i < from->mix.count; i++) {
        to->mix.move[i] = from->mix.move[i];
    }
}

bool trajectory_stand(struct trajectory *p, const struct mechanism *m, const double place[AXES])
{
    double joint[AXES];

    if (!mechanism_first(m, place, joint)) {
        return false;
    }
    memcpy(p->rest, place, sizeof p->rest);
    p->joints = false;
    mechanism_pulses(m, joint, p->pulses);
    return true;
}

bool trajectory_held(const struct trajectory *p)
{
    return p->hold && !(p->overrides & OUTPUTS_HOLD_OFF);
}

/* Whether the motion is on a ramp to rest, or rests there. */
static bool brakes(const struct trajectory *p)
{
    return trajectory_held(p) || p->abort || p->leave;
}

/* Override in force for a kind of command, and for the motion under way. */
static double in_force(const struct trajectory *p, bool ptp)
{
    const double panel = p->overrides & OUTPUTS_FEED_FIXED ? 1.0 : p->override[ptp];

    return brakes(p) ? 0.0 : p->overrides & OUTPUTS_ADAPTIVE ? panel * p->adaptive : panel;
}

bool trajectory_ordered(const struct trajectory *p)
{
    return p->motion == TRAJECTORY_AXES && p->mix.count == 0;
}

bool trajectory_in_joints(const struct trajectory *p)
{
    return p->motion == TRAJECTORY_AXES || (p->joints && !trajectory_busy(p));
}

bool trajectory_busy(const struct trajectory *p)
{
    return p->motion != TRAJECTORY_MIX || p->mix.count > 0;
}

/* Single block: whether the next command is the first of a block that may not begin yet. A
 * block is a line of the program, or one call. */
static bool blocked(const struct trajectory *p, const struct ring *r)
{
    const struct command *next = ring_head(r);
    return p->single && !p->allowed && next && (next->line == 0 || next->line != p->block);
}

bool trajectory_waits(const struct trajectory *p, const struct ring *r)
{
    if (p->motion == TRAJECTORY_CURVE) {
        return curve_waits(&p->curve) && (p->stopped || (p->single && !p->allowed));
    }
    return !trajectory_busy(p) && (p->stopped || blocked(p, r));
}

/* Whether what is under way stands, and nothing can begin. */
static bool stands(const struct trajectory *p, const struct ring *r)
{
    if (p->motion == TRAJECTORY_CHAIN) {
        return in_force(p, false) <= 0.0 && lookahead_rests(&p->lookahead);
    }
    if (p->motion == TRAJECTORY_CURVE) {
        return curve_rests(&p->curve)
               && (in_force(p, false) <= 0.0 || p->confirming || trajectory_waits(p, r));
    }
    if (trajectory_ordered(p)) {
        return axes_resting(&p->axes);
    }
    return mix_rests(&p->mix, brakes(p))
           && (p->mix.count > 0 || brakes(p) || p->confirming || trajectory_waits(p, r)
               || r->count == 0);
}

/* Where a plan made anew has nothing left, as an override's may in the very instant in which the
 * speed is 0, an abort or a leave ends with the next call of trajectory_advance. */
bool trajectory_resting(const struct trajectory *p, const struct ring *r)
{
    const bool drops =
        p->motion != TRAJECTORY_CHAIN && p->motion != TRAJECTORY_CURVE && (p->abort || p->leave);

    return !drops && stands(p, r);
}

bool trajectory_moving(const struct trajectory *p)
{
    return p->motion == TRAJECTORY_CHAIN   ? !lookahead_rests(&p->lookahead)
           : p->motion == TRAJECTORY_CURVE ? !curve_rests(&p->curve)
           : trajectory_ordered(p)         ? !axes_resting(&p->axes)
                                           : mix_moves(&p->mix);
}

/* A command of axes lasts as long as the last of them. */
static void wait_for_axes(struct trajectory *p)
{
    struct profile *wait = &p->mix.move[0].profile;
    profile_wait(wait, axes_left(&p->axes));
    wait->ends = p->axes.ratio > 0.0;
}

/* Plan what is under way afresh from where it is; chain and curve do it by themselves. */
static void replan(struct trajectory *p)
{
    const struct mix *x = &p->mix;

    if (p->motion == TRAJECTORY_AXES) {
        axes_set_ratio(&p->axes, in_force(p, true));
        if (x->count > 0) {
            wait_for_axes(p);
        }
    } else if (x->count > 0) {
        mix_replan(&p->mix, in_force(p, is_ptp(&x->move[x->count - 1].command)));
    }
}

bool trajectory_order(struct trajectory *p, const struct mechanism *m)
{
    double joint[AXES];

    memcpy(joint, p->rest, sizeof joint);
    if (m->kinematics && !p->joints) {
        mechanism_near(m, p->pulses, joint);
        if (!mechanism_joints(m, p->rest, joint)) {
            return false;
        }
    }
    axes_start(&p->axes, joint, in_force(p, true));
    p->motion = TRAJECTORY_AXES;
    return true;
}

static void place_of_axes(const struct axes *a, double point[AXES], double velocity[AXES])
{
    for (int i = 0; i < AXES; i++) {
        axes_state(a, i, &point[i], &velocity[i]);
    }
}

/* The motion ends at a place: nothing is under way any more. */
static void rest_at(struct trajectory *p, const double place[AXES], bool joints)
{
    memcpy(p->rest, place, sizeof p->rest);
    p->joints = joints;
    p->motion = TRAJECTORY_MIX;
    p->mix.count = 0;
}

void trajectory_bind(struct trajectory *p)
{
    double place[AXES], velocity[AXES];
    place_of_axes(&p->axes, place, velocity);
    rest_at(p, place, true);
}

void trajectory_hold(struct trajectory *p, bool on)
{
    if (p->hold != on) {
        p->hold = on;
        replan(p);
    }
}

void trajectory_single(struct trajectory *p, const struct trajectory_beside *b, bool on)
{
    if (on && !p->single && p->motion == TRAJECTORY_CHAIN) {
        lookahead_close(&p->lookahead, b->ring);
    } else if (on != p->single && p->motion == TRAJECTORY_CURVE) {
        curve_single(&p->curve, b->curve, on);
    }
    p->stopped = p->stopped || (p->single && !on && trajectory_waits(p, b->ring));
    p->allowed = p->allowed && on;
    p->single = on;
}

void trajectory_allow(struct trajectory *p)
{
    p->allowed = p->single;
}

void trajectory_ramp(const struct trajectory *p, struct trajectory *ramp)
{
    *ramp = *p;
    ramp->abort = true;
    replan(ramp);
}

void trajectory_shift(struct trajectory *ramp, double dt)
{
    mix_shift(&ramp->mix, dt);
    axes_advance(&ramp->axes, dt);
}

double trajectory_left(const struct trajectory *ramp)
{
    return el_max(mix_left(&ramp->mix),
                  ramp->motion == TRAJECTORY_AXES ? axes_left(&ramp->axes) : 0.0);
}

void trajectory_continue(struct trajectory *p)
{
    p->stopped = false;
    if (p->outputs.asks) {
        p->outputs.asks = false;
        p->outputs.tool = p->outputs.asked;
        p->untold = true;
    }
    trajectory_allow(p);
}

void trajectory_override(struct trajectory *p, double feed, double ptp)
{
    if (p->override[0] != feed || p->override[1] != ptp) {
        p->override[0] = feed;
        p->override[1] = ptp;
        replan(p);
    }
}

void trajectory_place(const struct trajectory *p, const struct ring *r, double point[AXES],
                      double velocity[AXES])
{
    switch (p->motion) {
    case TRAJECTORY_CHAIN: lookahead_place(&p->lookahead, r, point, velocity); break;
    case TRAJECTORY_CURVE:
        memcpy(point, p->curve.point, sizeof p->curve.point);
        memcpy(velocity, p->curve.velocity, sizeof p->curve.velocity);
        break;
    case TRAJECTORY_AXES: place_of_axes(&p->axes, point, velocity); break;
    default:              mix_place(&p->mix, p->rest, point, velocity);
    }
}

void trajectory_stop(struct trajectory *p, struct ring *r)
{
    double velocity[AXES], at[AXES];

    trajectory_place(p, r, at, velocity);
    rest_at(p, at, trajectory_in_joints(p));
    p->hold = p->abort = p->leave = p->stopped = p->allowed = p->confirming = false;
    p->untold =
        p->untold || p->outputs.spindle != 0.0 || p->outputs.coolant != 0 || p->outputs.asks;
    p->outputs.asks = false;
    p->overrides = 0;
    p->outputs.spindle = 0.0;
    p->outputs.coolant = 0;
    ring_clear(r);
}

void trajectory_adapt(struct trajectory *p, double share)
{
    if (p->adaptive != share) {
        p->adaptive = share;
        replan(p);
    }
}

void trajectory_abort(struct trajectory *p, struct ring *r)
{
    p->abort = true;
    replan(p);
    if (stands(p, r)) {
        trajectory_stop(p, r);
    }
}

/* The older command has ended. */
static void retire(struct trajectory *p)
{
    const struct command ended = p->mix.move[0].command;

    mix_retire(&p->mix);
    if (p->mix.count == 0) {
        rest_at(p, ended.path.end, p->motion == TRAJECTORY_AXES);
        p->confirming = p->confirm && ended.type != COMMAND_DELAY;
        p->leave = false;
    }
}

void trajectory_leave(struct trajectory *p, const struct ring *r)
{
    double at[AXES], velocity[AXES];

    p->leave = p->motion == TRAJECTORY_MIX && p->mix.count == 1;
    replan(p);
    if (p->leave && stands(p, r)) {
        trajectory_place(p, r, at, velocity);
        rest_at(p, at, false);
        p->confirming = p->confirm;
        p->leave = false;
    }
}

/* Whether the next command may begin, now or in the deceleration of the one under way. */
static bool may_start(const struct trajectory *p, const struct ring *r)
{
    const struct command *next = ring_head(r);
    if (!next || p->motion != TRAJECTORY_MIX || brakes(p) || p->stopped || p->confirming
        || blocked(p, r)) {
        return false;
    }
    return p->mix.count == 0 || (mix_open(&p->mix) && command_blends(next));
}

/* A command begins: its outputs and its line count from now on. Index 0: it takes no time. */
static void begin(struct trajectory *p, const struct shape_mark *k)
{
    p->outputs.digital = (p->outputs.digital | k->set) & ~k->clear;
    for (int i = 0; i < OUTPUTS_ANALOG; i++) {
        p->outputs.analog[i] = k->analog.set >> i & 1 ? k->analog.value[i] : p->outputs.analog[i];
    }
    p->line = p->block = k->line;
    p->allowed = false;
    p->started = k->index > 0 ? k->index : p->started;
}

static void begin_command(struct trajectory *p, const struct command *c)
{
    const struct shape_mark k = { .index = command_lasts(c) ? c->index : 0,
                                  .line = c->line,
                                  .set = c->set,
                                  .clear = c->clear,
                                  .analog = c->analog };
    begin(p, &k);
    if (command_lasts(c)) {
        memcpy(p->end, c->path.end, sizeof p->end);
    }
}

static void begin_axes(struct trajectory *p, const struct command *c,
                       const struct axes_limits l[AXES])
{
    axes_start(&p->axes, c->path.start, in_force(p, true));
    for (int i = 0; i < AXES; i++) {
        if (c->path.end[i] != c->path.start[i]) {
            axes_go(&p->axes, i, c->path.end[i], &l[i]);
        }
    }
    p->mix.move[p->mix.count++].command = *c;
    p->motion = TRAJECTORY_AXES;
    wait_for_axes(p);
}

static void begin_next(struct trajectory *p, const struct trajectory_beside *b)
{
    struct ring *r = b->ring;
    const struct command *c = ring_head(r);

    if (p->mix.count == 0 && !p->single && b->curve && curve_begins(r)) {
        curve_start(&p->curve, b->curve, r);
        p->motion = TRAJECTORY_CURVE;
        return;
    }
    if (p->mix.count == 0 && !p->single && lookahead_begins(r)) {
        lookahead_start(&p->lookahead, r);
        p->motion = TRAJECTORY_CHAIN;
        return;
    }
    begin_command(p, c);
    if (c->type == COMMAND_PTP_ASYN) {
        begin_axes(p, c, ring_peek(r, 0)->axis);
    } else if (command_lasts(c)) {
        mix_begin(&p->mix, c, in_force(p, is_ptp(c)));
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

static void begin_chained(struct trajectory *p, const struct ring *r)
{
    const struct command *c;
    while ((c = lookahead_begun(&p->lookahead, r)) != NULL) {
        begin_command(p, c);
    }
}

static void begin_curved(struct trajectory *p, const struct curve_plan *m)
{
    const struct shape_mark *k;
    while ((k = curve_begun(&p->curve, m)) != NULL) {
        begin(p, k);
        for (int i = 0; i < AXES; i++) {
            p->end[i] = k->end[i];
        }
    }
}

/* The motion that has looked ahead is over. */
static void end_ahead(struct trajectory *p, struct ring *r, const double place[AXES])
{
    rest_at(p, place, false);
    p->confirming = p->confirm;
    if (p->abort) {
        trajectory_stop(p, r); /* the ramp of the abort was that to its end */
    }
}

static double advance_curve(struct trajectory *p, const struct trajectory_beside *b, double dt)
{
    if (curve_waits(&p->curve)) {
        if (p->confirming || brakes(p) || trajectory_waits(p, b->ring)) {
            return 0.0;
        }
        curve_go(&p->curve, b->curve, p->single);
    }
    const double left = curve_advance(&p->curve, b->curve, b->ring, in_force(p, false), dt);
    p->confirming = p->confirm && curve_waits(&p->curve);
    if (curve_done(&p->curve, b->curve)) {
        begin_curved(p, b->curve);
        end_ahead(p, b->ring, b->curve->end);
    }
    return left;
}

static double advance_chain(struct trajectory *p, struct ring *r, double dt)
{
    struct lookahead *t = &p->lookahead;
    const double left = lookahead_advance(t, r, in_force(p, false), dt);
    if (left <= 0.0 || (t->smooth > 0.0 && !lookahead_done(t))) {
        return 0.0; /* the tool has to come after */
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
static double advance_commands(struct trajectory *p, bool startable, double dt)
{
    struct profile *old = &p->mix.move[0].profile;
    const double event = startable ? old->tail : old->total;
    const double step = el_min(dt, event - old->t);

    mix_shift(&p->mix, step);
    if (step < dt) {
        old->t = event; /* met exactly, whatever the sum rounds to */
    }
    if (p->motion == TRAJECTORY_AXES) {
        axes_advance(&p->axes, step);
    }
    return dt - step;
}

double trajectory_advance(struct trajectory *p, const struct trajectory_beside *b, double dt)
{
    struct ring *r = b->ring;

    if (p->motion == TRAJECTORY_CHAIN) {
        return advance_chain(p, r, dt);
    }
    if (p->motion == TRAJECTORY_CURVE) {
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
        if (stands(p, r)) {
            if (p->abort) {
                trajectory_stop(p, r);
            } else if (p->leave) {
                trajectory_leave(p, r);
            }
            return dt;
        }
        if (dt <= 0.0) {
            return 0.0;
        }
        if (trajectory_ordered(p)) {
            axes_advance(&p->axes, dt);
            dt = 0.0;
        } else {
            dt = advance_commands(p, startable, dt);
        }
    }
}

void trajectory_accept(struct trajectory *p, const struct trajectory_beside *b,
                       const struct point *point)
{
    memcpy(p->pulses, point->pulses, sizeof p->pulses);
    p->untold = false;
    if (p->motion == TRAJECTORY_CHAIN) {
        lookahead_drop(&p->lookahead, b->ring);
    } else if (p->motion == TRAJECTORY_CURVE) {
        curve_drop(&p->curve, b->curve);
    }
}

bool trajectory_joints(const struct trajectory *p, const struct mechanism *m,
                       const double place[AXES], double joint[AXES])
{
    if (trajectory_in_joints(p)) {
        memcpy(joint, place, AXES * sizeof *joint);
        return true;
    }
    return mechanism_joints(m, place, joint);
}

/* What looks ahead moves the tool to where the planned motion is. */
static void sample(struct trajectory *p, const struct trajectory_beside *b, double dt)
{
    if (p->motion == TRAJECTORY_CHAIN) {
        lookahead_sample(&p->lookahead, b->mean, b->ring, dt);
        begin_chained(p, b->ring);
        if (p->abort && lookahead_rests(&p->lookahead)) {
            trajectory_stop(p, b->ring);
        }
    } else if (p->motion == TRAJECTORY_CURVE) {
        curve_sample(&p->curve, b->curve);
        begin_curved(p, b->curve);
        if (p->abort && curve_rests(&p->curve)) {
            trajectory_stop(p, b->ring);
        }
    }
}

/* Way left of the command that moves, or of axes that have a place to go to. */
static void way_left(const struct trajectory *p, const double place[AXES], double left[AXES])
{
    const double *end =
        p->motion == TRAJECTORY_MIX && p->mix.count > 0 ? p->mix.move[0].command.path.end : p->end;
    const bool ordered = trajectory_ordered(p);

    for (int i = 0; i < AXES; i++) {
        const struct axes_axis *a = &p->axes.axis[i];
        left[i] = !trajectory_busy(p)   ? 0.0
                  : !ordered            ? end[i] - place[i]
                  : a->order == AXES_GO ? a->goal - place[i]
                                        : 0.0;
    }
}

bool trajectory_point(struct trajectory *p, const struct trajectory_beside *b,
                      const struct mechanism *m, double dt, struct point *point)
{
    double velocity[AXES], joint[AXES];

    sample(p, b, dt);
    struct ring *r = b->ring;
    trajectory_place(p, r, point->place, velocity);
    const double *v = velocity;
    point->feed = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (point->feed == 0.0) {
        point->feed = sqrt(v[3] * v[3] + v[4] * v[4] + v[5] * v[5]);
    }
    way_left(p, point->place, point->left);
    mechanism_near(m, p->pulses, joint);
    const bool reached = trajectory_joints(p, m, point->place, joint);
    if (trajectory_in_joints(p)) {
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

/* Axes that move by themselves: what limits the one that is under way longest. */
static struct limited axes_limited(const struct axes *a)
{
    const int last = axes_last(a);
    struct axes soon = *a;
    double place, now, then;

    axes_advance(&soon, 1e-6);
    axes_state(a, last, &place, &now);
    axes_state(&soon, last, &place, &then);
    const bool gains = fabs(then) > fabs(now), loses = fabs(then) < fabs(now);
    return (struct limited){ .by = gains   ? LIMITED_ACCELERATION
                                   : loses ? LIMITED_STOP
                                           : LIMITED_SPEED,
                             .axis = loses ? 0 : last + 1,
                             .feed = a->axis[last].limits.speed };
}

struct limited trajectory_limited(const struct trajectory *p, const struct trajectory_beside *b,
                                  const struct mechanism *m)
{
    const double override = in_force(p, false);

    if (brakes(p) || p->stopped || p->confirming || trajectory_waits(p, b->ring)) {
        return (struct limited){ .by = LIMITED_WAIT };
    }
    if (!trajectory_busy(p)) {
        return (struct limited){ .by = LIMITED_STOP };
    }
    switch (p->motion) {
    case TRAJECTORY_CHAIN: return lookahead_limited(&p->lookahead, b->ring, m, override);
    case TRAJECTORY_CURVE: return curve_limited(&p->curve, b->curve, override);
    case TRAJECTORY_AXES:  return axes_limited(&p->axes);
    default:               return mix_limited(&p->mix, m);
    }
}
