/* controller_pc - for the tests: the robot controller on its PC, with an ideal card that plays
 * every memory in time. */
#ifndef CONTROLLER_PC_H
#define CONTROLLER_PC_H

#include <string.h>

#include "check.h"
#include "controller.h"

static const double DEGREE = 0.017453292519943295, CYCLE = 1e-4;

static const char POINTS[] = "TOOL 1 X=0 Y=0 Z=150 A=0 B=0 C=0\n"
                             "USER 2 X=900 Y=-300 Z=200 A=0 B=0 C=90\n"
                             "P000 J1=0 J2=-20 J3=10 J4=0 J5=90 J6=0\n"
                             "P001 X=900 Y=0 Z=350 A=180 B=0 C=180 FRONT UP NOFLIP TOOL=1\n"
                             "P002 X=1000 Y=100 Z=350 A=180 B=0 C=180 TOOL=1\n"
                             "P003 X=1100 Y=0 Z=350 A=180 B=0 C=180 TOOL=1\n"
                             "P004 X=300 Y=-200 Z=150 A=180 B=0 C=90 TOOL=1 USER=2\n"
                             "P005 X=900 Y=0 Z=350 A=180 B=0 C=180 FRONT UP TOOL=1\n"
                             "P006 X=900 Y=0 Z=350 A=180 B=0 C=180 FLIP TOOL=1\n"
                             "P007 X=900 Y=0 Z=350 A=180 B=0 C=180 TURN4=0 TOOL=1\n"
                             "P008 X=5000 Y=0 Z=350 A=180 B=0 C=180 TOOL=1\n"
                             "P009 X=900 Y=0 Z=350 A=180 B=0 C=170 TURN4=0 TOOL=1\n"
                             "P010 X=1180 Y=0 Z=1110 A=0 B=90 C=0 TOOL=1\n"
                             "P011 X=1180 Y=0 Z=1410 A=0 B=90 C=0 TOOL=1\n"
                             "P012 X=1180 Y=0 Z=1110 A=0 B=90 C=0 FRONT UP TOOL=1\n";

static struct controller controller;
static struct controller_config config;
static struct orders_text text;
static struct controller_panel panel;
static struct fpga_shown card;
static struct fpga_host host;
static struct robot_job_program jobs;
static struct robot_job_points points;
static struct source_text given;
static struct source source;
static int64_t now;                /* [clocks] */
static double fastest[OPW_JOINTS]; /* [rad/s] highest speed of each joint since it was set to 0 */

static inline struct controller_config pc_config(void)
{
    static const double high[] = { 180, 95, 75, 400, 120, 400 };
    static const double low[] = { -180, -155, -155, -400, -120, -400 };
    static const double speed[] = { 175, 175, 175, 300, 300, 375 };
    static const double acc[] = { 500, 500, 500, 1000, 1000, 1500 };
    static const double ratio[] = { 100, 120, 120, 100, 100, 80 };
    static const double zero[] = { 0, 0, 0, 0, 90, 0 };
    struct controller_config c = {
        .bus = 2000, .slot = 200, .slots = 20, .pitch = 0.1, .lines = 4, .depth = 32, .seed = 1
    };
    c.layers = (struct layers_config){ .access = 40, .tick = 400000, .poll = 40000 };
    c.robot = (struct robot_config){ .feed = 3000.0,
                                     .acc = 1000.0,
                                     .spin = 180.0 * DEGREE,
                                     .cycle = CYCLE,
                                     .slot = 5e-6,
                                     .slot_pulses = 49.0 };
    c.robot.arm.opw = (struct opw){ 0.150,
                                    -0.115,
                                    0.0,
                                    0.445,
                                    0.700,
                                    0.795,
                                    0.085,
                                    { 0, 0, -90.0 * DEGREE },
                                    { 1, 1, 1, 1, 1, 1 } };
    c.robot.arm.tool = pose_none();
    for (int i = 0; i < OPW_JOINTS; i++) {
        c.robot.arm.joint[i] = (struct manipulator_joint){ low[i] * DEGREE, high[i] * DEGREE,
                                                           speed[i] * DEGREE, acc[i] * DEGREE };
        c.robot.scale[i] = 2500.0 * ratio[i] / (360.0 * DEGREE);
        c.zero[i] = zero[i] * DEGREE;
    }
    c.orders = (struct orders_config){ .start = { .vj = 50.0, .v = 100.0, .vr = 90.0 },
                                       .zone = { 0.0, 0.5, 1, 2, 4, 8, 16, 32, 64 },
                                       .rapid = 0.5,
                                       .feed = 10.0,
                                       .feed_most = 3000.0,
                                       .block_delete = true,
                                       .lines = 1000 };
    return c;
}

