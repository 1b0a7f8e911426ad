#include "frame.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "elementary.h"
#include "offsets.h"

static const double DEGREE = 0.017453292519943295;

/* Range of the magnitude of G51's factors, as on Fanuc's controls. */
static const double FACTOR_MIN = 0.001, FACTOR_MAX = 999.999;

/* Turn the vector (x, y) counter-clockwise; quarter turns are exact. */
static void turn(double degrees, double *x, double *y)
{
    static const double COSINE[4] = { 1.0, 0.0, -1.0, 0.0 };
    const double rest = fmod(degrees, 360.0), quarter = rest / 90.0;
    const bool whole = quarter == round(quarter);
    const int k = whole ? ((int)quarter + 4) % 4 : 0;
    const double c = whole ? COSINE[k] : el_cos(rest * DEGREE);
    const double s = whole ? COSINE[(k + 3) % 4] : el_sin(rest * DEGREE);
    const double turned = c * *x - s * *y;

    *y = s * *x + c * *y;
    *x = turned;
}

/* Turn of the coordinate system in force [deg]; those of G54.1 have none. */
static double system_turn(const struct interpreter *in)
{
    return in->system < INTERPRETER_SYSTEMS ? in->words.turn[in->system] : 0.0;
}

/* A program coordinate behind the scaling of G51 [mm]. */
static double scaled(const struct words *w, int axis, double x)
{
    return w->centre[axis] + w->factor[axis] * (x - w->centre[axis]);
}

/* Centre of G68's rotation, behind the scaling [mm]. */
static void rotation_centre(const struct words *w, double about[2])
{
    const int axis[2] = { path_first((enum path_plane)w->plane),
                          path_second((enum path_plane)w->plane) };

    for (int i = 0; i < 2; i++) {
        about[i] = w->scaled ? scaled(w, axis[i], w->about[i]) : w->about[i];
    }
}

/* Rotate a point about the centre of G68 by `sign` times its angle. */
static void rotate(const struct words *w, double sign, double point[AXES])
{
    double *x = &point[path_first((enum path_plane)w->plane)];
    double *y = &point[path_second((enum path_plane)w->plane)];
    double about[2];

    rotation_centre(w, about);
    *x -= about[0];
    *y -= about[1];
    turn(sign * w->angle, x, y);
    *x += about[0];
    *y += about[1];
}

void frame_machine(const struct interpreter *in, const double program[AXES], double machine[AXES])
{
    const struct words *w = &in->words;
    const bool turned = system_turn(in) != 0.0;

    memcpy(machine, program, AXES * sizeof *machine);
    for (int i = 0; i < 3 && w->scaled; i++) {
        machine[i] = scaled(w, i, machine[i]);
    }
    if (w->rotated) {
        rotate(w, 1.0, machine);
    }
    for (int i = 0; i < 2 && turned; i++) {
        machine[i] += offsets_shift(in, i);
    }
    if (turned) {
        turn(system_turn(in), &machine[0], &machine[1]);
    }
    for (int i = 0; i < AXES; i++) {
        machine[i] += turned && i < 2 ? offsets_origin(in, i) : offsets_zero(in, i);
    }
}

void frame_program(const struct interpreter *in, const double machine[AXES], double program[AXES])
{
    const struct words *w = &in->words;
    const bool turned = system_turn(in) != 0.0;

    for (int i = 0; i < AXES; i++) {
        program[i] = machine[i] - (turned && i < 2 ? offsets_origin(in, i) : offsets_zero(in, i));
    }
    if (turned) {
        turn(-system_turn(in), &program[0], &program[1]);
    }
    for (int i = 0; i < 2 && turned; i++) {
        program[i] -= offsets_shift(in, i);
    }
    if (w->rotated) {
        rotate(w, -1.0, program);
    }
    for (int i = 0; i < 3 && w->scaled; i++) {
        program[i] = w->centre[i] + (program[i] - w->centre[i]) / w->factor[i];
    }
}

