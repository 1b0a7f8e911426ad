#include "interpreter.h"

#include <string.h>

#include "block.h"
#include "cutter.h"
#include "cycles.h"
#include "feed.h"
#include "frame.h"
#include "nurbs.h"
#include "offsets.h"
#include "probing.h"
#include "rounding.h"
#include "saved_modes.h"
#include "switching.h"
#include "tapping.h"
#include "text_lines.h"
#include "tool_change.h"
#include "tools.h"
#include "uses.h"
#include "waiting.h"

static const double DWELL_LEAST = 1e-6, WAY_LEAST = 1e-9; /* [s], [mm]: less takes no time */

void interpreter_start(struct interpreter *in, const double point[AXES], double feed,
                       const double origin[INTERPRETER_SYSTEMS][AXES])
{
    memset(in, 0, sizeof *in);
    in->motion = GCODE_NO_MOTION;
    in->plane = PATH_XY;
    in->feed = feed;
    in->words.feed_mode = 940;
    in->parameters.debug = 1.0;
    memcpy(in->point, point, sizeof in->point);
    memcpy(in->origin, origin, INTERPRETER_SYSTEMS * sizeof *in->origin);
}

/* G61, G61.1: exact stop; G64: corners within P, runs of short lines within Q. */
static enum fault set_blend(struct interpreter *in, const struct block *b, struct fault_report *r)
{
    const struct token *p = gcode_word(&b->g, 'P'), *q = gcode_word(&b->g, 'Q');

    in->blend = b->g.code[GCODE_PATH] == 640;
    if (in->blend && ((p && p->value < 0.0) || (q && q->value < 0.0))) {
        return tokens_at_word(r, FAULT_VALUE, p && p->value < 0.0 ? p : q);
    }
    if (q && !p) {
        return tokens_at_word(r, FAULT_UNUSED, q);
    }
    in->tolerance = in->blend && p ? p->value * b->scale : 0.0;
    in->merge = in->blend && q ? q->value * b->scale : in->tolerance;
    return FAULT_NONE;
}

/* Set units and plane, by which other words of the line are read. */
static void set_measure(struct interpreter *in, struct block *b)
{
    const int *code = b->g.code;

    if (code[GCODE_UNITS] != GCODE_ABSENT) {
        in->inch = code[GCODE_UNITS] == 200;
    }
    b->scale = in->inch ? 25.4 : 1.0;
    if (code[GCODE_PLANE] != GCODE_ABSENT) {
        in->plane = code[GCODE_PLANE] == 170   ? PATH_XY
                    : code[GCODE_PLANE] == 180 ? PATH_ZX
                                               : PATH_YZ;
    }
}

static void set_motion(struct interpreter *in, const struct block *b)
{
    const int *code = b->g.code;

    if (code[GCODE_DISTANCE] != GCODE_ABSENT) {
        in->incremental = code[GCODE_DISTANCE] == 910;
    }
    if (code[GCODE_CENTRE] != GCODE_ABSENT) {
        in->absolute_centre = code[GCODE_CENTRE] == 901;
    }
    if (code[GCODE_MOTION] != GCODE_ABSENT) {
        in->motion = code[GCODE_MOTION];
    }
}

static enum fault set_modes(struct interpreter *in, struct block *b, struct fault_report *r)
{
    const int *code = b->g.code;
    const bool framed = in->words.scaled || in->words.rotated;
    const enum path_plane plane = in->plane;
    const int32_t system = in->system;
    enum fault f = FAULT_NONE;

    set_measure(in, b);
    if (code[GCODE_SYSTEM] != GCODE_ABSENT) {
        f = offsets_select(in, b, r);
    }
    if (f == FAULT_NONE && code[GCODE_PATH] != GCODE_ABSENT) {
        f = set_blend(in, b, r);
    }
    if (f != FAULT_NONE) {
        return f;
    }
    set_motion(in, b);
    if (framed && in->system != system) {
        return tokens_at_word(r, FAULT_FRAME, b->g.by[GCODE_SYSTEM]);
    }
    if (in->words.rotated && in->plane != plane) {
        return tokens_at_word(r, FAULT_FRAME, b->g.by[GCODE_PLANE]);
    }
    return FAULT_NONE;
}

/* The first of I J K, or of R P if no other code of the block takes it; or NULL. */
static const struct token *shape_word(const struct block *b)
{
    const struct token *shape = gcode_first(&b->g, "IJK");

    for (const char *c = "RP"; *c && !shape; c++) {
        shape = uses_of(&b->g, *c) ? NULL : gcode_word(&b->g, *c);
    }
    return shape;
}

