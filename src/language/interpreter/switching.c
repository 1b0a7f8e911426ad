#include "switching.h"

#include <math.h>
#include <stddef.h>

#include "block.h"
#include "frame.h"
#include "queue.h"

static const double METRE = 1000.0, FOOT = 304.8; /* [mm] S of G96 is in m or ft per minute */

/* What G96 asks for: its speed S, and the X of the program's zero in machine coordinates, from
 * which the radius is measured. */
static struct outputs_surface surface_of(const struct interpreter *in)
{
    static const double ZERO[AXES];
    const struct switches *s = &in->switches;
    double centre[AXES];

    if (!s->by_radius || switches_spindle(s) == 0.0) {
        return (struct outputs_surface){ 0.0, 0.0 };
    }
    frame_machine(in, ZERO, centre);
    return (struct outputs_surface){ s->pass, centre[0] };
}

void switching_make(struct interpreter *in, uint32_t set, uint32_t clear)
{
    struct command *c = block_command(in);
    c->type = COMMAND_OUTPUTS;
    c->spindle = switches_spindle(&in->switches);
    c->surface = in->switches.told = surface_of(in);
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

/* Number of an output that a word has, 0 .. count - 1; -1: it is none. */
static int output_of(const struct token *w, int count)
{
    return w->value >= 0.0 && w->value < count && w->value == round(w->value) ? (int)w->value : -1;
}

/* Execute M62 .. M65: bits of M64 and M65 go to *now, those of M62 and M63 wait in *in. */
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

/* Execute M67, whose value waits in *in, or M68, whose value goes to *now. */
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
           : code >= 670                       ? analog(in, b, now, r)
                                               : digital(in, b, now, r);
}

/* Execute M48 .. M53; M50 to M53 with P0 do the opposite. */
static enum fault overrides(struct interpreter *in, const struct block *b, struct fault_report *r)
{
    static const struct {
        int code;
        uint32_t on, off;
    } rows[] = {
        { 480, 0, OUTPUTS_FEED_FIXED | OUTPUTS_SPEED_FIXED },
        { 490, OUTPUTS_FEED_FIXED | OUTPUTS_SPEED_FIXED, 0 },
        { 500, 0, OUTPUTS_FEED_FIXED },
        { 510, 0, OUTPUTS_SPEED_FIXED },
        { 520, OUTPUTS_ADAPTIVE, 0 },
        { 530, 0, OUTPUTS_HOLD_OFF },
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
            tokens_note(r, FAULT_NOTE_SPEED, b->g.by[GCODE_OVERRIDE]);
        }
        const bool undo = takes && p && p->value == 0.0;
        const uint32_t on = undo ? rows[i].off : rows[i].on;
        const uint32_t off = undo ? rows[i].on : rows[i].off;
        in->switches.overrides = (in->switches.overrides | on) & ~off;
    }
    return FAULT_NONE;
}

/* Execute M3 .. M5, M19. M19 only stops the spindle, for its angle is no output; R [deg], P (0: the
 * shorter way, 1: clockwise, 2: counter-clockwise) and Q [s] are checked. */
static enum fault spindle(struct interpreter *in, const struct program *p, const struct block *b,
                          struct fault_report *r)
{
    static const struct {
        char letter;
        double most;
    } rows[] = { { 'R', 360.0 }, { 'P', 2.0 }, { 'Q', 86400.0 } };
    const int code = b->g.code[GCODE_SPINDLE];

    for (size_t i = 0; code == 190 && i < sizeof rows / sizeof *rows; i++) {
        const struct token *w = gcode_word(&b->g, rows[i].letter);
        if (w && !(w->value >= 0.0 && w->value <= rows[i].most)) {
            return tokens_at_word(r, FAULT_VALUE, w);
        }
    }
    if (code == 190 && !p->bare) {
        tokens_note(r, FAULT_NOTE_ORIENT, b->g.by[GCODE_SPINDLE]);
    }
    if (code != GCODE_ABSENT) {
        in->switches.turning = code == 30 ? 1 : code == 40 ? -1 : 0;
    }
    return FAULT_NONE;
}

