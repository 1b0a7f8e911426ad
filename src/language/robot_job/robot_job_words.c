#include "robot_job_reading.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

enum {
    WHOLE = ROBOT_JOB_WHOLES,
    REAL = 1u << ROBOT_JOB_R | 1u << ROBOT_JOB_LR,
    VARIABLE = WHOLE | REAL,
    VALUE = VARIABLE | 1u << ROBOT_JOB_CONSTANT,
    SIGNAL = 1u << ROBOT_JOB_IN | 1u << ROBOT_JOB_OT | 1u << ROBOT_JOB_IG | 1u << ROBOT_JOB_OG
};

/* Length of a pulse: usual, least and most. [ns] */
#define PULSE_TIME  300000000
#define PULSE_LEAST 10000000
#define PULSE_MOST  655350000000

/* What may follow a word in its line. */
enum form {
    MOVE,
    SPEED,
    LEVEL,
    FRAME,
    OUTPUT,
    ARITHMETIC,
    STEP,
    WAIT,
    TIMER,
    JUMP,
    CONDITION,
    END,
    LABEL,
    BLOCK,
    SHIFT,
    UNSHIFT,
    ARGUMENT,
    MESSAGE,
    PULSE,
    INCREMENT,
    PLACE,
    NOTHING
};

enum block {
    IF,
    ELSEIF,
    ELSE,
    ENDIF,
    LOOP,
    ENDLOOP,
    WHILE,
    ENDWHILE,
    FOR,
    NEXT,
    SWITCH,
    CASE,
    DEFAULT,
    ENDSWITCH
};

/* A word: what follows it, what it becomes (a path, an instruction, a part of a block; of FRAME and
 * OUTPUT one of two), kinds of its operands. */
struct word {
    char text[12];
    uint8_t form, what;
    uint16_t left, right;
};

