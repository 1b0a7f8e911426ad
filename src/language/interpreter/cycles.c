#include "cycles.h"

#include <math.h>
#include <string.h>

#include "block.h"
#include "el_extremes.h"
#include "feed.h"
#include "frame.h"
#include "switching.h"

static const double RELIEF = 0.254; /* [mm] clearance above a peck: 0.01 inch, as in LinuxCNC */
static const double REPEATS_MAX = 9999.0; /* highest L */
static const double PECKS_MAX = 10000.0;  /* in one hole */
static const double SAME = 1e-9; /* [mm] nearer places differ by rounding of offsets only */

/* The steps of each cycle from R on, and the words that it needs beside R and the depth:
 *
 *     d feed to the bottom         g feed one peck deeper; at the bottom go on behind the <
 *     u feed to R                  c rapid to RELIEF above what is drilled, R at most
 *     U feed to the clear height   < go on at the first step
 *     R rapid to R                 p dwell             x overrides off
 *     ^ rapid to the clear height  s spindle off       r spindle the other way round
 *     ! stop as M0                 t spindle and overrides as before
 *     i rapid aside                h rapid back over the hole
 *     D rapid to the bottom        o rapid to the clear height, both where the tool is
 *     k feed to K
 */
static const struct {
    int code;
    char steps[14], words[3];
} rows[] = {
    { 730, "gc<p^", "Q" },  { 740, "xdrpUt", "" },  { 810, "d^", "" },
    { 820, "dp^", "P" },    { 830, "gRc<p^", "Q" }, { 840, "xdrpUt", "" },
    { 850, "du^", "" },     { 860, "dps^t", "P" },  { 870, "isDhtkdsioht", "I" },
    { 880, "dps!^t", "P" }, { 890, "dpU", "P" },
};

/* Steps in front of those: rapid over the hole, rapid to R. */
enum { STEP_HOLE, STEP_TOP, STEP_FIRST };

/* Row of a code; -1: it is no canned cycle. */
static int row_of(int code)
{
    for (int i = 0; i < (int)(sizeof rows / sizeof *rows); i++) {
        if (rows[i].code == code) {
            return i;
        }
    }
    return -1;
}

bool cycles_code(int code)
{
    return code >= 730 && row_of(code) >= 0;
}

bool cycles_taps(int code)
{
    return code == 740 || code == 840;
}

static bool pecks(int code)
{
    return code == 730 || code == 830;
}

/* Whether a cycle takes P, Q, or I J K. P is a choice in tapping and in G73 and G83, with which
 * only Fanuc's controls have it. */
static bool takes(int code, char letter)
{
    return strchr(rows[row_of(code)].words, letter)
           || (letter == 'P' && (cycles_taps(code) || pecks(code)));
}

void cycles_modes(struct interpreter *in, const struct block *b)
{
    const int retract = b->g.code[GCODE_RETRACT];

    if (retract != GCODE_ABSENT) {
        in->cycle.to_r = retract == 990;
    }
    if (!cycles_code(in->motion)) {
        in->cycle.code = 0;
    }
}

/* Machine coordinates of a place, in program coordinates, at a height. Coordinates nearer than SAME
 * to where the tool is are made equal to it. */
static void place_at(const struct interpreter *in, const double program[AXES], double height,
                     double end[AXES])
{
    double place[AXES];
    memcpy(place, program, sizeof place);
    place[in->plane] = height;
    frame_machine(in, place, end);
    for (int i = 0; i < AXES; i++) {
        end[i] = fabs(end[i] - in->point[i]) < SAME ? in->point[i] : end[i];
    }
}

/* Make a straight motion to a place at a height. */
static enum fault go(struct interpreter *in, const struct program *p, const double program[AXES],
                     double height, bool rapid, struct fault_report *r)
{
    double end[AXES];
    place_at(in, program, height, end);
    const struct cycle *k = &in->cycle;
    block_at_line(in, &k->line, FAULT_NONE, r);
    return block_straight(in, p, end, rapid ? 0.0 : k->feed, cycles_taps(k->code), r);
}

/* Take a word that holds for a series: without it *value stays, or it is `missing` if no block of
 * the series has had it (!kept). */
