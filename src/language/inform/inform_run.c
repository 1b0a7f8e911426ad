#include "inform_run.h"

#include <math.h>
#include <string.h>

enum kind { NOTHING, MOTION, MODE, OUTPUT, NUMBER, TIME, FLOW, OPERATOR };

/* What an instruction is about. */
static const uint8_t KIND[] = {
    [INFORM_OP_MOVE] = MOTION, [INFORM_OP_SPEED] = MODE,   [INFORM_OP_LEVEL] = MODE,
    [INFORM_OP_TOOL] = MODE,   [INFORM_OP_USER] = MODE,    [INFORM_OP_DOUT] = OUTPUT,
    [INFORM_OP_AOUT] = OUTPUT, [INFORM_OP_SET] = NUMBER,   [INFORM_OP_ADD] = NUMBER,
    [INFORM_OP_SUB] = NUMBER,  [INFORM_OP_MUL] = NUMBER,   [INFORM_OP_DIV] = NUMBER,
    [INFORM_OP_WAIT] = TIME,   [INFORM_OP_TIMER] = TIME,   [INFORM_OP_JUMP] = FLOW,
    [INFORM_OP_UNLESS] = FLOW, [INFORM_OP_CALL] = FLOW,    [INFORM_OP_RET] = FLOW,
    [INFORM_OP_LOOP] = FLOW,   [INFORM_OP_ENDLOOP] = FLOW, [INFORM_OP_PAUSE] = OPERATOR,
    [INFORM_OP_NOP] = NOTHING
};

void inform_begin(struct inform_run *run, const struct inform_program *p,
                  const struct inform_start *start)
{
    memset(run, 0, sizeof *run);
    run->frame[0].pc = p->job[start->job].start;
    run->began = -1;
    run->out = start->out;
    run->speed[INFORM_VJ] = start->vj;
    run->speed[INFORM_V] = start->v;
    run->speed[INFORM_VR] = start->vr;
    run->level = start->level;
    run->tool = start->tool;
    run->user = start->user;
}

static double value(const struct inform_run *run, const struct inform_inputs *in,
                    const struct inform_operand *o)
{
    switch (o->kind) {
    case INFORM_B:
    case INFORM_I:
    case INFORM_D:        return run->whole[o->kind - INFORM_B][o->index];
    case INFORM_R:        return run->real[o->index];
    case INFORM_IN:       return in->di >> o->index & 1u;
    case INFORM_OT:       return run->out >> o->index & 1u;
    case INFORM_AI:       return in->ai[o->index];
    case INFORM_CONSTANT:
    case INFORM_NOTHING:  break;
    }
    return o->number;
}

static bool holds(const struct inform_run *run, const struct inform_inputs *in,
                  const struct inform_code *c)
{
    const double left = value(run, in, &c->left), right = value(run, in, &c->right);
    switch (c->relation) {
    case INFORM_ALWAYS:    break;
    case INFORM_EQUAL:     return left == right;
    case INFORM_NOT_EQUAL: return left != right;
    case INFORM_LESS:      return left < right;
    case INFORM_MORE:      return left > right;
    case INFORM_AT_MOST:   return left <= right;
    case INFORM_AT_LEAST:  return left >= right;
    }
    return true;
}

static bool is_input(const struct inform_operand *o)
{
    return o->kind == INFORM_IN || o->kind == INFORM_AI;
}

/* A variable takes a result, whole ones its whole part. */
static enum inform_fault store(struct inform_run *run, const struct inform_operand *o, double x)
{
    x = o->kind == INFORM_R ? x : trunc(x);
    if (!(x >= inform_low(o->kind) && x <= inform_high(o->kind))) {
        return INFORM_BAD_RANGE;
    }
    if (o->kind == INFORM_R) {
        run->real[o->index] = x;
    } else {
        run->whole[o->kind - INFORM_B][o->index] = (int32_t)x;
    }
    return INFORM_OK;
}

/* SET .. DIV. Sums, products and quotients of two D variables are exact in a double as far as
 * they fit a D variable. */
