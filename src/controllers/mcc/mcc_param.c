#include "mcc.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

MCC_MACH_PARAM mcc_param_of(const struct machine_axis *a)
{
    return (MCC_MACH_PARAM){ .type = a->used ? MCC_LINEAR : MCC_UNUSED,
                             .pos2encoder_dir = a->inverted,
                             .PPR = a->ppr,
                             .RPM = a->rpm,
                             .pitch = a->pitch,
                             .gear_ratio = a->gear_ratio,
                             .high_limit = a->high_limit,
                             .low_limit = a->low_limit,
                             .HOT_offset = a->hot_offset,
                             .LOT_offset = a->lot_offset,
                             .index_on = !a->index_low };
}

static bool bit(int32_t x)
{
    return x == 0 || x == 1;
}

/* True if the parameters are valid that machine_valid does not look at. */
static bool valid(const MCC_MACH_PARAM *p)
{
    return p->type >= MCC_LINEAR && p->type <= MCC_UNUSED && bit(p->pos2encoder_dir)
           && isfinite(p->high_limit) && isfinite(p->low_limit) && p->low_limit <= p->high_limit
           && isfinite(p->HOT_offset) && isfinite(p->LOT_offset) && bit(p->sensor_on)
           && bit(p->index_on) && p->home_dir >= 0 && p->home_dir <= 7;
}

static void set_axis(struct machine_axis *a, const MCC_MACH_PARAM *p)
{
    a->used = p->type == MCC_LINEAR || p->type == MCC_ROTARY;
    a->inverted = p->pos2encoder_dir == 1;
    a->ppr = p->PPR;
    a->rpm = p->RPM;
    a->pitch = p->pitch;
    a->gear_ratio = p->gear_ratio;
    a->high_limit = p->high_limit;
    a->low_limit = p->low_limit;
    a->hot_offset = p->HOT_offset;
    a->lot_offset = p->LOT_offset;
    a->index_low = p->index_on == 0;
}

/* *w becomes the machine with the user's parameters; MCC_PARAMETER if they are not valid. */
static int wanted(const struct mcc *m, struct machine *w)
{
    *w = m->machine;
    w->max_feed = m->cart_max_speed;
    for (int i = 0; i < AXES; i++) {
        if (!valid(&m->epcio_axis_param[i])) {
            return MCC_PARAMETER;
        }
        set_axis(&w->axis[i], &m->epcio_axis_param[i]);
        const struct home_config *h = &m->homing.axis[i].config;
        if (el_max(h->high_speed, h->low_speed) > machine_axis_speed(&w->axis[i])) {
            return MCC_PARAMETER;
        }
    }
    if (m->feed > w->max_feed) {
        return MCC_FEED_RATE;
    }
    w->feed = el_min(w->feed, w->max_feed);
    return machine_valid(w) ? MCC_NO_ERR : MCC_PARAMETER;
}

void mcc_param_home(struct mcc *m, int axis)
{
    const struct home_config *c = &m->homing.axis[axis].config;
    m->epcio_axis_param[axis].home_dir = (int32_t)c->direction;
    m->epcio_axis_param[axis].sensor_on = c->sensor_on;
}

/* Adapt the homing of an axis to new parameters: its offset is again in whole pulses, and its
 * encoder counts the other way if the axis has turned. */
static void set_homing(struct homing_axis *x, const MCC_MACH_PARAM *p, bool turned,
                       const struct machine_axis *a)
{
    const double scale = machine_pulses_per_mm(a);

    x->config.direction = (uint32_t)p->home_dir;
    x->config.sensor_on = p->sensor_on == 1;
    x->config.offset = round(x->config.offset * scale) / scale;
    if (turned) {
        x->zero = (int32_t)(0u - (uint32_t)x->zero);
    }
}

/* Keep an axis where it stands: it has got as many pulses as before, with their sign turned if its
 * direction has; its position in mm follows from them. */
static void keep_place(struct mcc *m, int i, const struct machine_axis *new)
{
    const struct machine_axis *old = &m->machine.axis[i];
    double place = m->trajectory.rest[i];

    if (new->inverted != old->inverted) {
        m->trajectory.pulses[i] = -m->trajectory.pulses[i];
        m->protection.base[i] = -m->protection.base[i];
        place = -place;
        m->comp[i] = (struct comp){ -m->comp[i].added, !m->comp[i].backward };
    }
    if (machine_pulses_per_mm(new) != machine_pulses_per_mm(old)) {
        place = m->trajectory.pulses[i] / machine_pulses_per_mm(new);
    }
    m->trajectory.rest[i] = m->end[i] = m->written.place[i] = place;
    m->written.pulses[i] = m->trajectory.pulses[i];
    m->written.added[i] = m->comp[i].added;
}

int MCC_update_param(struct mcc *m)
{
    struct machine w;

    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (!MCC_check_stop(m)) {
        return MCC_COMMAND_NOTFINISHED;
    }
    if (m->dry_run) {
        return MCC_COMMAND_NOTACCEPTED;
    }
    const int code = wanted(m, &w);
    if (code) {
        return code;
    }
    for (int i = 0; i < AXES; i++) {
        keep_place(m, i, &w.axis[i]);
        set_homing(&m->homing.axis[i], &m->epcio_axis_param[i],
                   w.axis[i].inverted != m->machine.axis[i].inverted, &w.axis[i]);
    }
    signals_turn(&m->signals, &m->machine);
    signals_turn(&m->signals, &w);
    m->machine = w;
    m->curve_plan.limits = machine_speed_limits(&w);
    return MCC_NO_ERR;
}

int MCC_set_comp(struct mcc *m, int axis, const struct comp_table *table)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (!control_rests(m)) {
        return MCC_COMMAND_NOTFINISHED;
    }
    if (axis < 0 || axis >= AXES || !m->machine.axis[axis].used || !comp_valid(table)) {
        return MCC_PARAMETER;
    }
    m->comp_table[axis] = *table;
    return MCC_NO_ERR;
}
