#include "switching.h"

#include <math.h>
#include <stddef.h>

#include "block.h"
#include "queue.h"

void switching_make(struct interpreter *in, uint32_t set, uint32_t clear)
{
    struct command *c = block_command(in);
    c->type = COMMAND_OUTPUTS;
    c->spindle = in->switches.turning * in->switches.speed;
    c->coolant = in->switches.coolant;
    c->overrides = in->switches.overrides;
    c->tool = in->tools.loaded;
    c->set = set;
    c->clear = clear;
    in->count++;
}

/* What a block switches at once: M64, M65, M68. */
struct at_once {
    uint32_t set, clear;
    struct outputs_analog analog;
};

/* Number of an output from a word, 0 .. count - 1; -1 if it is none. */
static int output_of(const struct token *w, int count)
{
    return w->value >= 0.0 && w->value < count && w->value == round(w->value) ? (int)w->value : -1;
}

/* M62 .. M65; bits of M64 and M65 go to *now, those of M62 and M63 wait in the state. */
static enum fault digital(struct interpreter *in, const struct block *b, struct at_once *now,
                          struct fault_report *r)
{
    const int code = b->g.code[GCODE_IO];
    const struct token *p = gcode_word(&b->g, 'P');

    if (!p) {
        return tokens_at_word(r, FAULT_NO_OUTPUT, b->g.by[GCODE_IO]);
    }
    const int output = output_of(p, OUTPUTS_DIGITAL);
    if (output < 0) {
        return tokens_at_word(r, FAULT_VALUE, p);
    }
    const uint32_t bit = (uint32_t)1 << output;
    const bool on = code == 620 || code == 640;
    if (code >= 640) {
        now->set = on ? bit : 0;
        now->clear = on ? 0 : bit;
    } else {
        in->set = on ? in->set | bit : in->set & ~bit;
        in->clear = on ? in->clear & ~bit : in->clear | bit;
    }
    return FAULT_NONE;
}

/* M67, which waits in the state, and M68, to *now. */
static enum fault analog(struct interpreter *in, const struct block *b, struct at_once *now,
                         struct fault_report *r)
{
    const struct token *e = gcode_word(&b->g, 'E'), *q = gcode_word(&b->g, 'Q');

    if (!e || !q) {
        return tokens_at_word(r, FAULT_MISSING, b->g.by[GCODE_IO]);
    }
    const int output = output_of(e, OUTPUTS_ANALOG);
    if (output < 0) {
        return tokens_at_word(r, FAULT_VALUE, e);
    }
    struct outputs_analog *a = b->g.code[GCODE_IO] == 670 ? &in->analog : &now->analog;
    a->set |= (uint32_t)1 << output;
    a->value[output] = q->value;
    return FAULT_NONE;
}

static enum fault outputs(struct interpreter *in, const struct block *b, struct at_once *now,
                          struct fault_report *r)
{
    const int code = b->g.code[GCODE_IO];

    return code == GCODE_ABSENT || code == 660 ? FAULT_NONE
         : code >= 670 ? analog(in, b, now, r) : digital(in, b, now, r);
}

static void note(struct fault_report *r, enum fault what, const struct token *w)
{
    r->note = what;
    r->note_line = r->line;
    r->note_offset = r->offset;
    r->note_at = w->at;
    r->note_length = w->length;
}

/* M48 .. M53; P0 undoes what the code alone does. */
static enum fault overrides(struct interpreter *in, const struct block *b, struct fault_report *r)
{
    static const struct { int code; uint32_t on, off; } rows[] = {
        { 480, 0, OUTPUTS_FEED_FIXED | OUTPUTS_SPEED_FIXED },
        { 490, OUTPUTS_FEED_FIXED | OUTPUTS_SPEED_FIXED, 0 },
        { 500, 0, OUTPUTS_FEED_FIXED }, { 510, 0, OUTPUTS_SPEED_FIXED },
        { 520, OUTPUTS_ADAPTIVE, 0 },   { 530, 0, OUTPUTS_HOLD_OFF },
    };
    const struct token *p = gcode_word(&b->g, 'P');
    const bool any = b->g.code[GCODE_OVERRIDE] != GCODE_ABSENT;

