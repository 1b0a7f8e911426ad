#include "controller_parts.h"

#include <math.h>

#include "el_extremes.h"

void controller_program_start(struct controller *s, const struct controller_config *c,
                              const struct orders_text *t)
{
    controller_program_drop(s);
    s->trouble = (struct controller_trouble){ 0 };
    s->first = s->given;
    struct orders_config now = c->orders;
    now.start.out = s->out;
    orders_start(&s->orders, &now, t, &s->robot.pose);
    s->program = s->orders.on ? PROGRAM_RUNS : PROGRAM_DROPPED;
}

void controller_program_drop(struct controller *s)
{
    s->orders.on = false;
    s->program = controller_running(s) ? PROGRAM_DROPPED : s->program;
    s->heads = s->count = s->output_count = 0;
    s->until_move = 0;
    s->next.kind = ORDER_NONE;
    s->delay = 0;
}

/* End the program with what has gone wrong; moves that were given before run to their end. */
static bool fail(struct controller *s, enum controller_error error, const struct order *order)
{
    s->trouble.error = error;
    s->trouble.line = order->line;
    s->trouble.job = order->job;
    s->trouble.fault = s->orders.job.fault;
    controller_program_drop(s);
    return true;
}

static bool other_tool(const struct pose *a, const struct pose *b)
{
    return memcmp(a, b, sizeof *a) != 0;
}

bool controller_program_ready(struct controller *s, const struct controller_config *c,
                              const struct pose *tool)
{
    return robot_ready(&s->robot)
           && (!other_tool(tool, &s->robot.tool)
               || robot_tool(&s->robot, &c->robot, tool) == ROBOT_OK);
}

enum robot_status controller_program_give(struct controller *s, const struct controller_config *c,
                                          struct robot_move *move, int32_t line,
                                          struct robot_refusal *why)
{
    move->line = (int32_t)(s->given + 1);
    const enum robot_status status = robot_move(&s->robot, &c->robot, move, why);
    if (status == ROBOT_OK) {
        s->given++;
        const double feed = move->feed > 0.0 ? move->feed : c->robot.feed;
        s->move_line[s->given % CONTROLLER_MOVES] = line;
        s->move_feed[s->given % CONTROLLER_MOVES] =
            move->kind == ROBOT_JOINTS ? 0.0F : (float)el_min(feed, c->robot.feed);
    }
    return status;
}

/* Where the external axis is at the end of a move. */
static double end_of(const struct robot *r, const struct robot_target *t)
{
    return t->beside != EXTERNAL_NONE ? t->external : robot_end_external(r);
}

/* Pose of the tip for joints, in the world, at the end of a move to a target. */
static struct pose pose_at(const struct manipulator *arm, const struct controller *s,
                           const struct controller_config *c, const struct robot_target *t,
                           const double joint[OPW_JOINTS])
{
    struct pose pose = manipulator_pose(arm, joint);
    external_to_world(&c->robot.external, end_of(&s->robot, t), pose.at);
    return pose;
}

/* A target by joints that is shifted becomes the pose of its tip, in the same branch and turns. */
static void shift_target(const struct manipulator *arm, const struct controller *s,
                         const struct controller_config *c, struct robot_target *t,
                         const double shift[3])
{
    static const double TURN = 6.283185307179586;
    if (shift[0] == 0.0 && shift[1] == 0.0 && shift[2] == 0.0) {
        return;
    }
    if (t->by_joints) {
        t->by_joints = false;
        t->pose = pose_at(arm, s, c, t, t->joint);
        t->branch = manipulator_branch(arm, t->joint);
        t->turned = true;
        for (int i = 0; i < OPW_JOINTS; i++) {
            const bool slides = manipulator_slides(arm, i);
            t->turn[i] = slides ? ROBOT_ANY_TURN : (int)round(t->joint[i] / TURN);
        }
    }
    for (int i = 0; i < 3; i++) {
        t->pose.at[i] += shift[i];
    }
}

/* The branch of the wrist in which joint 4 is within 90 deg of its zero, or beyond: one of the two
 * is, as they are half a turn apart. */
static void settle_wrist(const struct manipulator *arm, const struct external *e,
                         const struct robot *r, int32_t wrist, struct robot_target *t)
{
    static const double TURN = 6.283185307179586;
    struct pose pose = t->pose;
    double joint[OPW_JOINTS];
    int which;

    external_to_arm(e, end_of(r, t), pose.at);
    if (!(manipulator_flags(arm) & OPW_FLIP)) {
        return;
    }
    memcpy(joint, r->joint, sizeof joint);
    t->branch &= ~OPW_FLIP;
    if (manipulator_solve(arm, &pose, 1u << t->branch, NULL, joint, &which) == MANIPULATOR_FAR) {
        return;
    }
    const double four = joint[3] - TURN * round(joint[3] / TURN);
    const bool near = four > -TURN / 4.0 && four <= TURN / 4.0;
    t->branch |= near == (wrist == ROBOT_JOB_WRIST_NEAR) ? 0 : OPW_FLIP;
    t->open &= ~OPW_FLIP;
}