static const struct word WORDS[] = { { "MOVJ", MOVE, ROBOT_JOB_JOINT, 0, 0 },
                                     { "MOVL", MOVE, ROBOT_JOB_LINE, 0, 0 },
                                     { "MOVC", MOVE, ROBOT_JOB_CIRCLE, 0, 0 },
                                     { "MOVS", MOVE, ROBOT_JOB_SPLINE, 0, 0 },
                                     { "IMOV", INCREMENT, 0, 0, 0 },
                                     { "SPEED", SPEED, 0, 0, 0 },
                                     { "PL", LEVEL, 0, 0, 0 },
                                     { "TOOL", FRAME, ROBOT_JOB_OP_TOOL, 0, 0 },
                                     { "USER", FRAME, ROBOT_JOB_OP_USER, 0, 0 },
                                     { "DOUT", OUTPUT, ROBOT_JOB_OP_DOUT, 0, 0 },
                                     { "AOUT", OUTPUT, ROBOT_JOB_OP_AOUT, 0, 0 },
                                     { "DIN", ARITHMETIC, ROBOT_JOB_OP_SET, WHOLE, SIGNAL },
                                     { "AIN", ARITHMETIC, ROBOT_JOB_OP_SET, REAL,
                                       1u << ROBOT_JOB_AI },
                                     { "SET", ARITHMETIC, ROBOT_JOB_OP_SET, VARIABLE, VALUE },
                                     { "ADD", ARITHMETIC, ROBOT_JOB_OP_ADD, VARIABLE, VALUE },
                                     { "SUB", ARITHMETIC, ROBOT_JOB_OP_SUB, VARIABLE, VALUE },
                                     { "MUL", ARITHMETIC, ROBOT_JOB_OP_MUL, VARIABLE, VALUE },
                                     { "DIV", ARITHMETIC, ROBOT_JOB_OP_DIV, VARIABLE, VALUE },
                                     { "SETE", PLACE, ROBOT_JOB_OP_SETE, 0, 0 },
                                     { "GETE", PLACE, ROBOT_JOB_OP_GETE, 0, 0 },
                                     { "GETS", PLACE, ROBOT_JOB_OP_GETS, 0, 0 },
                                     { "CNVRT", PLACE, ROBOT_JOB_OP_CNVRT, 0, 0 },
                                     { "MSHIFT", PLACE, ROBOT_JOB_OP_MSHIFT, 0, 0 },
                                     { "INC", STEP, ROBOT_JOB_OP_ADD, 0, 0 },
                                     { "DEC", STEP, ROBOT_JOB_OP_SUB, 0, 0 },
                                     { "WAIT", WAIT, 0, 0, 0 },
                                     { "TIMER", TIMER, 0, 0, 0 },
                                     { "JUMP", JUMP, ROBOT_JOB_OP_JUMP, 0, 0 },
                                     { "CALL", JUMP, ROBOT_JOB_OP_CALL, 0, 0 },
                                     { "RET", CONDITION, ROBOT_JOB_OP_RET, 0, 0 },
                                     { "PAUSE", CONDITION, ROBOT_JOB_OP_PAUSE, 0, 0 },
                                     { "END", END, 0, 0, 0 },
                                     { "IF", BLOCK, IF, 0, 0 },
                                     { "IFTHEN", BLOCK, IF, 0, 0 },
                                     { "IFTHENEXP", BLOCK, IF, 0, 0 },
                                     { "ELSEIF", BLOCK, ELSEIF, 0, 0 },
                                     { "ELSEIFEXP", BLOCK, ELSEIF, 0, 0 },
                                     { "ELSE", BLOCK, ELSE, 0, 0 },
                                     { "ENDIF", BLOCK, ENDIF, 0, 0 },
                                     { "LOOP", BLOCK, LOOP, 0, 0 },
                                     { "ENDLOOP", BLOCK, ENDLOOP, 0, 0 },
                                     { "WHILE", BLOCK, WHILE, 0, 0 },
                                     { "WHILEEXP", BLOCK, WHILE, 0, 0 },
                                     { "ENDWHILE", BLOCK, ENDWHILE, 0, 0 },
                                     { "FOR", BLOCK, FOR, 0, 0 },
                                     { "NEXT", BLOCK, NEXT, 0, 0 },
                                     { "SWITCH", BLOCK, SWITCH, 0, 0 },
                                     { "CASE", BLOCK, CASE, 0, 0 },
                                     { "DEFAULT", BLOCK, DEFAULT, 0, 0 },
                                     { "ENDSWITCH", BLOCK, ENDSWITCH, 0, 0 },
                                     { "SFTON", SHIFT, 0, 0, 0 },
                                     { "SFTOF", UNSHIFT, ROBOT_JOB_OP_SHIFT, 0, 0 },
                                     { "GETARG", ARGUMENT, 0, 0, 0 },
                                     { "CWAIT", NOTHING, ROBOT_JOB_OP_REACHED, 0, 0 },
                                     { "MSG", MESSAGE, 0, 0, 0 },
                                     { "PULSE", PULSE, 0, 0, 0 },
                                     { "NOP", NOTHING, ROBOT_JOB_OP_NOP, 0, 0 },
                                     { "LABEL", LABEL, 0, 0, 0 } };
/* LABEL is the last one. */
enum { WORD_COUNT = sizeof WORDS / sizeof WORDS[0] };

struct robot_job_instruction *robot_job_reading_add(struct robot_job_reading *in,
                                                    enum robot_job_op op)
{
    struct robot_job_program *p = in->p;
    if (p->count == ROBOT_JOB_INSTRUCTIONS) {
        in->s.r->high = ROBOT_JOB_INSTRUCTIONS;
        robot_job_scan_fault_line(&in->s, ROBOT_JOB_BAD_TOO_MANY);
        return NULL;
    }
    struct robot_job_instruction *c = &p->instruction[p->count++];
    *c = (struct robot_job_instruction){ .op = op,
                                         .line = in->s.line,
                                         .level = ROBOT_JOB_ANY,
                                         .time = -1,
                                         .increment = ROBOT_JOB_NOT_BY,
                                         .beside = -1,
                                         .until = -1,
                                         .inside = robot_job_block_loop_inside(in) };
    return c;
}