/* Whether the block has a control point of a NURBS, its end, or what may not stand in between. */
static bool nurbs_asked(const struct interpreter *in, const struct block *b, bool words, bool axis)
{
    const int code = b->g.code[GCODE_MOTION];

    return in->motion == 52 ? axis || code == 52 || gcode_word(&b->g, 'P')
                            : code == 53 || (in->nurbs.count > 0 && words);
}

/* Make the motion of the block, if it has any. The first question that is answered with yes has the
 * words, so their order is the language's.
 * CCN 19: a question for each thing that may claim the words. */
static enum fault move(struct interpreter *in, const struct program *p, const struct block *b,
                       struct fault_report *r)
{
    const struct token *axis = gcode_first(&b->g, BLOCK_AXES "@^");
    const int code = b->g.code[GCODE_MOTION];
    const bool machine = b->g.code[GCODE_NONMODAL] == 530, words = axis || shape_word(b);

    if (nurbs_asked(in, b, words, axis)) {
        return nurbs_block(in, p, b, r);
    }
    if (machine && !axis) {
        return tokens_at_line(r, FAULT_NO_AXES, &b->tokens);
    }
    if (machine && in->motion != 0 && in->motion != 10) {
        return tokens_at_line(r, FAULT_G53, &b->tokens);
    }
    if (cycles_code(in->motion)) {
        return cycles_block(in, p, b, r);
    }
    if (in->motion == GCODE_NO_MOTION && axis) {
        return tokens_at_word(r, FAULT_NO_MOTION, axis);
    }
    if (probing_asked(b)) {
        return probing_block(in, p, b, r);
    }
    if (in->motion == 331 && (words || code == 331)) {
        return tapping_block(in, p, b, r);
    }
    if (!words && !gcode_arc(code) && !gcode_spline(code)) {
        return FAULT_NONE;
    }
    const int32_t before = in->count;
    const enum fault f = block_motion(in, p, b, r);
    return f == FAULT_NONE ? rounding_block(in, p, b, before, r) : f;
}

/* Whether a block with G4 moves, too: with P it may; X or U, on Fanuc's controls, are its time. */
static bool moves_behind_dwell(const struct block *b)
{
    return gcode_word(&b->g, 'P') && block_moves(b);
}

/* Execute what the block asks for: dwell, G28 or G30, offsets, scaling and rotation, or motion. */
static enum fault act(struct interpreter *in, const struct program *p, const struct block *b,
                      struct fault_report *r)
{
    const int nonmodal = b->g.code[GCODE_NONMODAL];
    enum fault f = FAULT_NONE;

    if (nonmodal == 40) {
        f = block_dwell(in, p, b, r);
        return f == FAULT_NONE && moves_behind_dwell(b) ? move(in, p, b, r) : f;
    }
    if (nonmodal == 280 || nonmodal == 300) {
        return block_home(in, p, b, r);
    }
    if (b->g.code[GCODE_TOOL] == 431 || b->g.code[GCODE_TOOL] == 432) {
        return FAULT_NONE; /* G43.1 and G43.2 have taken the axis words */
    }
    if (tools_measured(b)) {
        return tools_measure(in, p, b, r);
    }
    f = frame_change(in, p, b, r);
    if (f != FAULT_NONE || frame_takes_axes(b)) {
        return f;
    }
    if (offsets_changed(b)) {
        f = offsets_change(in, p, b, r);
        if (f != FAULT_NONE || offsets_take_axes(b)) {
            return f;
        }
    }
    return move(in, p, b, r);
}

/* G9: behind the motion of the block the axes come to rest, as by G4 P0. */
static void rest_behind(struct interpreter *in, const struct block *b, int32_t before)
{
    if (b->g.code[GCODE_EXACT] != GCODE_ABSENT && in->count > before && !in->cycle.running
        && !in->nurbs.running) {
        command_delay(block_command(in), in->point, 0.0);
        in->count++;
    }
}

/* M98, M99 */
static enum fault subprogram(struct interpreter *in, const struct program *p, const struct block *b,
                             struct fault_report *r)
{
    const struct token *number = gcode_word(&b->g, 'P'), *runs = gcode_word(&b->g, 'L');
    const int code = b->g.code[GCODE_STOP];

