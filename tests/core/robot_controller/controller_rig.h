/* controller_rig - for the tests: the driver and a card, which exchange their link at the instants
 * of a common grid. */
#ifndef CONTROLLER_RIG_H
#define CONTROLLER_RIG_H

#include "check.h"
#include "fpga.h"
#include "robot_rig.h"
#include "controller.h"

enum { SLOT = 200, SLOTS = 20, INTERVAL = SLOT * SLOTS };

/* Times of the source document [clocks]: 0.5 us, 1 KB and 3 KB at 133 MB/s, 1 us per register, 36
 * us per point. */
enum {
    WAIT = 20,
    COPY_IN = 308,
    COPY_OUT = 924,
    ACCESS = 40,
    POINT = 1440,
    RUN = WAIT + COPY_IN + COPY_OUT
};

static struct fpga card;
static struct controller controller;
static struct controller_config config;
static struct controller_panel panel;
static struct orders_text text;
static struct robot_job_points points;
static struct robot_job_program program;
static int64_t now;

static struct fpga_host host;
static int32_t write_seq, out_seq, reset_seq;

/* Set up a controller at rest without a program; then change `config` and call rig_power_on(). */
static inline void rig_document(void)
{
    config = (struct controller_config){
        .bus = 100,
        .slot = SLOT,
        .slots = SLOTS,
        .copy_in = COPY_IN,
        .copy_out = COPY_OUT,
        .point = POINT,
        .pitch = 0.1,
        .lines = 4,
        .depth = 32,
        .servo = 0x3f,
        .seed = 1,
        .robot = rig_config(),
        .layers = { .interrupt = { .least = WAIT, .most = WAIT },
                    .access = ACCESS,
                    .tick = 400000,
                    .poll = 1440000,
                    .quantum = 1440000 },
        .orders = { .start = { .vj = 50.0, .v = 100.0, .vr = 90.0 }, .rapid = 0.5, .lines = 1000 },
    };
    config.zero[4] = 90.0 * DEGREE;
    text = (struct orders_text){ 0 };
    panel = (struct controller_panel){ .override = 1.0, .jog_speed = 0.1 };
}

static inline void rig_program(const char *job, const char *of_points)
{
    struct robot_job_report report;

    CHECK_EQ(robot_job_points_read(&points, ROBOT_JOB_NO_AXIS, of_points,
                                   (int64_t)strlen(of_points), &report),
             0);
    CHECK_EQ(robot_job_read(&program, &points, job, (int64_t)strlen(job), &report), 0);
    text.job = &program;
    text.points = &points;
}

static inline void rig_power_on(void)
{
    const struct fpga_config c = {
        .slot_clocks = SLOT,
        .irq_every = INTERVAL,
        .alarm_stops = true,
        .stop_servo_off = true,
        .input_irq_mask = 0xffff,
    };
    fpga_reset(&card, &c);
    controller_start(&controller, &config);
    host = (struct fpga_host){ 0 };
    write_seq = out_seq = reset_seq = 0;
    now = 0;
}

static inline struct fpga_shown rig_shown(void)
{
    struct fpga_shown s = {
        .irq_seq = (int32_t)card.irq.seq,
        .irq_clock = (double)card.irq.clock,
        .irq_inputs = (int32_t)card.irq.inputs,
        .input_irq_seq = (int32_t)card.input_irq.seq,
        .input_irq_clock = (double)card.input_irq.clock,
        .input_irq_image = (int32_t)card.input_irq.inputs,
        .inputs = (int32_t)card.inputs.image,
        .memory = card.playing,
        .stopped = card.stopped,
    };
    int64_t pulses[FPGA_PLAYED];

    fpga_pulses(&card, pulses);
    for (int i = 0; i < FPGA_AXES; i++) {
        s.pulse_count[i] = (int32_t)pulses[i];
    }
    return s;
}

static inline void rig_read_host(void)
{
    if (link_new(&write_seq, host.write_seq)) {
        struct fpga_write w = { .seq = host.write_seq,
                                .clock = (int64_t)host.write_clock,
                                .memory = host.write_memory,
                                .slots = host.write_slots };
        memcpy(w.words, host.write_words, sizeof w.words);
        fpga_post_write(&card, &w);
    }
    if (link_new(&out_seq, host.out_seq)) {
        for (int i = 0; i < host.out_count; i++) {
            fpga_post_entry(&card, &(struct fpga_entry){ (int64_t)host.out_clock[i],
                                                         (uint32_t)host.out_mask[i],
                                                         (uint32_t)host.out_value[i] });
        }
    }
    if (link_new(&reset_seq, host.reset_seq)) {
        fpga_reset_stop(&card);
    }
    fpga_set_host(&card, host.run, (uint32_t)host.servo);
}

/* An instant: each side reads what the other one has published. */
static inline void rig_instant(void)
{
    fpga_advance(&card, now);
    const struct fpga_shown shown = rig_shown();
    controller_post(&controller, &config, &host);
    rig_read_host();
    controller_instant(&controller, &config, &text, &shown, &panel, now);
    now += config.bus;
}

static inline void rig_until(int64_t clock)
{
    while (now < clock) {
        rig_instant();
    }
}

/* Pulses from the start to the joint position commanded last. */
static inline int64_t rig_commanded(int i)
{
    return llround(controller.joint[i] * config.robot.scale[i])
           - llround(config.zero[i] * config.robot.scale[i]);
}

#endif