/* Check a constant that goes into a variable of whole numbers. */
static int check_constant(struct robot_job_reading *in, const struct robot_job_instruction *c,
                          struct robot_job_span at)
{
    struct robot_job_scan *s = &in->s;
    const double x = c->right.number;
    const double low = robot_job_low(c->left.kind), high = robot_job_high(c->left.kind);
    if (c->right.kind != ROBOT_JOB_CONSTANT || c->left.kind == ROBOT_JOB_R
        || c->left.kind == ROBOT_JOB_LR) {
        return 0;
    }
    if (x != floor(x)) {
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_WHOLE, at);
    }
    if (c->op == ROBOT_JOB_OP_SET && !(x >= low && x <= high)) {
        s->r->low = low;
        s->r->high = high;
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_VALUE, at);
    }
    return 0;
}

/* Read the operands of SET .. DIV: the variable that changes, then what changes it. */
static int arithmetic(struct robot_job_reading *in, enum robot_job_op op, uint32_t left,
                      uint32_t right)
{
    struct robot_job_scan *s = &in->s;
    const int place = left == VARIABLE ? robot_job_place_calculate(in, op) : 0;
    if (place != 0) {
        return place < 0 ? -1 : 0;
    }
    struct robot_job_instruction *c = robot_job_reading_add(in, op);
    if (!c || robot_job_operand(in, left, &c->left)) {
        return -1;
    }
    robot_job_scan_over(s);
    const int32_t at = s->at;
    return robot_job_operand(in, right, &c->right)
               ? -1
               : check_constant(in, c, (struct robot_job_span){ at, s->at - at });
}

/* INC, DEC: read the variable that changes by one. */
static int step(struct robot_job_reading *in, enum robot_job_op op)
{
    struct robot_job_instruction *c = robot_job_reading_add(in, op);
    if (!c || robot_job_operand(in, WHOLE, &c->left)) {
        return -1;
    }
    c->right = (struct robot_job_operand){ .kind = ROBOT_JOB_CONSTANT, .number = 1.0 };
    return 0;
}

/* Read the 0 to 255 of a group of outputs behind OG. */
static int group(struct robot_job_reading *in, struct robot_job_instruction *c)
{
    struct robot_job_scan *s = &in->s;
    c->op = ROBOT_JOB_OP_GROUP;
    if (robot_job_operand_channel(in, ROBOT_JOB_SIGNALS / ROBOT_JOB_GROUP, &c->to)) {
        return -1;
    }
    robot_job_scan_over(s);
    const int32_t at = s->at;
    if (robot_job_operand(in, WHOLE | 1u << ROBOT_JOB_CONSTANT, &c->right)) {
        return -1;
    }
    if (c->right.kind == ROBOT_JOB_CONSTANT) {
        int32_t value;
        s->at = at;
        return robot_job_scan_whole(s, 0, (1 << ROBOT_JOB_GROUP) - 1, &value);
    }
    return 0;
}

/* Read ON or OFF. */
static int on_or_off(struct robot_job_reading *in, struct robot_job_instruction *c)
{
    struct robot_job_scan *s = &in->s;
    const struct robot_job_span w = robot_job_scan_word(s);
    c->right = (struct robot_job_operand){ .kind = ROBOT_JOB_CONSTANT };
    c->right.number = robot_job_scan_is(s, w, "ON");
    if (c->right.number == 0.0 && !robot_job_scan_is(s, w, "OFF")) {
        s->at = w.length > 0 ? w.at : s->at;
        return robot_job_scan_unexpected(s);
    }
    return 0;
}

