/* binding_robot - the robot controller with its card and arm (a robot station), and the kinematics
 * of arms, for Python. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "binding.h"
#include "binding_text.h"
#include "robot_station.h"
#include "controller_words.h"

static const double DEGREE = 0.017453292519943295, MM = 1e-3;

enum { MESSAGE = ROBOT_JOB_MESSAGE_MAX };

/* A program in either language, with its points. It must stay in memory while it runs. */
struct robot_program {
    struct binding_text text;
    struct source source;
    struct robot_job_program job;
    struct robot_job_points points;
    struct orders_text orders;
};

/* What a program does at an instant. */
struct robot_sample {
    double time;                                /* [s] */
    double joint[OPW_JOINTS], rate[OPW_JOINTS]; /* [deg], [deg/s] commanded */
    double place[3], speed,
        feed;          /* [mm] of the tip, [mm/s] along its path, asked for; 0 of joints */
    double base[3];    /* [mm] where a track has the arm's base */
    double factors[3]; /* from singular: [mm], 1, 1 */
    int32_t line;      /* that moves, */
    int32_t at;        /* and that a job reads next; 0: none, it is a part program */
    int32_t by, axis;  /* struct limited */
};

#define SETTING(type, m, elements, unit, start, low, high) \
    { #m, \
      unit, \
      KIND(((struct controller_settings *)0)->m), \
      OFFSET(robot_station_config, controller.m), \
      SIZE(robot_station_config, controller.m) / (int32_t)sizeof(type), \
      sizeof(type), \
      SAME },
#define CARD(m, unit) ONE(robot_station_config, card.m, #m, unit)
static const struct field config_fields[] = {
    CONTROLLER_SETTINGS(SETTING)
        ONE_IN(robot_station_config, card.irq_every, "irq_every", "s", SECONDS),
    CARD(input_irq_mask, "bits"),
    CARD(follow_mask, "bits"),
    CARD(stop_mask, "bits"),
    CARD(stop_low, "bits"),
    CARD(alarm_stops, ""),
    CARD(stop_servo_off, ""),
};

#define READ(m, unit)     ONE(robot_station_reading, m, #m, unit)
#define READ_ROW(m, unit) ROW(robot_station_reading, m, #m, unit)
static const struct field reading_fields[] = {
    READ_ROW(pulses, "pulses"),
    READ_ROW(joint, "deg"),
    READ_ROW(pose, "mm, deg"),
    READ(external, "mm, deg"),
    READ(external_command, "mm, deg"),
    READ_ROW(base_command, "mm"),
    READ_ROW(joint_command, "deg"),
    READ_ROW(pose_command, "mm, deg"),
    READ(configuration, ""),
    READ_ROW(factors, "mm, 1, 1"),
    READ(status, ""),
    READ(line, ""),
    READ(done, ""),
    READ(rests, ""),
};

#define SEEN(m, name, unit) ONE(robot_station, m, name, unit)
/* Reports, with the names and units of the FMU's outputs. */
#define REPORT(m, name) ONE(robot_station, controller.report.m, name, "")
#define TIME(m, name)   ONE_IN(robot_station, controller.report.m, name, "s", SECONDS)
static const struct field seen_fields[] = {
    SEEN(clock, "clock", "clocks"),
    SEEN(controller.robot.speed, "path_feed", "mm/s"),
    SEEN(controller.robot.length, "path_length", "mm"),
    SEEN(controller.given, "move", ""),
    SEEN(controller.reached, "reached", ""),
    SEEN(controller.taught_count, "taught", ""),
    SEEN(controller.trouble.error, "error", ""),
    SEEN(controller.trouble.line, "error_line", ""),
    SEEN(controller.count, "queue", ""),
    SEEN(card.inputs.image, "inputs", "bits"),
    SEEN(card.outputs, "outputs", "bits"),
    ROW(robot_station, card.output_clock, "output_clock", "clocks"),
    ROW(robot_station, card.ai, "ai", "V"),
    ROW(robot_station, card.ao, "ao", "V"),
    SEEN(card.servo, "servo", "bits"),
    SEEN(card.stopped, "stopped", ""),
    SEEN(card.stopped_clock, "stopped_clock", "clocks"),
    SEEN(card.playing, "memory", ""),
    SEEN(card.irq.seq, "interrupts", ""),
    SEEN(card.irq.clock, "irq_clock", "clocks"),
    SEEN(card.underruns, "underruns", ""),
    SEEN(card.late, "late", ""),
    SEEN(card.refused, "refused", ""),
    ROW(robot_station, card.dropped, "dropped", "pulses"),
    REPORT(runs, "runs"),
    REPORT(late, "deadline_misses"),
    REPORT(polls, "polls"),
    REPORT(lines, "lines_done"),
    REPORT(points, "points_computed"),
    REPORT(starved, "starved"),
    TIME(wait, "irq_wait"),
    TIME(wait_most, "irq_wait_most"),
    TIME(run, "cycle_time"),
    TIME(run_most, "cycle_time_most"),
    TIME(spare, "spare_time"),
    TIME(busy, "busy"),
    TIME(line, "line_latency"),
    TIME(line_most, "line_latency_most"),
    TIME(told_most, "line_known_most"),
};

