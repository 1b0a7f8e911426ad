#include "mover_inside.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

void mover_start(struct mover *p)
{
    memset(p, 0, sizeof *p);
    p->override[0] = p->override[1] = p->adaptive = 1.0;
}

bool mover_stand(struct mover *p, const struct mechanism *m, const double place[AXES])
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

bool mover_held(const struct mover *p)
{
    return p->hold && !(p->overrides & OUTPUTS_HOLD_OFF);
}

/* Whether the motion is on a ramp to rest, or rests there. */
bool mover_brakes(const struct mover *p)
{
    return mover_held(p) || p->abort || p->leave;
}

/* Override in force for a kind of command, and for the motion under way. */
double mover_share(const struct mover *p, bool ptp)
{
    const double panel = p->overrides & OUTPUTS_FEED_FIXED ? 1.0 : p->override[ptp];

    return mover_brakes(p) ? 0.0
         : p->overrides & OUTPUTS_ADAPTIVE ? panel * p->adaptive : panel;
}

bool mover_ordered(const struct mover *p)
{
    return p->motion == MOVER_AXES && p->mix.count == 0;
}

bool mover_in_joints(const struct mover *p)
{
    return p->motion == MOVER_AXES || (p->joints && !mover_busy(p));
}

bool mover_busy(const struct mover *p)
{
    return p->motion != MOVER_MIX || p->mix.count > 0;
}

/* Single block: the next command is the first of a block that may not begin yet. A block is a line
 * of the program, or one call. */
bool mover_blocked(const struct mover *p, const struct ring *r)
{
    const struct command *next = ring_head(r);
    return p->single && !p->allowed && next && (next->line == 0 || next->line != p->block);
}

bool mover_waits(const struct mover *p, const struct ring *r)
{
    if (p->motion == MOVER_CURVE) {
        return curve_waits(&p->curve) && (p->stopped || (p->single && !p->allowed));
    }
    return !mover_busy(p) && (p->stopped || mover_blocked(p, r));
}

bool mover_resting(const struct mover *p, const struct ring *r)
{
    if (p->motion == MOVER_CHAIN) {
        return mover_share(p, false) <= 0.0 && track_rests(&p->track);
    }
    if (p->motion == MOVER_CURVE) {
        return curve_rests(&p->curve) &&
               (mover_share(p, false) <= 0.0 || p->confirming || mover_waits(p, r));
    }
    if (mover_ordered(p)) {
        return axes_resting(&p->axes);
    }
    return mix_rests(&p->mix, mover_brakes(p)) &&
           (p->mix.count > 0 || mover_brakes(p) || p->confirming || mover_waits(p, r) ||
            r->count == 0);
}

bool mover_moving(const struct mover *p)
{
    return p->motion == MOVER_CHAIN ? !track_rests(&p->track)
         : p->motion == MOVER_CURVE ? !curve_rests(&p->curve)
         : mover_ordered(p) ? !axes_resting(&p->axes) : mix_moves(&p->mix);
}

/* A command of axes lasts as long as the last of them. */
void mover_wait_for_axes(struct mover *p)
{
    struct profile *wait = &p->mix.move[0].profile;
    profile_wait(wait, axes_left(&p->axes));
    wait->ends = p->axes.ratio > 0.0;
}

/* Plan what is under way afresh from where it is; chain and curve do it by themselves. */
void mover_replan(struct mover *p)
{
    const struct mix *x = &p->mix;

    if (p->motion == MOVER_AXES) {
        axes_set_ratio(&p->axes, mover_share(p, true));
        if (x->count > 0) {
            mover_wait_for_axes(p);
        }
    } else if (x->count > 0) {
        mix_replan(&p->mix, mover_share(p, is_ptp(&x->move[x->count - 1].command)));
    }
}

bool mover_order(struct mover *p, const struct mechanism *m)
{
    double joint[AXES];

    memcpy(joint, p->rest, sizeof joint);
    if (m->kinematics && !p->joints) {
        mechanism_near(m, p->pulses, joint);
        if (!mechanism_joints(m, p->rest, joint)) {
            return false;
        }
    }
    axes_start(&p->axes, joint, mover_share(p, true));
    p->motion = MOVER_AXES;
    return true;
}

