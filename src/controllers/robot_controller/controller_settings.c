#include "controller_settings.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

static const double DEGREE = 0.017453292519943295;

static const char NOT_THERE[] = "not 0, of a joint that the arm has not";

/* A period may differ from whole clocks by so much. [clocks] */
static const double ROUNDING = 1e-6;

static void fill(double to[OPW_JOINTS], const double from[OPW_JOINTS])
{
    memcpy(to, from, OPW_JOINTS * sizeof *to);
}

struct controller_settings controller_defaults(void)
{
    static const double ZONE[ROBOT_JOB_LEVELS + 1] = { 0.0, 0.5,  1.0,  2.0, 4.0,
                                                       8.0, 16.0, 32.0, 64.0 };
    struct controller_settings s;

#define START(type, name, elements, unit, start, low, high) \
    for (size_t i = 0; i < sizeof s.name / sizeof(type); i++) { \
        ((type *)&s.name)[i] = start; \
    }
    CONTROLLER_SETTINGS(START)
    fill(s.joint_offset, (const double[]){ 0.0, 0.0, -90.0, 0.0, 0.0, 0.0 });
    fill(s.joint_low, (const double[]){ -180.0, -155.0, -155.0, -400.0, -120.0, -400.0 });
    fill(s.joint_high, (const double[]){ 180.0, 95.0, 75.0, 400.0, 120.0, 400.0 });
    fill(s.joint_speed, (const double[]){ 175.0, 175.0, 175.0, 300.0, 300.0, 375.0 });
    fill(s.joint_acc, (const double[]){ 500.0, 500.0, 500.0, 1000.0, 1000.0, 1500.0 });
    fill(s.gear_ratio, (const double[]){ 100.0, 120.0, 120.0, 100.0, 100.0, 80.0 });
    s.start_joint[4] = 90.0;
    s.external_direction[0] = 1.0;
    memcpy(s.zone, ZONE, sizeof s.zone);
    return s;
}

static bool within(struct controller_wrong *w, const char *name, int32_t index, double value,
                   double low, double high)
{
    *w = (struct controller_wrong){ name, NULL, index, value, low, high };
    return value >= low && value <= high;
}

static bool refuse(struct controller_wrong *w, const char *name, int32_t index, double value,
                   const char *why)
{
    *w = (struct controller_wrong){ name, why, index, value, value, value };
    return false;
}

/* The arm by its axes: origins and axes at zero, flange behind the last joint. The hand of a
 * palletizer turns with joint 1 alone, so its offset may as well be one of axis 2. */
static struct chain axes_of(const struct controller_settings *s)
{
    const struct pose flange = pose_of(s->flange, s->flange + 3);
    struct chain c = { .joints = s->joints };

    for (int i = 0; i < s->joints; i++) {
        const double *way = s->axis_origin + 3 * i, *axis = s->axis_direction + 3 * i;
        const double length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
        for (int k = 0; k < 3; k++) {
            c.joint[i].origin[k] = way[k];
            c.joint[i].axis[k] = axis[k] / length;
        }
        c.joint[i].slides = s->joint_slides[i] == 1;
        c.joint[i].level = s->joint_level[i];
    }
    for (int k = 0; k < 3; k++) {
        c.joint[1].origin[k] += s->hand_offset[k];
        c.flange.at[k] = 1e-3 * flange.at[k];
    }
    quaternion_matrix(flange.turn, c.flange.turn);
    return c;
}

/* Whether an arm by its axes is one that the controller moves.
 * CCN 18: a refusal for each number that fits no arm. */