static enum inform_fault calculate(struct inform_run *run, const struct inform_inputs *in,
                                   const struct inform_code *c)
{
    const double left = value(run, in, &c->left), right = value(run, in, &c->right);
    switch (c->op) {
    case INFORM_OP_ADD: return store(run, &c->left, left + right);
    case INFORM_OP_SUB: return store(run, &c->left, left - right);
    case INFORM_OP_MUL: return store(run, &c->left, left * right);
    case INFORM_OP_DIV:
        return right == 0.0 ? INFORM_BAD_ZERO_DIVISION : store(run, &c->left, left / right);
    default: return store(run, &c->left, right);
    }
}

/* The next point; its number is the move's. */
static void move(struct inform_run *run, const struct inform_points *points,
                 const struct inform_code *c, struct inform_request *r)
{
    const struct inform_point *p = &points->point[c->to];
    const enum inform_speed usual = c->path == INFORM_JOINT ? INFORM_VJ
                                    : run->rotary           ? INFORM_VR
                                                            : INFORM_V;
    r->answer = INFORM_MOVE;
    r->after = ++run->moves;
    r->path = c->path;
    r->point = c->to;
    r->via = c->via;
    r->tag = c->tag != INFORM_DEFAULT ? c->tag : usual;
    r->speed = c->tag != INFORM_DEFAULT ? c->speed : run->speed[usual];
    r->level = c->level != INFORM_ANY ? c->level : run->level;
    r->corner = c->corner;
    r->tool = p->tool != INFORM_ANY ? p->tool : run->tool;
    r->user = p->user != INFORM_ANY ? p->user : run->user;
}

static enum inform_fault output(struct inform_run *run, const struct inform_inputs *in,
                                const struct inform_code *c, struct inform_request *r)
{
    const double x = value(run, in, &c->right);
    r->index = c->to;
    if (c->op == INFORM_OP_AOUT) {
        r->answer = INFORM_AOUT;
        r->volt = x;
        return fabs(x) <= INFORM_VOLT_MAX ? INFORM_OK : INFORM_BAD_RANGE;
    }
    r->answer = INFORM_DOUT;
    r->on = x != 0.0;
    run->out = (run->out & ~(1u << c->to)) | (uint32_t)r->on << c->to;
    return INFORM_OK;
}

/* WAIT and TIMER: whether the time is up, or the condition holds. */
static bool waited(struct inform_run *run, const struct inform_inputs *in,
                   const struct inform_code *c)
{
    if (run->began < 0) {
        run->began = in->now;
    }
    if ((c->op == INFORM_OP_WAIT && holds(run, in, c))
        || (c->time >= 0 && in->now - run->began >= c->time)) {
        run->began = -1;
        return true;
    }
    return false;
}

/* Each of these returns where the program goes on, in the frame that is the top then. */

static int32_t call(struct inform_run *run, int32_t to)
{
    if (run->depth == INFORM_CALLS) {
        run->fault = INFORM_BAD_STACK;
        return run->frame[run->depth].pc;
    }
    run->frame[run->depth++].pc++;
    memset(&run->frame[run->depth], 0, sizeof run->frame[0]);
    return to;
}

static int32_t come_back(struct inform_run *run, struct inform_request *r)
{
    if (run->depth > 0) {
        run->depth--;
    } else {
        run->ended = 1;
        r->answer = INFORM_END;
    }
    return run->frame[run->depth].pc;
}

/* LOOP sets its counter and ENDLOOP goes back. */
static int32_t loop(struct inform_run *run, const struct inform_inputs *in,
                    const struct inform_code *c, int32_t pc)
{
    int32_t *left = &run->frame[run->depth].loop[c->via];
    if (c->op == INFORM_OP_LOOP) {
        const double rounds = value(run, in, &c->right);
        *left = c->right.kind == INFORM_NOTHING ? -1 : rounds > 0.0 ? (int32_t)rounds : 0;
        return *left == 0 ? c->to : pc + 1;
    }
    *left -= *left > 0;
    return *left == 0 ? pc + 1 : c->to;
}

static int32_t flow(struct inform_run *run, const struct inform_inputs *in,
                    const struct inform_code *c, bool done, struct inform_request *r)
{
    const int32_t pc = run->frame[run->depth].pc;

    switch (c->op) {
    case INFORM_OP_JUMP:   return done ? c->to : pc + 1;
    case INFORM_OP_UNLESS: return done ? pc + 1 : c->to;
    case INFORM_OP_CALL:   return done ? call(run, c->to) : pc + 1;
    case INFORM_OP_RET:    return done ? come_back(run, r) : pc + 1;
    default:               return loop(run, in, c, pc);
    }
}

