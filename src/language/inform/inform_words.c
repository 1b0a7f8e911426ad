#include "inform_reading.h"

#include <math.h>
#include <stddef.h>

enum {
    WHOLE = 1u << INFORM_B | 1u << INFORM_I | 1u << INFORM_D,
    VARIABLE = WHOLE | 1u << INFORM_R,
    VALUE = VARIABLE | 1u << INFORM_CONSTANT,
    SIGNAL = 1u << INFORM_IN | 1u << INFORM_OT
};

/* What follows a word. */
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
    NOTHING
};

enum block { IF, ELSEIF, ELSE, ENDIF, LOOP, ENDLOOP, WHILE, ENDWHILE };

/* A word: what follows it, what it becomes (a path, an instruction, a part of a block; of FRAME and
 * OUTPUT one of two), kinds of its operands. */
struct word {
    char text[12];
    uint8_t form, what;
    uint16_t left, right;
};

static const struct word WORDS[] = { { "MOVJ", MOVE, INFORM_JOINT, 0, 0 },
                                     { "MOVL", MOVE, INFORM_LINE, 0, 0 },
                                     { "MOVC", MOVE, INFORM_CIRCLE, 0, 0 },
                                     { "SPEED", SPEED, 0, 0, 0 },
                                     { "PL", LEVEL, 0, 0, 0 },
                                     { "TOOL", FRAME, INFORM_OP_TOOL, 0, 0 },
                                     { "USER", FRAME, INFORM_OP_USER, 0, 0 },
                                     { "DOUT", OUTPUT, INFORM_OP_DOUT, 0, 0 },
                                     { "AOUT", OUTPUT, INFORM_OP_AOUT, 0, 0 },
                                     { "DIN", ARITHMETIC, INFORM_OP_SET, WHOLE, SIGNAL },
                                     { "AIN", ARITHMETIC, INFORM_OP_SET, 1u << INFORM_R,
                                       1u << INFORM_AI },
                                     { "SET", ARITHMETIC, INFORM_OP_SET, VARIABLE, VALUE },
                                     { "ADD", ARITHMETIC, INFORM_OP_ADD, VARIABLE, VALUE },
                                     { "SUB", ARITHMETIC, INFORM_OP_SUB, VARIABLE, VALUE },
                                     { "MUL", ARITHMETIC, INFORM_OP_MUL, VARIABLE, VALUE },
                                     { "DIV", ARITHMETIC, INFORM_OP_DIV, VARIABLE, VALUE },
                                     { "INC", STEP, INFORM_OP_ADD, 0, 0 },
                                     { "DEC", STEP, INFORM_OP_SUB, 0, 0 },
                                     { "WAIT", WAIT, 0, 0, 0 },
                                     { "TIMER", TIMER, 0, 0, 0 },
                                     { "JUMP", JUMP, INFORM_OP_JUMP, 0, 0 },
                                     { "CALL", JUMP, INFORM_OP_CALL, 0, 0 },
                                     { "RET", CONDITION, INFORM_OP_RET, 0, 0 },
                                     { "PAUSE", CONDITION, INFORM_OP_PAUSE, 0, 0 },
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
                                     { "NOP", NOTHING, 0, 0, 0 },
                                     { "LABEL", LABEL, 0, 0, 0 } };
enum { WORD_COUNT = sizeof WORDS / sizeof WORDS[0] };

struct inform_code *inform_reading_add(struct inform_reading *in, enum inform_op op)
{
    struct inform_program *p = in->p;
    if (p->count == INFORM_CODES) {
        in->s.r->high = INFORM_CODES;
        inform_scan_fault_line(&in->s, INFORM_BAD_TOO_MANY);
        return NULL;
    }
    struct inform_code *c = &p->code[p->count++];
    *c = (struct inform_code){ .op = op,
                               .line = in->s.line,
                               .level = INFORM_ANY,
                               .time = -1,
                               .inside = inform_block_loop_inside(in) };
    return c;
}

/* A constant that goes into a variable of whole numbers. */
static int check_constant(struct inform_reading *in, const struct inform_code *c,
                          struct inform_piece at)
{
    struct inform_scan *s = &in->s;
    const double x = c->right.number;
    const double low = inform_low(c->left.kind), high = inform_high(c->left.kind);
    if (c->right.kind != INFORM_CONSTANT || c->left.kind == INFORM_R) {
        return 0;
    }
    if (x != floor(x)) {
        return inform_scan_fault(s, INFORM_BAD_WHOLE, at);
    }
    if (c->op == INFORM_OP_SET && !(x >= low && x <= high)) {
        s->r->low = low;
        s->r->high = high;
        return inform_scan_fault(s, INFORM_BAD_VALUE, at);
    }
    return 0;
}

