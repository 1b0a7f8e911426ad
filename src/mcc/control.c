/* control - the library's calls that act on motion under way or tell about it. */
#include <string.h>

#include "compensate.h"

/* Nothing under way and nothing to come. */
static bool idle(const struct mcc *m)
{
    return !m->running && m->ring.count == 0 && !ipo_busy(&m->ipo) && !m->ipo.stopped &&
           !m->ipo.confirming;
}

void control_settle(struct mcc *m)
{
    if (ipo_busy(&m->ipo) || m->ring.count > 0 || m->running) {
        return;
    }
    m->ipo.leave = false;
    memcpy(m->end, m->ipo.rest, sizeof m->end);     /* an abort may have moved it, */
    if (m->ipo.outputs.spindle == 0.0) {
        m->program.switches.turning = 0;            /* and switched these off */
    }
    m->program.switches.coolant = m->ipo.outputs.coolant;
}

int MCC_motion_hold(struct mcc *m)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (m->ipo.hold || m->ipo.abort || idle(m)) {
        return MCC_HOLD_ILLEGAL;
    }
    ipo_hold(&m->ipo, true);
    return MCC_NO_ERR;
}

int MCC_motion_conti(struct mcc *m)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (!m->ipo.hold || m->ipo.abort) {
        return MCC_CONTI_ILLEGAL;
    }
    ipo_hold(&m->ipo, false);
    return MCC_NO_ERR;
}

int MCC_motion_abort(struct mcc *m)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (m->ipo.abort || idle(m)) {
        return MCC_ABORT_ILLEGAL;
    }
    m->running = false;
    ipo_abort(&m->ipo, &m->ring);
    control_settle(m);
    return MCC_NO_ERR;
}

bool control_rests(const struct mcc *m)
{
    return idle(m) && m->queue.count == 0 && !m->ipo.news;
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
