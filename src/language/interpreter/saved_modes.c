#include "saved_modes.h"

#include <string.h>

#include "cutter.h"
#include "switching.h"

static struct saved_modes modes_now(const struct interpreter *in)
{
    const struct switches *s = &in->switches;
    struct saved_modes m = { .kept = true,
                             .plane = in->plane,
                             .inch = in->inch,
                             .incremental = in->incremental,
                             .absolute_centre = in->absolute_centre,
                             .blend = in->blend,
                             .tolerance = in->tolerance,
                             .merge = in->merge,
                             .system = in->system,
                             .feed = in->feed,
                             .feed_mode = in->words.feed_mode,
                             .per_turn = in->words.per_turn,
                             .to_r = in->cycle.to_r,
                             .side = in->cutter.side,
                             .speed = s->speed,
                             .by_radius = s->by_radius,
                             .pass = s->pass,
                             .most = s->most,
                             .turning = s->turning,
                             .coolant = s->coolant,
                             .overrides = s->overrides };
    memcpy(m.length, in->tools.length, sizeof m.length);
    return m;
}

/* Whether modes can be restored. While cutter compensation, G51 or G68 is in force, what a block
 * may not change then cannot be restored either. */
static bool possible(const struct interpreter *in, const struct saved_modes *m)
{
    const bool framed = in->words.scaled || in->words.rotated;
    const bool moved = m->system != in->system || m->plane != in->plane;
    const bool length = memcmp(m->length, in->tools.length, sizeof m->length) != 0;

    return m->side == in->cutter.side && !(framed && moved)
           && !(cutter_on(in) && (moved || length));
}

static enum fault restore(struct interpreter *in, const struct saved_modes *m,
                          struct fault_report *r)
{
    struct switches *s = &in->switches, before = in->switches;

    if (!possible(in, m)) {
        return fault_at(r, FAULT_RESTORE, r->at, r->length);
    }
    in->plane = m->plane;
    in->inch = m->inch;
    in->incremental = m->incremental;
    in->absolute_centre = m->absolute_centre;
    in->blend = m->blend;
    in->tolerance = m->tolerance;
    in->merge = m->merge;
    in->system = m->system;
    in->feed = m->feed;
    in->words.feed_mode = m->feed_mode;
    in->words.per_turn = m->per_turn;
    in->cycle.to_r = m->to_r;
    memcpy(in->tools.length, m->length, sizeof m->length);
    s->speed = m->speed;
    s->by_radius = m->by_radius;
    s->pass = m->pass;
    s->most = m->most;
    s->turning = m->turning;
    s->coolant = m->coolant;
    s->overrides = m->overrides;
    switching_differs(in, &before);
    return FAULT_NONE;
}

enum fault saved_modes_block(struct interpreter *in, const struct block *b, struct fault_report *r)
{
    struct saved_modes *m = &in->saved[in->flow.level];
    const int code = b->g.code[GCODE_SAVING];

    if (code == GCODE_ABSENT) {
        return FAULT_NONE;
    }
    tokens_at_word(r, FAULT_NO_MODES, b->g.by[GCODE_SAVING]);
    if (code == 720) {
        return m->kept ? restore(in, m, r) : FAULT_NO_MODES;
    }
    if (code == 710) {
        m->kept = m->returns = false;
    } else {
        *m = modes_now(in);
        m->returns = code == 730 && in->flow.level > 0;
    }
    return FAULT_NONE;
}

enum fault saved_modes_return(struct interpreter *in, struct fault_report *r)
{
    const int32_t level = in->flow.left;

    in->flow.left = 0;
    return level > 0 ? restore(in, &in->saved[level], r) : FAULT_NONE;
}