/* Read DOUT OT#(n) ON, DOUT OG#(n) value or AOUT AO#(n) value. */
static int output(struct robot_job_reading *in, bool digital)
{
    struct robot_job_scan *s = &in->s;
    struct robot_job_instruction *c =
        robot_job_reading_add(in, digital ? ROBOT_JOB_OP_DOUT : ROBOT_JOB_OP_AOUT);
    if (!c) {
        return -1;
    }
    robot_job_scan_over(s);
    const int32_t at = s->at;
    if (digital && robot_job_scan_is(s, robot_job_scan_word(s), "OG")) {
        return group(in, c);
    }
    s->at = at;
    if (!robot_job_scan_is(s, robot_job_scan_word(s), digital ? "OT" : "AO")) {
        s->at = at;
        return robot_job_scan_unexpected(s);
    }
    if (robot_job_operand_channel(in, digital ? ROBOT_JOB_SIGNALS : ROBOT_JOB_ANALOGS, &c->to)) {
        return -1;
    }
    if (digital) {
        robot_job_scan_take(s, '=');
    }
    robot_job_scan_over(s);
    struct robot_job_span w = { s->at, 0 };
    if (!digital) {
        if (robot_job_operand(in, VALUE, &c->right)) {
            return -1;
        }
        w.length = s->at - w.at;
        s->r->low = -ROBOT_JOB_VOLT_MAX;
        s->r->high = ROBOT_JOB_VOLT_MAX;
        return c->right.kind == ROBOT_JOB_CONSTANT && fabs(c->right.number) > ROBOT_JOB_VOLT_MAX
                   ? robot_job_scan_fault(s, ROBOT_JOB_BAD_VALUE, w)
                   : 0;
    }
    return on_or_off(in, c);
}

/* Read TOOL 1, TOOL TL#(1), USER 2 or USER UF#(2). */
static int frame(struct robot_job_reading *in, bool tool)
{
    struct robot_job_scan *s = &in->s;
    struct robot_job_instruction *c =
        robot_job_reading_add(in, tool ? ROBOT_JOB_OP_TOOL : ROBOT_JOB_OP_USER);
    if (!c) {
        return -1;
    }
    robot_job_scan_over(s);
    struct robot_job_span at = { s->at, 0 };
    const bool named = robot_job_scan_is(s, robot_job_scan_word(s), tool ? "TL" : "UF");
    s->at = named ? s->at : at.at;
    if (named && (!robot_job_scan_take(s, '#') || !robot_job_scan_take(s, '('))) {
        return robot_job_scan_unexpected(s);
    }
    if (robot_job_scan_whole(s, 0, ROBOT_JOB_FRAMES - 1, &c->to)) {
        return -1;
    }
    if (named && !robot_job_scan_take(s, ')')) {
        return robot_job_scan_unexpected(s);
    }
    at.length = s->at - at.at;
    return (tool ? in->points->tool : in->points->user)[c->to].defined
               ? 0
               : robot_job_scan_fault(s, ROBOT_JOB_BAD_FRAME, at);
}

/* Read PL=1 or PL 1. */
static int level(struct robot_job_reading *in)
{
    struct robot_job_instruction *c = robot_job_reading_add(in, ROBOT_JOB_OP_LEVEL);
    robot_job_scan_take(&in->s, '=');
    return c ? robot_job_scan_whole(&in->s, 0, ROBOT_JOB_LEVELS, &c->to) : -1;
}

static int wait(struct robot_job_reading *in)
{
    struct robot_job_instruction *c = robot_job_reading_add(in, ROBOT_JOB_OP_WAIT);
    if (!c || robot_job_operand_condition(in, c)) {
        return -1;
    }
    return robot_job_scan_over(&in->s) ? 0 : robot_job_operand_time(in, c);
}

static int timer(struct robot_job_reading *in)
{
    struct robot_job_instruction *c = robot_job_reading_add(in, ROBOT_JOB_OP_TIMER);
    return c ? robot_job_operand_time(in, c) : -1;
}

