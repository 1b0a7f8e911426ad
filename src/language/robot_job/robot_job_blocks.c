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

int robot_job_block_endif(struct robot_job_reading *in)
{
    struct robot_job_block *b = innermost(in, ROBOT_JOB_BLOCK_IF, ROBOT_JOB_BLOCK_ELSE);
    if (!b) {
        return -1;
    }
    if (b->kind == ROBOT_JOB_BLOCK_IF) {
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
