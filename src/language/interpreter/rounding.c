#include "rounding.h"

#include <math.h>
#include <string.h>

#include "block.h"
#include "contour_offset.h"
#include "cutter.h"
#include "elementary.h"
#include "frame.h"

/* A corner whose arc would be shorter is smooth, and stays as it is. [mm] */
static const double SMOOTH = 1e-5;

/* Give a fault the place of the motion that waits, and return it. */
static enum fault at_motion(const struct interpreter *in, enum fault f, struct fault_report *r)
{
    return block_at_line(in, &in->rounding.line, f, r);
}

/* Whether a command is a line or an arc that stays in the plane. */
static bool in_plane(const struct command *c, enum path_plane plane)
{
    bool stays =
        c->type != COMMAND_PTP && !c->path.cubic && (!c->path.arc || c->path.plane == plane);

    for (int i = 0; i < AXES; i++) {
        const bool free = i == path_first(plane) || i == path_second(plane);
        stays = stays && (free || c->path.start[i] == c->path.end[i]);
    }
    return stays;
}

/* Where a chamfer meets a motion: at the distance `size` [mm] from the corner, in front of it (sign
 * -1) or behind it (1). False: no place on the circle of an arc is so far away. */
static bool chamfer_at(const struct contour *s, const double corner[2], double size, double sign,
                       double at[2])
{
    const double *left = sign < 0.0 ? s->last : s->first;
    const double radius = s->radius[sign > 0.0 ? 0 : 1];

    if (s->turn == 0.0) {
        at[0] = corner[0] + sign * size * left[1];
        at[1] = corner[1] - sign * size * left[0];
        return true;
    }
    if (size >= 2.0 * radius) {
        return false;
    }
    const double angle = sign * s->turn * 2.0 * el_asin(size / (2.0 * radius));
    const double x = corner[0] - s->centre[0], y = corner[1] - s->centre[1];
    at[0] = s->centre[0] + el_cos(angle) * x - el_sin(angle) * y;
    at[1] = s->centre[1] + el_sin(angle) * x + el_cos(angle) * y;
    return true;
}

/* Where an arc of ,R touches a motion; its centre is `edge` [mm] to the left of it. */
static void touch_at(const struct contour *s, bool end, double edge, const double centre[2],
                     double at[2])
{
    const double *left = end ? s->last : s->first;
    const double x = centre[0] - s->centre[0], y = centre[1] - s->centre[1];
    const double away = s->radius[end] / el_hypot(x, y);

    at[0] = s->turn == 0.0 ? centre[0] - edge * left[0] : s->centre[0] + away * x;
    at[1] = s->turn == 0.0 ? centre[1] - edge * left[1] : s->centre[1] + away * y;
}

/* The chamfer or arc between two motions: its ends and its centre [mm], its sense. */
struct piece {
    double from[2], to[2], centre[2];
    bool ccw;
};

/* Find it for a corner that turns by an angle [rad]; false: there is no room. */
static bool piece_of(const struct rounding *k, const struct contour *a, const struct contour *b,
                     double angle, struct piece *q)
{
    const double edge = angle > 0.0 ? k->size : -k->size;
    double other[2];

    if (k->chamfer) {
        return chamfer_at(a, a->end, k->size, -1.0, q->from)
               && chamfer_at(b, a->end, k->size, 1.0, q->to);
    }
    if (!contour_fits(a, edge) || !contour_fits(b, edge)) {
        return false;
    }
    const enum contour_corner kind = contour_corner(a, b, edge, q->centre, other);
    touch_at(a, true, edge, q->centre, q->from);
    touch_at(b, false, edge, q->centre, q->to);
    q->ccw = angle > 0.0;
    return kind == CONTOUR_CONCAVE || kind == CONTOUR_JOINED;
}

/* Its path; false: there is none. */
static bool between(const struct rounding *k, const struct piece *q, struct path *path)
{
    const int a = path_first(k->plane), b = path_second(k->plane);
    double start[AXES], end[AXES], miss;

    memcpy(start, k->held.path.end, sizeof start);
    memcpy(end, k->held.path.end, sizeof end);
    start[a] = q->from[0];
    start[b] = q->from[1];
    end[a] = q->to[0];
    end[b] = q->to[1];
    if (k->chamfer) {
        path_line(path, start, end);
        return true;
    }
    return path_arc(path, k->plane, start, end, q->centre, q->ccw, 1, &miss) == PATH_OK;
}

