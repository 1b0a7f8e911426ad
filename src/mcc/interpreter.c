#include "interpreter.h"

#include <math.h>
#include <string.h>

#include "block.h"

static const double DWELL_MAX = 86400.0;    /* [s] a day */

void interpreter_start(struct interpreter *in, const double point[AXES], double feed)
{
    memset(in, 0, sizeof *in);
    in->motion = -1;
    in->plane = PATH_XY;
    in->feed = feed;
    memcpy(in->point, point, sizeof in->point);
}

static enum fault set_modes(struct interpreter *in, const struct program *p, struct block *b,
                            struct fault_report *r)
{
    const int *code = b->g.code;

    if (code[GCODE_UNITS] != GCODE_ABSENT) {
        in->inch = code[GCODE_UNITS] == 200;
    }
    b->scale = in->inch ? 25.4 : 1.0;
    if (code[GCODE_PLANE] != GCODE_ABSENT) {
        in->plane = code[GCODE_PLANE] == 170 ? PATH_XY
                  : code[GCODE_PLANE] == 180 ? PATH_ZX : PATH_YZ;
    }
    if (code[GCODE_SYSTEM] != GCODE_ABSENT) {
        in->system = (code[GCODE_SYSTEM] - 540) / 10;
    }
    if (code[GCODE_PATH] != GCODE_ABSENT) {
        in->blend = code[GCODE_PATH] == 640;
    }
    if (code[GCODE_DISTANCE] != GCODE_ABSENT) {
        in->incremental = code[GCODE_DISTANCE] == 910;
    }
    if (code[GCODE_CENTRE] != GCODE_ABSENT) {
        in->absolute_centre = code[GCODE_CENTRE] == 901;
    }
    if (code[GCODE_MOTION] != GCODE_ABSENT) {
        in->motion = code[GCODE_MOTION] == 800 ? -1 : code[GCODE_MOTION] / 10;
    }
    const struct token *f = gcode_word(&b->g, 'F');
    if (f) {
        const double feed = f->value * b->scale / 60.0;
        if (!(feed > 0.0)) {
            return tokens_at_word(r, FAULT_VALUE, f);
        }
        if (feed > p->machine->max_feed) {
            r->value = feed * 60.0;
            r->limit = p->machine->max_feed * 60.0;
            return tokens_at_word(r, FAULT_FEED, f);
        }
        in->feed = feed;
    }
    return FAULT_NONE;
}

/* Execute one block; *made tells whether it became a command. */
static enum fault execute(struct interpreter *in, const struct program *p, struct block *b,
                          struct command *c, bool *made, struct fault_report *r)
{
    enum fault f = gcode_sort(&b->g, &b->tokens, r);
    if (f == FAULT_NONE) {
        f = set_modes(in, p, b, r);
    }
    if (f != FAULT_NONE) {
        return f;
    }
    const struct token *axis = block_first(b, "XYZUVW"), *shape = block_first(b, "IJKRP");
    const int nonmodal = b->g.code[GCODE_NONMODAL], code = b->g.code[GCODE_MOTION];

    in->ended = b->g.end;
    if (nonmodal == 40) {
        const struct token *wait = gcode_word(&b->g, 'P');
        const struct token *extra = axis ? axis : block_first(b, "IJKR");
        if (extra) {
            return tokens_at_word(r, FAULT_UNUSED, extra);
        }
        if (!wait) {
            return tokens_at_line(r, FAULT_NO_DWELL, &b->tokens);
        }
        if (wait->value < 0.0 || wait->value > DWELL_MAX) {
            return tokens_at_word(r, FAULT_VALUE, wait);
        }
        command_delay(c, in->point, wait->value);
        c->line = in->line;
        *made = true;
        return FAULT_NONE;
    }
    if (nonmodal == 530 && !axis) {
        return tokens_at_line(r, FAULT_NO_AXES, &b->tokens);
    }
    if (nonmodal == 530 && in->motion != 0 && in->motion != 1) {
        return tokens_at_line(r, FAULT_G53, &b->tokens);
    }
    if (in->motion < 2 && shape) {
        return tokens_at_word(r, FAULT_UNUSED, shape);
    }
    if (in->motion < 0 && axis) {
        return tokens_at_word(r, FAULT_NO_MOTION, axis);
    }
    if (axis || shape || code == 20 || code == 30) {
        f = block_motion(in, p, b, c, r);
        *made = f == FAULT_NONE && c->path.length > 0.0;
    }
    return f;
}

enum interpreter_result interpreter_next(struct interpreter *in, const struct program *p,
                                         struct command *c, struct fault_report *r)
{
    struct block b;

    while (!in->ended && in->offset < (int64_t)p->length) {
        bool made = false;
        r->line = ++in->line;
        r->fault = tokens_read(&b.tokens, p->text, p->length, &in->offset, r);
        if (r->fault == FAULT_NONE && b.tokens.percent) {
            in->ended = in->percent;    /* the second % closes the program */
            in->percent = true;
        } else if (r->fault == FAULT_NONE) {
            memset(c, 0, sizeof *c);
            r->fault = execute(in, p, &b, c, &made, r);
        }
        if (r->fault != FAULT_NONE) {
            in->ended = true;
            return INTERPRETER_FAULT;
        }
        if (made) {
            return INTERPRETER_COMMAND;
        }
    }
    in->ended = true;
    return INTERPRETER_END;
}

void interpreter_check(const struct interpreter *from, const struct program *p,
                       struct fault_report *r)
{
    struct interpreter in = *from;
    struct command c;

    memset(r, 0, sizeof *r);
    while (interpreter_next(&in, p, &c, r) == INTERPRETER_COMMAND) {
    }
}
