#include "cutter.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "block.h"
#include "contour_offset.h"
#include "el_extremes.h"
#include "elementary.h"
#include "frame.h"
#include "tools.h"

/* Command i of those that are held, from 0, the oldest. */
static struct command *held(struct cutter *k, int32_t i)
{
    return &k->held[(k->first + i) % CUTTER_HELD];
}

/* Hold a command behind all others. */
static void hold(struct cutter *k, const struct command *c)
{
    *held(k, k->count++) = *c;
}

/* Whether a command moves in the plane. */
static bool in_plane(const struct command *c, enum path_plane plane)
{
    const int a = path_first(plane), b = path_second(plane);
    return c->path.arc || c->path.start[a] != c->path.end[a] || c->path.start[b] != c->path.end[b];
}

/* Give a fault the place of the motion held, and return it. */
static enum fault at_motion(const struct interpreter *in, enum fault f, struct fault_report *r)
{
    return f != FAULT_NONE ? block_at_line(in, &in->cutter.moving, f, r) : f;
}

/* Move a command, which has no motion in the plane, to where the tool's centre stands. */
static enum fault follow_place(struct command *c, const struct program *p, enum path_plane plane,
                               const double place[2], struct fault_report *r)
{
    if (!command_lasts(c)) {
        return FAULT_NONE;
    }
    double start[AXES], end[AXES];
    memcpy(start, c->path.start, sizeof start);
    memcpy(end, c->path.end, sizeof end);
    start[path_first(plane)] = end[path_first(plane)] = place[0];
    start[path_second(plane)] = end[path_second(plane)] = place[1];
    path_line(&c->path, start, end);
    return block_complete(c, p, r);
}

/* End the motion held where the tool's centre is at `to`, in front of a concave corner or not; all
 * that is held becomes ready. A fault has the place of that motion. */
static enum fault end_at(struct interpreter *in, const struct program *p, const double to[2],
                         bool concave, struct fault_report *r)
{
    struct cutter *k = &in->cutter;
    const bool back = k->enters || !(k->concave || concave);
    struct command *c = held(k, 0);
    const struct path along = c->path;
    struct contour s;

    contour_of(&s, &along, k->plane);
    const bool found = k->enters && along.arc
                           ? contour_entry(&s, &along, k->plane, to, &c->path)
                           : contour_path(&s, &along, k->plane, k->from, to, back, &c->path);
    if (!found) {
        return at_motion(in, k->enters ? FAULT_CUTTER_ENTRY : FAULT_CUTTER_SHORT, r);
    }
    enum fault f = at_motion(in, block_complete(c, p, r), r);
    for (int32_t i = 1; i < k->count && f == FAULT_NONE; i++) {
        f = follow_place(held(k, i), p, k->plane, to, r);
    }
    k->ready = k->count;
    k->moves = k->enters = false;
    return f;
}

/* Make the arc of the tool's centre about the corner in front of the motion `next`, with its feed;
 * if that is a rapid, with the feed of the motion before. Between two rapids it is a line. */
static enum fault turn_corner(struct interpreter *in, const struct program *p,
                              const struct command *before, const struct command *next,
                              const double from[2], const double to[2], struct fault_report *r)
{
    const enum path_plane plane = in->cutter.plane;
    const int a = path_first(plane), b = path_second(plane);
    const bool feeds = next->type != COMMAND_PTP;
    const double centre[2] = { next->path.start[a], next->path.start[b] };
    struct command c = feeds ? *next : *before;
    double start[AXES], end[AXES], miss;

    memcpy(start, next->path.start, sizeof start);
    memcpy(end, next->path.start, sizeof end);
    start[a] = from[0];
    start[b] = from[1];
    end[a] = to[0];
    end[b] = to[1];
    c.line = next->line;
    c.set = c.clear = 0;
    if (c.type == COMMAND_PTP) {
        path_line(&c.path, start, end);
    } else if (path_arc(&c.path, plane, start, end, centre, in->cutter.edge < 0.0, 1, &miss)
               != PATH_OK) {
        return FAULT_CUTTER_CORNER;
    }
    const enum fault f = block_complete(&c, p, r);
    hold(&in->cutter, &c);
    in->cutter.ready = in->cutter.count;
    return f;
}