void frame_way(const struct interpreter *in, double way[3])
{
    const struct words *w = &in->words;

    for (int i = 0; i < 3 && w->scaled; i++) {
        way[i] *= w->factor[i];
    }
    if (w->rotated) {
        turn(w->angle, &way[path_first((enum path_plane)w->plane)],
             &way[path_second((enum path_plane)w->plane)]);
    }
    if (system_turn(in) != 0.0) {
        turn(system_turn(in), &way[0], &way[1]);
    }
}

bool frame_circles(const struct interpreter *in, enum path_plane plane, double *ratio,
                   bool *mirrored)
{
    const struct words *w = &in->words;
    const double a = w->scaled ? w->factor[path_first(plane)] : 1.0;
    const double b = w->scaled ? w->factor[path_second(plane)] : 1.0;

    *ratio = fabs(a);
    *mirrored = a * b < 0.0;
    return fabs(a) == fabs(b) && (!w->rotated || w->plane == (int32_t)plane)
           && (system_turn(in) == 0.0 || plane == PATH_XY);
}

/* Axes that a rotation couples, so that a word of one may move all of them: a bit each. */
static int coupled(const struct interpreter *in)
{
    const enum path_plane plane = (enum path_plane)in->words.plane;
    int mask = system_turn(in) != 0.0 ? 3 : 0;

    if (in->words.rotated) {
        mask |= 1 << path_first(plane) | 1 << path_second(plane);
    }
    return mask;
}

/* Set X and Y by a radius [mm] and an angle [deg]. */
static void turn_to(double program[AXES], double radius, double azimuth)
{
    program[0] = radius;
    program[1] = 0.0;
    turn(azimuth, &program[0], &program[1]);
}

/* @ and ^: radius and angle about the zero of X and Y. The one without a word stays as it is; with
 * G91 the words are added to radius and angle of where the tool is. */
static enum fault polar_words(const struct interpreter *in, const struct block *b,
                              double program[AXES], struct fault_report *r)
{
    const struct token *radius = gcode_word(&b->g, '@'), *angle = gcode_word(&b->g, '^');
    const struct token *xy = gcode_first(&b->g, "XY"), *first = radius ? radius : angle;

    if (xy) {
        return tokens_at_words(r, FAULT_SHARED, first, xy);
    }
    double length = el_hypot(program[0], program[1]);
    double azimuth = el_atan2(program[1], program[0]) / DEGREE;
    if (length == 0.0 && (in->incremental || !angle)) {
        return tokens_at_word(r, FAULT_POLE, first);
    }
    length = radius ? radius->value * b->scale + (in->incremental ? length : 0.0) : length;
    azimuth = angle ? angle->value + (in->incremental ? azimuth : 0.0) : azimuth;
    turn_to(program, length, azimuth);
    return FAULT_NONE;
}

/* Set the axes of the plane by radius and angle of G16 about its pole. */
static void polar_place(const struct interpreter *in, double program[AXES])
{
    const int axis[2] = { path_first(in->plane), path_second(in->plane) };
    const struct words *w = &in->words;

    program[axis[0]] = w->radius;
    program[axis[1]] = 0.0;
    turn(w->azimuth, &program[axis[0]], &program[axis[1]]);
    for (int i = 0; i < 2; i++) {
        program[axis[i]] += w->pole[i];
    }
}

/* G16: the word of the plane's first axis is a radius, that of its second an angle. With G91 the
 * pole of a radius is where the tool is, and an angle is added to the latest one. False: the block
 * has neither. */