#define KEY(m)         ONE(robot_station, controller.m.pressed, "press_" #m, "")
#define PANEL(m, unit) ONE(robot_station, panel.m, #m, unit)
static const struct field panel_fields[] = {
    PANEL(hold, ""),
    PANEL(single, ""),
    PANEL(override, ""),
    PANEL(frame, ""),
    ROW(robot_station, panel.jog, "jog", ""),
    PANEL(jog_speed, ""),
    PANEL(jog_way, "mm or deg"),
    KEY(start),
    KEY(abort),
    KEY(reset),
    KEY(teach),
    KEY(replay),
    ONE(robot_station, inputs, "inputs", "bits"),
    ONE(robot_station, alarm, "alarm", "bits"),
    ONE(robot_station, emergency, "emergency", ""),
    ROW(robot_station, ai, "ai", "V"),
    ONE(robot_station, card.stopped, "stopped", ""),
};

#define MOVE(m, unit) ONE(robot_move, m, #m, unit)
static const struct field move_fields[] = {
    MOVE(kind, ""),          MOVE(target.by_joints, ""),
    MOVE(target.branch, ""), ROW(robot_move, via, "via", "mm"),
    MOVE(feed, "mm/s"),      MOVE(spin, "deg/s"),
    MOVE(share, ""),         MOVE(zone, "mm"),
    MOVE(radius, "mm"),      MOVE(part, ""),
    MOVE(singular, ""),
};

static const struct field refusal_fields[] = {
    ONE(robot_refusal, part, "part", ""),   ROW(robot_refusal, place, "place", "mm"),
    ONE(robot_refusal, which, "which", ""), ONE(robot_refusal, value, "value", ""),
    ONE(robot_refusal, limit, "limit", ""), ONE(robot_refusal, slides, "slides", ""),
};

#define SAMPLE(m, unit)     ONE(robot_sample, m, #m, unit)
#define SAMPLE_ROW(m, unit) ROW(robot_sample, m, #m, unit)
static const struct field sample_fields[] = {
    SAMPLE(time, "s"),
    SAMPLE_ROW(joint, "deg"),
    SAMPLE_ROW(rate, "deg/s"),
    SAMPLE_ROW(place, "mm"),
    SAMPLE_ROW(base, "mm"),
    SAMPLE(speed, "mm/s"),
    SAMPLE(feed, "mm/s"),
    SAMPLE_ROW(factors, "mm, 1, 1"),
    SAMPLE(line, ""),
    SAMPLE(at, ""),
    SAMPLE(by, ""),
    SAMPLE(axis, ""),
};

const struct table ROBOT_TABLES[] = {
    { "robot_config", config_fields, sizeof config_fields, sizeof(struct robot_station_config) },
    { "robot_reading", reading_fields, sizeof reading_fields,
      sizeof(struct robot_station_reading) },
    { "robot_seen", seen_fields, sizeof seen_fields, sizeof(struct robot_station) },
    { "robot_panel", panel_fields, sizeof panel_fields, sizeof(struct robot_station) },
    { "robot_move", move_fields, sizeof move_fields, sizeof(struct robot_move) },
    { "robot_refusal", refusal_fields, sizeof refusal_fields, sizeof(struct robot_refusal) },
    { "robot_program", NULL, 0, sizeof(struct robot_program) },
    { "robot_controller", NULL, 0, sizeof(struct controller) },
    { "robot_arm", NULL, 0, sizeof(struct manipulator) },
    { "robot_sample", sample_fields, sizeof sample_fields, sizeof(struct robot_sample) },
    { NULL, NULL, 0, 0 },
};