/* The number of a job's name among those that are called; -1: there are too many. */
static int32_t callee(struct robot_job_reading *in, struct robot_job_span name)
{
    struct robot_job_program *p = in->p;
    struct robot_job_scan *s = &in->s;
    struct robot_job_callee one = { .text = p->texts,
                                    .line = s->line,
                                    .column = robot_job_scan_column(s, name.at),
                                    .offset = name.at,
                                    .length = name.length };
    memcpy(one.name, s->text + name.at, (size_t)name.length);
    for (int32_t i = 0; i < p->callees; i++) {
        if (memcmp(p->callee[i].name, one.name, sizeof one.name) == 0) {
            return i;
        }
    }
    if (p->callees == ROBOT_JOB_CALLEES) {
        s->r->high = ROBOT_JOB_CALLEES;
        return robot_job_scan_fault_line(s, ROBOT_JOB_BAD_TOO_MANY);
    }
    p->callee[p->callees] = one;
    return p->callees++;
}

/* Read the arguments of a call, ARGF10 ARGFB000, in brackets or not. */
static int arguments(struct robot_job_reading *in, struct robot_job_instruction *c)
{
    struct robot_job_scan *s = &in->s;
    const bool bracket = robot_job_scan_take(s, '(');
    c->argument = in->p->terms;
    while (!robot_job_scan_over(s) && c->arguments < ROBOT_JOB_ARGUMENTS) {
        struct robot_job_term t = { .relation = ROBOT_JOB_ALWAYS };
        if (s->end - s->at < 4
            || !robot_job_scan_is(s, (struct robot_job_span){ s->at, 4 }, "ARGF")) {
            break;
        }
        s->at += 4;
        if (robot_job_operand(in, VALUE, &t.left) || robot_job_operand_keep(in, &t)) {
            return -1;
        }
        c->arguments++;
    }
    return !bracket || robot_job_scan_take(s, ')') ? 0 : robot_job_scan_unexpected(s);
}

/* JUMP *LABEL, JUMP LABEL, JUMP JOB:NAME, CALL JOB:NAME. Where that is, the end of the text tells,
 * and of a job the end of all texts. Until then `to` and `via` are the label's name, `level` is 0;
 * or `to` is the number of the job's name, `level` is 1. */
static int jump(struct robot_job_reading *in, enum robot_job_op op)
{
    struct robot_job_scan *s = &in->s;
    struct robot_job_instruction *c = robot_job_reading_add(in, op);
    struct robot_job_span name;
    if (!c) {
        return -1;
    }
    robot_job_scan_over(s);
    const int32_t at = s->at;
    c->level = robot_job_scan_is(s, robot_job_scan_word(s), "JOB") && robot_job_scan_take(s, ':');
    if (!c->level) {
        s->at = at;
        if (op == ROBOT_JOB_OP_CALL) {
            return robot_job_scan_unexpected(s);
        }
        robot_job_scan_take(s, '*');
    }
    if (robot_job_scan_name(s, ROBOT_JOB_NAME_MAX, &name)) {
        return -1;
    }
    c->to = name.at;
    c->via = name.length;
    if (c->level == 1) {
        c->via = 0;
        c->to = callee(in, name);
        if (c->to < 0 || (op == ROBOT_JOB_OP_CALL && arguments(in, c))) {
            return -1;
        }
    }
    return robot_job_operand_if(in, c);
}

/* Read *NAME, LABEL NAME or LABEL *NAME. */
static int label(struct robot_job_reading *in)
{
    struct robot_job_program *p = in->p;
    struct robot_job_scan *s = &in->s;
    struct robot_job_span name;
    robot_job_scan_take(s, '*');
    if (robot_job_scan_name(s, ROBOT_JOB_NAME_MAX, &name)) {
        return -1;
    }
    for (int32_t i = 0; i < p->labels; i++) {
        const struct robot_job_label *l = &p->label[i];
        const struct robot_job_span other = { l->offset, l->length };
        if (l->job == p->jobs - 1 && robot_job_scan_same(s->text, other, name)) {
            s->r->other = l->line;
            return robot_job_scan_fault(s, ROBOT_JOB_BAD_LABEL_TWICE, name);
        }
    }
    if (p->labels == ROBOT_JOB_LABELS) {
        s->r->high = ROBOT_JOB_LABELS;
        return robot_job_scan_fault_line(s, ROBOT_JOB_BAD_TOO_MANY);
    }
    p->label[p->labels++] = (struct robot_job_label){ .offset = name.at,
                                                      .length = name.length,
                                                      .job = p->jobs - 1,
                                                      .to = p->count,
                                                      .line = s->line,
                                                      .inside = robot_job_block_loop_inside(in) };
    return 0;
}

