#include "robot_job_values.h"

#include <math.h>
#include <string.h>

enum kind { NOTHING, MOTION, MODE, OUTPUT, NUMBER, PLACE, ARGUMENT, TIME, FLOW, OPERATOR };

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
                                [ROBOT_JOB_OP_PLACE_SET] = PLACE, [ROBOT_JOB_OP_PLACE_ADD] = PLACE,
                                [ROBOT_JOB_OP_PLACE_SUB] = PLACE, [ROBOT_JOB_OP_SETE] = PLACE,
                                [ROBOT_JOB_OP_GETE] = PLACE,      [ROBOT_JOB_OP_GETS] = PLACE,
                                [ROBOT_JOB_OP_CNVRT] = PLACE,     [ROBOT_JOB_OP_MSHIFT] = PLACE,
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
    run->tool = run->hand = start->tool;
    run->user = start->user;
}

static bool compare(struct robot_job_run *run, const struct robot_job_inputs *in,
                    enum robot_job_relation relation, const struct robot_job_operand *a,
                    const struct robot_job_operand *b)
{
    const double left = robot_job_value(run, in, a), right = robot_job_value(run, in, b);
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
static bool holds(struct robot_job_run *run, const struct robot_job_program *p,
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

/* SET .. DIV. Sums, products and quotients of two D variables are exact in a double as far as
 * they fit a D variable. */
static enum robot_job_fault calculate(struct robot_job_run *run, const struct robot_job_inputs *in,
                                      const struct robot_job_instruction *c)
{
    const double left = robot_job_value(run, in, &c->left),
                 right = robot_job_value(run, in, &c->right);
    switch (c->op) {
    case ROBOT_JOB_OP_ADD: return robot_job_store(run, &c->left, left + right);
    case ROBOT_JOB_OP_SUB: return robot_job_store(run, &c->left, left - right);
    case ROBOT_JOB_OP_MUL: return robot_job_store(run, &c->left, left * right);
    case ROBOT_JOB_OP_DIV:
        return right == 0.0 ? ROBOT_JOB_BAD_ZERO_DIVISION
                            : robot_job_store(run, &c->left, left / right);
    default: return robot_job_store(run, &c->left, right);
    }
}

/* The speed of a tag that a line gives, by a number or by a variable that counts in its unit. */
static enum robot_job_fault speed(struct robot_job_run *run, const struct robot_job_inputs *in,
                                  const struct robot_job_instruction *c, double *x)
{
    *x = c->speed;
    if (c->right.kind == ROBOT_JOB_NOTHING) {
        return ROBOT_JOB_OK;
    }
    *x = robot_job_value(run, in, &c->right) * robot_job_speed_unit(c->tag);
    return *x >= robot_job_speed_low(c->tag) && *x <= robot_job_speed_high(c->tag)
               ? ROBOT_JOB_OK
               : ROBOT_JOB_BAD_RANGE;
}

/* The shares of ACC and DEC. */
static enum robot_job_fault shares(struct robot_job_run *run, const struct robot_job_inputs *in,
                                   const struct robot_job_instruction *c, double share[2])
{
    bool good = true;
    for (int i = 0; i < 2; i++) {
        const bool given = c->acc[i].kind != ROBOT_JOB_NOTHING;
        share[i] = given ? robot_job_value(run, in, &c->acc[i]) : ROBOT_JOB_ACC_MAX;
        good = good && share[i] >= ROBOT_JOB_ACC_MIN && share[i] <= ROBOT_JOB_ACC_MAX;
    }
    return good ? ROBOT_JOB_OK : ROBOT_JOB_BAD_RANGE;
}

/* The point of the next line, to which a spline goes on, unless that has another tool. What is
 * wrong with it shows where it is done. */
static void go_on(struct robot_job_run *run, const struct robot_job_program *p,
                  const struct robot_job_points *points, const struct robot_job_instruction *next,
                  struct robot_job_request *r)
{
    const enum robot_job_fault before = run->fault;
    int32_t number;

    if (robot_job_which(run, p, points, next->to, &next->to_by, &number) == ROBOT_JOB_OK) {
        const struct robot_job_point *at = robot_job_place(run, p, points, number);
        const int32_t tool = at->tool != ROBOT_JOB_ANY ? at->tool : run->tool;
        r->next = tool == r->tool ? number : -1;
        r->next_user = at->user != ROBOT_JOB_ANY ? at->user : run->user;
    }
    run->fault = before;
}

/* Request a move to a point, and number it.
 * CCN 17: what its line leaves open is as the job has it by then. */
static enum robot_job_fault move(struct robot_job_run *run, const struct robot_job_program *p,
                                 const struct robot_job_points *points,
                                 const struct robot_job_inputs *in,
                                 const struct robot_job_instruction *c, struct robot_job_request *r)
{
    const enum robot_job_speed usual = c->path == ROBOT_JOB_JOINT ? ROBOT_JOB_VJ
                                       : run->rotary              ? ROBOT_JOB_VR
                                                                  : ROBOT_JOB_V;
    enum robot_job_fault fault = robot_job_which(run, p, points, c->to, &c->to_by, &r->point);
    if (fault == ROBOT_JOB_OK && c->path == ROBOT_JOB_CIRCLE) {
        fault = robot_job_which(run, p, points, c->via, &c->via_by, &r->via);
    }
    r->speed = run->speed[usual];
    if (fault == ROBOT_JOB_OK && c->tag != ROBOT_JOB_DEFAULT) {
        fault = speed(run, in, c, &r->speed);
    }
    fault = fault == ROBOT_JOB_OK ? shares(run, in, c, r->acc) : fault;
    if (fault != ROBOT_JOB_OK) {
        return fault;
    }
    const struct robot_job_point *at = robot_job_place(run, p, points, r->point);
    if (c->increment != ROBOT_JOB_NOT_BY && at->kind != ROBOT_JOB_POSE) {
        return ROBOT_JOB_BAD_STEP;
    }
    r->answer = ROBOT_JOB_MOVE;
    r->after = ++run->moves;
    r->path = c->path;
    r->tag = c->tag != ROBOT_JOB_DEFAULT ? c->tag : usual;
    r->level = c->level != ROBOT_JOB_ANY ? c->level : run->level;
    r->corner = c->corner;
    r->tool = at->tool != ROBOT_JOB_ANY ? at->tool : run->tool;
    r->user = at->user != ROBOT_JOB_ANY ? at->user : run->user;
    r->shift = run->shift;
    r->shift_user = run->shift_user;
    memcpy(r->shift_by, run->shift_by, sizeof r->shift_by);
    r->next = -1;
    if (c->goes_on) {
        go_on(run, p, points, c + 1, r);
    }
    r->increment = c->increment;
    if (c->increment != ROBOT_JOB_NOT_BY) { /* from where the tool is, which is shifted already */
        r->tool = run->hand;
        r->shift = -1;
    }
    r->beside = c->beside;
    r->until = c->until;
    r->until_on = c->until_on;
    run->hand = r->tool;
    run->early = c->early;
    run->until = c->until >= 0;
    return ROBOT_JOB_OK;
}

static enum robot_job_fault output(struct robot_job_run *run, const struct robot_job_inputs *in,
                                   const struct robot_job_instruction *c,
                                   struct robot_job_request *r)
{
    const double x = robot_job_value(run, in, &c->right);
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
        frame->argument[i] = robot_job_value(run, in, &p->term[c->argument + i].left);
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
        const double rounds = robot_job_value(run, in, &c->right);
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

/* SFTON takes the position as it is now. */
static enum robot_job_fault shift(struct robot_job_run *run, const struct robot_job_program *p,
                                  const struct robot_job_points *points,
                                  const struct robot_job_instruction *c)
{
    run->shift = -1;
    if (c->to < 0) {
        return ROBOT_JOB_OK;
    }
    const enum robot_job_fault fault =
        robot_job_which(run, p, points, c->to, &c->to_by, &run->shift);
    if (fault != ROBOT_JOB_OK) {
        return fault;
    }
    const struct robot_job_point *at = robot_job_place(run, p, points, run->shift);
    run->shift_user = c->via;
    memcpy(run->shift_by, at->value, sizeof run->shift_by);
    return at->kind == ROBOT_JOB_POSE && at->value[3] == 0.0 && at->value[4] == 0.0
                   && at->value[5] == 0.0
               ? ROBOT_JOB_OK
               : ROBOT_JOB_BAD_STEP;
}

/* SPEED, PL, TOOL, USER, SFTON, SFTOF: change what is in force from here on. */
static enum robot_job_fault set_mode(struct robot_job_run *run, const struct robot_job_program *p,
                                     const struct robot_job_points *points,
                                     const struct robot_job_inputs *in,
                                     const struct robot_job_instruction *c)
{
    switch (c->op) {
    case ROBOT_JOB_OP_SPEED:
        run->rotary = c->tag == ROBOT_JOB_VJ ? run->rotary : c->tag == ROBOT_JOB_VR;
        return speed(run, in, c, &run->speed[c->tag]);
    case ROBOT_JOB_OP_LEVEL: run->level = c->to; break;
    case ROBOT_JOB_OP_TOOL:  run->tool = run->hand = c->to; break;
    case ROBOT_JOB_OP_SHIFT: return shift(run, p, points, c);
    default:                 run->user = c->to;
    }
    return ROBOT_JOB_OK;
}

/* Whether an instruction waits until all moves before it are reached. */
static bool needs_rest(struct robot_job_run *run, const struct robot_job_program *p,
                       const struct robot_job_inputs *in, const struct robot_job_instruction *c)
{
    switch (c->op) {
    case ROBOT_JOB_OP_WAIT:
    case ROBOT_JOB_OP_TIMER:
    case ROBOT_JOB_OP_GETS:
    case ROBOT_JOB_OP_REACHED: return true;
    case ROBOT_JOB_OP_PAUSE:   return looks(p, c) || holds(run, p, in, c);
    case ROBOT_JOB_OP_RET:     return looks(p, c) || (run->depth == 0 && holds(run, p, in, c));
    default:                   return looks(p, c);
    }
}

/* Whether an instruction waits for the end of a move that an input may end: where the next move
 * begins is not known before. What NWAIT lets come with the move does not. */
static bool ends_first(const struct robot_job_run *run, const struct robot_job_instruction *c)
{
    return run->until && (!run->early || c->op == ROBOT_JOB_OP_MOVE);
}

/* GETARG: an argument that the job was not called with is a fault. */
static enum robot_job_fault take_argument(struct robot_job_run *run,
                                          const struct robot_job_instruction *c)
{
    const struct robot_job_call *frame = &run->frame[run->depth];
    return c->argument < frame->arguments
               ? robot_job_store(run, &c->left, frame->argument[c->argument])
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
 * CCN 20: a case for each kind of work. */
static bool step(struct robot_job_run *run, const struct robot_job_program *p,
                 const struct robot_job_points *points, const struct robot_job_inputs *in,
                 struct robot_job_request *r)
{
    const int32_t pc = run->frame[run->depth].pc;
    const struct robot_job_instruction *c = &p->instruction[pc];
    int32_t next = pc + 1;

    r->line = c->line;
    r->job = pc; /* its number comes with the request */
    if (in->reached < run->moves && (ends_first(run, c) || needs_rest(run, p, in, c))) {
        r->answer = ROBOT_JOB_REACH;
        return true;
    }
    if (run->early && needs_rest(run, p, in, c)) {
        run->early = 0; /* the move is reached */
    }
    const bool done = c->op == ROBOT_JOB_OP_WAIT || holds(run, p, in, c);
    run->idle = looks(p, c) ? 0 : run->idle + 1;
    if (run->fault != ROBOT_JOB_OK) { /* an operand that is no variable */
        return finish(run, r, pc);
    }
    switch (KIND[c->op]) {
    case MOTION:   run->fault = move(run, p, points, in, c, r); break;
    case MODE:     run->fault = set_mode(run, p, points, in, c); break;
    case PLACE:    run->fault = robot_job_change(run, p, points, in, c); break;
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