void binding_robot_defaults(struct robot_station_config *c)
{
    *c = robot_station_defaults();
}

/* The functions with a message return 0, or 1 with the message; `number` is the wrong value and its
 * limit. */
int binding_robot_on(struct robot_station *s, const struct robot_station_config *c,
                     double number[2], char message[MESSAGE])
{
    struct controller_wrong w;

    if (robot_station_start(s, c, &w)) {
        return 0;
    }
    number[0] = w.value;
    number[1] = w.value < w.low ? w.low : w.high;
    if (w.why) {
        snprintf(message, MESSAGE, "%s = %.10g (element %d): %s", w.name, w.value, (int)w.index,
                 w.why);
    } else {
        snprintf(message, MESSAGE, "%s = %.10g (element %d): %.10g to %.10g is wanted", w.name,
                 w.value, (int)w.index, w.low, w.high);
    }
    return 1;
}

void binding_robot_arm(const struct robot_station *s, struct manipulator *arm)
{
    *arm = s->config.robot.arm;
    arm->tool = s->tool;
}

/* Read a job and, by the callback, those that it calls and that are not in it. */
static int read_jobs(struct robot_program *p, const char *first, int64_t length, binding_file file,
                     char message[MESSAGE])
{
    const char *text[ROBOT_JOB_JOBS] = { first }, *name[ROBOT_JOB_JOBS] = { "" };
    char found[ROBOT_JOB_MESSAGE_MAX];
    struct robot_job_report r;

    robot_job_begin_reading(&p->job);
    int status = robot_job_read_text(&p->job, &p->points, first, length, &r);
    for (int32_t i = 0; i < p->job.callees && status == 0; i++) {
        const int32_t n = p->job.texts;
        if (file && n < ROBOT_JOB_JOBS && robot_job_wanted(&p->job, i)) {
            text[n] = file(p->job.callee[i].name, &length);
            name[n] = p->job.callee[i].name;
            status = text[n] ? robot_job_read_text(&p->job, &p->points, text[n], length, &r) : 0;
        }
    }
    if (status == 0 && robot_job_end_reading(&p->job, &r) == 0) {
        return 0;
    }
    robot_job_message(&r, text[r.text], found);
    snprintf(message, MESSAGE, "%.40s%s%.360s", name[r.text], r.text ? ": " : "", found);
    return 1;
}

/* Read a program (an empty text is none) in one of the languages, and its points, for a robot. */
int binding_robot_read(struct robot_program *p, const struct robot_station *s,
                       const char *const text[2], const int64_t length[2], bool gcode,
                       binding_file file, char message[MESSAGE])
{
    const enum robot_job_outside outside = (enum robot_job_outside)s->config.robot.external.kind;
    struct robot_job_report r;

    memset(p, 0, sizeof *p);
    robot_job_points_clear(&p->points, outside);
    p->orders.points = &p->points;
    if (robot_job_points_read(&p->points, outside, text[1], length[1], &r) < 0) {
        char found[ROBOT_JOB_MESSAGE_MAX];
        robot_job_message(&r, text[1], found);
        snprintf(message, MESSAGE, "points: %.400s", found);
        return 1;
    }
    p->text = binding_text_of(text[0], length[0], file);
    if (gcode) {
        p->source = binding_source(&p->text);
        p->orders.gcode = &p->source;
    } else if (read_jobs(p, text[0], length[0], file, message)) {
        return 1;
    } else {
        p->orders.job = &p->job;
    }
    return 0;
}

static int check_gcode(struct robot_station *s, const struct robot_program *p,
                       struct controller *trial, char message[MESSAGE])
{
    char words[CONTROLLER_WORDS];
    struct fault_list all;
    int count = 0;

