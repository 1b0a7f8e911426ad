#include "reaction.h"

#include <stdlib.h>
#include <string.h>

#include "reach.h"
#include "task.h"

/* Pulses of the DDA time under way still come. Without any for two DDA times, none will come. */
static const int64_t QUIET = 2; /* [DDA times] */

static const int64_t OUTSIDE = -1; /* value of `settled` while an axis is not in position */

/* Give a point its uncompensated frame, from the position before; false if an axis would get more
 * than max_dda pulses. */
static bool frame(const struct mcc *m, struct point *p)
{
    for (int i = 0; i < AXES; i++) {
        const int64_t pulses = (int64_t)p->pulses[i] - m->trajectory.pulses[i];
        if (llabs(pulses) > m->machine.axis[i].max_dda) {
            return false;
        }
        p->frame[i] = (int32_t)pulses;
    }
    return true;
}

/* *axis becomes the axis whose limit switch blocks the motion from one point to another, however
 * small it is; -1: none. Returns the error to be raised for it, 0 if the mode raises none. */
static int32_t blocked(const struct mcc *m, const struct point *from, const struct point *to,
                       int *axis)
{
    double way[AXES];
    for (int i = 0; i < AXES; i++) {
        way[i] = to->place[i] - from->place[i];
    }
    *axis = m->dry_run ? -1 : guard_switch(&m->machine, &m->signals, way);
    return guard_switch_error(&m->machine) ? MCC_ERROR_TRAVEL + *axis : 0;
}

/* True while homing runs, for which neither software limits nor limit switches count. */
static bool homing(const struct mcc *m)
{
    return trajectory_ordered(&m->trajectory) && m->homing.state == HOMING_RUNS;
}

/* A smooth curve is within a tolerance of paths that are within the limits: so far out it may be.
 * Of joints that are no coordinates the tolerance says nothing. */
static struct mechanism limits_of(const struct mcc *m, const struct mechanism *machine)
{
    struct mechanism limits = *machine;
    if (m->trajectory.motion == TRAJECTORY_CURVE && !machine->kinematics) {
        for (int i = 0; i < AXES; i++) {
            limits.joint[i].low -= m->curve_plan.widest;
            limits.joint[i].high += m->curve_plan.widest;
        }
    }
    return limits;
}

/* True if software limits and limit switches allow a point; else *error is as in reaction_point. */
static bool within(struct mcc *m, const struct mechanism *machine, bool ramping,
                   const struct point *p, int32_t *error)
{
    const struct queue *q = &m->queue;
    const struct point *last = q->count > 0 ? queue_peek(q, q->count - 1) : &m->written;
    int axis = -1;

    if (mechanism_bounded(machine)) {
        const struct mechanism limits = limits_of(m, machine);
        const struct trajectory_beside beside = mcc_beside(m);
        axis = mechanism_outside(&limits, m->trajectory.pulses, p->pulses);
        axis = axis >= 0
                   ? axis
                   : reach_beyond(&m->trajectory, &beside, &limits, machine_dda_time(&m->machine));
    }
    *error = MCC_ERROR_TRAVEL + axis;
    if (axis < 0 && !ramping) {
        *error = blocked(m, last, p, &axis);
    }
    return axis < 0;
}

bool reaction_point(struct mcc *m, const struct mechanism *machine, bool ramping, struct point *p,
                    int32_t *error)
{
    *error = MCC_ERROR_SPEED;
    if (!frame(m, p)) {
        return false;
    }
    if (!m->error) {
        *error = MCC_ERROR_ACC;
        if (guard_change(&m->machine, m->protection.frame, p->frame) >= 0
            || (!homing(m) && !within(m, machine, ramping, p, error))) {
            return false;
        }
    }
    memcpy(m->protection.frame, p->frame, sizeof p->frame);
    compensate_frame(m, p);
    return true;
}

void reaction_stop(struct mcc *m, int32_t error)
{
    const bool again = m->error != 0;

    m->error = again ? m->error : error;
    task_drop(m);
    if (again) {
        trajectory_stop(&m->trajectory, &m->ring);
    } else {
        trajectory_abort(&m->trajectory, &m->ring);
    }
    control_settle(m);
}

int32_t reaction_error_of(const struct fault_report *r)
{
    return r->fault == FAULT_TRAVEL ? MCC_ERROR_TRAVEL + r->axis : MCC_ERROR_ARC;
}

/* Stop at once: rest at the last of the `stay` points that a transaction holds, drop the others. */
static void stop_at_once(struct mcc *m, int32_t error, int32_t stay)
{
    const struct point *last = stay > 0 ? queue_peek(&m->queue, stay - 1) : &m->written;

    m->error = m->error ? m->error : error;
    task_drop(m);
    trajectory_stop(&m->trajectory, &m->ring);
    memcpy(m->trajectory.pulses, last->pulses, sizeof m->trajectory.pulses);
    memcpy(m->trajectory.rest, last->place, sizeof m->trajectory.rest);
    for (int i = 0; i < AXES; i++) {
        m->comp[i].added = last->added[i];
    }
    queue_keep(&m->queue, stay);
    control_settle(m);
}

int32_t reaction_put_out(const struct mcc *m, int axis)
{
    return m->protection.base[axis] + m->signals.pulses[axis] - m->written.added[axis];
}

