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

int offsets_system(int code)
{
    return code > 590 ? 5 + code - 590 : (code - 540) / 10;
}

bool offsets_changed(const struct block *b)
{
    const int code = b->g.code[GCODE_NONMODAL];
    return code == 100 || code == 281 || code == 301 || code == 520 ||
           (code >= 920 && code <= 923);
}

bool offsets_take_axes(const struct block *b)
{
    const int code = b->g.code[GCODE_NONMODAL];
    return code == 100 || code == 520 || code == 920;
}

/* The system G10 speaks of, from 0, into *system; P0 is the one in force. */
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
    if (p->value < 0.0 || p->value > INTERPRETER_SYSTEMS || p->value != round(p->value)) {
        return tokens_at_word(r, FAULT_VALUE, p);
    }
    *system = p->value > 0.0 ? (int)p->value - 1 : in->system;
    return FAULT_NONE;
}

static enum fault check_axes(const struct program *p, const struct block *b,
                             struct fault_report *r)
{
    for (int i = 0; i < AXES; i++) {
        const struct token *w = gcode_word(&b->g, BLOCK_AXES[i]);
        if (w && !p->machine.axis[i]) {
            return tokens_at_word(r, FAULT_AXIS, w);
        }
    }
    return FAULT_NONE;
}

/* G10 L2: the origin and its turn; L20: the origin that gives the place of the axes these
 * coordinates. */
static enum fault set_system(struct interpreter *in, const struct block *b, struct fault_report *r)
{
    const struct token *turn = gcode_word(&b->g, 'R'), *l = gcode_word(&b->g, 'L');
    const bool here = l && l->value == 20.0;
    int system = 0;
    enum fault f = system_of(in, b, &system, r);

    if (f != FAULT_NONE) {
        return f;
    }
    if (here && turn) {
        return tokens_at_word(r, FAULT_UNUSED, turn);
    }
    if (turn) {
        in->words.turn[system] = turn->value;
    }
    double program[AXES], place[AXES];
    const int32_t force = in->system;
    in->system = system;                    /* for the coordinates in it */
    frame_program(in, in->point, program);
    for (int i = 0; i < AXES; i++) {
        const struct token *w = gcode_word(&b->g, BLOCK_AXES[i]);
        program[i] = w ? gcode_value(b, i, w) : program[i];
    }
    frame_machine(in, program, place);
    for (int i = 0; i < AXES; i++) {
        if (gcode_word(&b->g, BLOCK_AXES[i])) {
            double *origin = &in->origin[system][i];
            *origin = here ? *origin + (in->point[i] - place[i]) : program[i];
        }
    }
    in->system = force;
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
    frame_program(in, in->point, program);      /* without the shift */
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
        memcpy(in->words.park[code == 301], in->point, sizeof in->point);
        return FAULT_NONE;
    }
    if (in->words.scaled || in->words.rotated) {
        return tokens_at_word(r, FAULT_FRAME, b->g.by[GCODE_NONMODAL]);
    }
    if (offsets_take_axes(b)) {
        if (!gcode_first(&b->g, BLOCK_AXES) && !(code == 100 && gcode_word(&b->g, 'R'))) {
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
    return letter >= 0 && letter < 3 ? letter
         : letter >= turned && letter < turned + 3 ? letter - turned + 3 : -1;
}

bool offsets_parameter(const struct interpreter *in, bool angles, int number, double *value)
{
    static const double NONE[AXES];
    const int block = number >= 5221 ? (number - 5221) / 20 : 0;
    const int letter = number >= 5221 ? (number - 5221) % 20 : (number - 1) % 10;
    const double *row = number >= 5161 && number <= 5169 ? in->words.park[0]
                      : number >= 5181 && number <= 5189 ? in->words.park[1]
                      : number >= 5211 && number <= 5219 ? in->shift
                      : number >= 5221 && block < INTERPRETER_SYSTEMS ? in->origin[block] : NULL;

    if (number == 5210 || number == 5220) {
        *value = number == 5220 ? in->system + 1.0 : in->shifted;
        return true;
    }
    if (!row || letter > 9 || (letter == 9 && number < 5221)) {
        return false;
    }
    const int axis = letter < 9 ? offsets_axis(angles, letter) : -1;
    *value = letter == 9 ? in->words.turn[block] : axis < 0 ? NONE[0] : row[axis];
    return true;
}