static bool axes_good(const struct controller_settings *s, struct controller_wrong *wrong)
{
    for (int i = 0; i < s->joints; i++) {
        const double *axis = s->axis_direction + 3 * i;
        if (axis[0] == 0.0 && axis[1] == 0.0 && axis[2] == 0.0) {
            return refuse(wrong, "axis_direction", 3 * i, 0.0, "an axis without direction");
        }
        if (s->joint_sign[i] != 1) {
            return refuse(wrong, "joint_sign", i, s->joint_sign[i],
                          "1 is wanted, as axis_direction has the sign");
        }
        if (s->joint_level[i] > i) {
            return refuse(wrong, "joint_level", i, s->joint_level[i], "more than joints before it");
        }
        if (s->joint_level[i] > 0 && s->joints == OPW_JOINTS) {
            return refuse(wrong, "joint_level", i, s->joint_level[i],
                          "no palletizer of four joints");
        }
    }
    for (int k = 0; k < 3; k++) {
        if (s->hand_offset[k] != 0.0 && !(s->joints == 4 && s->joint_level[3] == 2)) {
            return refuse(wrong, "hand_offset", k, s->hand_offset[k],
                          "no hand that joint_level[4] = 2 keeps level");
        }
    }
    for (int i = s->joints; i < OPW_JOINTS; i++) {
        if (s->start_joint[i] != 0.0) {
            return refuse(wrong, "start_joint", i, s->start_joint[i], NOT_THERE);
        }
    }
    const struct chain axes = axes_of(s);
    struct chain_form form;
    chain_form_of(&axes, CHAIN_NONE, &form);
    if (s->joints < OPW_JOINTS && form.kind == CHAIN_ITERATED) {
        return refuse(wrong, "joints", 0, s->joints, "no SCARA, no palletizer, no gantry");
    }
    return s->singular != ROBOT_WRIST
           || refuse(wrong, "singular", 0, s->singular, "not of an arm by its axes");
}

/* Whether there can be such an axis outside the arm. */
static bool external_good(const struct controller_settings *s, struct controller_wrong *wrong)
{
    const double *d = s->external_direction;

    if (!(s->external_low < s->external_high)) {
        return refuse(wrong, "external_low", 0, s->external_low, "not below external_high");
    }
    return d[0] != 0.0 || d[1] != 0.0 || d[2] != 0.0
           || refuse(wrong, "external_direction", 0, 0.0, "no direction");
}

bool controller_settings_good(const struct controller_settings *s, struct controller_wrong *wrong)
{
    const double clocks = s->bus_period * FPGA_CLOCK_HZ;

#define WITHIN(type, name, elements, unit, start, low, high) \
    for (size_t i = 0; i < sizeof s->name / sizeof(type); i++) { \
        if (!within(wrong, #name, (int32_t)i, (double)((const type *)&s->name)[i], low, high)) { \
            return false; \
        } \
    }
    CONTROLLER_SETTINGS(WITHIN)
    if (fabs(clocks - round(clocks)) > ROUNDING) {
        return refuse(wrong, "bus_period", 0, s->bus_period, "not a whole number of 25 ns clocks");
    }
    for (int i = 0; i < OPW_JOINTS; i++) {
        if (s->joint_sign[i] == 0) {
            return refuse(wrong, "joint_sign", i, 0.0, "1 or -1 is wanted");
        }
        if (!(s->joint_low[i] < s->joint_high[i])) {
            return refuse(wrong, "joint_low", i, s->joint_low[i], "not below joint_high");
        }
    }
    if (s->arm_by == 1 && !axes_good(s, wrong)) {
        return false;
    }
    if (s->external != EXTERNAL_NONE && !external_good(s, wrong)) {
        return false;
    }
    if (s->arm_by == 0 && s->joints != OPW_JOINTS) {
        return refuse(wrong, "joints", 0, s->joints, "6 is wanted of an arm by its lengths");
    }
    return fpga_slot_most((enum fpga_format)s->pulse_format, s->slot_clocks) >= 1
           || refuse(wrong, "slot_clocks", 0, s->slot_clocks, "too short for a pulse");
}

static int64_t clocks_of(double seconds)
{
    return llround(seconds * FPGA_CLOCK_HZ);
}

static void set_robot(const struct controller_settings *s, struct robot_config *r)
{
    *r = (struct robot_config){ .arm = { .opw = { .a1 = s->a1,
                                                  .a2 = s->a2,
                                                  .b = s->b,
                                                  .c1 = s->c1,
                                                  .c2 = s->c2,
                                                  .c3 = s->c3,
                                                  .c4 = s->c4 },
                                         .tool = pose_of(s->tool, s->tool + 3) },
                                .feed = s->max_feed / 60.0,
                                .acc = s->acceleration,
                                .spin = s->max_spin * DEGREE,
                                .smooth = s->smooth_time,
                                .flow = s->flow,
                                .cycle = (double)s->slots * s->slot_clocks / FPGA_CLOCK_HZ,
                                .slot = (double)s->slot_clocks / FPGA_CLOCK_HZ,
                                .slot_pulses = fpga_slot_most((enum fpga_format)s->pulse_format,
                                                              s->slot_clocks) };
    if (s->arm_by == 1) {
        const struct chain axes = axes_of(s);
        chain_form_of(&axes, CHAIN_NONE, &r->arm.axes);
        r->arm.by_axes = true;
    }
    for (int i = 0; i < OPW_JOINTS; i++) {
        const double unit = manipulator_unit(&r->arm, i);
        r->arm.opw.offset[i] = s->joint_offset[i] * DEGREE;
        r->arm.opw.sign[i] = s->joint_sign[i];
        r->arm.joint[i] =
            (struct manipulator_joint){ s->joint_low[i] * unit, s->joint_high[i] * unit,
                                        s->joint_speed[i] * unit, s->joint_acc[i] * unit };
        r->scale[i] = s->gear_ratio[i] * s->pulses_per_turn[i] / (360.0 * DEGREE);
    }
}

static void set_external(const struct controller_settings *s, struct external *e)
{
    const double *d = s->external_direction;
    const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);

    e->kind = (enum external_kind)s->external;
    const double unit = external_unit(e);
    e->low = s->external_low * unit;
    e->high = s->external_high * unit;
    e->speed = s->external_speed * unit;
    e->acc = s->external_acc * unit;
    e->scale = s->external_gear * s->external_pulses / (360.0 * DEGREE);
    for (int i = 0; i < 3 && e->kind == EXTERNAL_TRACK; i++) {
        e->along[i] = d[i] / length;
    }
}