/* Read RET or PAUSE, perhaps with a condition. */
static int simple(struct robot_job_reading *in, enum robot_job_op op)
{
    struct robot_job_instruction *c = robot_job_reading_add(in, op);
    return c ? robot_job_operand_if(in, c) : -1;
}

static int end(struct robot_job_reading *in)
{
    in->end_line = in->s.line;
    return robot_job_block_all_closed(in) || !robot_job_reading_add(in, ROBOT_JOB_OP_RET) ? -1 : 0;
}

static int nothing(struct robot_job_reading *in, enum robot_job_op op)
{
    return robot_job_reading_add(in, op) ? 0 : -1;
}

/* SFTOF: no shift from here on. */
static int unshift(struct robot_job_reading *in)
{
    struct robot_job_instruction *c = robot_job_reading_add(in, ROBOT_JOB_OP_SHIFT);
    if (c) {
        c->to = -1;
    }
    return c ? 0 : -1;
}

/* Read GETARG LB000 IARG#(1). */
static int argument(struct robot_job_reading *in)
{
    struct robot_job_scan *s = &in->s;
    struct robot_job_instruction *c = robot_job_reading_add(in, ROBOT_JOB_OP_GETARG);
    if (!c || robot_job_operand(in, VARIABLE, &c->left)) {
        return -1;
    }
    robot_job_scan_over(s);
    const int32_t at = s->at;
    if (!robot_job_scan_is(s, robot_job_scan_word(s), "IARG")) {
        s->at = at;
        return robot_job_scan_unexpected(s);
    }
    return robot_job_operand_channel(in, ROBOT_JOB_ARGUMENTS, &c->argument);
}

/* Read PULSE OT#(n) T=0.50; without T 0.3 s, as INFORM has it. */
static int pulse(struct robot_job_reading *in)
{
    struct robot_job_scan *s = &in->s;
    struct robot_job_instruction *c = robot_job_reading_add(in, ROBOT_JOB_OP_PULSE);
    if (!c) {
        return -1;
    }
    robot_job_scan_over(s);
    const int32_t at = s->at;
    if (!robot_job_scan_is(s, robot_job_scan_word(s), "OT")) {
        s->at = at;
        return robot_job_scan_unexpected(s);
    }
    c->time = PULSE_TIME;
    if (robot_job_operand_channel(in, ROBOT_JOB_SIGNALS, &c->to)) {
        return -1;
    }
    if (robot_job_scan_over(s)) {
        return 0;
    }
    struct robot_job_span time = { s->at, 0 };
    if (robot_job_operand_time(in, c)) {
        return -1;
    }
    time.length = s->at - time.at;
    s->r->low = PULSE_LEAST * 1e-9;
    s->r->high = PULSE_MOST * 1e-9;
    return c->time >= PULSE_LEAST ? 0 : robot_job_scan_fault(s, ROBOT_JOB_BAD_VALUE, time);
}

/* MSG "words": nobody reads them here. */
static int message(struct robot_job_reading *in)
{
    struct robot_job_scan *s = &in->s;
    if (!robot_job_scan_take(s, '"')) {
        return robot_job_scan_unexpected(s);
    }
    s->at = s->end;
    return nothing(in, ROBOT_JOB_OP_NOP);
}

