/* control - the library's calls that act on motion under way or tell about it. */
#include <string.h>

#include "mcc.h"
#include "task.h"

/* True if nothing is under way and nothing is to come. */
static bool idle(const struct mcc *m)
{
    return !m->running && m->ring.count == 0 && !trajectory_busy(&m->trajectory)
           && !m->trajectory.stopped && !m->trajectory.confirming;
}

void control_settle(struct mcc *m)
{
    if (trajectory_busy(&m->trajectory) || m->ring.count > 0 || m->running) {
        return;
    }
    m->trajectory.allowed = false;
    memcpy(m->end, m->trajectory.rest, sizeof m->end); /* an abort may have moved it, */
    if (m->trajectory.outputs.spindle == 0.0) {
        m->program.switches.turning = 0; /* and switched these off */
    }
    m->program.switches.told = m->trajectory.surface;
    m->program.switches.coolant = m->trajectory.outputs.coolant;
    m->program.switches.overrides = m->trajectory.overrides;
    m->program.tools.loaded = m->trajectory.outputs.tool;
}

int MCC_motion_hold(struct mcc *m)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (m->trajectory.hold || m->trajectory.abort || idle(m)) {
        return MCC_HOLD_ILLEGAL;
    }
    trajectory_hold(&m->trajectory, true);
    return MCC_NO_ERR;
}

int MCC_motion_conti(struct mcc *m)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (!m->trajectory.hold || m->trajectory.abort) {
        return MCC_CONTI_ILLEGAL;
    }
    trajectory_hold(&m->trajectory, false);
    return MCC_NO_ERR;
}

int MCC_motion_abort(struct mcc *m)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (m->trajectory.abort || idle(m)) {
        return MCC_ABORT_ILLEGAL;
    }
    task_drop(m);
    trajectory_abort(&m->trajectory, &m->ring);
    control_settle(m);
    return MCC_NO_ERR;
}

bool control_rests(const struct mcc *m)
{
    return idle(m) && m->queue.count == 0 && !m->trajectory.untold;
}

int MCC_check_stop(const struct mcc *m)
{
    return control_rests(m) && !compensate_due(m);
}

int MCC_get_cpos(const struct mcc *m, double place[AXES])
{
    memcpy(place, m->written.place, sizeof m->written.place);
    return m->open ? MCC_NO_ERR : MCC_INITIAL_MOTION;
}

int MCC_get_ppos(const struct mcc *m, int32_t pulses[AXES])
{
    memcpy(pulses, m->written.pulses, sizeof m->written.pulses);
    return m->open ? MCC_NO_ERR : MCC_INITIAL_MOTION;
}

int MCC_get_errcnt(const struct mcc *m, int32_t counts[AXES])
{
    memcpy(counts, m->signals.err, sizeof m->signals.err);
    return m->open ? MCC_NO_ERR : MCC_INITIAL_MOTION;
}

/* Dry run: everything is read, planned, checked and reported, but the frames carry no pulses. */

int MCC_enable_dry_run(struct mcc *m)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (m->dry_run) {
        return MCC_NO_ERR;
    }
    if (!MCC_check_stop(m)) {
        return MCC_COMMAND_NOTFINISHED;
    }
    m->dry_run = true;
    memcpy(m->dry_place, m->trajectory.rest, sizeof m->dry_place);
    memcpy(m->dry_pulses, m->trajectory.pulses, sizeof m->dry_pulses);
    return MCC_NO_ERR;
}

int MCC_disable_dry_run(struct mcc *m)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (!m->dry_run) {
        return MCC_NO_ERR;
    }
    if (!MCC_check_stop(m)) {
        return MCC_COMMAND_NOTFINISHED;
    }
    m->dry_run = false;
    memcpy(m->end, m->dry_place, sizeof m->end);
    memcpy(m->trajectory.rest, m->dry_place, sizeof m->trajectory.rest);
    memcpy(m->trajectory.pulses, m->dry_pulses, sizeof m->trajectory.pulses);
    memcpy(m->written.place, m->dry_place, sizeof m->written.place);
    memcpy(m->written.pulses, m->dry_pulses, sizeof m->written.pulses);
    return MCC_NO_ERR;
}

int MCC_check_dry_run(const struct mcc *m)
{
    return m->dry_run ? 0 : 1;
}
