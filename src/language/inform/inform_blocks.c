#include "inform_reading.h"

#include <stddef.h>

/* Open a block whose first instruction is the latest. */
static int open_block(struct inform_reading *in, int32_t kind)
{
    if (in->blocks == INFORM_BLOCKS) {
        in->s.r->high = INFORM_BLOCKS;
        return inform_scan_fault_line(&in->s, INFORM_BAD_TOO_MANY);
    }
    struct inform_block *b = &in->block[in->blocks++];
    b->kind = kind;
    b->code = in->p->count - 1;
    b->out = -1;
    b->line = in->s.line;
    b->begin = (struct inform_piece){ in->s.begin, in->s.end - in->s.begin };
    return 0;
}

/* The innermost block if it is of one of two kinds, else NULL and a report. */
static struct inform_block *innermost(struct inform_reading *in, int32_t kind, int32_t other)
{
    struct inform_block *b = in->blocks > 0 ? &in->block[in->blocks - 1] : NULL;
    if (b && ((int32_t)b->kind == kind || (int32_t)b->kind == other)) {
        return b;
    }
    in->s.r->other = b ? b->line : 0;
    inform_scan_fault_line(&in->s, INFORM_BAD_NOT_OPEN);
    return NULL;
}

int32_t inform_block_loop_inside(const struct inform_reading *in)
{
    for (int32_t i = in->blocks; i > 0; i--) {
        if (in->block[i - 1].kind == INFORM_BLOCK_LOOP) {
            return in->block[i - 1].code;
        }
    }
    return -1;
}

/* An instruction that does not go on unless its condition holds. */
static int add_unless(struct inform_reading *in)
{
    struct inform_code *c = inform_reading_add(in, INFORM_OP_UNLESS);
    return c ? inform_operand_condition(in, c) : -1;
}

int inform_block_if(struct inform_reading *in)
{
    return add_unless(in) ? -1 : open_block(in, INFORM_BLOCK_IF);
}

int inform_block_while(struct inform_reading *in)
{
    return add_unless(in) ? -1 : open_block(in, INFORM_BLOCK_WHILE);
}

int inform_block_else(struct inform_reading *in, bool condition)
{
    struct inform_block *b = innermost(in, INFORM_BLOCK_IF, INFORM_BLOCK_ELSE);
    if (!b) {
        return -1;
    }
    if (b->kind == INFORM_BLOCK_ELSE) {
        in->s.r->other = b->else_line;
        return inform_scan_fault_line(&in->s, INFORM_BAD_AFTER_ELSE);
    }
    struct inform_code *out = inform_reading_add(in, INFORM_OP_JUMP);
    if (!out) {
        return -1;
    }
    out->to = b->out; /* where it goes to is known at ENDIF */
    b->out = in->p->count - 1;
    in->p->code[b->code].to = in->p->count;
    if (!condition) {
        b->kind = INFORM_BLOCK_ELSE;
        b->else_line = in->s.line;
        return 0;
    }
    b->code = in->p->count;
    return add_unless(in);
}

int inform_block_endif(struct inform_reading *in)
{
    struct inform_block *b = innermost(in, INFORM_BLOCK_IF, INFORM_BLOCK_ELSE);
    if (!b) {
        return -1;
    }
    if (b->kind == INFORM_BLOCK_IF) {
        in->p->code[b->code].to = in->p->count;
    }
    for (int32_t i = b->out; i >= 0;) {
        const int32_t before = in->p->code[i].to;
        in->p->code[i].to = in->p->count;
        i = before;
    }
    in->blocks--;
    return 0;
}

int inform_block_endwhile(struct inform_reading *in)
{
    struct inform_block *b = innermost(in, INFORM_BLOCK_WHILE, INFORM_BLOCK_WHILE);
    struct inform_code *c = b ? inform_reading_add(in, INFORM_OP_JUMP) : NULL;
    if (!c) {
        return -1;
    }
    c->to = b->code;
    in->p->code[b->code].to = in->p->count;
    in->blocks--;
    return 0;
}

int inform_block_loop(struct inform_reading *in)
{
    enum { COUNTS = 1u << INFORM_CONSTANT | 1u << INFORM_B | 1u << INFORM_I | 1u << INFORM_D };
    struct inform_scan *s = &in->s;
    struct inform_code *c = inform_reading_add(in, INFORM_OP_LOOP);
    if (!c) {
        return -1;
    }
    for (int32_t i = 0; i < in->blocks; i++) {
        c->via += in->block[i].kind == INFORM_BLOCK_LOOP;
    }
    if (c->via == INFORM_LOOPS) {
        s->r->high = INFORM_LOOPS;
        return inform_scan_fault_line(s, INFORM_BAD_TOO_MANY);
    }
    if (!inform_scan_over(s)) {
        const int32_t at = s->at;
        int32_t count;
        if (inform_operand(in, COUNTS, &c->right)) {
            return -1;
        }
        if (c->right.kind == INFORM_CONSTANT) {
            s->at = at;
            if (inform_scan_whole(s, 0, INT32_MAX, &count)) {
                return -1;
            }
        }
    }
    return open_block(in, INFORM_BLOCK_LOOP);
}

int inform_block_endloop(struct inform_reading *in)
{
    struct inform_block *b = innermost(in, INFORM_BLOCK_LOOP, INFORM_BLOCK_LOOP);
    struct inform_code *c = b ? inform_reading_add(in, INFORM_OP_ENDLOOP) : NULL;
    if (!c) {
        return -1;
    }
    c->to = b->code + 1;
    c->via = in->p->code[b->code].via;
    in->p->code[b->code].to = in->p->count;
    in->blocks--;
    return 0;
}

int inform_block_all_closed(struct inform_reading *in)
{
    if (in->blocks == 0) {
        return 0;
    }
    const struct inform_block *b = &in->block[in->blocks - 1];
    in->s.r->other = in->s.line;
    in->s.line = b->line;
    return inform_scan_fault(&in->s, INFORM_BAD_OPEN, b->begin);
}