/* Where the latest move ends, and a step from there: of the tool's frame, or of one in the base,
 * about whose axes it turns. */
static void step_from_end(const struct manipulator *arm, const struct controller *s,
                          const struct controller_config *c, const struct order *order,
                          struct robot_target *t)
{
    double joint[OPW_JOINTS], by[3], back[4];

    robot_end(&s->robot, joint);
    const struct pose end = pose_at(arm, s, c, t, joint);
    if (order->in_tool) {
        t->pose = pose_product(&end, &order->step);
        return;
    }
    t->pose = end;
    quaternion_turn(order->frame.turn, order->step.at, by);
    quaternion_inverse(order->frame.turn, back);
    quaternion_product(back, end.turn, t->pose.turn);
    quaternion_product(order->step.turn, t->pose.turn, t->pose.turn);
    quaternion_product(order->frame.turn, t->pose.turn, t->pose.turn);
    for (int i = 0; i < 3; i++) {
        t->pose.at[i] += by[i];
    }
}

/* End the move that an input ends, if it is under way or about to begin, and the input is as it has
 * to be. */
static void look_at_until(struct controller *s, uint32_t di, bool begins)
{
    if (s->until_move == 0 || s->reached >= s->until_move) {
        s->until_move = 0;
        return;
    }
    const bool on = di >> (s->until - 1) & 1u;
    if (on == s->until_on && (begins || s->robot.line >= s->until_move)) {
        robot_abort(&s->robot);
        s->until_move = 0;
    }
}

bool controller_program_move(struct controller *s, const struct controller_config *c,
                             struct order *order)
{
    const struct pose *tool = order->plain ? &c->robot.arm.tool : &order->tool;
    struct robot_move m = order->move;
    struct manipulator arm = c->robot.arm;

    if (!controller_program_ready(s, c, tool)) {
        return false;
    }
    arm.tool = *tool;
    if (m.kind == ROBOT_CIRCLE || m.goes_on) {
        m.next = order->via.by_joints ? pose_at(&arm, s, c, &m.target, order->via.joint)
                                      : order->via.pose;
        for (int i = 0; i < 3; i++) {
            m.next.at[i] += order->shift[i];
            m.via[i] = m.next.at[i];
        }
    }
    if (order->goes_on) {
        step_from_end(&arm, s, c, order, &m.target);
    }
    shift_target(&arm, s, c, &m.target, order->shift);
    if (order->wrist) {
        settle_wrist(&arm, &c->robot.external, &s->robot, order->wrist, &m.target);
    }
    const enum robot_status status =
        controller_program_give(s, c, &m, order->line, &s->trouble.refusal);
    if (status != ROBOT_OK && status != ROBOT_BUSY) {
        s->trouble.status = status;
        return fail(s, CONTROLLER_MOVE, order);
    }
    return status == ROBOT_OK;
}

bool controller_program_put(struct controller *s, const struct order *o)
{
    if (s->output_count == CONTROLLER_OUTPUTS) {
        return false;
    }
    s->output[s->output_count++] =
        (struct controller_output){ .after = s->first + o->after,
                                    .analog = o->kind == ORDER_ANALOG,
                                    .mask = o->mask,
                                    .value = o->value,
                                    .index = o->index,
                                    .volt = o->amount,
                                    .pulse = llround(o->pulse * FPGA_CLOCK_HZ) };
    return true;
}

/* Give the arm a move of the program; in single steps the start key lets each one go. */
static bool carry_out_move(struct controller *s, const struct controller_config *c,
                           const struct controller_panel *panel, struct order *o, uint32_t di)
{
    const bool idle = robot_idle(&s->robot), held = panel->single && !(idle && s->leave);

    if (held || !controller_program_move(s, c, o)) {
        return false;
    }
    s->leave = false;
    if (o->until > 0 && s->trouble.error == CONTROLLER_OK) {
        s->until_move = s->given;
        s->until = o->until;
        s->until_on = o->until_on;
        look_at_until(s, di, idle);
    }
    return true;
}

/* End the program, once the arm rests and all outputs are put out. False: not yet. */
static bool end(struct controller *s)
{
    if (!robot_idle(&s->robot) || s->output_count) {
        return false;
    }
    controller_program_drop(s);
    s->program = PROGRAM_ENDED;
    return true;
}

