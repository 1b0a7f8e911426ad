/* robot_job_places - what names a position, and the lines that change one: SET ADD SUB SETE GETE
 * GETS CNVRT MSHIFT. */
#include "robot_job_reading.h"

enum { ELEMENTS = 6 };

/* Note where a position is wanted that no file has: the program may set it. */
static void want(struct robot_job_reading *in, int32_t number, struct robot_job_span w)
{
    struct robot_job_mention *m = &in->p->wanted[number];
    if (m->line == 0) {
        *m = (struct robot_job_mention){ .text = in->p->texts,
                                         .line = in->s.line,
                                         .column = robot_job_scan_column(&in->s, w.at),
                                         .offset = w.at,
                                         .length = w.length };
    }
}

/* Take P001 or PX001, P[3] or PX[B000]. 1: taken, 0: something else stands here. Nobody has looked
 * yet whether there is such a position. */
static int take_variable(struct robot_job_reading *in, int32_t *number, struct robot_job_by *by,
                         struct robot_job_span *at)
{
    struct robot_job_scan *s = &in->s;
    robot_job_scan_over(s);
    const int32_t begin = s->at;
    struct robot_job_span w = robot_job_scan_word(s);
    *by = (struct robot_job_by){ ROBOT_JOB_NOTHING, 0 };
    if (robot_job_scan_is(s, w, "P") || robot_job_scan_is(s, w, "PX")) {
        const int status = robot_job_operand_element(in, ROBOT_JOB_POINTS, number, by);
        w.length = s->at - w.at;
        *at = w;
        s->at = status ? s->at : begin;
        return status;
    }
    const bool all = w.length > 2 && robot_job_scan_is(s, (struct robot_job_span){ w.at, 2 }, "PX");
    const bool good =
        w.length > 0 && (all || robot_job_scan_is(s, (struct robot_job_span){ w.at, 1 }, "P"));
    *at = w;
    w.at += all;
    w.length -= all;
    *number = good ? robot_job_scan_digits(s, w) : -1;
    s->at = *number >= 0 ? s->at : begin;
    return *number >= 0;
}

int robot_job_place_take(struct robot_job_reading *in, int32_t *number, struct robot_job_by *by)
{
    struct robot_job_scan *s = &in->s;
    struct robot_job_span at;
    const int status = take_variable(in, number, by, &at);
    if (status < 0 || by->kind != ROBOT_JOB_NOTHING) {
        return status;
    }
    if (status == 0) {
        const int32_t begin = s->at;
        const struct robot_job_span w = robot_job_scan_word(s);
        *number = w.length > 1 && robot_job_scan_is(s, (struct robot_job_span){ w.at, 1 }, "C")
                      ? robot_job_scan_digits(s, w)
                      : -1;
        if (*number < 0) {
            s->at = begin;
            return 0;
        }
        *number = robot_job_positions_find(in, 'C', *number);
        return *number >= 0 ? 1 : robot_job_scan_fault(s, ROBOT_JOB_BAD_POSITION, w);
    }
    if (*number < ROBOT_JOB_POINTS && in->points->point[*number].kind != ROBOT_JOB_NO_POINT) {
        return 1;
    }
    const int32_t there = robot_job_positions_find(in, 'P', *number);
    if (there < 0 && *number >= ROBOT_JOB_POINTS) {
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_POINT, at);
    }
    if (there < 0) {
        want(in, *number, at);
    }
    *number = there < 0 ? *number : there;
    return 1;
}

/* Take the position that a line sets. */
static int take_target(struct robot_job_reading *in, struct robot_job_instruction *c)
{
    struct robot_job_scan *s = &in->s;
    struct robot_job_span at;
    const int status = take_variable(in, &c->to, &c->to_by, &at);
    if (status <= 0) {
        return status < 0 ? -1 : robot_job_scan_unexpected(s);
    }
    if (c->to_by.kind != ROBOT_JOB_NOTHING) {
        in->p->changes_any = true;
        return 0;
    }
    if (c->to >= ROBOT_JOB_POINTS) {
        s->r->low = 0;
        s->r->high = ROBOT_JOB_POINTS - 1;
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_VALUE, at);
    }
    in->p->changed[c->to] = true;
    return 0;
}

/* Take the position that a line looks at. */
static int take_source(struct robot_job_reading *in, struct robot_job_instruction *c)
{
    const int status = robot_job_place_take(in, &c->via, &c->via_by);
    return status > 0 ? 0 : status < 0 ? -1 : robot_job_scan_unexpected(&in->s);
}

int robot_job_place_calculate(struct robot_job_reading *in, enum robot_job_op op)
{
    struct robot_job_scan *s = &in->s;
    struct robot_job_span at;
    struct robot_job_by by;
    int32_t number;
    robot_job_scan_over(s);
    const int32_t begin = s->at;
    const int status = take_variable(in, &number, &by, &at);
    s->at = begin;
    if (status <= 0) {
        return status;
    }
    if (op > ROBOT_JOB_OP_SUB) {
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_KIND, at);
    }
    struct robot_job_instruction *c =
        robot_job_reading_add(in, (enum robot_job_op)(ROBOT_JOB_OP_PLACE_SET
                                                      + (op - ROBOT_JOB_OP_SET)));
    return c && !take_target(in, c) && !take_source(in, c) ? 1 : -1;
}