/* A motion in the plane has come behind one that is held: find the corner, and end that one. */
static enum fault corner(struct interpreter *in, const struct program *p, const struct command *c,
                         struct fault_report *r)
{
    struct cutter *k = &in->cutter;
    const struct command before = *held(k, 0);
    const bool entry_arc = k->enters && before.path.arc;
    struct contour a, b;
    double from[2], to[2];

    contour_of(&a, &before.path, k->plane);
    contour_of(&b, &c->path, k->plane);
    const enum contour_corner kind = contour_corner(&a, &b, k->edge, from, to);
    if (kind == CONTOUR_BACK || kind == CONTOUR_DEEP) {
        return kind == CONTOUR_BACK ? FAULT_CUTTER_BACK : FAULT_CUTTER_CORNER;
    }
    if (entry_arc && kind != CONTOUR_CONVEX) {
        contour_beside(&a, true, k->edge, from); /* only a smooth corner can follow it */
        if (el_hypot(from[0] - to[0], from[1] - to[1]) > 1e-5) {
            return FAULT_CUTTER_ENTRY;
        }
        memcpy(to, from, sizeof to);
    }
    enum fault f = end_at(in, p, from, kind == CONTOUR_CONCAVE, r);
    if (f == FAULT_NONE && kind == CONTOUR_CONVEX) {
        f = turn_corner(in, p, &before, c, from, to, r);
    }
    memcpy(k->from, to, sizeof k->from);
    k->concave = kind == CONTOUR_CONCAVE;
    return f;
}

static enum fault follow(struct interpreter *in, const struct program *p, const struct command *c,
                         struct fault_report *r)
{
    struct cutter *k = &in->cutter;
    struct contour s;

    if (!command_lasts(c) || c->type == COMMAND_DELAY || !in_plane(c, k->plane)) {
        if (k->count > CUTTER_HELD - 3) {
            return FAULT_CUTTER_FULL;
        }
        hold(k, c);
        k->ready += !k->moves;
        return k->moves ? FAULT_NONE : block_complete(held(k, k->count - 1), p, r);
    }
    contour_of(&s, &c->path, k->plane);
    if (!contour_fits(&s, k->edge)) {
        r->value = el_min(s.radius[0], s.radius[1]);
        r->limit = fabs(k->edge);
        return FAULT_CUTTER_ARC;
    }
    enum fault f = FAULT_NONE;
    if (k->moves) {
        f = corner(in, p, c, r);
    } else {
        memcpy(k->from, s.start, sizeof k->from);
        k->enters = true;
        k->concave = false;
        r->value = el_hypot(s.end[0] - s.start[0], s.end[1] - s.start[1]);
        r->limit = fabs(k->edge);
        f = r->value > r->limit ? FAULT_NONE : FAULT_CUTTER_ENTRY;
    }
    k->moves = true;
    k->moving = k->latest;
    hold(k, c);
    return f;
}

enum fault cutter_follow(struct interpreter *in, const struct program *p, const struct command *c,
                         struct fault_report *r)
{
    block_at_line(in, &in->cutter.latest, FAULT_NONE, r);
    return follow(in, p, c, r);
}

enum fault cutter_end(struct interpreter *in, const struct program *p, struct fault_report *r)
{
    struct cutter *k = &in->cutter;
    enum fault f = FAULT_NONE;

    if (k->moves) {
        struct contour s;
        double *const a = &in->point[path_first(k->plane)];
        double *const b = &in->point[path_second(k->plane)];
        double to[2];
        contour_of(&s, &held(k, 0)->path, k->plane);
        contour_beside(&s, true, k->edge, to);
        f = end_at(in, p, to, false, r);
        k->left[0] = *a;
        k->left[1] = *b;
        *a = k->from[0] = to[0];
        *b = k->from[1] = to[1];
        k->aside = true;
    }
    k->edge = 0.0;
    k->side = 0;
    return f;
}

bool cutter_take(struct interpreter *in, struct command *c)
{
    struct cutter *k = &in->cutter;

    if (k->ready == 0) {
        return false;
    }
    *c = *held(k, 0);
    k->first = (k->first + 1) % CUTTER_HELD;
    k->ready--;
    k->count--;
    return true;
}

void cutter_drop(struct interpreter *in)
{
    memset(&in->cutter, 0, sizeof in->cutter);
}

/* Set the distance of the tool's centre to the left of the contour, and the plane.
 * CCN 16: the diameter stands in the block, in the table or with the tool that is loaded. */