/* Join the motion made last to the one that waits: the commands are that one, shortened, the
 * chamfer or arc, and the motion, shortened. */
static enum fault join(struct interpreter *in, const struct program *p, struct fault_report *r)
{
    struct rounding *k = &in->rounding;
    const struct command second = in->made[in->count - 1];
    struct command held = k->held, corner = k->held, next = second;
    struct contour a, b;
    struct piece q;

    k->waits = false;
    if (in->count > 1 || !in_plane(&next, k->plane)) {
        return at_motion(in, FAULT_ROUND_NEXT, r);
    }
    contour_of(&a, &held.path, k->plane);
    contour_of(&b, &next.path, k->plane);
    const double angle = el_atan2(a.last[0] * b.first[1] - a.last[1] * b.first[0],
                                  a.last[0] * b.first[0] + a.last[1] * b.first[1]);
    const bool smooth = fabs(angle * k->size) < SMOOTH;
    const enum path_plane n = k->plane;
    if (!smooth
        && (!piece_of(k, &a, &b, angle, &q)
            || !contour_path(&a, &k->held.path, n, a.start, q.from, false, &held.path)
            || !contour_path(&b, &second.path, n, q.to, b.end, false, &next.path)
            || !between(k, &q, &corner.path))) {
        return at_motion(in, FAULT_ROUND_SHORT, r);
    }
    corner.set = corner.clear = corner.analog.set = 0;
    const struct command all[] = { held, corner, next };
    enum fault f = FAULT_NONE;
    in->count = 0;
    for (int i = 0; i < 3 && f == FAULT_NONE; i++) {
        if (i == 1 && smooth) {
            continue;
        }
        struct command *c = &in->made[in->count++];
        *c = all[i];
        f = smooth || cutter_on(in) ? FAULT_NONE : block_complete(c, p, r);
    }
    return f == FAULT_NONE ? f : at_motion(in, f, r);
}

/* Let the motion made last wait for the next one; w is its ,C or ,R. */
static enum fault hold(struct interpreter *in, const struct block *b, const struct token *w,
                       struct fault_report *r)
{
    struct rounding *k = &in->rounding;
    double ratio;
    bool mirrored;

    if (!(w->value >= 0.0)) {
        return tokens_at_word(r, FAULT_VALUE, w);
    }
    if (!frame_circles(in, in->plane, &ratio, &mirrored)) {
        return tokens_at_line(r, FAULT_OVAL, &b->tokens);
    }
    if (!in_plane(&in->made[in->count - 1], in->plane)) {
        return tokens_at_line(r, FAULT_ROUND_NEXT, &b->tokens);
    }
    k->size = w->value * b->scale * ratio;
    k->chamfer = w->letter == TOKENS_CHAMFER;
    k->plane = in->plane;
    k->held = in->made[--in->count];
    k->before = in->count;
    k->line = block_line(in, b, r);
    k->waits = k->fresh = true;
    return FAULT_NONE;
}

enum fault rounding_block(struct interpreter *in, const struct program *p, const struct block *b,
                          int32_t before, struct fault_report *r)
{
    const struct token *c = gcode_word(&b->g, TOKENS_CHAMFER);
    const struct token *round = gcode_word(&b->g, TOKENS_ROUND);
    const struct token *w = c ? c : round;
    enum fault f = FAULT_NONE;

    if (c && round) {
        return tokens_at_word(r, FAULT_UNUSED, round);
    }
    if (in->rounding.waits && b->g.code[GCODE_CUTTER] != GCODE_ABSENT) {
        return at_motion(in, FAULT_ROUND_NEXT, r);
    }
    if (in->count == before) {
        return w ? tokens_at_word(r, FAULT_ROUND_SHORT, w) : FAULT_NONE;
    }
    if (in->rounding.waits) {
        f = join(in, p, r);
    }
    return f == FAULT_NONE && w && w->value != 0.0 ? hold(in, b, w, r) : f;
}

enum fault rounding_missed(const struct interpreter *in, struct fault_report *r)
{
    const struct rounding *k = &in->rounding;
    const bool other = in->count > (k->fresh ? k->before : 0) || in->ended || in->waits;

    return k->waits && other ? at_motion(in, FAULT_ROUND_NEXT, r) : FAULT_NONE;
}
