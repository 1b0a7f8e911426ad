#include "robot_job_reading.h"

#include <math.h>

#define TIME_MAX 655.35 /* [s] as in the maker's language */

/* The largest number that any operand may be. */
#define CONSTANT_MAX 1e12

/* Kind and index of a variable such as B000 or LB000; NOTHING if the word is none. */
static enum robot_job_operand_kind variable(const struct robot_job_scan *s, struct robot_job_span w,
                                            int32_t *index)
{
    static const char LETTERS[] = "BIDR";
    const bool local =
        w.length > 2 && robot_job_scan_is(s, (struct robot_job_span){ w.at, 1 }, "L");
    w.at += local;
    w.length -= local;
    *index = robot_job_scan_digits(s, w);
    for (int32_t i = 0; *index >= 0 && i < 4; i++) {
        const char letter[2] = { LETTERS[i], '\0' };
        if (robot_job_scan_is(s, (struct robot_job_span){ w.at, 1 }, letter)) {
            return (enum robot_job_operand_kind)((local ? ROBOT_JOB_LB : ROBOT_JOB_B) + i);
        }
    }
    return ROBOT_JOB_NOTHING;
}

int robot_job_operand_element(struct robot_job_reading *in, int32_t most, int32_t *index,
                              struct robot_job_by *by)
{
    struct robot_job_scan *s = &in->s;
    *by = (struct robot_job_by){ ROBOT_JOB_NOTHING, 0 };
    if (s->at >= s->end || s->text[s->at] != '[') {
        return 0;
    }
    s->at++;
    struct robot_job_operand o = { .kind = ROBOT_JOB_NOTHING };
    const int which = robot_job_operand_whole(in, &o);
    if (which < 0 || (which == 0 && robot_job_scan_whole(s, 0, most - 1, index))) {
        return -1;
    }
    if (which > 0 && o.by.kind != ROBOT_JOB_NOTHING) { /* an element of an element */
        return robot_job_scan_unexpected(s);
    }
    if (which > 0) {
        *by = (struct robot_job_by){ o.kind, o.index };
    }
    return robot_job_scan_take(s, ']') ? 1 : robot_job_scan_unexpected(s);
}

int robot_job_operand_channel(struct robot_job_reading *in, int32_t most, int32_t *index)
{
    struct robot_job_scan *s = &in->s;
    if (!robot_job_scan_take(s, '#') || !robot_job_scan_take(s, '(')) {
        return robot_job_scan_unexpected(s);
    }
    if (robot_job_scan_whole(s, 1, most, index)) {
        return -1;
    }
    --*index;
    return robot_job_scan_take(s, ')') ? 0 : robot_job_scan_unexpected(s);
}

/* Whether a word is INFORM's, but nothing to count with here: words of the table, positions P000
 * and LP000, elements of an array. */
static bool is_lacking(const struct robot_job_scan *s, struct robot_job_span w)
{
    const int32_t local = w.length > 1 && (s->text[w.at] == 'L' || s->text[w.at] == 'l');
    const struct robot_job_span rest = { w.at + local, w.length - local };
    return robot_job_lacks(s, w) || (s->at < s->end && s->text[s->at] == '[')
           || (robot_job_scan_digits(s, rest) >= 0
               && robot_job_scan_is(s, (struct robot_job_span){ rest.at, 1 }, "P"));
}

/* Read an element of the variables of a kind, B[3] or LD[I000]: 1, 0 if the word is none, or -1. */
static int array(struct robot_job_reading *in, struct robot_job_span w, struct robot_job_operand *o)
{
    struct robot_job_scan *s = &in->s;
    static const char LETTERS[] = "BIDR";
    const bool local =
        w.length == 2 && robot_job_scan_is(s, (struct robot_job_span){ w.at, 1 }, "L");
    if (w.length != 1 + local || s->at >= s->end || s->text[s->at] != '[') {
        return 0;
    }
    for (int32_t i = 0; i < 4; i++) {
        const char letter[2] = { LETTERS[i], '\0' };
        if (robot_job_scan_is(s, (struct robot_job_span){ w.at + local, 1 }, letter)) {
            o->kind = (enum robot_job_operand_kind)((local ? ROBOT_JOB_LB : ROBOT_JOB_B) + i);
            return robot_job_operand_element(in, local ? ROBOT_JOB_LOCALS : ROBOT_JOB_VARIABLES,
                                             &o->index, &o->by);
        }
    }
    return 0;
}