static void place_of_axes(const struct axes *a, double point[AXES], double velocity[AXES])
{
    for (int i = 0; i < AXES; i++) {
        axes_state(a, i, &point[i], &velocity[i]);
    }
}

/* The motion ends at a place: nothing is under way any more. */
void mover_rest_at(struct mover *p, const double place[AXES], bool joints)
{
    memcpy(p->rest, place, sizeof p->rest);
    p->joints = joints;
    p->motion = MOVER_MIX;
    p->mix.count = 0;
}

void mover_bind(struct mover *p)
{
    double place[AXES], velocity[AXES];
    place_of_axes(&p->axes, place, velocity);
    mover_rest_at(p, place, true);
}

void mover_hold(struct mover *p, bool on)
{
    if (p->hold != on) {
        p->hold = on;
        mover_replan(p);
    }
}

void mover_single(struct mover *p, const struct mover_beside *b, bool on)
{
    if (on && !p->single && p->motion == MOVER_CHAIN) {
        track_close(&p->track, b->ring);
    } else if (on != p->single && p->motion == MOVER_CURVE) {
        curve_single(&p->curve, b->curve, on);
    }
    p->stopped = p->stopped || (p->single && !on && mover_waits(p, b->ring));
    p->allowed = p->allowed && on;
    p->single = on;
}

void mover_allow(struct mover *p)
{
    p->allowed = p->single;
}

void mover_ramp(const struct mover *p, struct mover *ramp)
{
    *ramp = *p;
    ramp->abort = true;
    mover_replan(ramp);
}

void mover_shift(struct mover *ramp, double dt)
{
    mix_shift(&ramp->mix, dt);
    axes_advance(&ramp->axes, dt);
}

double mover_left(const struct mover *ramp)
{
    return el_max(mix_left(&ramp->mix), ramp->motion == MOVER_AXES ? axes_left(&ramp->axes) : 0.0);
}

void mover_continue(struct mover *p)
{
    p->stopped = false;
    if (p->outputs.asks) {
        p->outputs.asks = false;
        p->outputs.tool = p->outputs.asked;
        p->untold = true;
    }
    mover_allow(p);
}

void mover_override(struct mover *p, double feed, double ptp)
{
    if (p->override[0] != feed || p->override[1] != ptp) {
        p->override[0] = feed;
        p->override[1] = ptp;
        mover_replan(p);
    }
}

void mover_place(const struct mover *p, const struct ring *r, double point[AXES],
                 double velocity[AXES])
{
    switch (p->motion) {
    case MOVER_CHAIN:
        track_place(&p->track, r, point, velocity);
        break;
    case MOVER_CURVE:
        memcpy(point, p->curve.point, sizeof p->curve.point);
        memcpy(velocity, p->curve.velocity, sizeof p->curve.velocity);
        break;
    case MOVER_AXES:
        place_of_axes(&p->axes, point, velocity);
        break;
    default:
        mix_place(&p->mix, p->rest, point, velocity);
    }
}

void mover_stop(struct mover *p, struct ring *r)
{
    double velocity[AXES], at[AXES];

    mover_place(p, r, at, velocity);
    mover_rest_at(p, at, mover_in_joints(p));
    p->hold = p->abort = p->leave = p->stopped = p->allowed = p->confirming = false;
    p->untold = p->untold || p->outputs.spindle != 0.0 || p->outputs.coolant != 0 ||
                p->outputs.asks;
    p->outputs.asks = false;
    p->overrides = 0;
    p->outputs.spindle = 0.0;
    p->outputs.coolant = 0;
    ring_clear(r);
}

void mover_adapt(struct mover *p, double share)
{
    if (p->adaptive != share) {
        p->adaptive = share;
        mover_replan(p);
    }
}

void mover_abort(struct mover *p, struct ring *r)
{
    p->abort = true;
    mover_replan(p);
    if (mover_resting(p, r)) {
        mover_stop(p, r);
    }
}
