/* FMU of the robot controller, software on a PC (core soft): bus grid, inputs from the FPGA card,
 * mailboxes to it, files. */
#include <string.h>

#include "library_in_use.h"
#include "controller_calls.h"
#include "controller_settings.h"
#include "controller_words.h"
#include "vars.h"

struct model {
    struct controller controller;
    int64_t instant;  /* [ns] next instant of the bus grid, at which inputs are read */
    bool unpublished; /* the outputs of the latest instant are shown at the next one */
    int32_t told;     /* error that was reported last */
    uint64_t text;    /* digest of the text of the jobs that it runs */
};

#define MODEL_BLOB
#define MODEL_IN_USE \
    RING_IN_USE(controller.robot.ring) \
    MEAN_IN_USE(controller.robot.mean, controller.robot.trajectory) \
    FMU_LIST(controller.robot.moves.move, controller.robot.moves.count) \
    JOINT_FLOW_IN_USE(controller.robot.flow) \
    FMU_LIST(controller.robot.tool_path.segment, controller.robot.tool_path.count) \
    INTERPRETER_IN_USE(controller.orders.gcode) \
    FMU_LIST(controller.orders.job.frame, controller.orders.job.frames) \
    FMU_LIST(controller.orders.job.changed, controller.orders.job.changes) \
    FMU_RING(controller.queue, controller.heads, controller.count, 0) \
    FMU_LIST(controller.taught, controller.taught_count)
#include "fmi_model.h"
#include "fmu_period.h"
#include "controller_parameters.h"
#include "controller_text.h"

static int cannot_write(struct fmu *f, const char *why)
{
    return fmu_fail(f, "teach_file: cannot write %s: %s", f->s.v.teach_file, why);
}

static int model_open(struct fmu *f)
{
    if (f->s.v.teach_file[0]) {
        const struct controller_inputs in = inputs_of(f);
        const struct fmu_path path = fmu_path(f, f->s.v.teach_file, FMU_WRITTEN);
        const char *why = path.good ? output_try(path.text, in.of, CONTROLLER_INPUTS) : path.text;
        if (why) {
            return cannot_write(f, why);
        }
    }
    struct controller_blob *b = calloc(1, sizeof *b);
    if (!b) {
        return fmu_fail(f, "out of memory");
    }
    f->blob = b;
    return config_of(f, &b->config) ? -1 : read_files(f, b);
}

static void model_close(struct fmu *f)
{
    struct controller_blob *b = f->blob;

    if (b) {
        program_close(b->gcode);
        for (int32_t i = 0; i < ROBOT_JOB_JOBS; i++) {
            free(b->file[i]);
        }
        free(b);
    }
}

static void publish_times(struct vars *v, const struct controller *s)
{
    const struct controller_report *r = &s->report;

    v->runs = r->runs;
    v->deadline_misses = r->late;
    v->lines_done = r->lines;
    v->points_computed = r->points;
    v->starved = r->starved;
    v->irq_wait = (double)r->wait / FPGA_CLOCK_HZ;
    v->irq_wait_most = (double)r->wait_most / FPGA_CLOCK_HZ;
    v->cycle_time = (double)r->run / FPGA_CLOCK_HZ;
    v->cycle_time_most = (double)r->run_most / FPGA_CLOCK_HZ;
    v->spare_time = (double)r->spare / FPGA_CLOCK_HZ;
    v->load = s->free > 0 ? (double)r->busy / (double)s->free : 0.0;
    v->line_latency = (double)r->line / FPGA_CLOCK_HZ;
    v->line_latency_most = (double)r->line_most / FPGA_CLOCK_HZ;
    v->line_known_most = (double)r->told_most / FPGA_CLOCK_HZ;
}

static void publish_arm(struct vars *v, struct controller *s, const struct controller_config *c,
                        const struct controller_panel *panel)
{
    const struct robot *r = &s->robot;
    double base[3] = { 0.0, 0.0, 0.0 };

    external_to_world(&c->robot.external, r->external, base);
    for (int i = 0; i < 3; i++) {
        v->tool_position[i] = r->pose.at[i] * 1e-3;
        v->base_place[i] = base[i] * 1e-3;
    }
    memcpy(v->tool_quaternion, r->pose.turn, sizeof v->tool_quaternion);
    memcpy(v->joint_command, r->joint, sizeof v->joint_command);
    memcpy(v->joint_rate, r->rate, sizeof v->joint_rate);
    v->external_command = r->external;
    v->external_command_rate = r->external_rate;
    v->configuration = robot_factors(r, &c->robot, v->factors);
    const struct limited limited = controller_limited(s, c, panel);
    v->limited_by = limited.by;
    v->limited_axis = limited.axis;
    v->programmed_feed = limited.feed;
    v->path_feed = r->speed;
    v->path_length = r->length;
}

static void publish_card(struct vars *v, struct controller *s, const struct controller_config *c)
{
    struct fpga_host host;
    const bool write = s->posts, ao = write && s->posts_ao, out = s->outbox.count > 0;

#define TAKE(type, name, elements) LINK_CARRY(host.name, v->card_##name)
#define SHOW(type, name, elements) LINK_CARRY(v->card_##name, host.name)
    if (out) { /* an old entry stays behind the last new one */
        FPGA_OUT(TAKE)
    }
    FPGA_LEVELS(TAKE)
    controller_post(s, c, &host);
    if (out) {
        FPGA_OUT(SHOW)
    }
    if (ao) {
        FPGA_AO(SHOW)
    }
    FPGA_LEVELS(SHOW)
    if (write) {
        FPGA_WRITE(SHOW)
    }
}

