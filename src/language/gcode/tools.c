#include "tools.h"

#include <math.h>
#include <string.h>

#include "frame.h"
#include "offsets.h"

enum fault tools_number(const struct token *w, int32_t *number, struct fault_report *r)
{
    if (!(w->value >= 0.0 && w->value <= TOOL_NUMBER_MAX) || w->value != round(w->value)) {
        return tokens_at_word(r, FAULT_VALUE, w);
    }
    *number = (int32_t)w->value;
    return FAULT_NONE;
}

/* The tool whose number a word has; 0: the one in the spindle. */
static enum fault tool_of(const struct interpreter *in, const struct token *w, struct tool *tool,
                          struct fault_report *r)
{
    int32_t number = 0;
    const enum fault f = tools_number(w, &number, r);

    if (f == FAULT_NONE
        && !tool_table_find(&in->tools.table, number ? number : in->tools.loaded, tool)) {
        return tokens_at_word(r, FAULT_TOOL, w);
    }
    return f;
}

/* G43.1 and G43.2 with axis words: these replace the offset in force, or are added to it. */
static enum fault by_axes(struct interpreter *in, const struct program *p, const struct block *b,
                          bool add, struct fault_report *r)
{
    for (int i = 0; i < AXES; i++) {
        const struct token *w = gcode_word(&b->g, BLOCK_AXES[i]);
        if (w && !p->machine.axis[i]) {
            return tokens_at_word(r, FAULT_AXIS, w);
        }
        if (w) {
            in->tools.length[i] = gcode_value(b, i, w) + (add ? in->tools.length[i] : 0.0);
        }
    }
    return FAULT_NONE;
}

/* G43 and G43.2 H: the offset of a tool replaces the one in force, or is added to it. */
static enum fault by_tool(struct interpreter *in, const struct program *p, const struct block *b,
                          bool add, struct fault_report *r)
{
    const struct token *h = gcode_word(&b->g, 'H');
    struct tool tool;

    if (!h) {
        tool_table_find(&in->tools.table, in->tools.loaded, &tool);
    } else {
        const enum fault f = tool_of(in, h, &tool, r);
        if (f != FAULT_NONE) {
            return f;
        }
    }
    for (int i = 0; i < AXES; i++) {
        const double offset = p->machine.axis[i] ? tool.offset[i] : 0.0;
        in->tools.length[i] = offset + (add ? in->tools.length[i] : 0.0);
    }
    return FAULT_NONE;
}

enum fault tools_lengths(struct interpreter *in, const struct program *p, const struct block *b,
                         struct fault_report *r)
{
    const int code = b->g.code[GCODE_TOOL], motion = b->g.code[GCODE_MOTION];
    const struct token *axis = gcode_first(&b->g, BLOCK_AXES), *h = gcode_word(&b->g, 'H');

    if (code == 490) {
        memset(in->tools.length, 0, sizeof in->tools.length);
    }
    if (code == 430) {
        return by_tool(in, p, b, false, r);
    }
    if (code != 431 && code != 432) {
        return FAULT_NONE;
    }
    if (motion != GCODE_ABSENT && motion != 800) {
        return tokens_at_words(r, FAULT_SHARED, b->g.by[GCODE_MOTION], b->g.by[GCODE_TOOL]);
    }
    if (!axis && !(h && code == 432)) {
        return tokens_at_word(r, FAULT_MISSING, b->g.by[GCODE_TOOL]);
    }
    if (axis && h) {
        return tokens_at_words(r, FAULT_SHARED, h, axis);
    }
    return h ? by_tool(in, p, b, true, r) : by_axes(in, p, b, code == 432, r);
}

double tools_length(const struct interpreter *in, int axis)
{
    return in->tools.length[axis];
}

bool tools_any_length(const struct interpreter *in)
{
    bool any = false;

    for (int i = 0; i < AXES; i++) {
        any = any || in->tools.length[i] != 0.0;
    }
    return any;
}

bool tools_diameter(const struct interpreter *in, int32_t number, double *diameter)
{
    struct tool tool;

    if (!tool_table_find(&in->tools.table, number ? number : in->tools.loaded, &tool)) {
        return false;
    }
    *diameter = tool.diameter;
    return true;
}

bool tools_parameter(const struct interpreter *in, bool angles, int number, double *value)
{
    const bool length = number >= 5081 && number <= 5089;
    struct tool tool;

    if (!length && (number < 5400 || number > 5413)) {
        return false;
    }
    const int axis = offsets_axis(angles, number - (length ? 5081 : 5401));
    tool_table_find(&in->tools.table, in->tools.loaded, &tool);
    *value = number == 5400              ? tool.number
             : number == 5410            ? tool.diameter
             : number > 5410 || axis < 0 ? 0.0
             : length                    ? in->tools.length[axis]
                                         : tool.offset[axis];
    return true;
}

/* L of G10; 0: the block has none. */
static double level(const struct block *b)
{
    const struct token *l = gcode_word(&b->g, 'L');
    return b->g.code[GCODE_NONMODAL] == 100 && l ? l->value : 0.0;
}

bool tools_measured(const struct block *b)
{
    return level(b) == 1.0 || level(b) == 10.0 || level(b) == 11.0;
}

/* Offset of a tool along an axis [mm], [deg] from the coordinates `wanted` of G10. L1: it is these.
 * L10: with it the place where the axes stand has these program coordinates; L11: likewise, by the
 * origin of G59.3 alone. */
static double measured(const struct interpreter *in, double l, int axis, const double here[AXES],
                       const double wanted[AXES])
{
    double machine[AXES];

    if (l == 1.0) {
        return wanted[axis];
    }
    if (l == 11.0) {
        return here[axis] - in->origin[INTERPRETER_SYSTEMS - 1][axis] - wanted[axis];
    }
    frame_machine(in, wanted, machine);
    return here[axis] - machine[axis] + tools_length(in, axis);
}

enum fault tools_measure(struct interpreter *in, const struct program *p, const struct block *b,
                         struct fault_report *r)
{
    const struct token *w = gcode_word(&b->g, 'P'), *radius = gcode_word(&b->g, 'R');
    int32_t number = 0;

    if (!w || !(radius || gcode_first(&b->g, BLOCK_AXES))) {
        return tokens_at_word(r, FAULT_MISSING, b->g.by[GCODE_NONMODAL]);
    }
    const enum fault f = tools_number(w, &number, r);
    if (f != FAULT_NONE) {
        return f;
    }
    struct tool *entry = number ? tool_table_entry(&in->tools.table, number) : NULL;
    if (!entry) {
        return tokens_at_word(r, FAULT_TOOL, w);
    }
    double here[AXES], wanted[AXES];
    frame_here(in, here);
    frame_program(in, here, wanted);
    for (int i = 0; i < AXES; i++) {
        const struct token *x = gcode_word(&b->g, BLOCK_AXES[i]);
        if (x && !p->machine.axis[i]) {
            return tokens_at_word(r, FAULT_AXIS, x);
        }
        wanted[i] = x ? gcode_value(b, i, x) : wanted[i];
    }
    for (int i = 0; i < AXES; i++) {
        if (gcode_word(&b->g, BLOCK_AXES[i])) {
            entry->offset[i] = measured(in, level(b), i, here, wanted);
        }
    }
    entry->diameter = radius ? 2.0 * radius->value * b->scale : entry->diameter;
    return FAULT_NONE;
}
