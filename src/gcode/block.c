#include "block.h"

#include <math.h>
#include <string.h>

#include "offsets.h"

static const char CENTRE_LETTERS[] = "IJK";
static const int TURNS_MAX = 10000;         /* P of an arc */
static const double DWELL_MAX = 86400.0;    /* [s] a day */

struct command *block_command(struct interpreter *in)
{
    struct command *c = &in->made[in->count];
    memset(c, 0, sizeof *c);
    c->line = in->line;
    return c;
}

/* The command is a motion of the program: digital outputs that wait for one go with it. */
static void accept(struct interpreter *in, struct command *c)
{
    c->set = in->set;
    c->clear = in->clear;
    in->set = in->clear = 0;
    memcpy(in->point, c->path.end, sizeof in->point);
    in->count++;
}

/* The fault of an arc or of a command, and what is known of it. */
static enum fault of_path(enum path_status s)
{
    return s == PATH_NO_RADIUS ? FAULT_ARC_RADIUS
         : s == PATH_MISSES_END ? FAULT_ARC_END
         : s == PATH_SHORT_RADIUS ? FAULT_ARC_CHORD
         : s == PATH_OPEN ? FAULT_ARC_CLOSED : FAULT_NONE;
}

static enum fault of_command(enum command_status s, const struct command_refusal *why,
                             struct fault_report *r)
{
    if (s == COMMAND_FAST || s == COMMAND_OUTSIDE) {
        r->axis = why->joint;
        r->value = why->value;
        r->limit = why->limit;
    }
    return s == COMMAND_FAST ? FAULT_SPEED
         : s == COMMAND_FAR ? FAULT_RANGE
         : s == COMMAND_OUTSIDE ? FAULT_TRAVEL : FAULT_NONE;
}

/* End point of the block in machine coordinates. */
static enum fault end_point(const struct interpreter *in, const struct program *p,
                            const struct block *b, double end[AXES], struct fault_report *r)
{
    const bool machine = b->g.code[GCODE_NONMODAL] == 530;

    for (int i = 0; i < AXES; i++) {
        const struct token *w = gcode_word(&b->g, BLOCK_AXES[i]);
        end[i] = in->point[i];
        if (!w) {
            continue;
        }
        if (!p->machine.axis[i]) {
            return tokens_at_word(r, FAULT_AXIS, w);
        }
        const double value = gcode_value(b, i, w);
        end[i] = machine ? value : in->incremental ? end[i] + value
                                                   : value + offsets_zero(in, i);
    }
    return FAULT_NONE;
}

static enum fault arc_centre(const struct interpreter *in, const struct block *b,
                             const double end[AXES], double centre[2], struct fault_report *r)
{
    const int axis[2] = { path_first(in->plane), path_second(in->plane) };
    const struct token *radius = gcode_word(&b->g, 'R');
    const struct token *any = gcode_first(&b->g, CENTRE_LETTERS);
    const struct token *normal = gcode_word(&b->g, CENTRE_LETTERS[in->plane]);

    if (normal) {
        return tokens_at_word(r, FAULT_UNUSED, normal);
    }
    if (radius && any) {
        return tokens_at_line(r, FAULT_CENTRE_AND_R, &b->tokens);
    }
    if (radius) {
        r->value = fabs(radius->value * b->scale);
        const enum path_status s =
            path_centre_by_radius(in->plane, in->point, end, radius->value * b->scale,
                                  in->motion == 3, centre, &r->limit);
        return tokens_at_line(r, of_path(s), &b->tokens);
    }
    for (int i = 0; i < 2; i++) {
        const struct token *w = gcode_word(&b->g, CENTRE_LETTERS[axis[i]]);
        if (!any || (in->absolute_centre && !w)) {
            return tokens_at_line(r, FAULT_NO_CENTRE, &b->tokens);
        }
        const double value = w ? w->value * b->scale : 0.0;
        centre[i] = value + (in->absolute_centre ? offsets_zero(in, axis[i])
                                                 : in->point[axis[i]]);
    }
    return FAULT_NONE;
}