static enum fault keep(const struct block *b, bool kept, char letter, double scale, double *value,
                       enum fault missing, struct fault_report *r)
{
    const struct token *w = gcode_word(&b->g, letter);
    if (!w && !kept) {
        const struct token *by = b->g.by[GCODE_MOTION];
        return by ? tokens_at_word(r, missing, by) : tokens_at_line(r, missing, &b->tokens);
    }
    *value = w ? w->value * scale : *value;
    return FAULT_NONE;
}

/* I J K of G87: displacement from the hole to where the tool fits through, and the height up to
 * which it bores. */
static enum fault keep_aside(struct interpreter *in, const struct block *b, bool kept,
                             struct fault_report *r)
{
    struct cycle *k = &in->cycle;
    const int plane[2] = { path_first(in->plane), path_second(in->plane) };
    enum fault f = keep(b, kept, "IJK"[in->plane], b -> scale, &k -> bore, FAULT_CYCLE_ASIDE, r);

    for (int i = 0; i < 2 && f == FAULT_NONE; i++) {
        f = keep(b, kept, "IJK"[plane[i]], b -> scale, &k -> aside[i], FAULT_CYCLE_ASIDE, r);
    }
    if (b->g.by[GCODE_MOTION]) {
        tokens_note(r, FAULT_NOTE_ORIENT, b->g.by[GCODE_MOTION]);
    }
    return f;
}

/* CCN 25: each word that a cycle keeps: whether it takes it, what it was, and what it may be. */
static enum fault keep_words(struct interpreter *in, const struct program *p, const struct block *b,
                             bool kept, struct fault_report *r)
{
    struct cycle *k = &in->cycle;
    const struct token *q = gcode_word(&b->g, 'Q'), *wait = gcode_word(&b->g, 'P');
    const struct token *l = gcode_word(&b->g, 'L');
    enum fault f = keep(b, kept, 'R', b->scale, &k->r, FAULT_CYCLE_R, r);

    if (f == FAULT_NONE) {
        f = keep(b, kept, BLOCK_AXES[in->plane], b->scale, &k->depth, FAULT_CYCLE_DEPTH, r);
    }
    if (f == FAULT_NONE && takes(in->motion, 'Q')) {
        f = keep(b, kept, 'Q', b->scale, &k->peck, FAULT_CYCLE_Q, r);
    }
    if (f == FAULT_NONE && takes(in->motion, 'P')) {
        k->dwell = kept ? k->dwell : 0.0;
        f = keep(b, kept || cycles_taps(in->motion) || pecks(in->motion), 'P', 1.0, &k->dwell,
                 FAULT_CYCLE_P, r);
        k->dwell = wait ? block_seconds(p, wait) : k->dwell;
    }
    if (f == FAULT_NONE && takes(in->motion, 'I')) {
        f = keep_aside(in, b, kept, r);
    }
    if (f != FAULT_NONE) {
        return f;
    }
    if (takes(in->motion, 'Q') && q && !(q->value > 0.0)) {
        return tokens_at_word(r, FAULT_VALUE, q);
    }
    if (takes(in->motion, 'P') && !(k->dwell >= 0.0 && k->dwell <= BLOCK_DWELL_MAX)) {
        return wait ? tokens_at_word(r, FAULT_VALUE, wait)
                    : tokens_at_line(r, FAULT_VALUE, &b->tokens);
    }
    if (l && !(l->value >= 1.0 && l->value <= REPEATS_MAX && l->value == round(l->value))) {
        return tokens_at_word(r, FAULT_VALUE, l);
    }
    k->repeats = l ? (int32_t)l->value - 1 : 0;
    return FAULT_NONE;
}

