#include "offsets.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

double offsets_zero(const struct interpreter *in, int axis)
{
    return in->origin[in->system][axis] + in->local[axis] + (in->shifted ? in->shift[axis] : 0.0);
}

bool offsets_changed(const struct block *b)
{
    const int code = b->g.code[GCODE_NONMODAL];
    return code == 100 || code == 520 || (code >= 920 && code <= 923);
}

/* The system G10 speaks of, 0..5, into *system; P0 is the one in force. */
static enum fault system_of(const struct interpreter *in, const struct block *b, int *system,
                            struct fault_report *r)
{
    const struct token *l = gcode_word(&b->g, 'L'), *p = gcode_word(&b->g, 'P');

    if (!l || !p) {
        return tokens_at_line(r, FAULT_NO_SYSTEM, &b->tokens);
    }
    if (l->value != 2.0) {
        return tokens_at_word(r, FAULT_VALUE, l);
    }
    if (p->value < 0.0 || p->value > INTERPRETER_SYSTEMS || p->value != round(p->value)) {
        return tokens_at_word(r, FAULT_VALUE, p);
    }
    *system = p->value > 0.0 ? (int)p->value - 1 : in->system;
    return FAULT_NONE;
}

/* G10, G52 and G92 set the axes they name. */
static enum fault set_axes(struct interpreter *in, const struct program *p, const struct block *b,
                           struct fault_report *r)
{
    const int code = b->g.code[GCODE_NONMODAL];
    int system = 0;

    if (!gcode_first(&b->g, BLOCK_AXES)) {
        return tokens_at_line(r, FAULT_NO_AXES, &b->tokens);
    }
    if (code == 100) {
        const enum fault f = system_of(in, b, &system, r);
        if (f != FAULT_NONE) {
            return f;
        }
    }
    for (int i = 0; i < AXES; i++) {
        const struct token *w = gcode_word(&b->g, BLOCK_AXES[i]);
        if (!w) {
            continue;
        }
        if (!p->machine.axis[i]) {
            return tokens_at_word(r, FAULT_AXIS, w);
        }
        const double value = gcode_value(b, i, w);
        if (code == 100) {
            in->origin[system][i] = value;
        } else if (code == 520) {
            in->local[i] = value;
        } else {
            in->shift[i] = in->point[i] - (in->origin[in->system][i] + in->local[i]) - value;
        }
    }
    return FAULT_NONE;
}

enum fault offsets_change(struct interpreter *in, const struct program *p, const struct block *b,
                          struct fault_report *r)
{
    const int code = b->g.code[GCODE_NONMODAL];

    if (code == 921 || (code == 920 && !in->shifted)) {
        memset(in->shift, 0, sizeof in->shift);
    }
    if (code >= 920) {
        in->shifted = code == 920 || code == 923;
        return code == 920 ? set_axes(in, p, b, r) : FAULT_NONE;
    }
    return set_axes(in, p, b, r);
}
