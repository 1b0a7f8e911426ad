#include "offsets.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "frame.h"
#include "tools.h"

double offsets_origin(const struct interpreter *in, int axis)
{
    return in->origin[in->system][axis] + tools_length(in, axis);
}

double offsets_shift(const struct interpreter *in, int axis)
{
    return in->shifted ? in->shift[axis] : 0.0;
}

double offsets_zero(const struct interpreter *in, int axis)
{
    return in->origin[in->system][axis] + offsets_shift(in, axis) + tools_length(in, axis);
}

/* Index of the system of G54.1 with a word P, which may be NULL; -1: there is none. */
static int further(const struct token *p)
{
    const bool good =
        p && p->value >= 1.0 && p->value <= INTERPRETER_MORE && p->value == round(p->value);
    return good ? INTERPRETER_SYSTEMS + (int)p->value - 1 : -1;
}

enum fault offsets_select(struct interpreter *in, const struct block *b, struct fault_report *r)
{
    const int code = b->g.code[GCODE_SYSTEM];
    const struct token *p = gcode_word(&b->g, 'P');

    if (code != GCODE_MORE && code != GCODE_MORE_HAAS) {
        in->system = code > 590 ? 5 + code - 590 : (code - 540) / 10;
        return FAULT_NONE;
    }
    if (further(p) < 0) {
        return p ? tokens_at_word(r, FAULT_VALUE, p)
                 : tokens_at_word(r, FAULT_MISSING, b->g.by[GCODE_SYSTEM]);
    }
    in->system = further(p);
    return FAULT_NONE;
}

bool offsets_changed(const struct block *b)
{
    const int code = b->g.code[GCODE_NONMODAL];
    return code == 100 || code == 281 || code == 301 || code == 520 || (code >= 920 && code <= 923);
}

bool offsets_take_axes(const struct block *b)
{
    const int code = b->g.code[GCODE_NONMODAL];
    return code == 100 || code == 520 || code == 920;
}

/* Index of the system that P of G10 names; P0: of that in force. */
static enum fault system_of(const struct interpreter *in, const struct block *b, int *system,
                            struct fault_report *r)
{
    const struct token *l = gcode_word(&b->g, 'L'), *p = gcode_word(&b->g, 'P');

    if (!l || !p) {
        return tokens_at_line(r, FAULT_NO_SYSTEM, &b->tokens);
    }
    if (l->value != 2.0 && l->value != 20.0) {
        return tokens_at_word(r, FAULT_VALUE, l);
    }
    if (b->fanuc && l->value == 20.0) { /* L20 is of the systems of G54.1 there */
        *system = further(p);
        return *system < 0 ? tokens_at_word(r, FAULT_VALUE, p) : FAULT_NONE;
    }
    if (p->value < 0.0 || p->value > INTERPRETER_SYSTEMS || p->value != round(p->value)) {
        return tokens_at_word(r, FAULT_VALUE, p);
    }
    *system = p->value > 0.0 ? (int)p->value - 1 : in->system;
    return FAULT_NONE;
}

/* FAULT_AXIS if an axis word is of an axis that the machine does not have. */
static enum fault check_axes(const struct program *p, const struct block *b, struct fault_report *r)
{
    for (int i = 0; i < AXES; i++) {
        const struct token *w = gcode_word(&b->g, BLOCK_AXES[i]);
        if (w && !p->machine.axis[i]) {
            return tokens_at_word(r, FAULT_AXIS, w);
        }
    }
    return FAULT_NONE;
}

/* G10 L2 sets origin and turn of a system; L20 sets the origin so that the axes stand at the
 * coordinates in the block. */
static enum fault set_system(struct interpreter *in, const struct block *b, struct fault_report *r)
{
    const struct token *turn = gcode_word(&b->g, 'R'), *l = gcode_word(&b->g, 'L');
    const bool here = l && l->value == 20.0 && !b->fanuc;
    int system = 0;
    enum fault f = system_of(in, b, &system, r);