static int block(struct robot_job_reading *in, enum block what)
{
    switch (what) {
    case IF:        return robot_job_block_if(in);
    case ELSEIF:    return robot_job_block_else(in, true);
    case ELSE:      return robot_job_block_else(in, false);
    case ENDIF:     return robot_job_block_endif(in);
    case LOOP:      return robot_job_block_loop(in);
    case ENDLOOP:   return robot_job_block_endloop(in);
    case WHILE:     return robot_job_block_while(in);
    case FOR:       return robot_job_block_for(in);
    case NEXT:      return robot_job_block_next(in);
    case SWITCH:    return robot_job_block_switch(in);
    case CASE:      return robot_job_block_case(in, true);
    case DEFAULT:   return robot_job_block_case(in, false);
    case ENDSWITCH: return robot_job_block_endswitch(in);
    default:        return robot_job_block_endwhile(in);
    }
}

/* CCN 22: a case for each form. */
static int instruction(struct robot_job_reading *in, const struct word *w)
{
    const enum robot_job_op op = (enum robot_job_op)w->what;

    switch ((enum form)w->form) {
    case MOVE:       return robot_job_move(in, (enum robot_job_path)w->what);
    case SPEED:      return robot_job_move_speed(in);
    case LEVEL:      return level(in);
    case FRAME:      return frame(in, op == ROBOT_JOB_OP_TOOL);
    case OUTPUT:     return output(in, op == ROBOT_JOB_OP_DOUT);
    case ARITHMETIC: return arithmetic(in, op, w->left, w->right);
    case STEP:       return step(in, op);
    case WAIT:       return wait(in);
    case TIMER:      return timer(in);
    case JUMP:       return jump(in, op);
    case CONDITION:  return simple(in, op);
    case END:        return end(in);
    case LABEL:      return label(in);
    case BLOCK:      return block(in, (enum block)w->what);
    case SHIFT:      return robot_job_move_shift(in);
    case UNSHIFT:    return unshift(in);
    case ARGUMENT:   return argument(in);
    case MESSAGE:    return message(in);
    case PULSE:      return pulse(in);
    case INCREMENT:  return robot_job_move_by(in);
    case PLACE:      return robot_job_place_line(in, op);
    default:         return nothing(in, op);
    }
}

/* The word that the line begins with; NULL: it is unknown, and reported. */
static const struct word *first_word(struct robot_job_scan *s)
{
    if (robot_job_scan_take(s, '*')) {
        return &WORDS[WORD_COUNT - 1]; /* LABEL */
    }
    const struct robot_job_span w = robot_job_scan_word(s);
    for (int i = 0; i < WORD_COUNT; i++) {
        if (robot_job_scan_is(s, w, WORDS[i].text)) {
            return &WORDS[i];
        }
    }
    s->at = w.length > 0 ? s->at : s->begin;
    if (w.length > 0) {
        robot_job_scan_fault(s, robot_job_lacks(s, w) ? ROBOT_JOB_BAD_LACKING : ROBOT_JOB_BAD_WORD,
                             w);
    } else {
        robot_job_scan_unexpected(s);
    }
    return NULL;
}

int robot_job_words(struct robot_job_reading *in)
{
    struct robot_job_scan *s = &in->s;
    const struct word *word = first_word(s);
    if (!word) {
        return -1;
    }
    if (in->end_line > 0) {
        s->r->other = in->end_line;
        return robot_job_scan_fault_line(s, ROBOT_JOB_BAD_AFTER_END);
    }
    if (robot_job_block_before_case(in)
        && !(word->form == BLOCK && word->what >= CASE && word->what <= ENDSWITCH)) {
        return robot_job_scan_fault_line(s, ROBOT_JOB_BAD_BEFORE_CASE);
    }
    if (word->form != MOVE || word->what != ROBOT_JOB_CIRCLE) {
        const int32_t at = s->at;
        if (robot_job_move_arc_over(in)) {
            return -1;
        }
        s->at = at;
    }
    if (word->form != MOVE || word->what != ROBOT_JOB_SPLINE) {
        in->splines = 0;
    }
    if (instruction(in, word)) {
        return -1;
    }
    return robot_job_scan_over(s) ? 0 : robot_job_scan_unexpected(s);
}
