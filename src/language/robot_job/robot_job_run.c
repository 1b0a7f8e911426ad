#include "robot_job_run.h"

#include <math.h>
#include <string.h>

#define GROUP_MASK ((1u << ROBOT_JOB_GROUP) - 1u)

enum kind { NOTHING, MOTION, MODE, OUTPUT, NUMBER, ARGUMENT, TIME, FLOW, OPERATOR };

/* What the instruction being done works on. */
static const uint8_t KIND[] = { [ROBOT_JOB_OP_MOVE] = MOTION,     [ROBOT_JOB_OP_SPEED] = MODE,
                                [ROBOT_JOB_OP_LEVEL] = MODE,      [ROBOT_JOB_OP_TOOL] = MODE,
                                [ROBOT_JOB_OP_USER] = MODE,       [ROBOT_JOB_OP_DOUT] = OUTPUT,
                                [ROBOT_JOB_OP_GROUP] = OUTPUT,    [ROBOT_JOB_OP_PULSE] = OUTPUT,
                                [ROBOT_JOB_OP_SHIFT] = MODE,      [ROBOT_JOB_OP_GETARG] = ARGUMENT,
                                [ROBOT_JOB_OP_REACHED] = NOTHING, [ROBOT_JOB_OP_AOUT] = OUTPUT,
                                [ROBOT_JOB_OP_SET] = NUMBER,      [ROBOT_JOB_OP_ADD] = NUMBER,
                                [ROBOT_JOB_OP_SUB] = NUMBER,      [ROBOT_JOB_OP_MUL] = NUMBER,
                                [ROBOT_JOB_OP_DIV] = NUMBER,      [ROBOT_JOB_OP_WAIT] = TIME,
                                [ROBOT_JOB_OP_TIMER] = TIME,      [ROBOT_JOB_OP_JUMP] = FLOW,
                                [ROBOT_JOB_OP_UNLESS] = FLOW,     [ROBOT_JOB_OP_CALL] = FLOW,
                                [ROBOT_JOB_OP_RET] = FLOW,        [ROBOT_JOB_OP_LOOP] = FLOW,
                                [ROBOT_JOB_OP_ENDLOOP] = FLOW,    [ROBOT_JOB_OP_PAUSE] = OPERATOR,
                                [ROBOT_JOB_OP_NOP] = NOTHING };

void robot_job_begin(struct robot_job_run *run, const struct robot_job_program *p,
                     const struct robot_job_start *start)
{
    memset(run, 0, sizeof *run);
    run->frames = 1;
    run->frame[0].pc = p->job[start->job].start;
    run->began = -1;
    run->shift = -1;
    run->out = start->out;
    run->speed[ROBOT_JOB_VJ] = start->vj;
    run->speed[ROBOT_JOB_V] = start->v;
    run->speed[ROBOT_JOB_VR] = start->vr;
    run->level = start->level;
    run->tool = start->tool;
    run->user = start->user;
}

/* The number that an operand stands for.
 * CCN 16: a case for each kind. */
static double value(const struct robot_job_run *run, const struct robot_job_inputs *in,
                    const struct robot_job_operand *o)
{
    switch (o->kind) {
    case ROBOT_JOB_B:
    case ROBOT_JOB_I:
    case ROBOT_JOB_D:        return run->whole[o->kind - ROBOT_JOB_B][o->index];
    case ROBOT_JOB_R:        return run->real[o->index];
    case ROBOT_JOB_IN:       return in->di >> o->index & 1u;
    case ROBOT_JOB_OT:       return run->out >> o->index & 1u;
    case ROBOT_JOB_AI:       return in->ai[o->index];
    case ROBOT_JOB_IG:       return in->di >> ROBOT_JOB_GROUP * o->index & GROUP_MASK;
    case ROBOT_JOB_OG:       return run->out >> ROBOT_JOB_GROUP * o->index & GROUP_MASK;
    case ROBOT_JOB_LB:
    case ROBOT_JOB_LI:
    case ROBOT_JOB_LD:       return run->frame[run->depth].whole[o->kind - ROBOT_JOB_LB][o->index];
    case ROBOT_JOB_LR:       return run->frame[run->depth].real[o->index];
    case ROBOT_JOB_CONSTANT:
    case ROBOT_JOB_NOTHING:  break;
    }
    return o->number;
}

