#include "mcc.h"

#include <math.h>

#include "reaction.h"

int MCC_clear_error(struct mcc *m)
{
    return m->open ? reaction_clear(m) : MCC_INITIAL_MOTION;
}

int MCC_set_check_OT(struct mcc *m, const int on[AXES])
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    for (int i = 0; i < AXES; i++) {
        const struct machine_axis *a = &m->machine.axis[i];
        if ((on[i] != 0 && on[i] != 1) || (on[i] && machine_low(a) > machine_high(a))) {
            return MCC_PARAMETER;
        }
    }
    for (int i = 0; i < AXES; i++) {
        m->machine.axis[i].check_ot = on[i];
    }
    return MCC_NO_ERR;
}

int MCC_get_check_OT(const struct mcc *m, int on[AXES])
{
    for (int i = 0; i < AXES; i++) {
        on[i] = m->machine.axis[i].check_ot;
    }
    return m->open ? MCC_NO_ERR : MCC_INITIAL_MOTION;
}

int MCC_set_max_dda_acc(struct mcc *m, const int32_t pulses[AXES])
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    for (int i = 0; i < AXES; i++) {
        if (pulses[i] < 1 || pulses[i] > 2 * machine_dda_limit(&m->machine)) {
            return MCC_PARAMETER;
        }
    }
    for (int i = 0; i < AXES; i++) {
        m->machine.axis[i].max_dda_acc = pulses[i];
    }
    return MCC_NO_ERR;
}

int MCC_get_max_dda_acc(const struct mcc *m, int32_t pulses[AXES])
{
    for (int i = 0; i < AXES; i++) {
        pulses[i] = m->machine.axis[i].max_dda_acc;
    }
    return MCC_NO_ERR;
}

static int set_in_pos(struct mcc *m, int axes, bool on)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (axes < 0 || axes >= 1 << AXES) {
        return MCC_PARAMETER;
    }
    for (int i = 0; i < AXES; i++) {
        bool *in_pos = &m->machine.axis[i].in_pos;
        *in_pos = axes >> i & 1 ? on : *in_pos;
    }
    m->trajectory.confirm = guard_watched(&m->machine) != 0;
    return MCC_NO_ERR;
}

int MCC_enable_in_pos(struct mcc *m, int axes)
{
    return set_in_pos(m, axes, true);
}

int MCC_disable_in_pos(struct mcc *m, int axes)
{
    return set_in_pos(m, axes, false);
}

int MCC_check_in_pos(const struct mcc *m, int in[AXES])
{
    const uint32_t within = reaction_arrived(m) ? guard_within(&m->machine, &m->signals) : 0;
    for (int i = 0; i < AXES; i++) {
        in[i] = within >> i & 1;
    }
    return m->open ? MCC_NO_ERR : MCC_INITIAL_MOTION;
}

int MCC_set_inpos_tol(struct mcc *m, const double mm[AXES])
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    for (int i = 0; i < AXES; i++) {
        if (!isfinite(mm[i]) || mm[i] < 0.0) {
            return MCC_PARAMETER;
        }
    }
    for (int i = 0; i < AXES; i++) {
        m->machine.axis[i].inpos_tol = mm[i];
    }
    return MCC_NO_ERR;
}

int MCC_get_inpos_tol(const struct mcc *m, double mm[AXES])
{
    for (int i = 0; i < AXES; i++) {
        mm[i] = m->machine.axis[i].inpos_tol;
    }
    return m->open ? MCC_NO_ERR : MCC_INITIAL_MOTION;
}

int protect_set_limit_mode(struct mcc *m, int mode)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (mode < -1 || mode > MACHINE_LIMIT_TOWARD_ERROR) {
        return MCC_PARAMETER;
    }
    m->machine.limit_check = mode >= 0;
    m->machine.limit_mode = mode >= 0 ? mode : m->machine.limit_mode;
    return MCC_NO_ERR;
}

int protect_set_track_limit(struct mcc *m, const int32_t counts[AXES])
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    for (int i = 0; i < AXES; i++) {
        if (counts[i] < 0) {
            return MCC_PARAMETER;
        }
    }
    for (int i = 0; i < AXES; i++) {
        m->machine.axis[i].track_limit = counts[i];
    }
    return MCC_NO_ERR;
}