/* SPEED, PL, TOOL, USER: what is in force from here on. */
static void set_mode(struct inform_run *run, const struct inform_code *c)
{
    switch (c->op) {
    case INFORM_OP_SPEED:
        run->speed[c->tag] = c->speed;
        run->rotary = c->tag == INFORM_VJ ? run->rotary : c->tag == INFORM_VR;
        break;
    case INFORM_OP_LEVEL: run->level = c->to; break;
    case INFORM_OP_TOOL:  run->tool = c->to; break;
    default:              run->user = c->to;
    }
}

/* Whether an instruction must see all moves before it reached. */
static bool needs_rest(const struct inform_run *run, const struct inform_inputs *in,
                       const struct inform_code *c)
{
    switch (c->op) {
    case INFORM_OP_WAIT:
    case INFORM_OP_TIMER: return true;
    case INFORM_OP_PAUSE: return is_input(&c->left) || holds(run, in, c);
    case INFORM_OP_RET:   return is_input(&c->left) || (run->depth == 0 && holds(run, in, c));
    default:              return is_input(&c->left) || is_input(&c->right);
    }
}

/* The instruction is done, unless it has a fault: true if it makes a request. */
static bool finish(struct inform_run *run, struct inform_request *r, int32_t next)
{
    if (r->answer != INFORM_BUSY) {
        run->idle = 0;
    } else if (run->fault == INFORM_OK && run->idle >= INFORM_IDLE_MAX) {
        run->fault = INFORM_BAD_ENDLESS;
    }
    if (run->fault != INFORM_OK) {
        r->answer = INFORM_FAULT;
        r->fault = run->fault;
        return true;
    }
    run->frame[run->depth].pc = next;
    return r->answer != INFORM_BUSY;
}

/* Do one instruction: true if it makes a request. */
static bool step(struct inform_run *run, const struct inform_program *p,
                 const struct inform_points *points, const struct inform_inputs *in,
                 struct inform_request *r)
{
    const int32_t pc = run->frame[run->depth].pc;
    const struct inform_code *c = &p->code[pc];
    int32_t next = pc + 1;

    r->line = c->line;
    if (in->reached < run->moves && needs_rest(run, in, c)) {
        r->answer = INFORM_REACH;
        return true;
    }
    const bool done = c->op == INFORM_OP_WAIT || holds(run, in, c);
    run->idle = is_input(&c->left) || is_input(&c->right) ? 0 : run->idle + 1;
    switch (KIND[c->op]) {
    case MOTION: move(run, points, c, r); break;
    case MODE:   set_mode(run, c); break;
    case OUTPUT: run->fault = output(run, in, c, r); break;
    case NUMBER: run->fault = calculate(run, in, c); break;
    case TIME:
        if (!waited(run, in, c)) {
            r->answer = INFORM_WAIT;
            next = pc;
        }
        break;
    case FLOW:     next = flow(run, in, c, done, r); break;
    case OPERATOR: r->answer = done ? INFORM_PAUSE : r->answer; break;
    default:       break;
    }
    return finish(run, r, next);
}

void inform_next(struct inform_run *run, const struct inform_program *p,
                 const struct inform_points *points, const struct inform_inputs *in, int32_t most,
                 struct inform_request *r)
{
    memset(r, 0, sizeof *r);
    r->after = run->moves;
    r->line = p->code[run->frame[run->depth].pc].line;
    r->fault = run->fault;
    r->answer = run->fault != INFORM_OK ? INFORM_FAULT : run->ended ? INFORM_END : INFORM_BUSY;
    for (int32_t n = 0; n < most && r->answer == INFORM_BUSY; n++) {
        if (step(run, p, points, in, r)) {
            return;
        }
    }
}

int32_t inform_running(const struct inform_run *run, const struct inform_program *p, int32_t *line)
{
    const int32_t pc = run->frame[run->depth].pc;
    int32_t job = 0;
    while (job + 1 < p->jobs && p->job[job + 1].start <= pc) {
        job++;
    }
    *line = p->code[pc].line;
    return job;
}