/* Find the first hole and the heights; a tool below R goes up there. */
static enum fault set_places(struct interpreter *in, const struct program *p, const struct block *b,
                             bool series, struct fault_report *r)
{
    struct cycle *k = &in->cycle;
    const int n = (int)in->plane;
    double from[AXES], here[AXES], end[AXES];
    const enum fault f = frame_end(in, p, b, end, r);

    if (f != FAULT_NONE) {
        return f;
    }
    if (!p->machine.axis[n]) {
        return tokens_at_line(r, FAULT_AXIS, &b->tokens);
    }
    frame_from(in, b, from);
    frame_program(in, from, here);
    frame_program(in, end, k->hole);
    frame_cycle_way(in, b, here, &k->way);
    const double now = here[n];
    k->initial = series ? k->initial : now;
    k->top = in->incremental ? k->initial + k->r : k->r;
    k->bottom = in->incremental ? k->top + k->depth : k->depth;
    k->clear = k->to_r ? k->top : el_max(k->top, k->initial);
    if (k->top < k->bottom) {
        r->value = k->top;
        r->limit = k->bottom;
        return tokens_at_line(r, FAULT_CYCLE_LOW, &b->tokens);
    }
    k->bored = in->incremental ? k->bottom + k->bore : k->bore;
    if (takes(in->motion, 'I') && k->bored < k->bottom) {
        r->value = k->bored;
        r->limit = k->bottom;
        return tokens_at_line(r, FAULT_CYCLE_LOW, &b->tokens);
    }
    if (takes(in->motion, 'Q') && k->top - k->bottom > PECKS_MAX * k->peck) {
        return tokens_at_line(r, FAULT_CYCLE_PECKS, &b->tokens);
    }
    frame_program(in, in->point, here);
    return now < k->top ? tokens_at_line(r, go(in, p, here, k->top, true, r), &b->tokens)
                        : FAULT_NONE;
}

/* CCN 17: a row of rules that all cycles share, each with its fault, in the order in which they
 * are told. */
enum fault cycles_block(struct interpreter *in, const struct program *p, const struct block *b,
                        struct fault_report *r)
{
    struct cycle *k = &in->cycle;
    const int code = in->motion;
    const int turning = switches_spindle(&in->switches) != 0.0 ? in->switches.turning : 0;
    const bool kept = k->code == code, series = k->code != 0;
    const bool named = b->g.code[GCODE_MOTION] == code;
    const struct token *extra = gcode_first(&b->g, "UVW");

    if (extra) {
        return tokens_at_word(r, FAULT_UNUSED, extra);
    }
    if (!gcode_first(&b->g, "XYZ@^")) {
        extra = gcode_first(&b->g, "RLQ");
        return named   ? tokens_at_word(r, FAULT_NO_AXES, b->g.by[GCODE_MOTION])
               : extra ? tokens_at_word(r, FAULT_UNUSED, extra)
                       : FAULT_NONE;
    }
    if ((takes(code, 'I') || (takes(code, 'P') && code != 820 && code != 890 && !pecks(code)))
        && (cycles_taps(code) ? turning != (code == 840 ? 1 : -1) : turning == 0)) {
        return tokens_at_line(r, FAULT_CYCLE_SPINDLE, &b->tokens);
    }
    if (in->words.feed_mode == 930) {
        return tokens_at_line(r, FAULT_CYCLE_FEED, &b->tokens);
    }
    k->line = block_line(in, b, r);
    enum fault f = feed_of(in, p, b, 0.0, cycles_taps(code), &k->feed, r);
    if (f == FAULT_NONE) {
        f = keep_words(in, p, b, kept, r);
    }
    if (f == FAULT_NONE) {
        f = set_places(in, p, b, series, r);
        k->code = code;
    }
    k->running = f == FAULT_NONE;
    k->step = STEP_HOLE;
    k->pecked = k->top;
    k->turning = in->switches.turning;
    k->overrides = in->switches.overrides;
    k->stop = b->g.code[GCODE_STOP];
    return f;
}

/* Make a command that switches the spindle and the overrides. */
static void turn(struct interpreter *in, int32_t turning, uint32_t overrides)
{
    in->switches.turning = turning;
    in->switches.overrides = overrides;
    switching_make(in, 0, 0);
}

/* Make a rapid of G87: i and h, aside of the hole or over it at the height of the tool; D and o,
 * along the normal from where the tool is. */
static enum fault shift(struct interpreter *in, const struct program *p, char step,
                        struct fault_report *r)
{
    const struct cycle *k = &in->cycle;
    const int plane[2] = { path_first(in->plane), path_second(in->plane) };
    double place[AXES];