/* op variable operand */
static int arithmetic(struct inform_reading *in, enum inform_op op, uint32_t left, uint32_t right)
{
    struct inform_scan *s = &in->s;
    struct inform_code *c = inform_reading_add(in, op);
    if (!c || inform_operand(in, left, &c->left)) {
        return -1;
    }
    inform_scan_over(s);
    const int32_t at = s->at;
    return inform_operand(in, right, &c->right)
               ? -1
               : check_constant(in, c, (struct inform_piece){ at, s->at - at });
}

/* INC, DEC: by one. */
static int step(struct inform_reading *in, enum inform_op op)
{
    struct inform_code *c = inform_reading_add(in, op);
    if (!c || inform_operand(in, WHOLE, &c->left)) {
        return -1;
    }
    c->right = (struct inform_operand){ .kind = INFORM_CONSTANT, .number = 1.0 };
    return 0;
}

/* DOUT OT#(n) ON, AOUT AO#(n) value */
static int output(struct inform_reading *in, bool digital)
{
    struct inform_scan *s = &in->s;
    struct inform_code *c = inform_reading_add(in, digital ? INFORM_OP_DOUT : INFORM_OP_AOUT);
    if (!c) {
        return -1;
    }
    inform_scan_over(s);
    const int32_t at = s->at;
    if (!inform_scan_is(s, inform_scan_word(s), digital ? "OT" : "AO")) {
        s->at = at;
        return inform_scan_unexpected(s);
    }
    if (inform_operand_channel(in, digital ? INFORM_SIGNALS : INFORM_ANALOGS, &c->to)) {
        return -1;
    }
    inform_scan_over(s);
    struct inform_piece w = { s->at, 0 };
    if (!digital) {
        if (inform_operand(in, VALUE, &c->right)) {
            return -1;
        }
        w.length = s->at - w.at;
        s->r->low = -INFORM_VOLT_MAX;
        s->r->high = INFORM_VOLT_MAX;
        return c->right.kind == INFORM_CONSTANT && fabs(c->right.number) > INFORM_VOLT_MAX
                   ? inform_scan_fault(s, INFORM_BAD_VALUE, w)
                   : 0;
    }
    w = inform_scan_word(s);
    c->right = (struct inform_operand){ .kind = INFORM_CONSTANT };
    c->right.number = inform_scan_is(s, w, "ON");
    if (c->right.number == 0.0 && !inform_scan_is(s, w, "OFF")) {
        s->at = w.length > 0 ? w.at : s->at;
        return inform_scan_unexpected(s);
    }
    return 0;
}

/* TOOL 1, TOOL TL#(1), USER 2, USER UF#(2) */
static int frame(struct inform_reading *in, bool tool)
{
    struct inform_scan *s = &in->s;
    struct inform_code *c = inform_reading_add(in, tool ? INFORM_OP_TOOL : INFORM_OP_USER);
    if (!c) {
        return -1;
    }
    inform_scan_over(s);
    struct inform_piece at = { s->at, 0 };
    const bool named = inform_scan_is(s, inform_scan_word(s), tool ? "TL" : "UF");
    s->at = named ? s->at : at.at;
    if (named && (!inform_scan_take(s, '#') || !inform_scan_take(s, '('))) {
        return inform_scan_unexpected(s);
    }
    if (inform_scan_whole(s, 0, INFORM_FRAMES - 1, &c->to)) {
        return -1;
    }
    if (named && !inform_scan_take(s, ')')) {
        return inform_scan_unexpected(s);
    }
    at.length = s->at - at.at;
    return (tool ? in->points->tool : in->points->user)[c->to].defined
               ? 0
               : inform_scan_fault(s, INFORM_BAD_FRAME, at);
}

/* PL=1 or PL 1 */
static int level(struct inform_reading *in)
{
    struct inform_code *c = inform_reading_add(in, INFORM_OP_LEVEL);
    inform_scan_take(&in->s, '=');
    return c ? inform_scan_whole(&in->s, 0, INFORM_LEVELS, &c->to) : -1;
}

static int wait(struct inform_reading *in)
{
    struct inform_code *c = inform_reading_add(in, INFORM_OP_WAIT);
    if (!c || inform_operand_condition(in, c)) {
        return -1;
    }
    return inform_scan_over(&in->s) ? 0 : inform_operand_time(in, c);
}

static int timer(struct inform_reading *in)
{
    struct inform_code *c = inform_reading_add(in, INFORM_OP_TIMER);
    return c ? inform_operand_time(in, c) : -1;
}

/* JUMP *LABEL, JUMP LABEL, JUMP JOB:NAME, CALL JOB:NAME; where that is, the end of the text tells:
 * until then `to` and `via` are the name, and `level` is 1 for a job. */
static int jump(struct inform_reading *in, enum inform_op op)
{
    struct inform_scan *s = &in->s;
    struct inform_code *c = inform_reading_add(in, op);
    struct inform_piece name;
    if (!c) {
        return -1;
    }
    inform_scan_over(s);
    const int32_t at = s->at;
    c->level = inform_scan_is(s, inform_scan_word(s), "JOB") && inform_scan_take(s, ':');
    if (!c->level) {
        s->at = at;
        if (op == INFORM_OP_CALL) {
            return inform_scan_unexpected(s);
        }
        inform_scan_take(s, '*');
    }
    if (inform_scan_name(s, INFORM_NAME_MAX, &name)) {
        return -1;
    }
    c->to = name.at;
    c->via = name.length;
    return inform_operand_if(in, c);
}