/* Carry out an order. False: it cannot be done yet. */
static bool carry_out(struct controller *s, const struct controller_config *c,
                      const struct controller_panel *panel, struct order *o, uint32_t di)
{
    const bool idle = robot_idle(&s->robot);

    switch (o->kind) {
    case ORDER_MOVE:   return carry_out_move(s, c, panel, o, di);
    case ORDER_OUT:
    case ORDER_ANALOG: return controller_program_put(s, o);
    case ORDER_DELAY:  s->delay = idle ? llround(o->amount * FPGA_CLOCK_HZ) : 0; return idle;
    case ORDER_PAUSE:
        s->program = idle && !controller_key_take(&s->start) ? PROGRAM_PAUSED : PROGRAM_RUNS;
        return idle && s->program == PROGRAM_RUNS;
    case ORDER_END: return end(s);
    default:        return fail(s, CONTROLLER_PROGRAM, o);
    }
}

/* Whether a pause is the last order known; what stands behind it may look at inputs. */
static bool pause_ahead(const struct controller *s)
{
    const int32_t last = (s->heads + s->count + CONTROLLER_QUEUE - 1) % CONTROLLER_QUEUE;
    return (s->count > 0 ? &s->queue[last] : &s->next)->kind == ORDER_PAUSE;
}

void controller_program_poll(struct controller *s, const struct controller_config *c,
                             const struct orders_text *t, const struct robot_job_inputs *in,
                             int64_t clock)
{
    while (s->orders.on && s->count < c->depth) {
        struct order *o = &s->queue[(s->heads + s->count) % CONTROLLER_QUEUE];
        if (pause_ahead(s)) {
            return;
        }
        orders_next(&s->orders, &c->orders, t, in, o);
        if (o->kind == ORDER_NONE) {
            return;
        }
        o->known = clock;
        s->count++;
    }
}

static bool fetch(struct controller *s, const struct controller_config *c,
                  const struct orders_text *t, const struct robot_job_inputs *in)
{
    if (c->user) {
        if (s->count == 0) {
            s->report.starved += s->orders.on && robot_idle(&s->robot);
            return false;
        }
        s->next = s->queue[s->heads];
        s->heads = (s->heads + 1) % CONTROLLER_QUEUE;
        s->count--;
        return true;
    }
    orders_next(&s->orders, &c->orders, t, in, &s->next);
    s->next.known = in->now / FPGA_CLOCK_NS;
    return s->next.kind != ORDER_NONE;
}

/* What the program does until the next run; a delay goes on while inputs behind it are asked. */
static void look_what_is_next(struct controller *s)
{
    if (controller_running(s) && s->program != PROGRAM_PAUSED) {
        s->program = s->delay > 0                      ? PROGRAM_DELAYS
                     : s->orders.on && s->orders.waits ? PROGRAM_WAITS
                                                       : PROGRAM_RUNS;
    }
}

int32_t controller_program_run(struct controller *s, const struct controller_config *c,
                               const struct orders_text *t, const struct controller_panel *panel,
                               const struct robot_job_inputs *in)
{
    int32_t done = 0;

    look_at_until(s, in->di, false);
    s->delay -= s->delay > 0 ? c->slots * c->slot : 0;
    while (controller_running(s) && done < c->lines && s->delay <= 0) {
        if (s->next.kind == ORDER_NONE && !fetch(s, c, t, in)) {
            break;
        }
        const struct order order = { .kind = s->next.kind, .known = s->next.known };
        if (!carry_out(s, c, panel, &s->next, in->di)) {
            break;
        }
        done++;
        if (order.kind == ORDER_MOVE && s->known < 0) {
            s->known = order.known;
        }
        s->next.kind = ORDER_NONE;
    }
    look_what_is_next(s);
    return done;
}

/* Outputs that come on for a time, or that are set anew while they are. */
static void begin_pulses(struct controller *s, const struct controller_output *o, int64_t done)
{
    s->pulsed &= ~o->mask;
    if (o->pulse == 0) {
        return;
    }
    s->pulsed |= o->mask & o->value;
    for (int i = 0; i < ROBOT_JOB_SIGNALS; i++) {
        if (o->mask & o->value & 1u << i) {
            s->pulse_end[i] = done + o->pulse;
        }
    }
}

/* Pulses that are over. */
static void end_pulses(struct controller *s, int64_t done)
{
    uint32_t over = 0;

    for (int i = 0; i < ROBOT_JOB_SIGNALS && s->pulsed; i++) {
        over |= s->pulsed & 1u << i && s->pulse_end[i] <= done ? 1u << i : 0u;
    }
    outbox_put(&s->outbox, done, over, 0);
    s->out &= ~over;
    s->pulsed &= ~over;
}

void controller_program_outputs(struct controller *s, int64_t done)
{
    int32_t n = 0;

    end_pulses(s, done);
    for (; n < s->output_count && s->output[n].after <= s->reached; n++) {
        const struct controller_output *o = &s->output[n];
        outbox_put(&s->outbox, done, o->mask, o->value);
        s->out = (s->out & ~o->mask) | o->value;
        begin_pulses(s, o, done);
        if (o->analog) {
            s->volt[o->index] = o->volt;
            s->posts_ao = true;
        }
    }
    s->output_count -= n;
    memmove(s->output, s->output + n, (size_t)s->output_count * sizeof s->output[0]);
}
