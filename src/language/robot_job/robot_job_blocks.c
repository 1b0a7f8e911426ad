#include "robot_job_reading.h"

#include <stddef.h>

/* Open a block whose first instruction is the latest. */
static int open_block(struct robot_job_reading *in, int32_t kind)
{
    if (in->blocks == ROBOT_JOB_BLOCKS) {
        in->s.r->high = ROBOT_JOB_BLOCKS;
        return robot_job_scan_fault_line(&in->s, ROBOT_JOB_BAD_TOO_MANY);
    }
    struct robot_job_block *b = &in->block[in->blocks++];
    b->kind = kind;
    b->code = in->p->count - 1;
    b->out = -1;
    b->line = in->s.line;
    b->begin = (struct robot_job_span){ in->s.begin, in->s.end - in->s.begin };
    return 0;
}

/* The innermost block, if it is of one of two kinds; else NULL, and a report. */
static struct robot_job_block *innermost(struct robot_job_reading *in, int32_t kind, int32_t other)
{
    struct robot_job_block *b = in->blocks > 0 ? &in->block[in->blocks - 1] : NULL;
    if (b && ((int32_t)b->kind == kind || (int32_t)b->kind == other)) {
        return b;
    }
    in->s.r->other = b ? b->line : 0;
    robot_job_scan_fault_line(&in->s, ROBOT_JOB_BAD_NOT_OPEN);
    return NULL;
}

int32_t robot_job_block_loop_inside(const struct robot_job_reading *in)
{
    for (int32_t i = in->blocks; i > 0; i--) {
        if (in->block[i - 1].kind == ROBOT_JOB_BLOCK_LOOP) {
            return in->block[i - 1].code;
        }
    }
    return -1;
}

/* Read a condition, and add an instruction that jumps unless it holds. */
static int add_unless(struct robot_job_reading *in)
{
    struct robot_job_instruction *c = robot_job_reading_add(in, ROBOT_JOB_OP_UNLESS);
    return c ? robot_job_operand_condition(in, c) : -1;
}

/* Read a bound of FOR or a value of CASE: a variable, or a whole number that one of this kind can
 * have. */
static int bound_of(struct robot_job_reading *in, enum robot_job_operand_kind kind,
                    struct robot_job_operand *bound)
{
    struct robot_job_scan *s = &in->s;
    robot_job_scan_over(s);
    const int32_t at = s->at;
    int32_t whole;
    if (robot_job_operand(in, ROBOT_JOB_WHOLES | 1u << ROBOT_JOB_CONSTANT, bound)) {
        return -1;
    }
    if (bound->kind != ROBOT_JOB_CONSTANT) {
        return 0;
    }
    s->at = at;
    return robot_job_scan_whole(s, (int32_t)robot_job_low(kind), (int32_t)robot_job_high(kind),
                                &whole);
}

int robot_job_block_if(struct robot_job_reading *in)
{
    return add_unless(in) ? -1 : open_block(in, ROBOT_JOB_BLOCK_IF);
}

int robot_job_block_while(struct robot_job_reading *in)
{
    return add_unless(in) ? -1 : open_block(in, ROBOT_JOB_BLOCK_WHILE);
}

int robot_job_block_else(struct robot_job_reading *in, bool condition)
{
    struct robot_job_block *b = innermost(in, ROBOT_JOB_BLOCK_IF, ROBOT_JOB_BLOCK_ELSE);
    if (!b) {
        return -1;
    }
    if (b->kind == ROBOT_JOB_BLOCK_ELSE) {
        in->s.r->other = b->else_line;
        return robot_job_scan_fault_line(&in->s, ROBOT_JOB_BAD_AFTER_ELSE);
    }
    struct robot_job_instruction *out = robot_job_reading_add(in, ROBOT_JOB_OP_JUMP);
    if (!out) {
        return -1;
    }
    out->to = b->out; /* where it goes to is known at ENDIF */
    b->out = in->p->count - 1;
    in->p->instruction[b->code].to = in->p->count;
    if (!condition) {
        b->kind = ROBOT_JOB_BLOCK_ELSE;
        b->else_line = in->s.line;
        return 0;
    }
    b->code = in->p->count;
    return add_unless(in);
}

/* End a block of branches; without ELSE or DEFAULT it is still of the kind `open`, and its latest
 * condition goes to its end, too. */
static int end_branches(struct robot_job_reading *in, struct robot_job_block *b, int32_t open)
{
    if ((int32_t)b->kind == open && b->code >= 0) {
        in->p->instruction[b->code].to = in->p->count;
    }
    for (int32_t i = b->out; i >= 0;) {
        const int32_t before = in->p->instruction[i].to;
        in->p->instruction[i].to = in->p->count;
        i = before;
    }
    in->blocks--;
    return 0;
}