/* *NAME, LABEL NAME, LABEL *NAME */
static int label(struct inform_reading *in)
{
    struct inform_program *p = in->p;
    struct inform_scan *s = &in->s;
    struct inform_piece name;
    inform_scan_take(s, '*');
    if (inform_scan_name(s, INFORM_NAME_MAX, &name)) {
        return -1;
    }
    for (int32_t i = 0; i < p->labels; i++) {
        const struct inform_label *l = &p->label[i];
        const struct inform_piece other = { l->offset, l->length };
        if (l->job == p->jobs - 1 && inform_scan_same(s->text, other, name)) {
            s->r->other = l->line;
            return inform_scan_fault(s, INFORM_BAD_LABEL_TWICE, name);
        }
    }
    if (p->labels == INFORM_LABELS) {
        s->r->high = INFORM_LABELS;
        return inform_scan_fault_line(s, INFORM_BAD_TOO_MANY);
    }
    p->label[p->labels++] = (struct inform_label){ .offset = name.at,
                                                   .length = name.length,
                                                   .job = p->jobs - 1,
                                                   .to = p->count,
                                                   .line = s->line,
                                                   .inside = inform_block_loop_inside(in) };
    return 0;
}

/* RET, PAUSE: perhaps with a condition. */
static int simple(struct inform_reading *in, enum inform_op op)
{
    struct inform_code *c = inform_reading_add(in, op);
    return c ? inform_operand_if(in, c) : -1;
}

static int end(struct inform_reading *in)
{
    in->end_line = in->s.line;
    return inform_block_all_closed(in) || !inform_reading_add(in, INFORM_OP_RET) ? -1 : 0;
}

static int nothing(struct inform_reading *in)
{
    return inform_reading_add(in, INFORM_OP_NOP) ? 0 : -1;
}

static int block(struct inform_reading *in, enum block what)
{
    switch (what) {
    case IF:      return inform_block_if(in);
    case ELSEIF:  return inform_block_else(in, true);
    case ELSE:    return inform_block_else(in, false);
    case ENDIF:   return inform_block_endif(in);
    case LOOP:    return inform_block_loop(in);
    case ENDLOOP: return inform_block_endloop(in);
    case WHILE:   return inform_block_while(in);
    default:      return inform_block_endwhile(in);
    }
}

static int instruction(struct inform_reading *in, const struct word *w)
{
    const enum inform_op op = (enum inform_op)w->what;

    switch ((enum form)w->form) {
    case MOVE:       return inform_move(in, (enum inform_path)w->what);
    case SPEED:      return inform_move_speed(in);
    case LEVEL:      return level(in);
    case FRAME:      return frame(in, op == INFORM_OP_TOOL);
    case OUTPUT:     return output(in, op == INFORM_OP_DOUT);
    case ARITHMETIC: return arithmetic(in, op, w->left, w->right);
    case STEP:       return step(in, op);
    case WAIT:       return wait(in);
    case TIMER:      return timer(in);
    case JUMP:       return jump(in, op);
    case CONDITION:  return simple(in, op);
    case END:        return end(in);
    case LABEL:      return label(in);
    case BLOCK:      return block(in, (enum block)w->what);
    default:         return nothing(in);
    }
}

/* Which word the line begins with; NULL: a report is written. */
static const struct word *first_word(struct inform_scan *s)
{
    if (inform_scan_take(s, '*')) {
        return &WORDS[WORD_COUNT - 1]; /* LABEL */
    }
    const struct inform_piece w = inform_scan_word(s);
    for (int i = 0; i < WORD_COUNT; i++) {
        if (inform_scan_is(s, w, WORDS[i].text)) {
            return &WORDS[i];
        }
    }
    s->at = w.length > 0 ? s->at : s->begin;
    if (w.length > 0) {
        inform_scan_fault(s, INFORM_BAD_WORD, w);
    } else {
        inform_scan_unexpected(s);
    }
    return NULL;
}

int inform_words(struct inform_reading *in)
{
    struct inform_scan *s = &in->s;
    const struct word *word = first_word(s);
    if (!word) {
        return -1;
    }
    if (in->end_line > 0) {
        s->r->other = in->end_line;
        return inform_scan_fault_line(s, INFORM_BAD_AFTER_END);
    }
    if (word->form != MOVE || word->what != INFORM_CIRCLE) {
        const int32_t at = s->at;
        if (inform_move_arc_over(in)) {
            return -1;
        }
        s->at = at;
    }
    if (instruction(in, word)) {
        return -1;
    }
    return inform_scan_over(s) ? 0 : inform_scan_unexpected(s);
}