static bool polar_mode(struct interpreter *in, const struct block *b, double program[AXES])
{
    struct words *w = &in->words;
    const int axis[2] = { path_first(in->plane), path_second(in->plane) };
    const struct token *radius = gcode_word(&b->g, BLOCK_AXES[axis[0]]);
    const struct token *angle = gcode_word(&b->g, BLOCK_AXES[axis[1]]);

    if (!radius && !angle) {
        return false;
    }
    for (int i = 0; i < 2; i++) {
        w->pole[i] = !in->incremental ? 0.0 : radius ? program[axis[i]] : w->pole[i];
    }
    w->radius = radius ? radius->value * b->scale : w->radius;
    w->azimuth = angle ? angle->value + (in->incremental ? w->azimuth : 0.0) : w->azimuth;
    polar_place(in, program);
    return true;
}

void frame_here(const struct interpreter *in, double here[AXES])
{
    const struct cutter *k = &in->cutter;
    const int first = path_first(k->plane), second = path_second(k->plane);

    memcpy(here, in->point, AXES * sizeof *here);
    if (k->aside && here[first] == k->from[0] && here[second] == k->from[1]) {
        here[first] = k->left[0];
        here[second] = k->left[1];
    }
}

void frame_from(const struct interpreter *in, const struct block *b, double from[AXES])
{
    const struct cutter *k = &in->cutter;
    const int first = path_first(k->plane), second = path_second(k->plane);

    memcpy(from, in->point, AXES * sizeof *from);
    if (k->aside
        && (gcode_word(&b->g, BLOCK_AXES[first]) || gcode_word(&b->g, BLOCK_AXES[second])
            || gcode_first(&b->g, "@^"))) {
        frame_here(in, from);
    }
}

void frame_cycle_way(const struct interpreter *in, const struct block *b, const double before[AXES],
                     struct cycle_way *way)
{
    const int axis[2] = { path_first(in->plane), path_second(in->plane) };
    const struct token *word[2] = { gcode_word(&b->g, BLOCK_AXES[axis[0]]),
                                    gcode_word(&b->g, BLOCK_AXES[axis[1]]) };
    const struct token *radius = gcode_word(&b->g, '@'), *angle = gcode_word(&b->g, '^');

    *way = (struct cycle_way){ .polar = CYCLE_STRAIGHT };
    if (!in->incremental) {
        return;
    }
    if (radius || angle) {
        way->polar = CYCLE_POLE;
        way->plane[0] = radius ? radius->value * b->scale : 0.0;
        way->plane[1] = angle ? angle->value : 0.0;
    } else if (in->words.polar && (word[0] || word[1])) {
        way->polar = CYCLE_POLAR;
        way->about = word[0] != NULL;
        way->plane[1] = word[1] ? word[1]->value : 0.0;
    } else {
        way->plane[0] = in->cycle.hole[axis[0]] - before[axis[0]];
        way->plane[1] = in->cycle.hole[axis[1]] - before[axis[1]];
    }
}

bool frame_go_on(struct interpreter *in, const struct cycle_way *way, double place[AXES])
{
    double *const a = &place[path_first(in->plane)], *const b = &place[path_second(in->plane)];
    struct words *w = &in->words;

    if (way->polar == CYCLE_STRAIGHT) {
        *a += way->plane[0];
        *b += way->plane[1];
    } else if (way->polar == CYCLE_POLE) {
        const double length = el_hypot(place[0], place[1]);
        if (length == 0.0) {
            return false;
        }
        turn_to(place, length + way->plane[0],
                el_atan2(place[1], place[0]) / DEGREE + way->plane[1]);
    } else {
        w->pole[0] = way->about ? *a : w->pole[0];
        w->pole[1] = way->about ? *b : w->pole[1];
        w->azimuth += way->plane[1];
        polar_place(in, place);
    }
    return true;
}

/* The end point of a block while it is found, axis by axis. */
struct ends {
    bool machine, framed; /* G53; program coordinates differ by more than offsets */
    int together;         /* axes that a rotation couples, a bit each */
    int polar, moved;     /* axes that polar words, or words in program coordinates, move: bits */
    double *end;
    double program[AXES];
};

