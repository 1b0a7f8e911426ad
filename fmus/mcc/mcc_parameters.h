/* mcc_parameters - checks the parameters of the mcc FMU and converts them to the configuration of
 * the motion library and its PC. Included by model.c after fmi_model.h. */
#ifndef MCC_PARAMETERS_H
#define MCC_PARAMETERS_H

#include <math.h>
#include <string.h>

#include "el_extremes.h"
#include "fmu_period.h"

static double clocks(double seconds)
{
    return seconds * CLOCK_HZ;
}

static struct machine machine_of(const struct vars *v)
{
    struct machine m = { .dda_time = v->dda_time,
                         .dda_length = v->dda_length,
                         .queue_depth = v->queue_depth,
                         .feed = v->feed / 60.0,
                         .max_feed = v->max_feed / 60.0,
                         .arc_tolerance = v->arc_tolerance,
                         .acc_time = v->acc_time,
                         .dec_time = v->dec_time,
                         .acc_type = v->acc_type[0],
                         .dec_type = v->dec_type[0],
                         .jerk_share = v->jerk_share,
                         .limit_check = v->limit_mode >= 0,
                         .limit_mode = v->limit_mode < 0 ? 0 : v->limit_mode,
                         .inpos_mode = v->inpos_mode,
                         .inpos_settle = v->inpos_settle,
                         .inpos_timeout = v->inpos_timeout };
    for (int i = 0; i < AXES; i++) {
        m.axis[i] = (struct machine_axis){ .used = v->active[i],
                                           .pitch = v->lead[i],
                                           .gear_ratio = v->gear_ratio[i],
                                           .ppr = v->ppr[i],
                                           .rpm = v->max_rpm[i],
                                           .p_gain = v->p_gain[i],
                                           .inverted = v->pos2encoder_dir[i] == 1,
                                           .index_low = !v->index_on[i],
                                           .max_dda_acc = v->max_dda_acc[i],
                                           .check_ot = v->check_over_travel[i],
                                           .high_limit = v->high_limit[i],
                                           .low_limit = v->low_limit[i],
                                           .hot_offset = v->hot_offset[i],
                                           .lot_offset = v->lot_offset[i],
                                           .track_limit = v->track_error_limit[i],
                                           .in_pos = v->in_pos[i],
                                           .inpos_tol = v->inpos_tol[i],
                                           .acc = v->axis_acc[i],
                                           .jerk = v->axis_jerk[i] };
    }
    return m;
}

static int check_homing(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    const struct machine m = machine_of(v);
    bool any = false;

    for (int i = 0; i < AXES; i++) {
        const double safe = machine_axis_speed(&m.axis[i]);
        if (v->home_order[i] == 0) {
            continue;
        }
        any = true;
        if (!v->active[i]) {
            return fmu_fail(f, "home_order[%d] = %d: the axis is not active", i + 1,
                            (int)v->home_order[i]);
        }
        if (v->home_high_speed[i] > safe || v->home_low_speed[i] > safe) {
            return fmu_fail(f,
                            "home_high_speed[%d] = %g mm/s, home_low_speed[%d] = %g mm/s: "
                            "max_rpm is %g mm/s",
                            i + 1, v->home_high_speed[i], i + 1, v->home_low_speed[i], safe);
        }
    }
    return v->home_first && !any ? fmu_fail(f, "home_first: home_order names no axis") : 0;
}

static int check_protection(struct fmu *f)
{
    const struct machine machine = machine_of(&f->s.v);

    for (int i = 0; i < AXES; i++) {
        const struct machine_axis *a = &machine.axis[i];
        if (a->check_ot && machine_low(a) > machine_high(a)) {
            return fmu_fail(f,
                            "check_over_travel[%d]: the software limits leave no way, from %g "
                            "to %g mm",
                            i + 1, machine_low(a), machine_high(a));
        }
        if (a->max_dda_acc > 2 * machine_dda_limit(&machine)) {
            return fmu_fail(f, "max_dda_acc[%d] = %d: a change is at most %d pulses", i + 1,
                            (int)a->max_dda_acc, (int)(2 * machine_dda_limit(&machine)));
        }
    }
    return 0;
}

/* Parameters of the software control law need output_mode 2. */
static int check_law(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    const struct {
        const char *name;
        const double *value;
    } axis[] = { { "position_gain", v->position_gain },
                 { "velocity_ff", v->velocity_ff },
                 { "command_lag", v->command_lag } };
    const struct {
        const char *name;
        double value;
    } cross[] = { { "cross_gain", v->cross_gain },
                  { "cross_integral", v->cross_integral },
                  { "cross_derivative", v->cross_derivative } };
    int coupled = 0;

    for (int i = 0; i < AXES; i++) {
        for (size_t k = 0; k < sizeof axis / sizeof *axis; k++) {
            if (axis[k].value[i] > 0.0 && v->active[i] && v->output_mode[i] != 2) {
                return fmu_fail(f,
                                "%s[%d] = %g is of the software law: output_mode[%d] = %d, "
                                "2 is wanted",
                                axis[k].name, i + 1, axis[k].value[i], i + 1,
                                (int)v->output_mode[i]);
            }
        }
        coupled += i < 3 && v->active[i];
    }
    for (size_t k = 0; k < sizeof cross / sizeof *cross; k++) {
        for (int i = 0; i < 3 && cross[k].value > 0.0; i++) {
            if (v->active[i] && v->output_mode[i] != 2) {
                return fmu_fail(f,
                                "%s = %g couples X Y Z by the software law: output_mode[%d] = "
                                "%d, 2 is wanted",
                                cross[k].name, cross[k].value, i + 1, (int)v->output_mode[i]);
            }
        }
        if (cross[k].value > 0.0 && coupled < 2) {
            return fmu_fail(f, "%s = %g couples X Y Z: only %d of them active", cross[k].name,
                            cross[k].value, coupled);
        }
    }
    return 0;
}

