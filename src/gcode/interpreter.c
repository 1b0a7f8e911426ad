#include "interpreter.h"

#include <string.h>

#include "block.h"
#include "offsets.h"
#include "switching.h"

/* So that a path of any length has an end. [mm/s] */
static const double FEED_MIN = 1e-9;

void interpreter_start(struct interpreter *in, const double point[AXES], double feed,
                       const double origin[INTERPRETER_SYSTEMS][AXES])
{
    memset(in, 0, sizeof *in);
    in->motion = -1;
    in->plane = PATH_XY;
    in->feed = feed;
    memcpy(in->point, point, sizeof in->point);
    memcpy(in->origin, origin, sizeof in->origin);
}

static void set_modes(struct interpreter *in, struct block *b)
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
        const struct token *p = gcode_word(&b->g, 'P');
        in->blend = code[GCODE_PATH] == 640;
        in->tolerance = in->blend && p ? p->value * b->scale : 0.0;
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
}

static enum fault set_feed(struct interpreter *in, const struct program *p, const struct block *b,
                           struct fault_report *r)
{
    const struct token *f = gcode_word(&b->g, 'F');

    if (!f) {
        return FAULT_NONE;
    }
    const double feed = f->value * b->scale / 60.0;
    if (feed < FEED_MIN) {
        return tokens_at_word(r, FAULT_VALUE, f);
    }
    if (feed > p->limits.feed) {
        r->value = feed * 60.0;
        r->limit = p->limits.feed * 60.0;
        return tokens_at_word(r, FAULT_FEED, f);
    }
    in->feed = feed;
    return FAULT_NONE;
}

/* Each word serves one code: axis words a motion or a code beside the groups, P one of several. */
static enum fault check_shares(const struct interpreter *in, const struct block *b,
                               struct fault_report *r)
{
    const int nonmodal = b->g.code[GCODE_NONMODAL], motion = b->g.code[GCODE_MOTION];
    const struct token *one = b->g.by[GCODE_NONMODAL], *io = b->g.by[GCODE_IO];
    const struct token *p = gcode_word(&b->g, 'P'), *l = gcode_word(&b->g, 'L');
    const struct token *path = b->g.code[GCODE_PATH] == 640 && p ? b->g.by[GCODE_PATH] : NULL;
    const bool arc = in->motion >= 2 && gcode_first(&b->g, BLOCK_AXES "IJKR");
    const bool axes = nonmodal == 100 || nonmodal == 280 || nonmodal == 520 || nonmodal == 920;

    if (axes && motion != GCODE_ABSENT && motion != 800) {
        return tokens_at_words(r, FAULT_SHARED, b->g.by[GCODE_MOTION], one);
    }
    if (io && (nonmodal == 40 || nonmodal == 100)) {
        return tokens_at_words(r, FAULT_SHARED, io, one);
    }
    if (io && p && !axes && arc) {
        return tokens_at_words(r, FAULT_SHARED, p, io);
    }
    if (path && (io || nonmodal == 40 || nonmodal == 100 || (arc && !axes))) {
        return tokens_at_words(r, FAULT_SHARED, path, io ? io : arc && !axes ? p : one);
    }
    if (path && p->value < 0.0) {
        return tokens_at_word(r, FAULT_VALUE, p);
    }
    if (l && nonmodal != 100) {
        return tokens_at_word(r, FAULT_UNUSED, l);
    }
    const struct token *extra = axes ? gcode_first(&b->g, "IJKR") : NULL;
    extra = !extra && axes && nonmodal != 100 && !io && !path ? p : extra;
    return extra ? tokens_at_word(r, FAULT_UNUSED, extra) : FAULT_NONE;
}

/* Motion of the block, if it has any. */
static enum fault move(struct interpreter *in, const struct program *p, const struct block *b,
                       struct fault_report *r)
{
    const struct token *axis = gcode_first(&b->g, BLOCK_AXES);
    const bool other = b->g.by[GCODE_IO] || b->g.code[GCODE_PATH] == 640;   /* whose P it is */
    const struct token *shape = gcode_first(&b->g, other ? "IJKR" : "IJKRP");
    const int code = b->g.code[GCODE_MOTION];
    const bool machine = b->g.code[GCODE_NONMODAL] == 530;