    for (size_t i = 0; any && i < sizeof rows / sizeof *rows; i++) {
        if (b->g.code[GCODE_OVERRIDE] != rows[i].code) {
            continue;
        }
        const bool takes = rows[i].code >= 500;
        if (takes && p && p->value != 0.0 && p->value != 1.0) {
            return tokens_at_word(r, FAULT_VALUE, p);
        }
        if (rows[i].code == 510) {
            note(r, FAULT_NOTE_SPEED, b->g.by[GCODE_OVERRIDE]);
        }
        const bool undo = takes && p && p->value == 0.0;
        const uint32_t on = undo ? rows[i].off : rows[i].on;
        const uint32_t off = undo ? rows[i].on : rows[i].off;
        in->switches.overrides = (in->switches.overrides | on) & ~off;
    }
    return FAULT_NONE;
}

/* M3 .. M5; M19 turns the spindle to R degrees, P 0 on the shorter way, 1 clockwise, 2
 * counter-clockwise, within Q seconds: it stops, turning to a place is beyond the outputs. */
static enum fault spindle(struct interpreter *in, const struct block *b, struct fault_report *r)
{
    static const struct { char letter; double most; } rows[] = {
        { 'R', 360.0 }, { 'P', 2.0 }, { 'Q', 86400.0 }
    };
    const int code = b->g.code[GCODE_SPINDLE];

    for (size_t i = 0; code == 190 && i < sizeof rows / sizeof *rows; i++) {
        const struct token *w = gcode_word(&b->g, rows[i].letter);
        if (w && !(w->value >= 0.0 && w->value <= rows[i].most)) {
            return tokens_at_word(r, FAULT_VALUE, w);
        }
    }
    if (code == 190) {
        note(r, FAULT_NOTE_ORIENT, b->g.by[GCODE_SPINDLE]);
    }
    if (code != GCODE_ABSENT) {
        in->switches.turning = code == 30 ? 1 : code == 40 ? -1 : 0;
    }
    return FAULT_NONE;
}

/* Whether two states of what is switched differ for the machine. */
static bool differ(const struct switches *a, const struct switches *b)
{
    return a->coolant != b->coolant || a->overrides != b->overrides ||
           a->turning * a->speed != b->turning * b->speed;
}

enum fault switching_block(struct interpreter *in, const struct block *b, struct fault_report *r)
{
    const struct switches before = in->switches;
    const struct token *speed = gcode_word(&b->g, 'S');
    const int coolant = b->g.code[GCODE_COOLANT];
    struct switches *s = &in->switches;
    struct at_once now = { 0 };

    if (speed && speed->value < 0.0) {
        return tokens_at_word(r, FAULT_VALUE, speed);
    }
    enum fault f = outputs(in, b, &now, r);
    f = f == FAULT_NONE ? spindle(in, b, r) : f;
    f = f == FAULT_NONE ? overrides(in, b, r) : f;
    if (f != FAULT_NONE) {
        return f;
    }
    if (speed) {
        s->speed = speed->value;
    }
    if (coolant != GCODE_ABSENT) {
        s->coolant = coolant == 90 ? 0
                   : s->coolant | (coolant == 70 ? OUTPUTS_MIST : OUTPUTS_FLOOD);
    }
    if (now.set || now.clear || now.analog.set || differ(s, &before)) {
        switching_make(in, now.set, now.clear);
        in->made[in->count - 1].analog = now.analog;
    }
    return FAULT_NONE;
}

void switching_end(struct interpreter *in)
{
    struct switches *s = &in->switches;
    const struct switches before = *s;

    s->turning = s->coolant = 0;
    s->overrides = 0;
    if (differ(s, &before)) {
        switching_make(in, 0, 0);
    }
}
