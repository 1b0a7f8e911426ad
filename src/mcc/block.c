#include "block.h"

#include <math.h>
#include <string.h>

static const char AXIS_LETTERS[] = "XYZUVW";
static const char CENTRE_LETTERS[] = "IJK";
static const int TURNS_MAX = 10000;         /* P of an arc */

const struct token *block_first(const struct block *b, const char *letters)
{
    for (; *letters; letters++) {
        if (gcode_word(&b->g, *letters)) {
            return gcode_word(&b->g, *letters);
        }
    }
    return NULL;
}

/* End point of the block in machine coordinates. */
static enum fault end_point(const struct interpreter *in, const struct program *p,
                            const struct block *b, double end[AXES], struct fault_report *r)
{
    const bool machine = b->g.code[GCODE_NONMODAL] == 530;

    for (int i = 0; i < AXES; i++) {
        const struct token *w = gcode_word(&b->g, AXIS_LETTERS[i]);
        end[i] = in->point[i];
        if (!w) {
            continue;
        }
        if (!p->machine->axis[i].used) {
            return tokens_at_word(r, FAULT_AXIS, w);
        }
        const double value = w->value * b->scale;
        end[i] = machine ? value : in->incremental ? end[i] + value
                                                   : value + p->offset[in->system][i];
    }
    return FAULT_NONE;
}

static enum fault arc_centre(const struct interpreter *in, const struct program *p,
                             const struct block *b, const double end[AXES], double centre[2],
                             struct fault_report *r)
{
    const int axis[2] = { path_first(in->plane), path_second(in->plane) };
    const struct token *radius = gcode_word(&b->g, 'R');
    const struct token *any = block_first(b, CENTRE_LETTERS);
    const struct token *normal = gcode_word(&b->g, CENTRE_LETTERS[in->plane]);

    if (normal) {
        return tokens_at_word(r, FAULT_UNUSED, normal);
    }
    if (radius && any) {
        return tokens_at_line(r, FAULT_CENTRE_AND_R, &b->tokens);
    }
    if (radius) {
        r->value = fabs(radius->value * b->scale);
        const enum fault f = path_centre_by_radius(in->plane, in->point, end,
                                                   radius->value * b->scale, in->motion == 3,
                                                   centre, &r->limit);
        return tokens_at_line(r, f, &b->tokens);
    }
    for (int i = 0; i < 2; i++) {
        const struct token *w = gcode_word(&b->g, CENTRE_LETTERS[axis[i]]);
        if (!any || (in->absolute_centre && !w)) {
            return tokens_at_line(r, FAULT_NO_CENTRE, &b->tokens);
        }
        const double value = w ? w->value * b->scale : 0.0;
        centre[i] = value + (in->absolute_centre ? p->offset[in->system][axis[i]]
                                                 : in->point[axis[i]]);
    }
    return FAULT_NONE;
}

static enum fault arc(const struct interpreter *in, const struct program *p, const struct block *b,
                      const double end[AXES], struct path *path, struct fault_report *r)
{
    const struct token *turns = gcode_word(&b->g, 'P');
    double centre[2];

    if (!p->machine->axis[path_first(in->plane)].used ||
        !p->machine->axis[path_second(in->plane)].used) {
        return tokens_at_line(r, FAULT_AXIS, &b->tokens);
    }
    if (turns && (turns->value < 1.0 || turns->value > TURNS_MAX ||
                  turns->value != round(turns->value))) {
        return tokens_at_word(r, FAULT_VALUE, turns);
    }
    enum fault f = arc_centre(in, p, b, end, centre, r);
    if (f == FAULT_NONE) {
        f = path_arc(path, in->plane, in->point, end, centre, in->motion == 3,
                     turns ? (int)turns->value : 1, &r->value);
        tokens_at_line(r, f, &b->tokens);
    }
    return f;
}

enum fault block_motion(struct interpreter *in, const struct program *p, const struct block *b,
                         struct command *c, struct fault_report *r)
{
    double end[AXES];
    enum fault f = end_point(in, p, b, end, r);
    if (f != FAULT_NONE) {
        return f;
    }
    if (in->motion >= 2) {
        f = arc(in, p, b, end, &c->path, r);
    } else {
        path_line(&c->path, in->point, end);
    }
    if (f != FAULT_NONE) {
        return f;
    }
    if (c->path.length > 0.0) {
        c->blend = in->blend;
        c->line = in->line;
        if (in->motion == 0) {
            f = command_ptp(c, p->machine);
        } else {
            f = command_move(c, p->machine,
                             in->motion == 1 ? COMMAND_LINE : command_arc_type(&c->path),
                             in->feed, r);
        }
        memcpy(in->point, end, sizeof in->point);
    }
    return tokens_at_line(r, f, &b->tokens);
}