    if (machine && !axis) {
        return tokens_at_line(r, FAULT_NO_AXES, &b->tokens);
    }
    if (machine && in->motion != 0 && in->motion != 1) {
        return tokens_at_line(r, FAULT_G53, &b->tokens);
    }
    if (in->motion < 2 && shape) {
        return tokens_at_word(r, FAULT_UNUSED, shape);
    }
    if (in->motion < 0 && axis) {
        return tokens_at_word(r, FAULT_NO_MOTION, axis);
    }
    return axis || shape || code == 20 || code == 30 ? block_motion(in, p, b, r) : FAULT_NONE;
}

/* Dwell, offsets, home or motion, whichever the block asks for. */
static enum fault act(struct interpreter *in, const struct program *p, const struct block *b,
                      struct fault_report *r)
{
    const int nonmodal = b->g.code[GCODE_NONMODAL];
    enum fault f = FAULT_NONE;

    if (nonmodal == 40) {
        return block_dwell(in, b, r);
    }
    if (nonmodal == 280) {
        return block_home(in, p, b, r);
    }
    if (offsets_changed(b)) {
        f = offsets_change(in, p, b, r);
        if (f != FAULT_NONE || nonmodal <= 920) {   /* these have taken the axis words */
            return f;
        }
    }
    return move(in, p, b, r);
}

static void stop(struct interpreter *in, const struct program *p, const struct block *b)
{
    const int code = b->g.code[GCODE_STOP];

    if (code == 0 || (code == 10 && p->optional_stop)) {
        block_command(in)->type = COMMAND_STOP;
        in->count++;
    }
    if (code == 20 || code == 300) {
        in->ended = true;
        switching_end(in);
    }
}

/* Execute one block, in the order of RS-274: feed, outputs, spindle, coolant, dwell, modes,
 * offsets, motion, stop. */
static enum fault execute(struct interpreter *in, const struct program *p, struct block *b,
                          struct fault_report *r)
{
    enum fault f = gcode_sort(&b->g, &b->tokens, p->angles, r);

    b->angles = p->angles;

    if (f == FAULT_NONE) {
        set_modes(in, b);
        f = check_shares(in, b, r);
    }
    if (f == FAULT_NONE) {
        f = set_feed(in, p, b, r);
    }
    if (f == FAULT_NONE) {
        f = switching_block(in, b, r);
    }
    if (f == FAULT_NONE) {
        f = act(in, p, b, r);
    }
    if (f == FAULT_NONE) {
        stop(in, p, b);
    }
    return f;
}

/* Read and execute one line. */
static enum fault next_line(struct interpreter *in, const struct program *p,
                            struct fault_report *r)
{
    struct source_line line;
    struct block b;

    enum fault f = source_read(p->source, &in->offset, &line, r);
    if (f == FAULT_NONE && !line.text) {
        in->ended = true;
        return FAULT_NONE;
    }
    r->line = ++in->line;
    if (f != FAULT_NONE) {
        return f;
    }
    f = tokens_read(&b.tokens, line.text, line.length, r);
    if (b.tokens.slash && p->block_delete) {
        return FAULT_NONE;      /* whatever stands behind it */
    }
    if (f == FAULT_NONE && b.tokens.percent) {
        in->ended = in->percent;    /* the second % closes the program */
        in->percent = true;
        return FAULT_NONE;
    }
    return f == FAULT_NONE ? execute(in, p, &b, r) : f;
}

enum interpreter_result interpreter_next(struct interpreter *in, const struct program *p,
                                         struct command *c, struct fault_report *r)
{
    while (in->taken == in->count) {
        if (in->ended) {
            return INTERPRETER_END;
        }
        in->taken = in->count = 0;
        r->fault = next_line(in, p, r);
        if (r->fault != FAULT_NONE) {
            in->ended = true;
            in->taken = in->count = 0;
            return INTERPRETER_FAULT;
        }
    }
    *c = in->made[in->taken++];
    return INTERPRETER_COMMAND;
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

bool interpreter_damaged(const struct interpreter *in)
{
    return in->offset < 0 || in->motion < -1 || in->motion > 3 || in->system < 0 ||
           in->system >= INTERPRETER_SYSTEMS || in->count < 0 || in->count > INTERPRETER_MADE ||
           in->taken < 0 || in->taken > in->count;
}