static bool compare(const struct robot_job_run *run, const struct robot_job_inputs *in,
                    enum robot_job_relation relation, const struct robot_job_operand *a,
                    const struct robot_job_operand *b)
{
    const double left = value(run, in, a), right = value(run, in, b);
    switch (relation) {
    case ROBOT_JOB_ALWAYS:    break;
    case ROBOT_JOB_EQUAL:     return left == right;
    case ROBOT_JOB_NOT_EQUAL: return left != right;
    case ROBOT_JOB_LESS:      return left < right;
    case ROBOT_JOB_MORE:      return left > right;
    case ROBOT_JOB_AT_MOST:   return left <= right;
    case ROBOT_JOB_AT_LEAST:  return left >= right;
    }
    return true;
}

/* Whether the condition of an instruction holds: all its comparisons, or any of them. */
static bool holds(const struct robot_job_run *run, const struct robot_job_program *p,
                  const struct robot_job_inputs *in, const struct robot_job_instruction *c)
{
    bool good = compare(run, in, c->relation, &c->left, &c->right);
    for (int32_t i = 0; i < c->terms && good != c->any; i++) {
        const struct robot_job_term *t = &p->term[c->more + i];
        good = compare(run, in, t->relation, &t->left, &t->right);
    }
    return good;
}

static bool is_input(const struct robot_job_operand *o)
{
    return o->kind == ROBOT_JOB_IN || o->kind == ROBOT_JOB_AI || o->kind == ROBOT_JOB_IG;
}

/* Whether an instruction looks at an input. */
static bool looks(const struct robot_job_program *p, const struct robot_job_instruction *c)
{
    bool found = is_input(&c->left) || is_input(&c->right);
    for (int32_t i = 0; i < c->terms; i++) {
        found |= is_input(&p->term[c->more + i].left);
    }
    return found;
}

/* Set a variable to a result; variables of whole numbers take its whole part. */
static enum robot_job_fault store(struct robot_job_run *run, const struct robot_job_operand *o,
                                  double x)
{
    struct robot_job_call *frame = &run->frame[run->depth];
    x = o->kind == ROBOT_JOB_R || o->kind == ROBOT_JOB_LR ? x : trunc(x);
    if (!(x >= robot_job_low(o->kind) && x <= robot_job_high(o->kind))) {
        return ROBOT_JOB_BAD_RANGE;
    }
    if (o->kind == ROBOT_JOB_R) {
        run->real[o->index] = x;
    } else if (o->kind == ROBOT_JOB_LR) {
        frame->real[o->index] = x;
    } else if (o->kind >= ROBOT_JOB_LB) {
        frame->whole[o->kind - ROBOT_JOB_LB][o->index] = (int32_t)x;
    } else {
        run->whole[o->kind - ROBOT_JOB_B][o->index] = (int32_t)x;
    }
    return ROBOT_JOB_OK;
}

/* SET .. DIV. Sums, products and quotients of two D variables are exact in a double as far as
 * they fit a D variable. */
static enum robot_job_fault calculate(struct robot_job_run *run, const struct robot_job_inputs *in,
                                      const struct robot_job_instruction *c)
{
    const double left = value(run, in, &c->left), right = value(run, in, &c->right);
    switch (c->op) {
    case ROBOT_JOB_OP_ADD: return store(run, &c->left, left + right);
    case ROBOT_JOB_OP_SUB: return store(run, &c->left, left - right);
    case ROBOT_JOB_OP_MUL: return store(run, &c->left, left * right);
    case ROBOT_JOB_OP_DIV:
        return right == 0.0 ? ROBOT_JOB_BAD_ZERO_DIVISION : store(run, &c->left, left / right);
    default: return store(run, &c->left, right);
    }
}

