#include "probing.h"

#include "block.h"
#include "frame.h"
#include "waiting.h"

bool probing_asked(const struct block *b)
{
    return b->g.code[GCODE_MOTION] >= 382 && b->g.code[GCODE_MOTION] <= 385;
}

enum fault probing_block(struct interpreter *in, const struct program *p, const struct block *b,
                         struct fault_report *r)
{
    const int code = b->g.code[GCODE_MOTION];
    const struct token *word = b->g.by[GCODE_MOTION];
    const int32_t before = in->count;

    if (!p->has_probe) {
        return tokens_at_word(r, FAULT_NO_PROBE, word);
    }
    if (in->waits) {
        return tokens_at_words(r, FAULT_SHARED, b->g.by[GCODE_IO], word);
    }
    if (!gcode_first(&b->g, BLOCK_AXES)) {
        return tokens_at_line(r, FAULT_NO_AXES, &b->tokens);
    }
    const enum fault f = block_motion(in, p, b, r);
    if (f != FAULT_NONE) {
        return f;
    }
    in->motion = GCODE_NO_MOTION;
    if (in->count == before && (code == 383 || code == 385)) {
        frame_program(in, in->point, in->contact); /* no motion, no contact, and no error */
        in->touched = 0.0;
        return FAULT_NONE;
    }
    if (in->count == before) {
        return tokens_at_line(r, FAULT_PROBE_POINT, &b->tokens);
    }
    struct command *c = &in->made[in->count - 1];
    c->blend = false;
    c->tolerance = 0.0;
    c->probes = true;
    waiting_for(in, WAIT_FREE);
    in->wait.behind = before;
    in->wait.until = in->count;
    in->wait.mode = code < 384 ? WAIT_HIGH : WAIT_LOW;
    in->wait.must = code == 382 || code == 384;
    return FAULT_NONE;
}