/* Take the position from the pulses that the card has put out. The compensation is taken as that of
 * the latest point written; the rest is driven in when the library goes on. */
static void follow(struct mcc *m)
{
    struct point *w = &m->written;

    for (int i = 0; i < AXES; i++) {
        if (m->machine.axis[i].used) {
            w->pulses[i] = m->trajectory.pulses[i] = reaction_put_out(m, i);
            w->place[i] = w->pulses[i] / machine_pulses_per_mm(&m->machine.axis[i]);
        }
        w->frame[i] = 0;
        m->comp[i].added = w->added[i];
    }
    w->feed = 0.0;
    w->waits = false;
    memcpy(m->trajectory.rest, w->place, sizeof m->trajectory.rest);
    memcpy(m->end, w->place, sizeof m->end);
}

static void emergency(struct mcc *m)
{
    m->error = MCC_ERROR_STOP;
    task_drop(m);
    trajectory_stop(&m->trajectory, &m->ring);
    queue_clear(&m->queue);
    m->written.outputs = m->trajectory.outputs; /* they go off now, not with a point */
    m->trajectory.untold = false;
}

static void note_pulses(struct mcc *m, int64_t clocks)
{
    struct protection *p = &m->protection;

    p->quiet += clocks;
    if (m->signals.stop || memcmp(p->seen, m->signals.pulses, sizeof p->seen) != 0) {
        p->quiet = 0;
    }
    memcpy(p->seen, m->signals.pulses, sizeof p->seen);
}

bool reaction_arrived(const struct mcc *m)
{
    bool all = m->queue.count == 0 && !trajectory_busy(&m->trajectory);
    for (int i = 0; i < AXES && !m->dry_run; i++) {
        all = all && (!m->machine.axis[i].used || m->written.pulses[i] == reaction_put_out(m, i));
    }
    return all;
}

/* In-position check of the command that has ended. */
static void confirm(struct mcc *m, int64_t clocks)
{
    const struct machine *machine = &m->machine;
    const int mode = machine->inpos_mode;
    const uint32_t watched = guard_watched(machine);
    struct protection *p = &m->protection;

    if (!reaction_arrived(m)) {
        p->waited = 0;
        p->settled = OUTSIDE;
        return;
    }
    p->waited += clocks;
    if ((guard_within(machine, &m->signals) & watched) != watched) {
        p->settled = OUTSIDE;
    } else {
        p->settled = p->settled == OUTSIDE ? 0 : p->settled + clocks;
    }
    const bool once = mode == MACHINE_INPOS_ONCE_BLOCK || mode == MACHINE_INPOS_ONCE_UNBLOCK;
    const double settle = once ? 0.0 : machine->inpos_settle * CLOCK_HZ;
    const double timeout = machine->inpos_timeout * CLOCK_HZ;
    const bool late = timeout > 0.0 && (double)p->waited >= timeout;
    if (p->settled != OUTSIDE && (double)p->settled >= settle) {
        m->trajectory.confirming = false;
    } else if (late && (mode == MACHINE_INPOS_ONCE_BLOCK || mode == MACHINE_INPOS_SETTLE_BLOCK)) {
        reaction_stop(m, MCC_ERROR_IN_POS);
    } else if (late) {
        m->trajectory.confirming = false;
    }
}

void reaction_look(struct mcc *m, const struct reaction_look *l)
{
    note_pulses(m, l->clocks);
    if (m->signals.stop) {
        emergency(m);
    }
    if (m->error == MCC_ERROR_STOP) {
        follow(m);
        return;
    }
    for (int i = 0; i < AXES && l->overflow != 0; i++) {
        if (m->machine.axis[i].track_limit > 0 && (l->overflow >> i & 1)) {
            stop_at_once(m, MCC_ERROR_TRACK + i, l->flying);
        }
    }
    int axis = guard_track(&m->machine, &m->signals);
    if (axis >= 0 && !m->error) {
        reaction_stop(m, MCC_ERROR_TRACK + axis);
    }
    if (!m->error && !m->trajectory.abort && !homing(m) && m->queue.count > 0) {
        const int32_t error = blocked(m, &m->written, queue_peek(&m->queue, 0), &axis);
        if (axis >= 0) {
            reaction_stop(m, error); /* the newest points may go in another direction */
        }
    }
    if (m->trajectory.confirming) {
        confirm(m, l->clocks);
    }
    inquiry_look(m, l->clocks);
}

int reaction_clear(struct mcc *m)
{
    const bool track = m->error >= MCC_ERROR_TRACK && m->error < MCC_ERROR_TRACK + AXES;

    if (m->signals.stop || (track && guard_track(&m->machine, &m->signals) >= 0)) {
        return MCC_RUN_TIME;
    }
    const bool stop = m->error == MCC_ERROR_STOP;
    const bool rests = stop ? m->protection.quiet >= QUIET * machine_dda_clocks(&m->machine)
                            : !m->error || MCC_check_stop(m);
    if (!rests) {
        return MCC_COMMAND_NOTFINISHED;
    }
    if (stop) {
        follow(m);
    }
    m->error = 0;
    return MCC_NO_ERR;
}