static int check_parameters(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    const double bus = clocks(v->bus_period);

    if (!fmu_is_period(bus)) {
        return fmu_fail(f, "bus_period = %.17g s is not a whole number of %d ns clocks",
                        v->bus_period, CLOCK_NS);
    }
    const struct {
        const char *name;
        double value;
    } times[] = {
        { "start_delay", v->start_delay },
        { "irq_latency", v->irq_latency },
        { "irq_jitter", v->irq_jitter },
        { "service_time", v->service_time },
    };
    if (v->module_offset[PC_PCL] != 0.0) {
        return fmu_fail(f,
                        "module_offset[%d] = %g s: interrupts wake the position control, it has "
                        "no cycle",
                        PC_PCL + 1, v->module_offset[PC_PCL]);
    }
    for (size_t i = 0; i < sizeof times / sizeof *times; i++) {
        if (!(clocks(times[i].value) < FMU_TICKS_MAX)) {
            return fmu_fail(f, "%s = %g s is too long", times[i].name, times[i].value);
        }
    }
    if (v->min_stock + v->batch > PCL_FIFO) {
        return fmu_fail(f, "min_stock %d + batch %d: the FIFO of the card holds %d commands",
                        (int)v->min_stock, (int)v->batch, PCL_FIFO);
    }
    const struct {
        const char *name, *value;
    } types[] = { { "acc_type", v->acc_type }, { "dec_type", v->dec_type } };
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        if (strcmp(types[i].value, "T") && strcmp(types[i].value, "S")) {
            return fmu_fail(f, "%s = \"%s\" is neither T nor S", types[i].name, types[i].value);
        }
    }
    if (check_homing(f) || check_law(f)) {
        return -1;
    }
    if (v->feed > v->max_feed) {
        return fmu_fail(f, "feed %g mm/min is above max_feed %g mm/min", v->feed, v->max_feed);
    }
    return check_protection(f);
}

static void homing_of(const struct vars *v, struct pc_config *c)
{
    for (int i = 0; i < AXES; i++) {
        c->home[i] = (struct home_config){ .mode = (enum home_mode)v->home_mode[i],
                                           .direction = (uint32_t)v->home_dir[i],
                                           .sensor_on = v->home_sensor_on[i],
                                           .high_speed = v->home_high_speed[i],
                                           .low_speed = v->home_low_speed[i],
                                           .offset = v->home_offset[i],
                                           .search = v->home_search[i],
                                           .index_way = v->home_index_way[i] };
        c->home_order[i] = v->home_order[i];
    }
    c->home_first = v->home_first;
    c->home_settle = v->home_settle;
}

static struct law_config law_of(const struct vars *v)
{
    struct law_config c = { .cross_p = v->cross_gain,
                            .cross_i = v->cross_integral,
                            .cross_d = v->cross_derivative };

    for (int i = 0; i < AXES; i++) {
        const double volts = 60.0 / (v->ppr[i] * v->speed_per_volt[i]);
        c.axis[i] = (struct law_axis){ .gain = v->position_gain[i] * volts,
                                       .volts = volts,
                                       .feed_forward = v->velocity_ff[i],
                                       .lag = v->command_lag[i] };
    }
    return c;
}

/* A cycle in clocks; one that is not 0 has at least one clock. */
static int64_t cycle_of(double seconds)
{
    return seconds > 0.0 ? (int64_t)llround(el_max(1.0, clocks(seconds))) : 0;
}

static struct pc_config config_of(const struct vars *v)
{
    struct pc_config c = { .bus = (int64_t)round(clocks(v->bus_period)),
                           .ipo = (int64_t)round(clocks(v->ipo_period)),
                           .ipo_event = v->ipo_event,
                           .interpreter = cycle_of(v->interpreter_period),
                           .process = cycle_of(v->process_period),
                           .start = (int64_t)ceil(clocks(v->start_delay) - FMU_PERIOD_TOLERANCE),
                           .latency = clocks(v->irq_latency),
                           .jitter = clocks(v->irq_jitter),
                           .seed = v->seed,
                           .min_stock = v->min_stock,
                           .batch = v->batch,
                           .block_delete = v->block_delete,
                           .optional_stop = v->optional_stop,
                           .wait_start = !v->auto_start,
                           .dry_run = v->dry_run,
                           .law = law_of(v) };
    for (int i = 0; i < PC_MODULES; i++) {
        c.priority[i] = v->module_priority[i];
        c.offset[i] = (int64_t)llround(clocks(v->module_offset[i]));
        c.time[i] = (int64_t)llround(clocks(v->module_time[i]));
        c.unit[i] = (int64_t)llround(clocks(v->module_unit_time[i]));
        c.most[i] = v->module_units[i];
    }
    c.isr.service = (int64_t)llround(clocks(v->service_time));
    memcpy(c.isr.mask, v->irq_sources, sizeof c.isr.mask);
    memcpy(c.isr.priority, v->irq_priority, sizeof c.isr.priority);
    memcpy(c.output_mode, v->output_mode, sizeof c.output_mode);
    homing_of(v, &c);
    return c;
}

#endif