static enum fault set_edge(struct interpreter *in, const struct block *b, struct fault_report *r)
{
    const int code = b->g.code[GCODE_CUTTER];
    const struct token *d = gcode_word(&b->g, 'D'), *by = b->g.by[GCODE_CUTTER];
    const bool direct = code == 411 || code == 421;
    double diameter = 0.0, ratio;
    bool mirrored;

    if (direct && !d) {
        return tokens_at_word(r, FAULT_MISSING, by);
    }
    if (direct) {
        diameter = d->value * b->scale;
    } else if (d && (d->value < 0.0 || d->value > INT32_MAX || d->value != round(d->value))) {
        return tokens_at_word(r, FAULT_VALUE, d);
    } else if (d ? d->value != 0.0 : in->tools.loaded != 0) {
        const int32_t number = d ? (int32_t)d->value : in->tools.loaded;
        if (!tools_diameter(in, number, &diameter)) {
            return tokens_at_word(r, FAULT_TOOL, d ? d : by);
        }
    }
    in->cutter.side = code < 420 ? 1 : -1;
    frame_circles(in, in->plane, &ratio, &mirrored); /* left becomes right in a mirror */
    in->cutter.edge = (mirrored ? -0.5 : 0.5) * in->cutter.side * diameter;
    in->cutter.plane = in->plane;
    return FAULT_NONE;
}

/* The word of the block that may not come while compensation is on, or NULL. */
static const struct token *refused(const struct interpreter *in, const struct block *b)
{
    static const enum gcode_group groups[] = { GCODE_SYSTEM, GCODE_TOOL, GCODE_SCALING,
                                               GCODE_ROTATION, GCODE_CHANGE };
    const int nonmodal = b->g.code[GCODE_NONMODAL], io = b->g.code[GCODE_IO];

    for (size_t i = 0; i < sizeof groups / sizeof *groups; i++) {
        if (b->g.by[groups[i]]) {
            return b->g.by[groups[i]];
        }
    }
    if (nonmodal != GCODE_ABSENT && nonmodal != 40) {
        return b->g.by[GCODE_NONMODAL];
    }
    if (io == 660) {
        return b->g.by[GCODE_IO];
    }
    if (in->motion > 30 && in->motion != GCODE_NO_MOTION) { /* splines, probing, cycles */
        return b->g.by[GCODE_MOTION] ? b->g.by[GCODE_MOTION] : gcode_first(&b->g, BLOCK_AXES);
    }
    return NULL;
}

/* CCN 20: a row of rules of G40 to G42, each with its fault, in the order in which they are
 * told. */
enum fault cutter_block(struct interpreter *in, const struct program *p, const struct block *b,
                        struct fault_report *r)
{
    struct cutter *k = &in->cutter;
    const int code = b->g.code[GCODE_CUTTER];
    const struct token *by = b->g.by[GCODE_CUTTER], *axis = gcode_first(&b->g, "XYZ");
    enum fault f = FAULT_NONE;

    k->aside = k->aside && in->point[path_first(k->plane)] == k->from[0]
               && in->point[path_second(k->plane)] == k->from[1];
    if (code == 400) {
        k->straight = k->straight || k->edge != 0.0;
        f = cutter_end(in, p, r);
    } else if (code != GCODE_ABSENT && k->side != 0) {
        return tokens_at_word(r, FAULT_CUTTER_ON, by);
    } else if (code != GCODE_ABSENT && in->plane == PATH_YZ) {
        return tokens_at_word(r, FAULT_CUTTER_PLANE, by);
    } else if (code != GCODE_ABSENT) {
        f = set_edge(in, b, r);
    }
    if (f != FAULT_NONE) {
        return f;
    }
    if (k->side != 0 && in->plane != k->plane) {
        return tokens_at_word(r, FAULT_CUTTER_PLANE, b->g.by[GCODE_PLANE]);
    }
    if (k->side != 0 && refused(in, b)) {
        return tokens_at_word(r, FAULT_CUTTER_WORD, refused(in, b));
    }
    if (k->straight && gcode_arc(in->motion) && (axis || gcode_first(&b->g, "IJKR"))) {
        return tokens_at_line(r, FAULT_CUTTER_EXIT, &b->tokens);
    }
    k->straight = k->straight && !axis;
    k->latest = block_line(in, b, r);
    return FAULT_NONE;
}
