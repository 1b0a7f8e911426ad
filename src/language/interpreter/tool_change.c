#include "tool_change.h"

#include "block.h"
#include "switching.h"
#include "tools.h"

/* The word's tool is the next one. */
static enum fault choose(struct interpreter *in, const struct token *t, struct fault_report *r)
{
    struct tool tool;
    int32_t number = 0;
    const enum fault f = tools_number(t, &number, r);

    if (f != FAULT_NONE) {
        return f;
    }
    if (!tool_table_find(&in->tools.table, number, &tool)) {
        return tokens_at_word(r, FAULT_TOOL, t);
    }
    in->tools.chosen = true;
    in->tools.next = number;
    return FAULT_NONE;
}

/* M6: the next tool comes into the spindle, which is off. */
static void load(struct interpreter *in, const struct program *p)
{
    const bool turns = switches_spindle(&in->switches) != 0.0;

    in->tools.chosen = false;
    in->switches.turning = 0;
    if (!p->change_stops) {
        in->tools.loaded = in->tools.next;
    }
    if (turns || !p->change_stops) {
        switching_make(in, 0, 0);
    }
    if (p->change_stops) {
        struct command *c = block_command(in);
        c->type = COMMAND_STOP;
        c->changes = true;
        c->tool = in->tools.loaded = in->tools.next;
        in->count++;
    }
}

/* M61 Q: the tool is in the spindle already. */
static enum fault declare(struct interpreter *in, const struct block *b, struct fault_report *r)
{
    const struct token *q = gcode_word(&b->g, 'Q');

    if (!q) {
        return tokens_at_word(r, FAULT_MISSING, b->g.by[GCODE_CHANGE]);
    }
    const bool chosen = in->tools.chosen;
    const int32_t next = in->tools.next;
    const enum fault f = choose(in, q, r);
    if (f == FAULT_NONE) {
        in->tools.loaded = in->tools.next;
        in->tools.chosen = chosen;
        in->tools.next = next;
        switching_make(in, 0, 0);
    }
    return f;
}

enum fault tool_change(struct interpreter *in, const struct program *p, const struct block *b,
                       struct fault_report *r)
{
    const struct token *t = gcode_word(&b->g, 'T');
    const enum fault f = t ? choose(in, t, r) : FAULT_NONE;

    if (f != FAULT_NONE || b->g.code[GCODE_CHANGE] == GCODE_ABSENT) {
        return f;
    }
    if (b->g.code[GCODE_CHANGE] == 610) {
        return declare(in, b, r);
    }
    if (!in->tools.chosen) {
        return tokens_at_word(r, FAULT_NO_TOOL, b->g.by[GCODE_CHANGE]);
    }
    load(in, p);
    return FAULT_NONE;
}