static enum fault arc(const struct interpreter *in, const struct program *p, const struct block *b,
                      const double end[AXES], struct path *path, struct fault_report *r)
{
    const struct token *turns = gcode_word(&b->g, 'P');
    double centre[2];

    if (!p->machine.axis[path_first(in->plane)] ||
        !p->machine.axis[path_second(in->plane)]) {
        return tokens_at_line(r, FAULT_AXIS, &b->tokens);
    }
    if (turns && (turns->value < 1.0 || turns->value > TURNS_MAX ||
                  turns->value != round(turns->value))) {
        return tokens_at_word(r, FAULT_VALUE, turns);
    }
    enum fault f = arc_centre(in, b, end, centre, r);
    if (f == FAULT_NONE) {
        f = of_path(path_arc(path, in->plane, in->point, end, centre, in->motion == 3,
                             turns ? (int)turns->value : 1, &r->value));
        tokens_at_line(r, f, &b->tokens);
    }
    return f;
}

enum fault block_motion(struct interpreter *in, const struct program *p, const struct block *b,
                        struct fault_report *r)
{
    struct command *c = block_command(in);
    double end[AXES];
    enum fault f = end_point(in, p, b, end, r);

    if (f == FAULT_NONE && in->motion >= 2) {
        f = arc(in, p, b, end, &c->path, r);
    } else if (f == FAULT_NONE) {
        path_line(&c->path, in->point, end);
    }
    if (f != FAULT_NONE || c->path.length == 0.0) {
        return f;
    }
    c->blend = in->blend;
    c->tolerance = in->tolerance;
    struct command_refusal why;
    enum command_status s;
    if (in->motion == 0) {
        s = command_ptp(c, &p->machine, &p->limits, &why);
    } else {
        const enum command_type type = in->motion == 1 ? COMMAND_LINE : command_arc_type(&c->path);
        s = command_move(c, &p->machine, &p->limits, type, in->feed, &why);
    }
    accept(in, c);
    return tokens_at_line(r, of_command(s, &why, r), &b->tokens);
}

static enum fault rapid(struct interpreter *in, const struct program *p, const struct block *b,
                        const double end[AXES], struct fault_report *r)
{
    struct command *c = block_command(in);

    path_line(&c->path, in->point, end);
    if (c->path.length == 0.0) {
        return FAULT_NONE;
    }
    struct command_refusal why;
    const enum command_status s = command_ptp(c, &p->machine, &p->limits, &why);
    accept(in, c);
    return tokens_at_line(r, of_command(s, &why, r), &b->tokens);
}

enum fault block_home(struct interpreter *in, const struct program *p, const struct block *b,
                      struct fault_report *r)
{
    const bool all = !gcode_first(&b->g, BLOCK_AXES);
    double via[AXES], home[AXES];
    enum fault f = end_point(in, p, b, via, r);

    for (int i = 0; i < AXES; i++) {
        const bool goes = all ? p->machine.axis[i]
                              : gcode_word(&b->g, BLOCK_AXES[i]) != NULL;
        home[i] = goes ? 0.0 : via[i];
    }
    if (f == FAULT_NONE) {
        f = rapid(in, p, b, via, r);
    }
    return f != FAULT_NONE ? f : rapid(in, p, b, home, r);
}

enum fault block_dwell(struct interpreter *in, const struct block *b, struct fault_report *r)
{
    const struct token *wait = gcode_word(&b->g, 'P'), *extra = gcode_first(&b->g, BLOCK_AXES);

    extra = extra ? extra : gcode_first(&b->g, "IJKR");
    if (extra) {
        return tokens_at_word(r, FAULT_UNUSED, extra);
    }
    if (!wait) {
        return tokens_at_line(r, FAULT_NO_DWELL, &b->tokens);
    }
    if (wait->value < 0.0 || wait->value > DWELL_MAX) {
        return tokens_at_word(r, FAULT_VALUE, wait);
    }
    command_delay(block_command(in), in->point, wait->value);
    in->count++;
    return FAULT_NONE;
}