    if (code != 980 && code != 990) {
        return FAULT_NONE;
    }
    if (in->cycle.running || in->nurbs.running) {
        return tokens_at_word(r, FAULT_UNUSED, b->g.by[GCODE_STOP]);
    }
    tokens_at_word(r, FAULT_NO_SUB, number ? number : b->g.by[GCODE_STOP]);
    return code == 990 ? flow_return(in, p, r)
           : !number   ? FAULT_NO_SUB
                       : flow_subprogram(in, p, number->value, runs ? &runs->value : NULL, NULL, r);
}

/* Whether axis words of the block move the axes. */
static bool moves_axes(const struct block *b)
{
    const int other = b->g.code[GCODE_NONMODAL], tool = b->g.code[GCODE_TOOL];
    const bool moves = other == GCODE_ABSENT || other == 280 || other == 300 || other == 530
                       || (other == 40 && moves_behind_dwell(b));

    return moves && tool != 431 && tool != 432 && !frame_takes_axes(b)
           && gcode_first(&b->g, BLOCK_AXES "@^");
}

/* Execute G67; or behind a line that moves the axes make the call of G66. */
static enum fault modal_macro(struct interpreter *in, const struct program *p,
                              const struct block *b, struct fault_report *r)
{
    in->flow.modal.on = in->flow.modal.on && b->g.code[GCODE_MODAL] == GCODE_ABSENT;
    if (!flow_modal_acts(&in->flow) || !moves_axes(b) || in->ended) {
        return FAULT_NONE;
    }
    tokens_at_line(r, FAULT_MODAL, &b->tokens);
    return in->cycle.running || in->nurbs.count > 0 ? FAULT_MODAL : flow_modal_call(in, p, r);
}

/* Execute M0, M1, M60 (a stop) or M2, M30 (the end); `code` is ten times the number. */
static void stop(struct interpreter *in, const struct program *p, int code)
{
    if (code == 0 || code == 600 || (code == 10 && p->optional_stop)) {
        block_command(in)->type = COMMAND_STOP;
        in->count++;
    }
    if (code == 20 || code == 300) {
        in->ended = true;
        switching_end(in);
    }
}

/* The first of two faults. */
static enum fault also(enum fault f, enum fault g)
{
    return f != FAULT_NONE ? f : g;
}

/* Behind a fault: put the axes where the words of the block lead, and let axis words that lacked a
 * code of motion have G1 from here on. */
static void go_on(struct interpreter *in, const struct program *p, const struct block *b,
                  enum fault f, const double before[AXES])
{
    const int nonmodal = b->g.code[GCODE_NONMODAL];
    struct fault_report ignored;
    double end[AXES];

    in->motion = f == FAULT_NO_MOTION ? 10 : in->motion;
    if (memcmp(before, in->point, sizeof end) == 0 && !frame_takes_axes(b)
        && (nonmodal == GCODE_ABSENT || nonmodal == 530
            || (nonmodal == 40 && moves_behind_dwell(b)))
        && frame_end(in, p, b, end, &ignored) == FAULT_NONE) {
        memcpy(in->point, end, sizeof end);
    }
}

/* Execute one block, in the order of RS-274: modes, feed, tool, outputs, spindle, coolant, dwell,
 * offsets, motion, stop. f is a fault of its text. Behind a fault it goes on with what is left, so
 * that modes and place are right for the lines that follow.
 * CCN 21: half of it chooses where the faults of each part go. */
static enum fault execute(struct interpreter *in, const struct program *p, struct block *b,
                          enum fault f, struct fault_report *r)
{
    struct fault_report ignored;
    double before[AXES];

    ignored.notes = 0;
    ignored.line = r->line; /* the place that calls get */
    ignored.offset = r->offset;
    memcpy(ignored.file, r->file, FAULT_FILE);
    memcpy(before, in->point, sizeof before);
    b->angles = p->angles;
    b->fanuc = p->fanuc;
    f = also(f, gcode_sort(b, f ? &ignored : r));
    f = also(f, set_modes(in, b, f ? &ignored : r));
    f = also(f, uses_check(in, b, f ? &ignored : r));
    f = also(f, feed_set(in, p, b, f ? &ignored : r));
    f = also(f, waiting_input(in, p, b, f ? &ignored : r));
    f = also(f, tool_change(in, p, b, f ? &ignored : r));
    f = also(f, tools_lengths(in, p, b, f ? &ignored : r));
    f = also(f, switching_block(in, p, b, f ? &ignored : r));
    f = also(f, saved_modes_block(in, b, f ? &ignored : r));
    if (b->g.code[GCODE_SAVING] == 720) { /* G codes of the block come behind M72 */
        f = also(f, set_modes(in, b, f ? &ignored : r));
        f = also(f, tools_lengths(in, p, b, f ? &ignored : r));
    }
    cycles_modes(in, b);
    f = also(f, cutter_block(in, p, b, f ? &ignored : r));
    f = also(f, nurbs_between(in, b, f ? &ignored : r));
    const int32_t made = in->count;
    f = also(f, act(in, p, b, f ? &ignored : r));
    rest_behind(in, b, made);
    if (f != FAULT_NONE) {
        go_on(in, p, b, f, before);
    }
    if (!in->cycle.running && !in->nurbs.running) {
        stop(in, p, b->g.code[GCODE_STOP]);
    }
    f = also(f, modal_macro(in, p, b, f ? &ignored : r));
    return also(f, subprogram(in, p, b, f ? &ignored : r));
}

