#include "inform_reading.h"

#include <math.h>

#define TIME_MAX 655.35 /* [s] as in the maker's language */

/* The largest number that any operand may be. */
#define CONSTANT_MAX 1e12

/* Kind of a word such as B000 with its index, NOTHING if it is none. */
static enum inform_operand_kind variable(const struct inform_scan *s, struct inform_piece w,
                                         int32_t *index)
{
    static const char LETTERS[] = "BIDR";
    *index = inform_scan_digits(s, w);
    for (int32_t i = 0; *index >= 0 && i < 4; i++) {
        const char letter[2] = { LETTERS[i], '\0' };
        if (inform_scan_is(s, (struct inform_piece){ w.at, 1 }, letter)) {
            return (enum inform_operand_kind)(INFORM_B + i);
        }
    }
    return INFORM_NOTHING;
}

int inform_operand_channel(struct inform_reading *in, int32_t most, int32_t *index)
{
    struct inform_scan *s = &in->s;
    if (!inform_scan_take(s, '#') || !inform_scan_take(s, '(')) {
        return inform_scan_unexpected(s);
    }
    if (inform_scan_whole(s, 1, most, index)) {
        return -1;
    }
    --*index;
    return inform_scan_take(s, ')') ? 0 : inform_scan_unexpected(s);
}

/* A word: signal, analog input or variable. */
static int named(struct inform_reading *in, struct inform_piece w, struct inform_operand *o)
{
    struct inform_scan *s = &in->s;
    if (inform_scan_is(s, w, "IN") || inform_scan_is(s, w, "OT")) {
        o->kind = inform_scan_is(s, w, "IN") ? INFORM_IN : INFORM_OT;
        return inform_operand_channel(in, INFORM_SIGNALS, &o->index);
    }
    if (inform_scan_is(s, w, "AI")) {
        o->kind = INFORM_AI;
        return inform_operand_channel(in, INFORM_ANALOGS, &o->index);
    }
    o->kind = variable(s, w, &o->index);
    if (o->kind == INFORM_NOTHING) {
        return inform_scan_fault(s, INFORM_BAD_WORD, w);
    }
    if (o->index >= INFORM_VARIABLES) {
        s->r->low = 0;
        s->r->high = INFORM_VARIABLES - 1;
        return inform_scan_fault(s, INFORM_BAD_VALUE, w);
    }
    return 0;
}

int inform_operand(struct inform_reading *in, uint32_t kinds, struct inform_operand *o)
{
    struct inform_scan *s = &in->s;
    struct inform_piece w = inform_scan_word(s);
    int status;
    *o = (struct inform_operand){ .kind = INFORM_CONSTANT };
    if (w.length > 0) {
        status = named(in, w, o);
    } else {
        inform_scan_over(s);
        w.at = s->at;
        status = inform_scan_number(s, -CONSTANT_MAX, CONSTANT_MAX, &o->number);
    }
    w.length = s->at - w.at;
    if (status) {
        return -1;
    }
    return kinds & 1u << o->kind ? 0 : inform_scan_fault(s, INFORM_BAD_KIND, w);
}

static enum inform_relation relation(struct inform_scan *s)
{
    if (inform_scan_take(s, '=')) {
        return INFORM_EQUAL;
    }
    if (inform_scan_take(s, '<')) {
        return s->at < s->end && s->text[s->at] == '>'   ? (s->at++, INFORM_NOT_EQUAL)
               : s->at < s->end && s->text[s->at] == '=' ? (s->at++, INFORM_AT_MOST)
                                                         : INFORM_LESS;
    }
    if (inform_scan_take(s, '>')) {
        return s->at < s->end && s->text[s->at] == '=' ? (s->at++, INFORM_AT_LEAST) : INFORM_MORE;
    }
    return INFORM_ALWAYS;
}

/* What a signal is compared with. */
static int on_or_off(struct inform_reading *in, struct inform_code *c)
{
    struct inform_scan *s = &in->s;
    if (inform_scan_over(s)) {
        return inform_scan_unexpected(s);
    }
    const struct inform_piece w = inform_scan_word(s);
    c->right = (struct inform_operand){ .kind = INFORM_CONSTANT };
    c->right.number = inform_scan_is(s, w, "ON");
    if ((c->right.number == 0.0 && !inform_scan_is(s, w, "OFF"))
        || c->relation > INFORM_NOT_EQUAL) {
        return inform_scan_fault_line(s, INFORM_BAD_COMPARE);
    }
    return 0;
}

int inform_operand_condition(struct inform_reading *in, struct inform_code *c)
{
    enum {
        VARIABLES = 1u << INFORM_B | 1u << INFORM_I | 1u << INFORM_D | 1u << INFORM_R,
        LEFT = VARIABLES | 1u << INFORM_IN | 1u << INFORM_OT | 1u << INFORM_AI,
        RIGHT = VARIABLES | 1u << INFORM_CONSTANT
    };
    struct inform_scan *s = &in->s;
    const bool bracket = inform_scan_take(s, '(');

    if (inform_operand(in, LEFT, &c->left)) {
        return -1;
    }
    c->relation = relation(s);
    if (c->relation == INFORM_ALWAYS) {
        return inform_scan_unexpected(s);
    }
    if (c->left.kind == INFORM_IN || c->left.kind == INFORM_OT
            ? on_or_off(in, c)
            : inform_operand(in, RIGHT, &c->right)) {
        return -1;
    }
    return !bracket || inform_scan_take(s, ')') ? 0 : inform_scan_unexpected(s);
}

int inform_operand_if(struct inform_reading *in, struct inform_code *c)
{
    struct inform_scan *s = &in->s;
    if (inform_scan_over(s)) {
        return 0;
    }
    const int32_t at = s->at;
    if (!inform_scan_is(s, inform_scan_word(s), "IF")) {
        s->at = at;
        return inform_scan_unexpected(s);
    }
    return inform_operand_condition(in, c);
}

int inform_operand_time(struct inform_reading *in, struct inform_code *c)
{
    struct inform_scan *s = &in->s;
    const int32_t at = s->at;
    double seconds;
    if (!inform_scan_is(s, inform_scan_word(s), "T")) {
        s->at = at;
        return inform_scan_unexpected(s);
    }
    if (!inform_scan_take(s, '=')) {
        return inform_scan_unexpected(s);
    }
    if (inform_scan_number(s, 0.0, TIME_MAX, &seconds)) {
        return -1;
    }
    c->time = llround(seconds * 1e9);
    return 0;
}
