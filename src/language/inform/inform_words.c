#include "inform_reading.h"

#include <math.h>
#include <stddef.h>

enum word {
    MOVJ, MOVL, MOVC, SPEED, PL, TOOL, USER, DOUT, AOUT, DIN, AIN, SET, ADD, SUB, MUL, DIV, INC,
    DEC, WAIT, TIMER, JUMP, CALL, RET, END, LABEL, IF, ELSEIF, ELSE, ENDIF, LOOP, ENDLOOP, WHILE,
    ENDWHILE, PAUSE, NOP, WORDS
};

static const struct { char text[12]; uint8_t word; } TABLE[] = {
    { "MOVJ", MOVJ }, { "MOVL", MOVL }, { "MOVC", MOVC }, { "SPEED", SPEED }, { "PL", PL },
    { "TOOL", TOOL }, { "USER", USER }, { "DOUT", DOUT }, { "AOUT", AOUT }, { "DIN", DIN },
    { "AIN", AIN }, { "SET", SET }, { "ADD", ADD }, { "SUB", SUB }, { "MUL", MUL },
    { "DIV", DIV }, { "INC", INC }, { "DEC", DEC }, { "WAIT", WAIT }, { "TIMER", TIMER },
    { "JUMP", JUMP }, { "CALL", CALL }, { "RET", RET }, { "END", END }, { "LABEL", LABEL },
    { "IF", IF }, { "IFTHEN", IF }, { "IFTHENEXP", IF }, { "ELSEIF", ELSEIF },
    { "ELSEIFEXP", ELSEIF }, { "ELSE", ELSE }, { "ENDIF", ENDIF }, { "LOOP", LOOP },
    { "ENDLOOP", ENDLOOP }, { "WHILE", WHILE }, { "WHILEEXP", WHILE }, { "ENDWHILE", ENDWHILE },
    { "PAUSE", PAUSE }, { "NOP", NOP }
};

enum {
    WHOLE = 1u << INFORM_B | 1u << INFORM_I | 1u << INFORM_D,
    VARIABLE = WHOLE | 1u << INFORM_R,
    VALUE = VARIABLE | 1u << INFORM_CONSTANT
};

struct inform_code *inform_reading_add(struct inform_reading *in, enum inform_op op)
{
    struct inform_program *p = in->p;
    if (p->count == INFORM_CODES) {
        in->s.r->high = INFORM_CODES;
        inform_scan_fault_line(&in->s, INFORM_BAD_TOO_MANY);
        return NULL;
    }
    struct inform_code *c = &p->code[p->count++];
    *c = (struct inform_code){
        .op = op, .line = in->s.line, .level = INFORM_ANY, .time = -1,
        .inside = inform_block_loop_inside(in)
    };
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
               ? -1 : check_constant(in, c, (struct inform_piece){ at, s->at - at });
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
                   ? inform_scan_fault(s, INFORM_BAD_VALUE, w) : 0;
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
               ? 0 : inform_scan_fault(s, INFORM_BAD_FRAME, at);
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
    p->label[p->labels++] = (struct inform_label){
        .offset = name.at, .length = name.length, .job = p->jobs - 1, .to = p->count,
        .line = s->line, .inside = inform_block_loop_inside(in)
    };
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

static int instruction(struct inform_reading *in, enum word word)
{
    switch (word) {
    case MOVJ:     return inform_move(in, INFORM_JOINT);
    case MOVL:     return inform_move(in, INFORM_LINE);
    case MOVC:     return inform_move(in, INFORM_CIRCLE);
    case SPEED:    return inform_move_speed(in);
    case PL:       return level(in);
    case TOOL:     return frame(in, true);
    case USER:     return frame(in, false);
    case DOUT:     return output(in, true);
    case AOUT:     return output(in, false);
    case DIN:      return arithmetic(in, INFORM_OP_SET, WHOLE, 1u << INFORM_IN | 1u << INFORM_OT);
    case AIN:      return arithmetic(in, INFORM_OP_SET, 1u << INFORM_R, 1u << INFORM_AI);
    case SET:      return arithmetic(in, INFORM_OP_SET, VARIABLE, VALUE);
    case ADD:      return arithmetic(in, INFORM_OP_ADD, VARIABLE, VALUE);
    case SUB:      return arithmetic(in, INFORM_OP_SUB, VARIABLE, VALUE);
    case MUL:      return arithmetic(in, INFORM_OP_MUL, VARIABLE, VALUE);
    case DIV:      return arithmetic(in, INFORM_OP_DIV, VARIABLE, VALUE);
    case INC:      return step(in, INFORM_OP_ADD);
    case DEC:      return step(in, INFORM_OP_SUB);
    case WAIT:     return wait(in);
    case TIMER:    return timer(in);
    case JUMP:     return jump(in, INFORM_OP_JUMP);
    case CALL:     return jump(in, INFORM_OP_CALL);
    case RET:      return simple(in, INFORM_OP_RET);
    case END:      return end(in);
    case LABEL:    return label(in);
    case IF:       return inform_block_if(in);
    case ELSEIF:   return inform_block_else(in, true);
    case ELSE:     return inform_block_else(in, false);
    case ENDIF:    return inform_block_endif(in);
    case LOOP:     return inform_block_loop(in);
    case ENDLOOP:  return inform_block_endloop(in);
    case WHILE:    return inform_block_while(in);
    case ENDWHILE: return inform_block_endwhile(in);
    case PAUSE:    return simple(in, INFORM_OP_PAUSE);
    case NOP:      return inform_reading_add(in, INFORM_OP_NOP) ? 0 : -1;
    case WORDS:    break;
    }
    return 0;
}

/* Which word the line begins with; WORDS: a report is written. */
static enum word first_word(struct inform_scan *s)
{
    if (inform_scan_take(s, '*')) {
        return LABEL;
    }
    const struct inform_piece w = inform_scan_word(s);
    for (size_t i = 0; i < sizeof TABLE / sizeof *TABLE; i++) {
        if (inform_scan_is(s, w, TABLE[i].text)) {
            return (enum word)TABLE[i].word;
        }
    }
    s->at = w.length > 0 ? s->at : s->begin;
    if (w.length > 0) {
        inform_scan_fault(s, INFORM_BAD_WORD, w);
    } else {
        inform_scan_unexpected(s);
    }
    return WORDS;
}

int inform_words(struct inform_reading *in)
{
    struct inform_scan *s = &in->s;
    const enum word word = first_word(s);
    if (word == WORDS) {
        return -1;
    }
    if (in->end_line > 0) {
        s->r->other = in->end_line;
        return inform_scan_fault_line(s, INFORM_BAD_AFTER_END);
    }
    if (word != MOVC) {
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