/* Request a move to a point, and number it. */
static void move(struct robot_job_run *run, const struct robot_job_point *p,
                 const struct robot_job_instruction *c, struct robot_job_request *r)
{
    const enum robot_job_speed usual = c->path == ROBOT_JOB_JOINT ? ROBOT_JOB_VJ
                                       : run->rotary              ? ROBOT_JOB_VR
                                                                  : ROBOT_JOB_V;
    r->answer = ROBOT_JOB_MOVE;
    r->after = ++run->moves;
    r->path = c->path;
    r->point = c->to;
    r->via = c->via;
    r->tag = c->tag != ROBOT_JOB_DEFAULT ? c->tag : usual;
    r->speed = c->tag != ROBOT_JOB_DEFAULT ? c->speed : run->speed[usual];
    r->level = c->level != ROBOT_JOB_ANY ? c->level : run->level;
    r->corner = c->corner;
    r->tool = p->tool != ROBOT_JOB_ANY ? p->tool : run->tool;
    r->user = p->user != ROBOT_JOB_ANY ? p->user : run->user;
    r->shift = run->shift;
    r->shift_user = run->shift_user;
    run->early = c->early;
}

static enum robot_job_fault output(struct robot_job_run *run, const struct robot_job_inputs *in,
                                   const struct robot_job_instruction *c,
                                   struct robot_job_request *r)
{
    const double x = value(run, in, &c->right);
    r->index = c->to;
    r->after -= run->early;
    if (c->op == ROBOT_JOB_OP_GROUP) {
        r->answer = ROBOT_JOB_DOUT;
        r->index = ROBOT_JOB_GROUP * c->to;
        r->count = ROBOT_JOB_GROUP;
        if (!(x >= 0.0 && x <= GROUP_MASK)) {
            return ROBOT_JOB_BAD_RANGE;
        }
        r->on = (int32_t)x;
        run->out = (run->out & ~(GROUP_MASK << r->index)) | (uint32_t)r->on << r->index;
        return ROBOT_JOB_OK;
    }
    if (c->op == ROBOT_JOB_OP_PULSE) { /* to the program it is what it becomes: off */
        r->answer = ROBOT_JOB_DOUT;
        r->count = r->on = 1;
        r->time = c->time;
        run->out &= ~(1u << c->to);
        return ROBOT_JOB_OK;
    }
    if (c->op == ROBOT_JOB_OP_AOUT) {
        r->answer = ROBOT_JOB_AOUT;
        r->volt = x;
        return fabs(x) <= ROBOT_JOB_VOLT_MAX ? ROBOT_JOB_OK : ROBOT_JOB_BAD_RANGE;
    }
    r->answer = ROBOT_JOB_DOUT;
    r->count = 1;
    r->on = x != 0.0;
    run->out = (run->out & ~(1u << c->to)) | (uint32_t)r->on << c->to;
    return ROBOT_JOB_OK;
}

/* WAIT and TIMER: whether the time is up, or the condition holds. */
static bool waited(struct robot_job_run *run, const struct robot_job_program *p,
                   const struct robot_job_inputs *in, const struct robot_job_instruction *c)
{
    if (run->began < 0) {
        run->began = in->now;
    }
    if ((c->op == ROBOT_JOB_OP_WAIT && holds(run, p, in, c))
        || (c->time >= 0 && in->now - run->began >= c->time)) {
        run->began = -1;
        return true;
    }
    return false;
}

/* Each of these returns the instruction at which the program goes on, in the frame then on top. */

