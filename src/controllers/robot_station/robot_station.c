#include "robot_station.h"

#include <math.h>
#include <string.h>

struct robot_station_config robot_station_defaults(void)
{
    return (struct robot_station_config){
        .controller = controller_defaults(),
        .card = { .irq_every = 4000, .alarm_stops = true, .stop_servo_off = true }
    };
}

bool robot_station_start(struct robot_station *s, const struct robot_station_config *config,
                         struct controller_wrong *wrong)
{
    struct fpga_config card = config->card;

    if (!controller_settings_good(&config->controller, wrong)) {
        return false;
    }
    card.slot_clocks = config->controller.slot_clocks;
    card.format = (enum fpga_format)config->controller.pulse_format;
    if (card.irq_every < 1 || card.irq_every > INT32_MAX || card.irq_every % card.slot_clocks) {
        const double slot = (double)card.slot_clocks / FPGA_CLOCK_HZ; /* [s], as it is given */
        *wrong = (struct controller_wrong){ .name = "irq_every",
                                            .why = "not a whole number of slots",
                                            .value = (double)card.irq_every / FPGA_CLOCK_HZ,
                                            .low = slot,
                                            .high = slot };
        return false;
    }
    memset(s, 0, sizeof *s);
    controller_configure(&config->controller, &s->config);
    s->config.start = INT64_MAX; /* by its key only */
    s->panel = (struct controller_panel){ .override = 1.0, .jog_speed = 0.1 };
    s->tool = s->config.robot.arm.tool;
    controller_start(&s->controller, &s->config);
    fpga_reset(&s->card, &card);
    return true;
}

static void pins(struct robot_station *s)
{
    const uint32_t ready = (1u << FPGA_AXES) - 1;
    const uint32_t drives = ready | s->alarm << 8;
    uint32_t changed = fpga_inputs_changed(&s->card, s->inputs);

    for (int i = 0; changed; i++, changed >>= 1) {
        if (changed & 1) {
            fpga_change_input(&s->card, i, 0);
        }
    }
    if (s->card.drive_pins != drives || s->card.emergency != s->emergency) {
        fpga_set_drives(&s->card, drives, s->emergency);
    }
    if (memcmp(s->ai_seen, s->ai, sizeof s->ai) != 0) {
        memcpy(s->ai_seen, s->ai, sizeof s->ai);
        fpga_set_ai(&s->card, s->ai);
    }
}

/* A jog by an increment has come to its end. */
static void end_jog(struct robot_station *s)
{
    if (s->panel.jog_way > 0.0 && robot_idle(&s->controller.robot)) {
        memset(s->panel.jog, 0, sizeof s->panel.jog);
    }
}

/* One instant of the bus grid: the PC sees the card as it is, the card gets what the PC has worked
 * out from what it saw one instant before. */
static void instant(struct robot_station *s, const struct orders_text *program)
{
    static const struct orders_text NONE;
    struct fpga_shown shown;

    fpga_show(&s->card, &shown);
    controller_post(&s->controller, &s->config, &s->host);
    fpga_take(&s->taken, &s->card, &s->host);
    pins(s);
    controller_instant(&s->controller, &s->config, program ? program : &NONE, &shown, &s->panel,
                       s->instant);
    end_jog(s);
    s->instant += s->config.bus;
}

void robot_station_run(struct robot_station *s, int64_t until, const struct orders_text *program)
{
    while (s->instant < until) {
        fpga_advance(&s->card, s->instant);
        s->clock = s->instant;
        instant(s, program);
    }
    if (until > s->clock) {
        fpga_advance(&s->card, until);
        s->clock = until;
    }
}

void robot_station_pose(const struct pose *pose, double value[6])
{
    memcpy(value, pose->at, sizeof pose->at);
    quaternion_angles(pose->turn, value + 3);
}

void robot_station_read(const struct robot_station *s, struct robot_station_reading *r)
{
    const struct controller *controller = &s->controller;
    struct manipulator arm = s->config.robot.arm;
    double joint[OPW_JOINTS];
    int32_t due = 0;

    memset(r, 0, sizeof *r);
    int64_t pulses[FPGA_PLAYED];
    fpga_pulses(&s->card, pulses);
    memcpy(r->pulses, pulses, sizeof r->pulses);
    for (int i = 0; i < OPW_JOINTS; i++) {
        const double scale = s->config.robot.scale[i], at = controller->origin[i];
        joint[i] = (at + (double)r->pulses[i]) / scale;
        const double unit = manipulator_unit(&arm, i);
        r->joint[i] = joint[i] / unit;
        r->joint_command[i] = controller->joint[i] / unit;
        due += (double)llround(controller->joint[i] * scale) != at + (double)r->pulses[i];
    }
    const struct external *e = &s->config.robot.external;
    const double count = controller->external_origin + (double)pulses[FPGA_AXES];
    const double external = e->kind != EXTERNAL_NONE ? count / e->scale : 0.0;
    due += (double)llround(controller->external * e->scale) != count;
    r->external = external / external_unit(e);
    r->external_command = controller->external / external_unit(e);
    external_to_world(e, controller->external, r->base_command);
    arm.tool = controller->robot.tool;
    struct pose pose = manipulator_pose(&arm, joint);
    external_to_world(e, external, pose.at);
    robot_station_pose(&pose, r->pose);
    robot_station_pose(&controller->robot.pose, r->pose_command);
    r->configuration = manipulator_factors(&arm, joint, r->factors);
    r->factors[0] *= 1e3;
    r->status = controller_status(controller, &s->panel);
    r->line = controller->robot.line > 0
                  ? controller->move_line[controller->robot.line % CONTROLLER_MOVES]
                  : 0;
    r->done = controller_done(controller);
    r->rests = controller->stopped
               || (!controller_running(controller) && controller->replaying < 0 && !controller->jogs
                   && !controller->output_count && !controller->start.pressed
                   && robot_idle(&controller->robot) && due == 0);
}

void robot_station_rehearse(const struct robot_station *s, const struct orders_text *program,
                            struct controller *trial)
{
    struct controller_config c = s->config;

    memcpy(c.zero, s->controller.robot.joint, sizeof c.zero);
    c.zero_external = s->controller.robot.external;
    controller_start(trial, &c);
    controller_rehearse(trial, &c, program);
}