    frame_program(in, in->point, place);
    for (int i = 0; i < 2 && (step == 'i' || step == 'h'); i++) {
        place[plane[i]] = k->hole[plane[i]] + (step == 'i' ? k->aside[i] : 0.0);
    }
    return go(in, p, place,
              step == 'D'   ? k->bottom
              : step == 'o' ? k->clear
                            : place[in->plane],
              true, r);
}

/* Make one step of the cycle.
 * CCN 22: a case for each letter of a list of steps. */
static enum fault step(struct interpreter *in, const struct program *p, const char *steps,
                       struct fault_report *r)
{
    struct cycle *k = &in->cycle;
    const uint32_t fixed = OUTPUTS_FEED_FIXED | OUTPUTS_SPEED_FIXED;

    switch (steps[k->step++ - STEP_FIRST]) {
    case 'd': return go(in, p, k->hole, k->bottom, false, r);
    case 'u': return go(in, p, k->hole, k->top, false, r);
    case 'U': return go(in, p, k->hole, k->clear, false, r);
    case 'R': return go(in, p, k->hole, k->top, true, r);
    case '^': return go(in, p, k->hole, k->clear, true, r);
    case 'i':
    case 'h':
    case 'D':
    case 'o': return shift(in, p, steps[k->step - 1 - STEP_FIRST], r);
    case 'k': return go(in, p, k->hole, k->bored, false, r);
    case 'g':
        k->pecked = el_max(k->pecked - k->peck, k->bottom);
        if (k->pecked - k->bottom < SAME) { /* what rounding leaves is no peck */
            k->pecked = k->bottom;
            k->step = STEP_FIRST + (int32_t)(strchr(steps, '<') - steps) + 1;
        }
        return go(in, p, k->hole, k->pecked, false, r);
    case 'c': return go(in, p, k->hole, el_min(k->pecked + RELIEF, k->top), true, r);
    case '<': k->step = STEP_FIRST; return FAULT_NONE;
    case 'p':
        if (k->dwell > 0.0) {
            command_delay(block_command(in), in->point, k->dwell);
            in->count++;
        }
        return FAULT_NONE;
    case 's': turn(in, 0, k->overrides); return FAULT_NONE;
    case 'r': turn(in, -k->turning, k->overrides | fixed); return FAULT_NONE;
    case 't': turn(in, k->turning, k->overrides); return FAULT_NONE;
    case 'x':
        if ((k->overrides & fixed) != fixed) {
            turn(in, k->turning, k->overrides | fixed);
        }
        return FAULT_NONE;
    default: /* '!' */
        block_command(in)->type = COMMAND_STOP;
        in->count++;
        return FAULT_NONE;
    }
}

/* A hole is finished: go on to the next one, or the block is done. */
static enum fault next_hole(struct interpreter *in)
{
    struct cycle *k = &in->cycle;

    k->running = k->repeats > 0;
    k->repeats -= k->running;
    k->step = STEP_HOLE;
    k->pecked = k->top;
    return !k->running || frame_go_on(in, &k->way, k->hole) ? FAULT_NONE : FAULT_POLE;
}

enum fault cycles_next(struct interpreter *in, const struct program *p, struct fault_report *r)
{
    struct cycle *k = &in->cycle;
    const char *steps = rows[row_of(k->code)].steps;
    double here[AXES];
    enum fault f = FAULT_NONE;

    while (k->running && in->count == 0 && f == FAULT_NONE) {
        in->flow.again += k->repeats > 0; /* counts as a line that is read again */
        if (k->step == STEP_HOLE) {
            k->step++;
            frame_program(in, in->point, here);
            f = go(in, p, k->hole, here[in->plane], true, r);
        } else if (k->step == STEP_TOP) {
            k->step++;
            f = go(in, p, k->hole, k->top, true, r);
        } else if (steps[k->step - STEP_FIRST] != '\0') {
            f = step(in, p, steps, r);
        } else {
            f = next_hole(in);
        }
    }
    if (f != FAULT_NONE) {
        k->running = false;
        return block_at_line(in, &k->line, f, r);
    }
    return f;
}