static void set_orders(const struct controller_settings *s, struct orders_config *o)
{
    *o = (struct orders_config){
        .start = { .vj = 100.0 * s->rapid, .v = s->feed / 60.0, .vr = s->max_spin },
        .rapid = s->rapid,
        .feed = s->feed / 60.0,
        .feed_most = s->max_feed / 60.0,
        .block_delete = s->block_delete,
        .optional_stop = s->optional_stop,
        .tool_stop = s->tool_stop,
        .singular = (enum robot_singular)s->singular,
        .lines = 1000
    };
    memcpy(o->zone, s->zone, sizeof o->zone);
    memcpy(o->origin[0], s->origin, sizeof o->origin[0]);
}

static void set_layers(const struct controller_settings *s, struct layers_config *l)
{
    l->interrupt =
        (struct latency){ s->irq_latency * FPGA_CLOCK_HZ, s->irq_mean * FPGA_CLOCK_HZ,
                          el_max(s->irq_longest, s->irq_latency) * FPGA_CLOCK_HZ, s->irq_rare };
    l->access = clocks_of(s->access_time);
    l->tick = clocks_of(s->timer_period);
    l->poll = clocks_of(s->poll_period);
    l->quantum = clocks_of(s->quantum);
    l->crowded = s->crowded;
    l->follow[LAYER_INTERRUPT] = (uint32_t)s->follow_interrupt;
    l->follow[LAYER_DRIVER] = (uint32_t)s->follow_driver;
    l->follow[LAYER_TIMER] = (uint32_t)s->follow_timer;
    l->follow[LAYER_USER] = (uint32_t)s->follow_user;
}

void controller_configure(const struct controller_settings *s, struct controller_config *c)
{
    memset(c, 0, sizeof *c);
    c->bus = clocks_of(s->bus_period);
    c->slot = s->slot_clocks;
    c->slots = s->slots;
    c->format = (enum fpga_format)s->pulse_format;
    c->copy_in = clocks_of(s->bus_bytes_in / s->bus_read_rate);
    c->copy_out = clocks_of(s->bus_bytes_out / s->bus_write_rate);
    c->line = clocks_of(s->line_time);
    c->point = clocks_of(s->ik_time);
    c->pitch = s->pitch;
    c->lines = s->lines;
    c->user = s->program_layer == 1;
    c->depth = s->queue_depth;
    c->start = clocks_of(s->start_delay);
    c->seed = s->seed;
    for (int i = 0; i < OPW_JOINTS; i++) {
        c->servo |= (uint32_t)s->servo[i] << i;
    }
    set_layers(s, &c->layers);
    set_robot(s, &c->robot);
    set_external(s, &c->robot.external);
    set_orders(s, &c->orders);
    c->orders.external = c->robot.external;
    if (c->robot.external.kind != EXTERNAL_NONE) {
        c->zero_external = s->external_start * external_unit(&c->robot.external);
        c->servo |= 1u << FPGA_AXES;
    }
    for (int i = 0; i < OPW_JOINTS; i++) {
        c->zero[i] = s->start_joint[i] * manipulator_unit(&c->robot.arm, i);
        c->orders.slides[i] = manipulator_slides(&c->robot.arm, i);
    }
    memcpy(c->orders.pulses, c->robot.scale, sizeof c->orders.pulses);
}