int robot_job_block_endif(struct robot_job_reading *in)
{
    struct robot_job_block *b = innermost(in, ROBOT_JOB_BLOCK_IF, ROBOT_JOB_BLOCK_ELSE);
    if (!b) {
        return -1;
    }
    return end_branches(in, b, ROBOT_JOB_BLOCK_IF);
}

int robot_job_block_endwhile(struct robot_job_reading *in)
{
    struct robot_job_block *b = innermost(in, ROBOT_JOB_BLOCK_WHILE, ROBOT_JOB_BLOCK_WHILE);
    struct robot_job_instruction *c = b ? robot_job_reading_add(in, ROBOT_JOB_OP_JUMP) : NULL;
    if (!c) {
        return -1;
    }
    c->to = b->code;
    in->p->instruction[b->code].to = in->p->count;
    in->blocks--;
    return 0;
}

int robot_job_block_loop(struct robot_job_reading *in)
{
    enum {
        COUNTS =
            1u << ROBOT_JOB_CONSTANT | 1u << ROBOT_JOB_B | 1u << ROBOT_JOB_I | 1u << ROBOT_JOB_D
    };
    struct robot_job_scan *s = &in->s;
    struct robot_job_instruction *c = robot_job_reading_add(in, ROBOT_JOB_OP_LOOP);
    if (!c) {
        return -1;
    }
    for (int32_t i = 0; i < in->blocks; i++) {
        c->via += in->block[i].kind == ROBOT_JOB_BLOCK_LOOP;
    }
    if (c->via == ROBOT_JOB_LOOPS) {
        s->r->high = ROBOT_JOB_LOOPS;
        return robot_job_scan_fault_line(s, ROBOT_JOB_BAD_TOO_MANY);
    }
    if (!robot_job_scan_over(s)) {
        const int32_t at = s->at;
        int32_t count;
        if (robot_job_operand(in, COUNTS, &c->right)) {
            return -1;
        }
        if (c->right.kind == ROBOT_JOB_CONSTANT) {
            s->at = at;
            if (robot_job_scan_whole(s, 0, INT32_MAX, &count)) {
                return -1;
            }
        }
    }
    return open_block(in, ROBOT_JOB_BLOCK_LOOP);
}

int robot_job_block_endloop(struct robot_job_reading *in)
{
    struct robot_job_block *b = innermost(in, ROBOT_JOB_BLOCK_LOOP, ROBOT_JOB_BLOCK_LOOP);
    struct robot_job_instruction *c = b ? robot_job_reading_add(in, ROBOT_JOB_OP_ENDLOOP) : NULL;
    if (!c) {
        return -1;
    }
    c->to = b->code + 1;
    c->via = in->p->instruction[b->code].via;
    in->p->instruction[b->code].to = in->p->count;
    in->blocks--;
    return 0;
}

/* FOR B000=0 TO 9 STEP 1: the variable is set; the block is left when it has passed the end. */
int robot_job_block_for(struct robot_job_reading *in)
{
    struct robot_job_scan *s = &in->s;
    struct robot_job_instruction *set = robot_job_reading_add(in, ROBOT_JOB_OP_SET);
    int32_t step = 1;
    if (!set || robot_job_operand(in, ROBOT_JOB_WHOLES, &set->left)) {
        return -1;
    }
    if (!robot_job_scan_take(s, '=')) {
        return robot_job_scan_unexpected(s);
    }
    if (bound_of(in, set->left.kind, &set->right)) {
        return -1;
    }
    struct robot_job_instruction *c = robot_job_reading_add(in, ROBOT_JOB_OP_UNLESS);
    robot_job_scan_over(s);
    int32_t at = s->at;
    if (!c) {
        return -1;
    }
    if (!robot_job_scan_is(s, robot_job_scan_word(s), "TO")) {
        s->at = at;
        return robot_job_scan_unexpected(s);
    }
    c->left = set->left;
    if (bound_of(in, set->left.kind, &c->right)) {
        return -1;
    }
    if (!robot_job_scan_over(s)) {
        at = s->at;
        if (!robot_job_scan_is(s, robot_job_scan_word(s), "STEP")) {
            s->at = at;
            return robot_job_scan_unexpected(s);
        }
        if (robot_job_scan_whole(s, INT16_MIN, INT16_MAX, &step)) {
            return -1;
        }
    }
    c->relation = step < 0 ? ROBOT_JOB_AT_LEAST : ROBOT_JOB_AT_MOST;
    if (open_block(in, ROBOT_JOB_BLOCK_FOR)) {
        return -1;
    }
    in->block[in->blocks - 1].operand = set->left;
    in->block[in->blocks - 1].step = step;
    return 0;
}