    if (f != FAULT_NONE) {
        return f;
    }
    if (l->value == 20.0 && turn) {
        return tokens_at_word(r, FAULT_UNUSED, turn);
    }
    if (turn) {
        in->words.turn[system] = turn->value;
    }
    double now[AXES], program[AXES], place[AXES];
    const int32_t force = in->system;
    in->system = system; /* frame_program and frame_machine use it */
    frame_here(in, now);
    frame_program(in, now, program);
    for (int i = 0; i < AXES; i++) {
        const struct token *w = gcode_word(&b->g, BLOCK_AXES[i]);
        program[i] = w ? gcode_value(b, i, w) : program[i];
    }
    frame_machine(in, program, place);
    for (int i = 0; i < AXES; i++) {
        if (gcode_word(&b->g, BLOCK_AXES[i])) {
            double *origin = &in->origin[system][i];
            *origin = here ? *origin + (now[i] - place[i]) : program[i];
        }
    }
    in->system = force;
    if (system >= INTERPRETER_SYSTEMS + in->more) {
        in->more = system - INTERPRETER_SYSTEMS + 1;
    }
    return FAULT_NONE;
}

/* G52 and G92. */
static void set_shift(struct interpreter *in, const struct block *b)
{
    double program[AXES];

    if (!in->shifted) {
        memset(in->shift, 0, sizeof in->shift);
    }
    in->shifted = false;
    frame_here(in, program);
    frame_program(in, program, program); /* without the shift */
    in->shifted = true;
    for (int i = 0; i < AXES; i++) {
        const struct token *w = gcode_word(&b->g, BLOCK_AXES[i]);
        if (w) {
            const double value = gcode_value(b, i, w);
            in->shift[i] = b->g.code[GCODE_NONMODAL] == 520 ? value : program[i] - value;
        }
    }
}

enum fault offsets_change(struct interpreter *in, const struct program *p, const struct block *b,
                          struct fault_report *r)
{
    const int code = b->g.code[GCODE_NONMODAL];

    if (code == 281 || code == 301) {
        frame_here(in, in->words.park[code == 301]);
        return FAULT_NONE;
    }
    if (in->words.scaled || in->words.rotated) {
        return tokens_at_word(r, FAULT_FRAME, b->g.by[GCODE_NONMODAL]);
    }
    if (offsets_take_axes(b)) {
        if (!gcode_first(&b->g, BLOCK_AXES) && !b->g.idle
            && !(code == 100 && gcode_word(&b->g, 'R'))) {
            return tokens_at_line(r, FAULT_NO_AXES, &b->tokens);
        }
        const enum fault f = check_axes(p, b, r);
        if (f != FAULT_NONE || code == 100) {
            return f != FAULT_NONE ? f : set_system(in, b, r);
        }
        set_shift(in, b);
        return FAULT_NONE;
    }
    if (code == 921) {
        memset(in->shift, 0, sizeof in->shift);
    }
    in->shifted = code == 923;
    return FAULT_NONE;
}

int offsets_axis(bool angles, int letter)
{
    const int turned = angles ? 3 : 6;
    return letter >= 0 && letter < 3                 ? letter
           : letter >= turned && letter < turned + 3 ? letter - turned + 3
                                                     : -1;
}

/* Origins of G54.1 as Fanuc's controls number them: a system each 20 numbers, its axes in order. */
static bool further_parameter(const struct interpreter *in, int number, double *value)
{
    const bool all = number >= 14001;
    const int from = all ? 14001 : 7001, systems = all ? INTERPRETER_MORE : 48;
    const int system = number >= from ? (number - from) / 20 : -1, axis = (number - from) % 20;

    if (system < 0 || system >= systems || axis >= AXES) {
        return false;
    }
    *value = in->origin[INTERPRETER_SYSTEMS + system][axis];
    return true;
}

/* CCN 23: each number, or range of numbers, is a row of the language's table. */
bool offsets_parameter(const struct interpreter *in, const struct program *p, int number,
                       double *value)
{
    static const double NONE[AXES];
    const int block = number >= 5221 ? (number - 5221) / 20 : 0;
    const int letter = number >= 5221 ? (number - 5221) % 20 : (number - 1) % 10;
    const double *row = number >= 5161 && number <= 5169                ? in->words.park[0]
                        : number >= 5181 && number <= 5189              ? in->words.park[1]
                        : number >= 5211 && number <= 5219              ? in->shift
                        : number >= 5221 && block < INTERPRETER_SYSTEMS ? in->origin[block]
                                                                        : NULL;

    if (number == 5210 || number == 5220) {
        *value = number == 5220 ? in->system + 1.0 : in->shifted;
        return true;
    }
    if (p->fanuc && further_parameter(in, number, value)) {
        return true;
    }
    if (!row || letter > 9 || (letter == 9 && number < 5221)) {
        return false;
    }
    const int axis = letter < 9 ? offsets_axis(p->angles, letter) : -1;
    *value = letter == 9 ? in->words.turn[block] : axis < 0 ? NONE[0] : row[axis];
    return true;
}