static struct controller_panel panel_of(const struct vars *v)
{
    struct controller_panel p = { .hold = v->hold,
                                  .abort = v->abort,
                                  .start = v->start,
                                  .single = v->single,
                                  .reset = v->reset,
                                  .teach = v->teach,
                                  .replay = v->replay,
                                  .override = v->override,
                                  .frame = (enum robot_frame)v->jog_frame,
                                  .jog_speed = v->jog_speed,
                                  .jog_way = v->jog_way };
    memcpy(p.jog, v->jog, sizeof p.jog);
    return p;
}

static void publish(struct fmu *f)
{
    struct vars *v = &f->s.v;
    struct controller *s = &f->s.m.controller;
    const struct controller_blob *b = f->blob;
    const struct controller_panel panel = panel_of(v);
    const bool cycle = s->posts || s->stopped || f->s.m.instant == 0;

    v->status = controller_status(s, &panel);
    v->done = controller_done(s);
    v->failed = controller_failed(s);
    v->error = s->trouble.error;
    v->error_line = s->trouble.line;
    v->line = s->robot.line > 0 ? s->move_line[s->robot.line % CONTROLLER_MOVES] : 0;
    v->move = (int32_t)s->given;
    v->reached = (int32_t)s->reached;
    v->taught = s->taught_count;
    v->queue = s->count;
    if (cycle) { /* these outputs change only with the cycle */
        publish_times(v, s);
        publish_arm(v, s, &b->config, &panel);
    }
    publish_card(v, s, &b->config);
    v->polls = s->report.polls;
    if (v->error != f->s.m.told) {
        char words[CONTROLLER_WORDS];
        controller_words(&s->trouble, words);
        f->s.m.told = v->error;
        if (v->error) {
            fmu_warn(f, "%s: line %d: %s", b->has_job ? job_file_of(b, s->trouble.job) : v->program,
                     (int)v->error_line, words);
        }
    }
}

/* Plan every move of a part program before the first one starts, so that faults are found early. */
static int rehearse(struct fmu *f, const struct orders_text *t)
{
    const struct controller_blob *b = f->blob;
    struct controller *s = &f->s.m.controller;
    struct fault_list all;

    orders_check(&b->config.orders, t, &s->robot.pose, &all);
    const struct source source = { program_look, b->gcode };
    const struct named_program named = { "program", f->s.v.program, "XYZABC", &source };
    if (judge_program(f, &named, &all)) {
        return -1;
    }
    controller_rehearse(s, &b->config, t);
    if (s->trouble.error != CONTROLLER_OK) {
        char words[CONTROLLER_WORDS];
        controller_words(&s->trouble, words);
        return fmu_fail(f, "%s: line %d: %s", f->s.v.program, (int)s->trouble.line, words);
    }
    return 0;
}

static int model_start(struct fmu *f)
{
    const struct controller_blob *b = f->blob;
    const struct orders_text t = text_of(b);
    struct controller *s = &f->s.m.controller;

    controller_start(s, &b->config);
    if (t.gcode) {
        if (rehearse(f, &t)) {
            return -1;
        }
        controller_start(s, &b->config);
    }
    f->s.m.text = b->text;
    publish(f);
    return 0;
}

/* Read the inputs at an instant of the bus grid and let the PC work. */
static void read_bus(struct fmu *f, int64_t at)
{
    const struct vars *v = &f->s.v;
    const struct controller_blob *b = f->blob;
    const struct controller_panel panel = panel_of(v);
    const struct orders_text t = text_of(b);
    struct fpga_shown card = { 0 };

#define READ(type, name, elements) LINK_CARRY(card.name, v->card_##name)
    FPGA_INTERRUPTS(READ)
    READ(int32_t, inputs, )
    READ(int32_t, memory, )
    READ(bool, stopped, )
    READ(int32_t, pulse_count, )
    READ(int32_t, external_count, )
    controller_instant(&f->s.m.controller, &b->config, &t, &card, &panel, at / FPGA_CLOCK_NS);
}

static int model_step(struct fmu *f, int64_t t0, int64_t t1)
{
    struct model *m = &f->s.m;
    const struct controller_blob *b = f->blob;
    const struct vars *v = &f->s.v;

    (void)t0;
    if (!(fabs(v->card_irq_clock) < FMU_TICKS_MAX
          && fabs(v->card_input_irq_clock) < FMU_TICKS_MAX)) {
        return fmu_fail(f, "card_irq_clock = %g, card_input_irq_clock = %g: not clocks",
                        v->card_irq_clock, v->card_input_irq_clock);
    }
    if (m->text != b->text) { /* the place in a restored state is of other instructions */
        return fmu_fail(f, "program: the state is one of another program");
    }
    for (;;) {
        if (m->unpublished && m->instant <= t1) {
            publish(f);
            m->unpublished = false;
        }
        if (m->instant >= t1) {
            return 0;
        }
        read_bus(f, m->instant);
        m->instant += b->config.bus * FPGA_CLOCK_NS;
        m->unpublished = true;
    }
}

/* Write the points that were taught. */
static int model_end(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    const char *why = v->teach_file[0] ? write_points(f) : NULL;

    return why ? cannot_write(f, why) : 0;
}