static inline void pc_start(const char *job, const char *gcode)
{
    struct robot_job_report r;

    text = (struct orders_text){ .points = &points };
    CHECK_EQ(robot_job_points_read(&points, ROBOT_JOB_NO_AXIS, POINTS, (int64_t)strlen(POINTS), &r),
             0);
    if (job) {
        CHECK_EQ(robot_job_read(&jobs, &points, job, (int64_t)strlen(job), &r), 0);
        text.job = &jobs;
    }
    if (gcode) {
        given = (struct source_text){ gcode, (int64_t)strlen(gcode) };
        source = source_of(&given);
        text.gcode = &source;
    }
    memset(&card, 0, sizeof card);
    memset(&host, 0, sizeof host);
    panel = (struct controller_panel){ .override = 1.0, .jog_speed = 0.1 };
    card.memory = -1;
    now = 0;
    controller_start(&controller, &config);
}

/* Play the memory that the driver wrote last. */
static inline void pc_play(void)
{
    for (int n = 0; n < host.write_slots && !card.stopped; n++) {
        int32_t pulses[FPGA_SLOT_AXES];
        CHECK_EQ(fpga_slot_unpack(&host.write_words[n * FPGA_SLOT_WORDS], FPGA_COUNTS, 49, pulses),
                 -1);
        for (int i = 0; i < FPGA_AXES; i++) {
            card.pulse_count[i] += pulses[i];
        }
    }
}

/* The time of one memory: the interrupt, the driver's run, the pulses of the card. */
static inline void pc_cycle(void)
{
    card.irq_seq++;
    card.irq_clock = (double)now;
    for (int k = 0; k < 2; k++, now += config.bus) {
        controller_instant(&controller, &config, &text, &card, &panel, now);
        controller_post(&controller, &config, &host);
        for (int n = 0; host.out_count > 0 && n < host.out_count; n++) {
            card.inputs = (card.inputs & ~host.out_mask[n]) | host.out_value[n];
        }
    }
    pc_play();
    card.memory = host.write_memory;
    for (int i = 0; i < OPW_JOINTS; i++) {
        const double pulses = controller.robot.joint[i] * config.robot.scale[i]
                              - config.zero[i] * config.robot.scale[i];
        CHECK(card.stopped || fabs(pulses - card.pulse_count[i]) <= 1.0 + 1e-6);
        fastest[i] = fmax(fastest[i], fabs(controller.robot.rate[i]));
    }
}

static inline void pc_run(int cycles)
{
    for (int n = 0; n < cycles; n++) {
        pc_cycle();
    }
}

/* Run until the controller has a status, for 60 s at most. */
static inline void pc_until(enum controller_status status)
{
    for (int n = 0; n < 600000 && controller_status(&controller, &panel) != status; n++) {
        pc_cycle();
    }
    CHECK_EQ(controller_status(&controller, &panel), status);
}

static inline void pc_press(bool *key)
{
    *key = true;
    pc_cycle();
    *key = false;
    pc_cycle();
}

static inline void pc_at(double x, double y, double z, double tolerance)
{
    CHECK_NEAR(controller.robot.pose.at[0], x, tolerance);
    CHECK_NEAR(controller.robot.pose.at[1], y, tolerance);
    CHECK_NEAR(controller.robot.pose.at[2], z, tolerance);
}

/* Angle between the tool's orientation and that of A B C [deg]. */
static inline double pc_off(double a, double b, double c)
{
    double want[4], back[4], v[3];
    quaternion_by_angles((double[]){ a, b, c }, want);
    quaternion_inverse(controller.robot.pose.turn, back);
    quaternion_product(want, back, want);
    quaternion_vector(want, v);
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) / DEGREE;
}

#endif
