/* FMU of six servo drives (core drive) on one sampling grid. */
#include <math.h>

#include "drive.h"
#include "vars.h"

enum { CHANNELS = 6 };

struct model {
    struct drive_state drive[CHANNELS];
    struct drive_config config[CHANNELS];
    struct drive_output next[CHANNELS]; /* outputs of the latest instant, shown at the next one */
    int64_t period;                     /* [ns] sampling grid */
    int64_t instant;                    /* [ns] next instant of that grid */
    int channels; /* channels up to the last active one: a sample looks at no more */
    bool prompt;  /* a channel shows its outputs without a period's delay */
};

#include "fmi_model.h"
#include "fmu_period.h"

/* The nearest number of samples to the time of the command's moving mean. */
static int32_t mean_samples(const struct vars *v, int i)
{
    return (int32_t)lround(v->command_mean_time[i] / v->period);
}

static struct drive_config config(const struct vars *v, int i)
{
    return (struct drive_config){
        .mode = v->mode[i],
        .period = v->period,
        .speed_per_volt = v->speed_per_volt[i],
        .volt_offset = v->volt_offset[i],
        .encoder_lines = v->encoder_lines[i],
        .encoder_counts = v->encoder_counts[i],
        .pulses_per_turn = v->pulses_per_turn[i],
        .velocity_gain = v->velocity_gain[i],
        .velocity_time = v->velocity_time[i],
        .position_gain = v->position_gain[i],
        .feed_forward = v->feed_forward[i],
        .feed_forward_time = v->feed_forward_time[i],
        .torque_limit = v->torque_limit[i],
        .speed_limit = v->speed_limit[i],
        .error_limit = v->error_limit[i],
        .overload_time = v->overload_time[i],
        .brake_torque = v->brake_torque[i],
        .command_mean = mean_samples(v, i),
        .command_time = v->command_time[i],
        .rated_torque = v->rated_torque[i],
        .thermal_time = v->thermal_time[i],
        .thermal_limit = v->thermal_limit[i],
        .brake_close_time = v->brake_close_time[i],
        .brake_hold_time = v->brake_hold_time[i],
        .brake_run_time = v->brake_run_time[i],
        .brake_speed = v->brake_speed[i],
    };
}

static void take_settings(struct model *m, const struct vars *v)
{
    m->prompt = false;
    for (int i = 0; i < CHANNELS; i++) {
        m->config[i] = config(v, i);
        m->prompt |= v->prompt[i];
    }
}

/* Show the outputs of the latest sample: of all channels, or of those that are prompt. */
static void publish(struct vars *v, const struct model *m, bool all)
{
    for (int i = 0; i < CHANNELS; i++) {
        const struct drive_output *o = &m->next[i];
        if (!v->active[i] || (!all && !v->prompt[i]))
            continue;
        v->torque[i] = o->torque;
        v->speed[i] = o->speed;
        v->speed_command[i] = o->speed_command;
        v->following_error[i] = o->following_error;
        v->load_ratio[i] = o->load_ratio;
        v->ready[i] = o->ready;
        v->saturated[i] = o->saturated;
        v->alarm[i] = o->alarm;
    }
}

static int model_start(struct fmu *f)
{
    struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    double ticks = v->period * (1e9 / FMU_TICK_NS);
    if (!fmu_is_period(ticks))
        return fmu_fail(f, "period = %.17g s: not a whole number of %d ns", v->period, FMU_TICK_NS);
    for (int i = 0; i < CHANNELS; i++)
        if (v->command_mean_time[i] / v->period >= DRIVE_MEAN_MOST + 0.5)
            return fmu_fail(f, "command_mean_time[%d] = %.17g s: at most %d samples of %g s", i + 1,
                            v->command_mean_time[i], DRIVE_MEAN_MOST, v->period);
    *m = (struct model){ .period = (int64_t)round(ticks) * FMU_TICK_NS };
    for (int i = 0; i < CHANNELS; i++)
        if (v->active[i])
            m->channels = i + 1;
    publish(v, m, true);
    return 0;
}

static int sample(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    for (int i = 0; i < m->channels; i++) {
        if (!v->active[i])
            continue;
        const struct drive_config *c = &m->config[i];
        struct drive_input in = { v->enable[i],      v->alarm_reset[i], v->dac[i],
                                  v->pulse_count[i], v->phase[i],       v->encoder_unplugged[i] };
        int32_t alarm = m->drive[i].alarm;
        if (drive_tick(c, &m->drive[i], &in, &m->next[i]) != DRIVE_OK)
            return fmu_fail(f, "phase[%d] = %g: more counts than a number can hold exactly", i + 1,
                            v->phase[i]);
        const bool overload = m->next[i].alarm == DRIVE_OVERLOAD && alarm != DRIVE_OVERLOAD;
        if (overload && v->rated_torque[i] > 0.0 && m->next[i].load_ratio > v->thermal_limit[i])
            fmu_warn(
                f,
                "axis %d: overload at %.9f s: its RMS torque over thermal_time = %g s was more "
                "than thermal_limit = %g of rated_torque = %g N.m",
                i + 1, (double)m->instant * 1e-9, v->thermal_time[i], v->thermal_limit[i],
                v->rated_torque[i]);
        else if (overload)
            fmu_warn(f,
                     "axis %d: overload at %.9f s: its torque was at its limit of %g N.m for "
                     "more than overload_time = %g s",
                     i + 1, (double)m->instant * 1e-9, v->torque_limit[i], v->overload_time[i]);
        else if (m->next[i].alarm != alarm)
            fmu_event(f, "axis %d: alarm %d at %.9f s", i + 1, (int)m->next[i].alarm,
                      (double)m->instant * 1e-9);
    }
    return 0;
}

/* Inputs are read at the instants in [t0, t1); the outputs show the result from the next instant
 * on, those of a prompt channel from t1 on. */
static int model_step(struct fmu *f, int64_t t0, int64_t t1)
{
    struct model *m = &f->s.m;
    if (f->tuned)
        take_settings(m, &f->s.v);
    f->tuned = false;
    for (; m->instant < t1; m->instant += m->period) {
        if (m->instant > t0)
            publish(&f->s.v, m, true);
        if (sample(f))
            return -1;
        if (m->prompt)
            publish(&f->s.v, m, false);
    }
    if (m->instant == t1)
        publish(&f->s.v, m, true);
    return 0;
}