    orders_check(&s->config.orders, &p->orders, &s->controller.robot.pose, &all);
    for (int i = 0; i < all.count && count < MESSAGE; i++) {
        const struct fault_report *r = &all.of[i];
        const char *text = "";
        p->source.look(p->source.context, r->file, r->offset, &text);
        count += snprintf(message + count, (size_t)(MESSAGE - count),
                          "%s%s%sline %d: %s \"%.*s\", column %d", i ? "\n" : "", r->file,
                          r->file[0] ? ".ngc: " : "", (int)r->line, fault_text(r->fault),
                          (int)r->length, text + r->at, (int)r->at + 1);
    }
    if (all.count > 0) {
        return 1;
    }
    robot_station_rehearse(s, &p->orders, trial);
    if (trial->trouble.error != CONTROLLER_OK) {
        controller_words(&trial->trouble, words);
        snprintf(message, MESSAGE, "line %d: %s", (int)trial->trouble.line, words);
        return 1;
    }
    return 0;
}

/* Start a program that was read, while the robot is at rest; a part program is planned first. */
int binding_robot_start(struct robot_station *s, const struct robot_program *p, const char *job,
                        struct controller *trial, char message[MESSAGE])
{
    struct robot_job_start *start = &s->config.orders.start;

    if (p->orders.gcode && check_gcode(s, p, trial, message)) {
        return 1;
    }
    start->job = 0;
    start->out = s->card.host_outputs;
    if (p->orders.job && job[0]) {
        start->job = robot_job_find(&p->job, job);
        if (start->job < 0) {
            start->job = 0;
            snprintf(message, MESSAGE, "no job \"%.40s\" in the program", job);
            return 1;
        }
    }
    s->controller.start.pressed = true;
    return 0;
}

void binding_robot_run(struct robot_station *s, int64_t until, const struct robot_program *p)
{
    robot_station_run(s, until, p ? &p->orders : NULL);
}

static void sample(struct robot_station *s, const struct robot_program *p, struct robot_sample *x)
{
    const struct robot *r = &s->controller.robot;
    const struct limited limited = controller_limited(&s->controller, &s->config, &s->panel);

    memset(x, 0, sizeof *x);
    x->time = (double)s->clock / FPGA_CLOCK_HZ;
    for (int i = 0; i < OPW_JOINTS; i++) {
        const double unit = manipulator_unit(&s->config.robot.arm, i);
        x->joint[i] = r->joint[i] / unit;
        x->rate[i] = r->rate[i] / unit;
    }
    memcpy(x->place, r->pose.at, sizeof x->place);
    external_to_world(&s->config.robot.external, r->external, x->base);
    x->speed = r->speed;
    x->feed = limited.feed;
    robot_factors(r, &s->config.robot, x->factors);
    x->factors[0] /= MM;
    x->line = r->line > 0 ? s->controller.move_line[r->line % CONTROLLER_MOVES] : 0;
    if (p->orders.job) {
        robot_job_running(&s->controller.orders.job, &p->job, &x->at);
    }
    x->by = (int32_t)limited.by;
    x->axis = limited.axis;
}

/* Run on to a clock, a row every `step` clocks, until the program is over and the arm rests; at
 * most `most` rows. Returns their number. */
int64_t binding_robot_trace(struct robot_station *s, const struct robot_program *p, int64_t until,
                            int64_t step, struct robot_sample *rows, int64_t most)
{
    struct robot_station_reading now;
    int64_t count = 0;

    robot_station_read(s, &now);
    while (!now.rests && s->clock < until && count < most) {
        robot_station_run(s, s->clock + step, &p->orders);
        sample(s, p, &rows[count++]);
        robot_station_read(s, &now);
    }
    return count;
}

/* Move to joint angles [deg] or to a pose X Y Z [mm] A B C [deg]. */
int binding_robot_move(struct robot_station *s, struct robot_move *m, const double target[6],
                       struct robot_refusal *why, char message[MESSAGE])
{
    for (int i = 0; i < OPW_JOINTS; i++) {
        m->target.joint[i] = target[i] * manipulator_unit(&s->config.robot.arm, i);
    }
    m->target.pose = m->target.by_joints ? pose_none() : pose_of(target, target + 3);
    m->spin *= DEGREE;
    const enum robot_status status = controller_move(&s->controller, &s->config, m, &s->tool, why);
    controller_refusal_words(status, why, message);
    return (int)status;
}