/* Apply @ and ^, or with G16 the axis words of the plane. */
static enum fault polar_ends(struct interpreter *in, const struct block *b, struct ends *e,
                             struct fault_report *r)
{
    const int other = b->g.code[GCODE_NONMODAL];
    const bool at_pole = b->g.letters & (GCODE_BIT('@') | GCODE_BIT('^'));

    if (at_pole && !e->machine) {
        e->polar = 3;
        return polar_words(in, b, e->program, r);
    }
    if (in->words.polar && (other == GCODE_ABSENT || other == 40)
        && polar_mode(in, b, e->program)) {
        e->polar = 1 << path_first(in->plane) | 1 << path_second(in->plane);
    }
    return FAULT_NONE;
}

/* Apply the word of axis i. */
static void axis_end(const struct interpreter *in, const struct block *b, int i,
                     const struct token *word, struct ends *e)
{
    const struct words *w = &in->words;
    const double value = gcode_value(b, i, word);

    if (e->machine) {
        e->end[i] = value;
    } else if (in->incremental && !(e->together & 1 << i)) {
        e->end[i] += w->scaled && i < 3 ? w->factor[i] * value : value;
    } else if (!e->framed) {
        e->end[i] = value + offsets_zero(in, i);
    } else {
        e->moved |= 1 << i;
    }
    if (e->framed) {
        e->program[i] = in->incremental ? e->program[i] + value : value;
    }
}

/* Machine coordinates of the axes that words in program coordinates move. */
static void framed_ends(const struct interpreter *in, struct ends *e)
{
    double place[AXES];

    e->moved |= e->polar;
    e->moved |= e->moved & e->together ? e->together : 0;
    frame_machine(in, e->program, place);
    for (int i = 0; i < AXES; i++) {
        e->end[i] = e->moved & 1 << i ? place[i] : e->end[i];
    }
}

enum fault frame_end(struct interpreter *in, const struct program *p, const struct block *b,
                     double end[AXES], struct fault_report *r)
{
    const bool at_pole = b->g.letters & (GCODE_BIT('@') | GCODE_BIT('^'));
    struct ends e;

    e.machine = b->g.code[GCODE_NONMODAL] == 530;
    e.together = coupled(in);
    e.framed = in->words.scaled || e.together || in->words.polar || at_pole;
    e.polar = e.moved = 0;
    e.end = end;
    frame_from(in, b, end);
    if (e.framed) {
        frame_program(in, end, e.program);
        const enum fault f = polar_ends(in, b, &e, r);
        if (f != FAULT_NONE) {
            return f;
        }
    }
    for (int i = 0; i < AXES; i++) {
        const struct token *word = gcode_word(&b->g, BLOCK_AXES[i]);
        const bool polar = e.polar & 1 << i;
        if ((word || polar) && !p->machine.axis[i]) {
            return word ? tokens_at_word(r, FAULT_AXIS, word)
                        : tokens_at_line(r, FAULT_AXIS, &b->tokens);
        }
        if (word && !polar) {
            axis_end(in, b, i, word, &e);
        }
    }
    if (e.framed) {
        framed_ends(in, &e);
    }
    return FAULT_NONE;
}

/* Centre of G51 or G68 along an axis: its word, or without one where the tool is. */
static double centre_of(const struct block *b, int axis, const double here[AXES])
{
    const struct token *word = gcode_word(&b->g, BLOCK_AXES[axis]);

    return word ? gcode_value(b, axis, word) : here[axis];
}

/* G51. On Fanuc's controls a factor without a decimal point is in thousandths. */
static enum fault scale(struct interpreter *in, const struct program *p, const struct block *b,
                        struct fault_report *r)
{
    static const char LETTERS[] = "IJK";
    const struct token *all = gcode_word(&b->g, 'P'), *any = gcode_first(&b->g, LETTERS);
    double here[AXES];