/* Execute S, G96 with its D, G97. */
static enum fault speed(struct interpreter *in, const struct block *b, struct fault_report *r)
{
    const struct token *s = gcode_word(&b->g, 'S'), *d = gcode_word(&b->g, 'D');
    const int code = b->g.code[GCODE_SURFACE];
    struct switches *now = &in->switches;

    if (code == 960 && (!s || !d)) {
        return tokens_at_word(r, FAULT_MISSING, b->g.by[GCODE_SURFACE]);
    }
    if (s && s->value < 0.0) {
        return tokens_at_word(r, FAULT_VALUE, s);
    }
    if (code == 960 && !(d->value > 0.0)) {
        return tokens_at_word(r, FAULT_VALUE, d);
    }
    if (code != GCODE_ABSENT) {
        now->by_radius = code == 960;
        now->most = code == 960 ? d->value : now->most;
    }
    if (s && now->by_radius) {
        now->pass = s->value * (in->inch ? FOOT : METRE) / 60.0;
    } else if (s) {
        now->speed = s->value;
    }
    return FAULT_NONE;
}

/* Whether two states differ in coolant, overrides or the spindle's speed. */
static bool differ(const struct switches *a, const struct switches *b)
{
    return a->coolant != b->coolant || a->overrides != b->overrides
           || switches_spindle(a) != switches_spindle(b);
}

/* Likewise for the state now; or the surface speed is not that which the machine has. */
static bool differs(const struct interpreter *in, const struct switches *before)
{
    const struct outputs_surface pass = surface_of(in), told = in->switches.told;
    return differ(&in->switches, before) || pass.speed != told.speed || pass.centre != told.centre;
}

void switching_differs(struct interpreter *in, const struct switches *before)
{
    if (differs(in, before)) {
        switching_make(in, 0, 0);
    }
}

/* Add a note for each word that does nothing on a machine without spindle and coolant (p->bare). */
static void tell(const struct block *b, struct fault_report *r)
{
    const struct gcode *g = &b->g;
    const struct token *speed = g->by[GCODE_SPINDLE]   ? g->by[GCODE_SPINDLE]
                                : g->by[GCODE_SURFACE] ? g->by[GCODE_SURFACE]
                                                       : gcode_word(g, 'S');
    const struct {
        enum fault what;
        const struct token *word;
    } rows[] = {
        { FAULT_NOTE_SPINDLE, speed },
        { FAULT_NOTE_COOLANT, g->by[GCODE_COOLANT] },
        { FAULT_NOTE_OVERRIDE, g->by[GCODE_OVERRIDE] },
        { FAULT_NOTE_MERGE, g->code[GCODE_PATH] == 640 ? gcode_word(g, 'Q') : NULL },
    };

    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (rows[i].word) {
            tokens_note(r, rows[i].what, rows[i].word);
        }
    }
}

enum fault switching_block(struct interpreter *in, const struct program *p, const struct block *b,
                           struct fault_report *r)
{
    const struct switches before = in->switches;
    const int coolant = b->g.code[GCODE_COOLANT];
    struct switches *s = &in->switches;
    struct at_once now = { 0 };

    if (p->bare) {
        tell(b, r);
    }
    enum fault f = speed(in, b, r);
    f = f == FAULT_NONE ? outputs(in, b, &now, r) : f;
    f = f == FAULT_NONE ? spindle(in, p, b, r) : f;
    f = f == FAULT_NONE ? overrides(in, b, r) : f;
    if (f != FAULT_NONE) {
        return f;
    }
    if (coolant != GCODE_ABSENT) {
        s->coolant =
            coolant == 90 ? 0 : s->coolant | (coolant == 70 ? OUTPUTS_MIST : OUTPUTS_FLOOD);
    }
    if (now.set || now.clear || now.analog.set || differs(in, &before)) {
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
    s->by_radius = false;
    if (differ(s, &before)) {
        switching_make(in, 0, 0);
    }
}