int binding_robot_running(const struct robot_station *s)
{
    return controller_running(&s->controller);
}

int binding_robot_jog(struct robot_station *s, struct robot_refusal *why, char message[MESSAGE])
{
    const enum robot_status status = controller_jog(&s->controller, &s->config, &s->panel, why);
    controller_refusal_words(status, why, message);
    return (int)status;
}

/* Set the digital outputs of a mask; with mask 0, the analog output `index`, counted from 0. */
int binding_robot_output(struct robot_station *s, uint32_t mask, uint32_t value, int32_t index,
                         double volt)
{
    struct order o = { .kind = mask ? ORDER_OUT : ORDER_ANALOG,
                       .mask = mask,
                       .value = value,
                       .index = index,
                       .amount = volt };
    return (int)controller_output(&s->controller, &o);
}

int binding_robot_tool(struct robot_station *s, const double tool[6])
{
    if (!robot_idle(&s->controller.robot)) {
        return 1;
    }
    s->tool = pose_of(tool, tool + 3);
    return (int)robot_tool(&s->controller.robot, &s->config.robot, &s->tool);
}

void binding_robot_words(const struct robot_station *s, char message[MESSAGE])
{
    controller_words(&s->controller.trouble, message);
}

int binding_robot_taught(const struct robot_station *s, int32_t n, char line[ROBOT_JOB_POINT_TEXT])
{
    return controller_taught(&s->controller, &s->config, n, line);
}

/* Position and rotation of a tool as a matrix, or of its inverse. */
static void tool_matrix(const struct manipulator *m, bool back, double at[3], double turn[3][3])
{
    const struct pose tool = back ? pose_inverse(&m->tool) : m->tool;

    for (int i = 0; i < 3; i++) {
        at[i] = tool.at[i] * MM;
    }
    quaternion_matrix(tool.turn, turn);
}

/* A pose followed by a frame: product of both transformations [m]. */
static void behind(const struct opw_pose *p, const double at[3], const double turn[3][3],
                   struct opw_pose *out)
{
    for (int i = 0; i < 3; i++) {
        const double *t = p->turn[i];
        out->at[i] = p->at[i] + t[0] * at[0] + t[1] * at[1] + t[2] * at[2];
        for (int j = 0; j < 3; j++) {
            out->turn[i][j] = t[0] * turn[0][j] + t[1] * turn[1][j] + t[2] * turn[2][j];
        }
    }
}

/* Joints as people give them become those of the core. */
static void joints_of(const struct manipulator *m, const double given[OPW_JOINTS],
                      double joint[OPW_JOINTS])
{
    for (int i = 0; i < OPW_JOINTS; i++) {
        joint[i] = given[i] * manipulator_unit(m, i);
    }
}

/* Forward kinematics: for n sets of joint angles [deg] the 4 x 4 matrices of the tool centre point
 * [mm]. */
void binding_robot_forward(const struct manipulator *m, int64_t n, const double (*joint)[6],
                           double (*matrix)[4][4])
{
    double at[3], turn[3][3], q[OPW_JOINTS];
    struct opw_pose flange, tip;

    tool_matrix(m, false, at, turn);
    for (int64_t k = 0; k < n; k++) {
        joints_of(m, joint[k], q);
        manipulator_flange(m, q, &flange);
        behind(&flange, at, (const double(*)[3])turn, &tip);
        memset(matrix[k], 0, sizeof matrix[k]);
        matrix[k][3][3] = 1.0;
        for (int i = 0; i < 3; i++) {
            memcpy(matrix[k][i], tip.turn[i], sizeof tip.turn[i]);
            matrix[k][i][3] = tip.at[i] / MM;
        }
    }
}