/* Go on with a cycle or a NURBS that runs, or read and execute one line. */
static enum fault next_line(struct interpreter *in, const struct program *p, struct fault_report *r)
{
    struct block b;

    if (in->cycle.running) {
        const enum fault f = cycles_next(in, p, r);
        if (f == FAULT_NONE && !in->cycle.running) {
            stop(in, p, in->cycle.stop);
        }
        return f;
    }
    if (in->nurbs.running) {
        const enum fault f = nurbs_next(in, p, r);
        if (f == FAULT_NONE && !in->nurbs.running) {
            stop(in, p, in->nurbs.stop);
        }
        return f;
    }
    enum fault f = lines_next(in, p, &b.tokens, r);
    if (b.tokens.count > 0) {
        f = execute(in, p, &b, f, r);
    }
    f = also(f, saved_modes_return(in, r));
    return f == FAULT_NONE && in->ended ? nurbs_end(in, r) : f;
}

/* Hand out a command. One that takes time begins the count of FAULT_ENDLESS anew; a loop of others
 * would keep a controller from its next interpolation point for ever. */
static enum interpreter_result hand_out(struct interpreter *in, const struct command *c)
{
    const bool brief = c->type == COMMAND_DELAY
                           ? c->dwell < DWELL_LEAST
                           : c->type != COMMAND_STOP && c->path.length < WAY_LEAST;

    in->flow.idle = brief ? in->flow.idle : in->flow.again;
    return INTERPRETER_COMMAND;
}

bool interpreter_due(const struct interpreter *in)
{
    return in->cutter.ready == 0 && in->taken >= in->count && !in->waits && !in->ended
           && !in->cycle.running && !in->nurbs.running && in->file == 0 && in->flow.level == 0
           && !in->flow.rest;
}

/* Whether the next line of the program itself is not to be read, or not there yet. */
static bool used_up(const struct interpreter *in, const struct program *p)
{
    const char *text;

    return (p->by_hand || p->upto > 0) && interpreter_due(in)
           && (p->by_hand ? p->source->look(p->source->context, "", in->offset, &text) == 0
                          : in->line + 1 >= p->upto);
}

enum interpreter_result interpreter_read(struct interpreter *in, const struct program *p,
                                         struct command *c, struct fault_report *r)
{
    r->notes = 0;
    while (!cutter_take(in, c)) {
        const bool made = in->taken < in->count && !waiting_now(in);
        if (made && !cutter_on(in)) {
            *c = in->made[in->taken++];
            return hand_out(in, c);
        }
        if (!made && in->waits) {
            in->flow.idle = in->flow.again;
            return INTERPRETER_WAIT;
        }
        if (!made && in->ended && !cutter_on(in)) {
            return INTERPRETER_END;
        }
        if (!made && used_up(in, p)) {
            return INTERPRETER_LINES;
        }
        if (made) {
            r->fault = cutter_follow(in, p, &in->made[in->taken++], r);
        } else if (in->ended) {
            r->fault = cutter_end(in, p, r);
        } else {
            in->taken = in->count = 0;
            in->rounding.fresh = false;
            r->fault = next_line(in, p, r);
            r->fault = also(r->fault, rounding_missed(in, r));
        }
        if (r->fault != FAULT_NONE) {
            in->taken = in->count = 0;
            in->waits = in->cycle.running = false;
            nurbs_skip(in);
            in->rounding.waits = false;
            cutter_drop(in);
            return INTERPRETER_FAULT;
        }
    }
    return hand_out(in, c);
}

enum interpreter_result interpreter_next(struct interpreter *in, const struct program *p,
                                         struct command *c, struct fault_report *r)
{
    const enum interpreter_result got = interpreter_read(in, p, c, r);

    in->ended = in->ended || got == INTERPRETER_FAULT;
    return got;
}