/* The arguments are looked at in the frame of the caller. */
static int32_t call(struct robot_job_run *run, const struct robot_job_program *p,
                    const struct robot_job_inputs *in, const struct robot_job_instruction *c)
{
    if (run->depth == ROBOT_JOB_CALLS) {
        run->fault = ROBOT_JOB_BAD_STACK;
        return run->frame[run->depth].pc;
    }
    struct robot_job_call *frame = &run->frame[run->depth + 1];
    memset(frame, 0, sizeof *frame);
    frame->arguments = c->arguments;
    for (int32_t i = 0; i < c->arguments; i++) {
        frame->argument[i] = value(run, in, &p->term[c->argument + i].left);
    }
    run->frame[run->depth++].pc++;
    run->frames++;
    return c->to;
}

static int32_t come_back(struct robot_job_run *run, struct robot_job_request *r)
{
    if (run->depth > 0) {
        run->depth--;
        run->frames--;
    } else {
        run->ended = 1;
        r->answer = ROBOT_JOB_END;
    }
    return run->frame[run->depth].pc;
}

/* LOOP sets its counter and ENDLOOP goes back. */
static int32_t loop(struct robot_job_run *run, const struct robot_job_inputs *in,
                    const struct robot_job_instruction *c, int32_t pc)
{
    int32_t *left = &run->frame[run->depth].loop[c->via];
    if (c->op == ROBOT_JOB_OP_LOOP) {
        const double rounds = value(run, in, &c->right);
        *left = c->right.kind == ROBOT_JOB_NOTHING ? -1 : rounds > 0.0 ? (int32_t)rounds : 0;
        return *left == 0 ? c->to : pc + 1;
    }
    *left -= *left > 0;
    return *left == 0 ? pc + 1 : c->to;
}

static int32_t flow(struct robot_job_run *run, const struct robot_job_program *p,
                    const struct robot_job_inputs *in, const struct robot_job_instruction *c,
                    bool done, struct robot_job_request *r)
{
    const int32_t pc = run->frame[run->depth].pc;

    switch (c->op) {
    case ROBOT_JOB_OP_JUMP:   return done ? c->to : pc + 1;
    case ROBOT_JOB_OP_UNLESS: return done ? pc + 1 : c->to;
    case ROBOT_JOB_OP_CALL:   return done ? call(run, p, in, c) : pc + 1;
    case ROBOT_JOB_OP_RET:    return done ? come_back(run, r) : pc + 1;
    default:                  return loop(run, in, c, pc);
    }
}

/* SPEED, PL, TOOL, USER, SFTON, SFTOF: change what is in force from here on. */
static void set_mode(struct robot_job_run *run, const struct robot_job_instruction *c)
{
    switch (c->op) {
    case ROBOT_JOB_OP_SPEED:
        run->speed[c->tag] = c->speed;
        run->rotary = c->tag == ROBOT_JOB_VJ ? run->rotary : c->tag == ROBOT_JOB_VR;
        break;
    case ROBOT_JOB_OP_LEVEL: run->level = c->to; break;
    case ROBOT_JOB_OP_TOOL:  run->tool = c->to; break;
    case ROBOT_JOB_OP_SHIFT:
        run->shift = c->to;
        run->shift_user = c->via;
        break;
    default: run->user = c->to;
    }
}

/* Whether an instruction waits until all moves before it are reached. */
static bool needs_rest(const struct robot_job_run *run, const struct robot_job_program *p,
                       const struct robot_job_inputs *in, const struct robot_job_instruction *c)
{
    switch (c->op) {
    case ROBOT_JOB_OP_WAIT:
    case ROBOT_JOB_OP_TIMER:
    case ROBOT_JOB_OP_REACHED: return true;
    case ROBOT_JOB_OP_PAUSE:   return looks(p, c) || holds(run, p, in, c);
    case ROBOT_JOB_OP_RET:     return looks(p, c) || (run->depth == 0 && holds(run, p, in, c));
    default:                   return looks(p, c);
    }
}

/* GETARG: an argument that the job was not called with is a fault. */
static enum robot_job_fault take_argument(struct robot_job_run *run,
                                          const struct robot_job_instruction *c)
{
    const struct robot_job_call *frame = &run->frame[run->depth];
    return c->argument < frame->arguments ? store(run, &c->left, frame->argument[c->argument])
                                          : ROBOT_JOB_BAD_ARGUMENT;
}