/* Read (n), the number of an element. */
static int take_element(struct robot_job_reading *in, struct robot_job_instruction *c)
{
    struct robot_job_scan *s = &in->s;
    if (!robot_job_scan_take(s, '(')) {
        return robot_job_scan_unexpected(s);
    }
    if (robot_job_scan_whole(s, 1, ELEMENTS, &c->level)) {
        return -1;
    }
    c->level--;
    return robot_job_scan_take(s, ')') ? 0 : robot_job_scan_unexpected(s);
}

/* SETE P001 (3) D000, GETE D000 P001 (3). */
static int element(struct robot_job_reading *in, struct robot_job_instruction *c)
{
    enum { LONG = 1u << ROBOT_JOB_D | 1u << ROBOT_JOB_LD, VALUE = LONG | 1u << ROBOT_JOB_CONSTANT };
    struct robot_job_scan *s = &in->s;
    int32_t whole;
    if (c->op == ROBOT_JOB_OP_GETE) {
        return robot_job_operand(in, LONG, &c->left) || take_source(in, c) || take_element(in, c)
                   ? -1
                   : 0;
    }
    if (take_target(in, c) || take_element(in, c)) {
        return -1;
    }
    robot_job_scan_over(s);
    const int32_t at = s->at;
    if (robot_job_operand(in, VALUE, &c->right)) {
        return -1;
    }
    if (c->right.kind != ROBOT_JOB_CONSTANT) {
        return 0;
    }
    s->at = at;
    return robot_job_scan_whole(s, INT32_MIN, INT32_MAX, &whole);
}

/* GETS PX001 $PX000 in pulses, $PX001 as a pose. */
static int here(struct robot_job_reading *in, struct robot_job_instruction *c)
{
    struct robot_job_scan *s = &in->s;
    robot_job_scan_over(s);
    const int32_t begin = s->at;
    struct robot_job_span at = robot_job_scan_word(s);
    if (at.length > 0 && s->text[at.at] != 'P' && s->text[at.at] != 'p') {
        return robot_job_scan_fault_line(s, ROBOT_JOB_BAD_LACKING); /* other system variables */
    }
    s->at = begin;
    if (take_target(in, c)) {
        return -1;
    }
    if (!robot_job_scan_take(s, '$')) {
        return robot_job_scan_unexpected(s);
    }
    at = robot_job_scan_word(s);
    c->level = robot_job_scan_is(s, at, "PX001");
    return c->level == 1 || robot_job_scan_is(s, at, "PX000")
               ? 0
               : robot_job_scan_fault(s, ROBOT_JOB_BAD_LACKING, at);
}

/* Take the frame of a line: BF, RF, UF#(1), and TF if there is one of a tool to be meant. */
static int take_frame(struct robot_job_reading *in, struct robot_job_instruction *c, bool tool)
{
    struct robot_job_scan *s = &in->s;
    robot_job_scan_over(s);
    const int32_t begin = s->at;
    const struct robot_job_span w = robot_job_scan_word(s);
    const int status = robot_job_move_frame(in, w, c);
    if (status > 0 && (tool || c->increment != ROBOT_JOB_BY_TOOL)) {
        return 0;
    }
    s->at = status == 0 ? begin : s->at;
    return status < 0 ? -1
           : status > 0 || robot_job_scan_is(s, w, "MTF")
               ? robot_job_scan_fault(s, ROBOT_JOB_BAD_LACKING, w)
               : robot_job_scan_unexpected(s);
}

/* Take TL#(1), if it stands here. */
static int take_tool(struct robot_job_reading *in, struct robot_job_instruction *c)
{
    struct robot_job_scan *s = &in->s;
    c->level = ROBOT_JOB_ANY;
    if (robot_job_scan_over(s)) {
        return 0;
    }
    struct robot_job_span at = robot_job_scan_word(s);
    if (!robot_job_scan_is(s, at, "TL")) {
        s->at = at.length > 0 ? at.at : s->at;
        return robot_job_scan_unexpected(s);
    }
    if (!robot_job_scan_take(s, '#') || !robot_job_scan_take(s, '(')) {
        return robot_job_scan_unexpected(s);
    }
    if (robot_job_scan_whole(s, 0, ROBOT_JOB_FRAMES - 1, &c->level)) {
        return -1;
    }
    if (!robot_job_scan_take(s, ')')) {
        return robot_job_scan_unexpected(s);
    }
    at.length = s->at - at.at;
    return in->points->tool[c->level].defined ? 0
                                              : robot_job_scan_fault(s, ROBOT_JOB_BAD_FRAME, at);
}

/* MSHIFT PX001 BF PX002 PX003: its second position. */
static int take_end(struct robot_job_reading *in, struct robot_job_instruction *c)
{
    const int status = robot_job_place_take(in, &c->end, &c->end_by);
    return status > 0 ? 0 : status < 0 ? -1 : robot_job_scan_unexpected(&in->s);
}

int robot_job_place_line(struct robot_job_reading *in, enum robot_job_op op)
{
    struct robot_job_instruction *c = robot_job_reading_add(in, op);
    if (!c) {
        return -1;
    }
    switch (op) {
    case ROBOT_JOB_OP_GETS: return here(in, c);
    case ROBOT_JOB_OP_CNVRT:
        return take_target(in, c) || take_source(in, c) || take_frame(in, c, false)
                       || take_tool(in, c)
                   ? -1
                   : 0;
    case ROBOT_JOB_OP_MSHIFT:
        return take_target(in, c) || take_frame(in, c, true) || take_source(in, c)
                       || take_end(in, c)
                   ? -1
                   : 0;
    default: return element(in, c);
    }
}
