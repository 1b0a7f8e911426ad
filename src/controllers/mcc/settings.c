/* settings - the library's calls that set and read how it moves. */
#include <math.h>

#include "mcc.h"

int MCC_set_abs(struct mcc *m)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    m->incremental = false;
    return MCC_NO_ERR;
}

int MCC_set_inc(struct mcc *m)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    m->incremental = true;
    return MCC_NO_ERR;
}

int MCC_get_pos_type(const struct mcc *m)
{
    return m->incremental ? 0 : 1;
}

int MCC_set_fspd(struct mcc *m, double feed)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (!(machine_positive(feed) && feed <= m->machine.max_feed)) {
        return MCC_FEED_RATE;
    }
    m->feed = feed;
    return MCC_NO_ERR;
}

int MCC_set_ptp_spd(struct mcc *m, double percent)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (!machine_share(percent / 100.0)) {
        return MCC_FEED_RATE;
    }
    m->machine.ptp_ratio = percent / 100.0;
    return MCC_NO_ERR;
}

int MCC_enable_quit(struct mcc *m)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    m->blend = true;
    return MCC_NO_ERR;
}

int MCC_disable_quit(struct mcc *m)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    m->blend = false;
    return MCC_NO_ERR;
}

int MCC_check_quit(const struct mcc *m)
{
    return m->blend ? 0 : 1;
}

int mcc_set_tolerance(struct mcc *m, double tolerance)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (!(isfinite(tolerance) && tolerance >= 0.0)) {
        return MCC_PARAMETER;
    }
    m->tolerance = tolerance;
    return MCC_NO_ERR;
}

int mcc_set_curve(struct mcc *m, bool on, double merge)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (!(isfinite(merge) && merge >= 0.0)) {
        return MCC_PARAMETER;
    }
    m->curve = on;
    m->merge = merge;
    return MCC_NO_ERR;
}

static int set_time(const struct mcc *m, double *time, double ms)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (!machine_positive(ms / 1000.0)) {
        return MCC_PARAMETER;
    }
    *time = ms / 1000.0;
    return MCC_NO_ERR;
}

static int set_type(const struct mcc *m, char *type, char value)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (value != 'T' && value != 'S') {
        return MCC_PARAMETER;
    }
    *type = value;
    return MCC_NO_ERR;
}

int MCC_set_acc_type(struct mcc *m, char type)
{
    return set_type(m, &m->machine.acc_type, type);
}

char MCC_get_acc_type(const struct mcc *m)
{
    return m->machine.acc_type;
}

int MCC_set_dec_type(struct mcc *m, char type)
{
    return set_type(m, &m->machine.dec_type, type);
}

char MCC_get_dec_type(const struct mcc *m)
{
    return m->machine.dec_type;
}

int MCC_set_acc_step(struct mcc *m, double ms)
{
    return set_time(m, &m->machine.acc_time, ms);
}

double MCC_get_acc_step(const struct mcc *m)
{
    return m->machine.acc_time * 1000.0;
}

int MCC_set_dec_step(struct mcc *m, double ms)
{
    return set_time(m, &m->machine.dec_time, ms);
}

double MCC_get_dec_step(const struct mcc *m)
{
    return m->machine.dec_time * 1000.0;
}

int MCC_set_dda(struct mcc *m, double ms)
{
    if (m->open && !MCC_check_stop(m)) {
        return MCC_COMMAND_NOTFINISHED;
    }
    return set_time(m, &m->machine.dda_time, ms);
}

double MCC_get_dda(const struct mcc *m)
{
    return machine_dda_time(&m->machine) * 1000.0;
}

int MCC_set_max_dda_spd(struct mcc *m, const int32_t pulses[AXES])
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    for (int i = 0; i < AXES; i++) {
        if (pulses[i] < 1 || pulses[i] > machine_dda_limit(&m->machine)) {
            return MCC_PARAMETER;
        }
    }
    for (int i = 0; i < AXES; i++) {
        m->machine.axis[i].max_dda = pulses[i];
    }
    return MCC_NO_ERR;
}

int MCC_get_max_dda_spd(const struct mcc *m, int32_t pulses[AXES])
{
    for (int i = 0; i < AXES; i++) {
        pulses[i] = m->machine.axis[i].max_dda;
    }
    return MCC_NO_ERR;
}

static int set_override(struct mcc *m, double percent, bool ptp)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    const double *now = m->trajectory.override;
    const double ratio = percent / 100.0;
    if (!(ratio == 0.0 || (machine_positive(ratio) && ratio <= 2.0))) {
        return MCC_PARAMETER;
    }
    trajectory_override(&m->trajectory, ptp ? now[0] : ratio, ptp ? ratio : now[1]);
    return MCC_NO_ERR;
}

int MCC_set_over_spd(struct mcc *m, double percent)
{
    return set_override(m, percent, false);
}

double MCC_get_over_spd(const struct mcc *m)
{
    return m->trajectory.override[0] * 100.0;
}

int MCC_set_ptp_ospd(struct mcc *m, double percent)
{
    return set_override(m, percent, true);
}

double MCC_get_ptp_ospd(const struct mcc *m)
{
    return m->trajectory.override[1] * 100.0;
}

int MCC_set_P_gain(struct mcc *m, const int32_t gain[AXES])
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    for (int i = 0; i < AXES; i++) {
        if ((uint32_t)gain[i] > UINT16_MAX) {
            return MCC_PARAMETER;
        }
    }
    for (int i = 0; i < AXES; i++) {
        m->machine.axis[i].p_gain = gain[i];
    }
    return MCC_NO_ERR;
}

int MCC_get_P_gain(const struct mcc *m, int32_t gain[AXES])
{
    for (int i = 0; i < AXES; i++) {
        gain[i] = m->machine.axis[i].p_gain;
    }
    return MCC_NO_ERR;
}