/* Read a word that is a signal, an analog input or a variable. */
static int named(struct robot_job_reading *in, struct robot_job_span w, struct robot_job_operand *o)
{
    struct robot_job_scan *s = &in->s;
    if (robot_job_scan_is(s, w, "IN") || robot_job_scan_is(s, w, "OT")) {
        o->kind = robot_job_scan_is(s, w, "IN") ? ROBOT_JOB_IN : ROBOT_JOB_OT;
        return robot_job_operand_channel(in, ROBOT_JOB_SIGNALS, &o->index);
    }
    if (robot_job_scan_is(s, w, "IG") || robot_job_scan_is(s, w, "OG")) {
        o->kind = robot_job_scan_is(s, w, "IG") ? ROBOT_JOB_IG : ROBOT_JOB_OG;
        return robot_job_operand_channel(in, ROBOT_JOB_SIGNALS / ROBOT_JOB_GROUP, &o->index);
    }
    if (robot_job_scan_is(s, w, "AI")) {
        o->kind = ROBOT_JOB_AI;
        return robot_job_operand_channel(in, ROBOT_JOB_ANALOGS, &o->index);
    }
    const int element = array(in, w, o);
    if (element != 0) {
        return element < 0 ? -1 : 0;
    }
    o->kind = variable(s, w, &o->index);
    if (o->kind == ROBOT_JOB_NOTHING) {
        return robot_job_scan_fault(s,
                                    is_lacking(s, w) ? ROBOT_JOB_BAD_LACKING : ROBOT_JOB_BAD_WORD,
                                    w);
    }
    const int32_t most = o->kind >= ROBOT_JOB_LB ? ROBOT_JOB_LOCALS : ROBOT_JOB_VARIABLES;
    if (o->index >= most) {
        s->r->low = 0;
        s->r->high = most - 1;
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_VALUE, w);
    }
    return 0;
}

int robot_job_operand(struct robot_job_reading *in, uint32_t kinds, struct robot_job_operand *o)
{
    struct robot_job_scan *s = &in->s;
    struct robot_job_span w = robot_job_scan_word(s);
    int status;
    *o = (struct robot_job_operand){ .kind = ROBOT_JOB_CONSTANT };
    if (w.length > 0) {
        status = named(in, w, o);
    } else {
        robot_job_scan_over(s);
        w.at = s->at;
        status = robot_job_scan_number(s, -CONSTANT_MAX, CONSTANT_MAX, &o->number);
    }
    w.length = s->at - w.at;
    if (status) {
        return -1;
    }
    return kinds & 1u << o->kind ? 0 : robot_job_scan_fault(s, ROBOT_JOB_BAD_KIND, w);
}

int robot_job_operand_whole(struct robot_job_reading *in, struct robot_job_operand *o)
{
    struct robot_job_scan *s = &in->s;
    robot_job_scan_over(s);
    const int32_t at = s->at;
    const bool named = robot_job_scan_word(s).length > 0;
    s->at = at;
    return named ? (robot_job_operand(in, ROBOT_JOB_WHOLES, o) ? -1 : 1) : 0;
}

static enum robot_job_relation relation(struct robot_job_scan *s)
{
    if (robot_job_scan_take(s, '=')) {
        return ROBOT_JOB_EQUAL;
    }
    if (robot_job_scan_take(s, '<')) {
        return s->at < s->end && s->text[s->at] == '>'   ? (s->at++, ROBOT_JOB_NOT_EQUAL)
               : s->at < s->end && s->text[s->at] == '=' ? (s->at++, ROBOT_JOB_AT_MOST)
                                                         : ROBOT_JOB_LESS;
    }
    if (robot_job_scan_take(s, '>')) {
        return s->at < s->end && s->text[s->at] == '=' ? (s->at++, ROBOT_JOB_AT_LEAST)
                                                       : ROBOT_JOB_MORE;
    }
    return ROBOT_JOB_ALWAYS;
}

/* Read ON or OFF, which a signal is compared with. */
static int on_or_off(struct robot_job_reading *in, struct robot_job_term *c)
{
    struct robot_job_scan *s = &in->s;
    if (robot_job_scan_over(s)) {
        return robot_job_scan_unexpected(s);
    }
    const struct robot_job_span w = robot_job_scan_word(s);
    c->right = (struct robot_job_operand){ .kind = ROBOT_JOB_CONSTANT };
    c->right.number = robot_job_scan_is(s, w, "ON");
    if ((c->right.number == 0.0 && !robot_job_scan_is(s, w, "OFF"))
        || c->relation > ROBOT_JOB_NOT_EQUAL) {
        return robot_job_scan_fault_line(s, ROBOT_JOB_BAD_COMPARE);
    }
    return 0;
}

