#include "switching.h"

#include <math.h>
#include <stddef.h>

#include "block.h"
#include "queue.h"

/* The outputs as they are to be from here on, and digital ones that change. */
static void make(struct interpreter *in, uint32_t set, uint32_t clear)
{
    struct command *c = block_command(in);
    c->type = COMMAND_OUTPUTS;
    c->spindle = in->switches.turning * in->switches.speed;
    c->coolant = in->switches.coolant;
    c->set = set;
    c->clear = clear;
    in->count++;
}

/* M62 .. M65; bits of M64 and M65 go to *set and *clear, those of M62 and M63 wait in the state. */
static enum fault digital(struct interpreter *in, const struct block *b, uint32_t *set,
                          uint32_t *clear, struct fault_report *r)
{
    const int code = b->g.code[GCODE_IO];
    const struct token *p = gcode_word(&b->g, 'P');

    if (code == GCODE_ABSENT) {
        return FAULT_NONE;
    }
    if (!p) {
        return tokens_at_word(r, FAULT_NO_OUTPUT, b->g.by[GCODE_IO]);
    }
    if (p->value < 0.0 || p->value >= OUTPUTS_DIGITAL || p->value != round(p->value)) {
        return tokens_at_word(r, FAULT_VALUE, p);
    }
    const uint32_t bit = (uint32_t)1 << (int)p->value;
    const bool on = code == 620 || code == 640;
    if (code >= 640) {
        *set = on ? bit : 0;
        *clear = on ? 0 : bit;
    } else {
        in->set = on ? in->set | bit : in->set & ~bit;
        in->clear = on ? in->clear & ~bit : in->clear | bit;
    }
    return FAULT_NONE;
}

enum fault switching_block(struct interpreter *in, const struct block *b, struct fault_report *r)
{
    const struct switches before = in->switches;
    struct switches *s = &in->switches;
    const struct token *speed = gcode_word(&b->g, 'S');
    const int spindle = b->g.code[GCODE_SPINDLE], coolant = b->g.code[GCODE_COOLANT];
    uint32_t set = 0, clear = 0;

    if (speed && speed->value < 0.0) {
        return tokens_at_word(r, FAULT_VALUE, speed);
    }
    const enum fault f = digital(in, b, &set, &clear, r);
    if (f != FAULT_NONE) {
        return f;
    }
    if (speed) {
        s->speed = speed->value;
    }
    if (spindle != GCODE_ABSENT) {
        s->turning = spindle == 30 ? 1 : spindle == 40 ? -1 : 0;
    }
    if (coolant != GCODE_ABSENT) {
        s->coolant = coolant == 90 ? 0
                   : s->coolant | (coolant == 70 ? OUTPUTS_MIST : OUTPUTS_FLOOD);
    }
    if (set || clear || s->coolant != before.coolant ||
        s->turning * s->speed != before.turning * before.speed) {
        make(in, set, clear);
    }
    return FAULT_NONE;
}

void switching_end(struct interpreter *in)
{
    struct switches *s = &in->switches;
    const bool off = s->turning * s->speed == 0.0 && s->coolant == 0;

    s->turning = s->coolant = 0;
    if (!off) {
        make(in, 0, 0);
    }
}