/* Carry out an instruction, unless it has a fault. True: it makes a request. */
static bool finish(struct robot_job_run *run, struct robot_job_request *r, int32_t next)
{
    if (r->answer != ROBOT_JOB_BUSY) {
        run->idle = 0;
    } else if (run->fault == ROBOT_JOB_OK && run->idle >= ROBOT_JOB_IDLE_MAX) {
        run->fault = ROBOT_JOB_BAD_ENDLESS;
    }
    if (run->fault != ROBOT_JOB_OK) {
        r->answer = ROBOT_JOB_FAULT;
        r->fault = run->fault;
        return true;
    }
    run->frame[run->depth].pc = next;
    return r->answer != ROBOT_JOB_BUSY;
}

/* Do one instruction. True: it makes a request.
 * CCN 17: a case for each kind of work. */
static bool step(struct robot_job_run *run, const struct robot_job_program *p,
                 const struct robot_job_points *points, const struct robot_job_inputs *in,
                 struct robot_job_request *r)
{
    const int32_t pc = run->frame[run->depth].pc;
    const struct robot_job_instruction *c = &p->instruction[pc];
    int32_t next = pc + 1;

    r->line = c->line;
    r->job = pc; /* its number comes with the request */
    if (in->reached < run->moves && needs_rest(run, p, in, c)) {
        r->answer = ROBOT_JOB_REACH;
        return true;
    }
    if (run->early && needs_rest(run, p, in, c)) {
        run->early = 0; /* the move is reached */
    }
    const bool done = c->op == ROBOT_JOB_OP_WAIT || holds(run, p, in, c);
    run->idle = looks(p, c) ? 0 : run->idle + 1;
    switch (KIND[c->op]) {
    case MOTION:   move(run, robot_job_point(p, points, c->to), c, r); break;
    case MODE:     set_mode(run, c); break;
    case OUTPUT:   run->fault = output(run, in, c, r); break;
    case NUMBER:   run->fault = calculate(run, in, c); break;
    case ARGUMENT: run->fault = take_argument(run, c); break;
    case TIME:
        if (!waited(run, p, in, c)) {
            r->answer = ROBOT_JOB_WAIT;
            next = pc;
        }
        break;
    case FLOW:     next = flow(run, p, in, c, done, r); break;
    case OPERATOR: r->answer = done ? ROBOT_JOB_PAUSE : r->answer; break;
    default:       break;
    }
    return finish(run, r, next);
}

/* Number of the job that an instruction belongs to. */
static int32_t job_of(const struct robot_job_program *p, int32_t instruction)
{
    int32_t job = 0;
    while (job + 1 < p->jobs && p->job[job + 1].start <= instruction) {
        job++;
    }
    return job;
}

void robot_job_next(struct robot_job_run *run, const struct robot_job_program *p,
                    const struct robot_job_points *points, const struct robot_job_inputs *in,
                    int32_t most, struct robot_job_request *r)
{
    memset(r, 0, sizeof *r);
    r->after = run->moves;
    r->job = run->frame[run->depth].pc;
    r->line = p->instruction[r->job].line;
    r->fault = run->fault;
    r->answer = run->fault != ROBOT_JOB_OK ? ROBOT_JOB_FAULT
                : run->ended               ? ROBOT_JOB_END
                                           : ROBOT_JOB_BUSY;
    for (int32_t n = 0; n < most && r->answer == ROBOT_JOB_BUSY; n++) {
        if (step(run, p, points, in, r)) {
            break;
        }
    }
    r->job = job_of(p, r->job);
}

int32_t robot_job_running(const struct robot_job_run *run, const struct robot_job_program *p,
                          int32_t *line)
{
    const int32_t pc = run->frame[run->depth].pc;
    *line = p->instruction[pc].line;
    return job_of(p, pc);
}