/* Inverse kinematics: all branches for the matrix of a tool centre point. */
static uint32_t solve(const struct manipulator *m, const double at[3], const double turn[3][3],
                      const double matrix[4][4], const double near[6],
                      double all[OPW_BRANCHES][OPW_JOINTS])
{
    struct opw_pose tip, flange;

    for (int i = 0; i < 3; i++) {
        memcpy(tip.turn[i], matrix[i], sizeof tip.turn[i]);
        tip.at[i] = matrix[i][3] * MM;
    }
    behind(&tip, at, turn, &flange);
    return manipulator_branches(m, &flange, near, 0xff, all);
}

/* Inverse kinematics: all branches for n matrices; NaN for a branch that does not exist. */
void binding_robot_inverse(const struct manipulator *m, int64_t n, const double (*matrix)[4][4],
                           const double (*near)[6], double (*joint)[OPW_BRANCHES][OPW_JOINTS])
{
    double at[3], turn[3][3], q[OPW_JOINTS];

    tool_matrix(m, true, at, turn);
    for (int64_t k = 0; k < n; k++) {
        joints_of(m, near[k], q);
        const uint32_t there = solve(m, at, (const double(*)[3])turn, matrix[k], q, joint[k]);
        for (int b = 0; b < OPW_BRANCHES; b++) {
            for (int i = 0; i < OPW_JOINTS; i++) {
                joint[k][b][i] =
                    there >> b & 1 ? joint[k][b][i] / manipulator_unit(m, i) : (double)NAN;
            }
        }
    }
}

/* The branch within the limits whose joint angles [deg] are nearest to `near`; -1 and NaN if there
 * is none. */
void binding_robot_nearest(const struct manipulator *m, int64_t n, const double (*matrix)[4][4],
                           const double (*near)[6], double (*joint)[OPW_JOINTS], int32_t *branch)
{
    double at[3], turn[3][3], q[OPW_JOINTS], all[OPW_BRANCHES][OPW_JOINTS], low[6], high[6];

    tool_matrix(m, true, at, turn);
    for (int i = 0; i < OPW_JOINTS; i++) {
        low[i] = m->joint[i].low;
        high[i] = m->joint[i].high;
    }
    for (int64_t k = 0; k < n; k++) {
        double found[OPW_JOINTS];
        joints_of(m, near[k], q);
        const uint32_t there = solve(m, at, (const double(*)[3])turn, matrix[k], q, all);
        branch[k] = manipulator_nearest(m, there, (const double(*)[6])all, q, low, high, found);
        for (int i = 0; i < OPW_JOINTS; i++) {
            joint[k][i] = branch[k] >= 0 ? found[i] / manipulator_unit(m, i) : (double)NAN;
        }
    }
}

/* Singularity factors ([mm], 1, 1) and branches of n sets of joint angles. */
void binding_robot_factors(const struct manipulator *m, int64_t n, const double (*joint)[6],
                           double (*factor)[3], int32_t *branch)
{
    double q[OPW_JOINTS];

    for (int64_t k = 0; k < n; k++) {
        joints_of(m, joint[k], q);
        branch[k] = manipulator_factors(m, q, factor[k]);
        factor[k][0] /= MM;
    }
}

/* Poses X Y Z [mm] A B C [deg] of n matrices, and matrices of poses. */
void binding_robot_pose(int64_t n, const double (*matrix)[4][4], double (*pose)[6])
{
    for (int64_t k = 0; k < n; k++) {
        double turn[3][3];
        struct pose p;
        for (int i = 0; i < 3; i++) {
            memcpy(turn[i], matrix[k][i], sizeof turn[i]);
            p.at[i] = matrix[k][i][3];
        }
        quaternion_of_matrix((const double(*)[3])turn, p.turn);
        robot_station_pose(&p, pose[k]);
    }
}

void binding_robot_matrix(int64_t n, const double (*pose)[6], double (*matrix)[4][4])
{
    for (int64_t k = 0; k < n; k++) {
        const struct pose p = pose_of(pose[k], pose[k] + 3);
        double turn[3][3];
        quaternion_matrix(p.turn, turn);
        memset(matrix[k], 0, sizeof matrix[k]);
        matrix[k][3][3] = 1.0;
        for (int i = 0; i < 3; i++) {
            memcpy(matrix[k][i], turn[i], sizeof turn[i]);
            matrix[k][i][3] = p.at[i];
        }
    }
}