int robot_job_block_next(struct robot_job_reading *in)
{
    struct robot_job_scan *s = &in->s;
    struct robot_job_block *b = innermost(in, ROBOT_JOB_BLOCK_FOR, ROBOT_JOB_BLOCK_FOR);
    struct robot_job_instruction *add = b ? robot_job_reading_add(in, ROBOT_JOB_OP_ADD) : NULL;
    if (!add) {
        return -1;
    }
    robot_job_scan_over(s);
    struct robot_job_span at = { s->at, 0 };
    if (robot_job_operand(in, ROBOT_JOB_WHOLES, &add->left)) {
        return -1;
    }
    at.length = s->at - at.at;
    if (add->left.kind != b->operand.kind || add->left.index != b->operand.index
        || add->left.by.kind != b->operand.by.kind || add->left.by.index != b->operand.by.index) {
        s->r->other = b->line;
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_NEXT, at);
    }
    add->right = (struct robot_job_operand){ .kind = ROBOT_JOB_CONSTANT, .number = b->step };
    struct robot_job_instruction *back = robot_job_reading_add(in, ROBOT_JOB_OP_JUMP);
    if (!back) {
        return -1;
    }
    back->to = b->code;
    in->p->instruction[b->code].to = in->p->count;
    in->blocks--;
    return 0;
}

int robot_job_block_switch(struct robot_job_reading *in)
{
    enum { LOOKED_AT = ROBOT_JOB_WHOLES | 1u << ROBOT_JOB_IG | 1u << ROBOT_JOB_OG };
    struct robot_job_operand looked_at;
    if (robot_job_operand(in, LOOKED_AT, &looked_at) || open_block(in, ROBOT_JOB_BLOCK_SWITCH)) {
        return -1;
    }
    in->block[in->blocks - 1].operand = looked_at;
    in->block[in->blocks - 1].code = -1;
    return 0;
}

bool robot_job_block_before_case(const struct robot_job_reading *in)
{
    return in->blocks > 0 && in->block[in->blocks - 1].kind == ROBOT_JOB_BLOCK_SWITCH
           && in->block[in->blocks - 1].code < 0;
}

/* CASE 1, CASE 1,5 or DEFAULT. */
int robot_job_block_case(struct robot_job_reading *in, bool value)
{
    struct robot_job_scan *s = &in->s;
    struct robot_job_block *b = innermost(in, ROBOT_JOB_BLOCK_SWITCH, ROBOT_JOB_BLOCK_DEFAULT);
    if (!b) {
        return -1;
    }
    if (b->kind == ROBOT_JOB_BLOCK_DEFAULT) {
        s->r->other = b->else_line;
        return robot_job_scan_fault_line(s, ROBOT_JOB_BAD_AFTER_DEFAULT);
    }
    if (b->code >= 0) {
        struct robot_job_instruction *out = robot_job_reading_add(in, ROBOT_JOB_OP_JUMP);
        if (!out) {
            return -1;
        }
        out->to = b->out; /* where it goes to is known at ENDSWITCH */
        b->out = in->p->count - 1;
        in->p->instruction[b->code].to = in->p->count;
    }
    if (!value) {
        b->kind = ROBOT_JOB_BLOCK_DEFAULT;
        b->else_line = s->line;
        return 0;
    }
    struct robot_job_instruction *c = robot_job_reading_add(in, ROBOT_JOB_OP_UNLESS);
    b->code = in->p->count - 1;
    if (!c || bound_of(in, ROBOT_JOB_D, &c->right)) {
        return -1;
    }
    c->relation = ROBOT_JOB_EQUAL;
    c->left = b->operand;
    c->any = true;
    c->more = in->p->terms;
    while (robot_job_scan_take(s, ',')) {
        struct robot_job_term t = { ROBOT_JOB_EQUAL, b->operand, { 0 } };
        if (bound_of(in, ROBOT_JOB_D, &t.right) || robot_job_operand_keep(in, &t)) {
            return -1;
        }
        c->terms++;
    }
    return 0;
}

int robot_job_block_endswitch(struct robot_job_reading *in)
{
    struct robot_job_block *b = innermost(in, ROBOT_JOB_BLOCK_SWITCH, ROBOT_JOB_BLOCK_DEFAULT);
    return b ? end_branches(in, b, ROBOT_JOB_BLOCK_SWITCH) : -1;
}

int robot_job_block_all_closed(struct robot_job_reading *in)
{
    if (in->blocks == 0) {
        return 0;
    }
    const struct robot_job_block *b = &in->block[in->blocks - 1];
    in->s.r->other = in->s.line;
    in->s.line = b->line;
    return robot_job_scan_fault(&in->s, ROBOT_JOB_BAD_OPEN, b->begin);
}