/* Read one comparison, in brackets of its own or not. */
static int comparison(struct robot_job_reading *in, struct robot_job_term *c)
{
    enum {
        VARIABLES = ROBOT_JOB_WHOLES | 1u << ROBOT_JOB_R | 1u << ROBOT_JOB_LR,
        LEFT = VARIABLES | 1u << ROBOT_JOB_IN | 1u << ROBOT_JOB_OT | 1u << ROBOT_JOB_AI
               | 1u << ROBOT_JOB_IG | 1u << ROBOT_JOB_OG,
        RIGHT = VARIABLES | 1u << ROBOT_JOB_CONSTANT
    };
    struct robot_job_scan *s = &in->s;

    if (robot_job_operand(in, LEFT, &c->left)) {
        return -1;
    }
    c->relation = relation(s);
    if (c->relation == ROBOT_JOB_ALWAYS) {
        return robot_job_scan_unexpected(s);
    }
    return c->left.kind == ROBOT_JOB_IN || c->left.kind == ROBOT_JOB_OT
               ? on_or_off(in, c)
               : robot_job_operand(in, RIGHT, &c->right);
}

int robot_job_operand_until(struct robot_job_reading *in, struct robot_job_instruction *c)
{
    struct robot_job_term t = { .relation = ROBOT_JOB_ALWAYS };
    if (robot_job_operand(in, 1u << ROBOT_JOB_IN, &t.left)) {
        return -1;
    }
    if (!robot_job_scan_take(&in->s, '=')) {
        return robot_job_scan_unexpected(&in->s);
    }
    t.relation = ROBOT_JOB_EQUAL;
    if (on_or_off(in, &t)) {
        return -1;
    }
    c->until = t.left.index;
    c->until_on = t.right.number != 0.0;
    return 0;
}

int robot_job_operand_keep(struct robot_job_reading *in, const struct robot_job_term *t)
{
    if (in->p->terms == ROBOT_JOB_TERMS) {
        in->s.r->high = ROBOT_JOB_TERMS;
        return robot_job_scan_fault_line(&in->s, ROBOT_JOB_BAD_TOO_MANY);
    }
    in->p->term[in->p->terms++] = *t;
    return 0;
}

/* Take AND or OR. 1: taken, 0: something else stands here. */
static int conjunction(struct robot_job_reading *in, struct robot_job_instruction *c)
{
    struct robot_job_scan *s = &in->s;
    robot_job_scan_over(s);
    const struct robot_job_span w = robot_job_scan_word(s);
    const bool any = robot_job_scan_is(s, w, "OR");
    if (!any && !robot_job_scan_is(s, w, "AND")) {
        s->at = w.length > 0 ? w.at : s->at;
        return 0;
    }
    if (c->terms > 0 && any != c->any) {
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_MIXTURE, w);
    }
    c->any = any;
    return 1;
}

int robot_job_operand_condition(struct robot_job_reading *in, struct robot_job_instruction *c)
{
    struct robot_job_scan *s = &in->s;
    struct robot_job_term t = { .relation = ROBOT_JOB_ALWAYS };
    bool bracket = robot_job_scan_take(s, '(');
    int more;

    if (comparison(in, &t)) {
        return -1;
    }
    c->relation = t.relation;
    c->left = t.left;
    c->right = t.right;
    c->more = in->p->terms;
    bracket = bracket && !robot_job_scan_take(s, ')'); /* it closes behind all comparisons */
    while ((more = conjunction(in, c)) > 0) {
        const bool own = robot_job_scan_take(s, '(');
        if (comparison(in, &t)) {
            return -1;
        }
        if (own && !robot_job_scan_take(s, ')')) {
            return robot_job_scan_unexpected(s);
        }
        if (robot_job_operand_keep(in, &t)) {
            return -1;
        }
        c->terms++;
    }
    if (more < 0) {
        return -1;
    }
    return !bracket || robot_job_scan_take(s, ')') ? 0 : robot_job_scan_unexpected(s);
}

int robot_job_operand_if(struct robot_job_reading *in, struct robot_job_instruction *c)
{
    struct robot_job_scan *s = &in->s;
    if (robot_job_scan_over(s)) {
        return 0;
    }
    const int32_t at = s->at;
    if (!robot_job_scan_is(s, robot_job_scan_word(s), "IF")) {
        s->at = at;
        return robot_job_scan_unexpected(s);
    }
    return robot_job_operand_condition(in, c);
}

int robot_job_operand_time(struct robot_job_reading *in, struct robot_job_instruction *c)
{
    struct robot_job_scan *s = &in->s;
    const int32_t at = s->at;
    double seconds;
    if (!robot_job_scan_is(s, robot_job_scan_word(s), "T")) {
        s->at = at;
        return robot_job_scan_unexpected(s);
    }
    if (!robot_job_scan_take(s, '=')) {
        return robot_job_scan_unexpected(s);
    }
    if (robot_job_scan_number(s, 0.0, TIME_MAX, &seconds)) {
        return -1;
    }
    c->time = llround(seconds * 1e9);
    return 0;
}