    if (all && any) {
        return tokens_at_words(r, FAULT_SHARED, all, any);
    }
    if (!all && !any) {
        return tokens_at_line(r, FAULT_NO_FACTOR, &b->tokens);
    }
    frame_here(in, here);
    frame_program(in, here, here);
    struct words w = in->words;
    w.scaled = true;
    for (int i = 0; i < 3; i++) {
        const struct token *word = all ? all : gcode_word(&b->g, LETTERS[i]);
        const bool thousandths = p->fanuc && word && word->whole;
        w.factor[i] = !word ? 1.0 : thousandths ? word->value / 1000.0 : word->value;
        if (!(fabs(w.factor[i]) >= FACTOR_MIN && fabs(w.factor[i]) <= FACTOR_MAX)) {
            return tokens_at_word(r, FAULT_VALUE, word);
        }
        w.centre[i] = centre_of(b, i, here);
    }
    in->words = w;
    return FAULT_NONE;
}

/* G68 */
static enum fault rotation(struct interpreter *in, const struct block *b, struct fault_report *r)
{
    const struct token *angle = gcode_word(&b->g, 'R');
    const struct token *normal = gcode_word(&b->g, BLOCK_AXES[in->plane]);
    struct words *w = &in->words;
    double here[AXES];

    if (!angle) {
        return tokens_at_line(r, FAULT_NO_ANGLE, &b->tokens);
    }
    if (normal) {
        return tokens_at_word(r, FAULT_UNUSED, normal);
    }
    frame_here(in, here);
    frame_program(in, here, here);
    w->rotated = true;
    w->plane = (int32_t)in->plane;
    w->angle = angle->value;
    w->about[0] = centre_of(b, path_first(in->plane), here);
    w->about[1] = centre_of(b, path_second(in->plane), here);
    return FAULT_NONE;
}

/* G16: radius and angle begin as those of where the tool is. */
static void begin_polar(struct interpreter *in)
{
    struct words *w = &in->words;
    double here[AXES];

    frame_here(in, here);
    frame_program(in, here, here);
    const double x = here[path_first(in->plane)], y = here[path_second(in->plane)];
    w->polar = true;
    w->pole[0] = w->pole[1] = 0.0;
    w->radius = el_hypot(x, y);
    w->azimuth = el_atan2(y, x) / DEGREE;
}

bool frame_takes_axes(const struct block *b)
{
    return b->g.code[GCODE_SCALING] == 510 || b->g.code[GCODE_ROTATION] == 680;
}

/* CCN 17: scaling, rotation and polar words in the order in which they apply. */
enum fault frame_change(struct interpreter *in, const struct program *p, const struct block *b,
                        struct fault_report *r)
{
    const int scaling = b->g.code[GCODE_SCALING], turning = b->g.code[GCODE_ROTATION];
    enum fault f = FAULT_NONE;

    for (int i = 0; i < AXES && frame_takes_axes(b); i++) {
        const struct token *word = gcode_word(&b->g, BLOCK_AXES[i]);
        if (word && (i >= 3 || !p->machine.axis[i])) {
            return tokens_at_word(r, i >= 3 ? FAULT_UNUSED : FAULT_AXIS, word);
        }
    }
    if (turning == 690) {
        in->words.rotated = false;
    }
    if (scaling != GCODE_ABSENT && in->words.rotated) { /* scaling applies in front of rotation */
        return tokens_at_word(r, FAULT_FRAME, b->g.by[GCODE_SCALING]);
    }
    if (scaling == 500) {
        in->words.scaled = false;
    } else if (scaling == 510) {
        f = scale(in, p, b, r);
    }
    if (turning == 680 && f == FAULT_NONE) {
        f = rotation(in, b, r);
    }
    if (f == FAULT_NONE && b->g.code[GCODE_POLAR] == 160) {
        begin_polar(in);
    } else if (b->g.code[GCODE_POLAR] == 150) {
        in->words.polar = false;
    }
    return f;
}
