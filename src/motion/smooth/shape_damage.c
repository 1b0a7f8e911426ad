/* shape_damage - whether counts and places of a chain are such that it stays within its arrays. */
#include <math.h>

#include "shape.h"

static bool within(int64_t x, int64_t low, int64_t high)
{
    return x >= low && x <= high;
}

static bool piece_good(const struct piece *p)
{
    return within(p->kind, PIECE_LINE, PIECE_CUBIC) && p->length > 0.0 && isfinite(p->length)
        && (p->kind != PIECE_ARC || (p->path.arc && !p->path.cubic
                                     && within(p->path.plane, PATH_YZ, PATH_TILTED)))
        && (p->kind != PIECE_CUBIC || (p->path.cubic && !p->path.arc));
}

/* Each command without a place waits at one vertex, or for the next command. */
static bool run_good(const struct shape *s)
{
    const struct shape_run *r = &s->run;
    int64_t waiting = s->marks_loose;

    if (!within(r->vertices, 1, SHAPE_VERTICES) || !within(r->placed, 1, r->vertices)
        || !within(r->spans, 0, SHAPE_SPANS) || !within(r->kept, 0, SHAPE_SPANS + 3)
        || !within(s->looked, 0, r->vertices - 1)
        || !within(s->grabbed, 0, s->exact ? r->vertices - 1 : 0)
        || !within(s->closing, SHAPE_OPEN, SHAPE_BY_END)) {
        return false;
    }
    for (int32_t k = 0; k < r->vertices; k++) {
        if (!within(r->vertex[k].marks, 0, SHAPE_MARKS)) {
            return false;
        }
        waiting += r->vertex[k].marks;
    }
    return waiting == s->marks - s->marks_set
        && (s->closing != SHAPE_BY_LONG || piece_good(&s->next));
}

bool shape_damaged(const struct shape *s)
{
    const int64_t most = INT64_MAX / 4;

    if (!within(s->made, 0, most) || !within(s->gone, 0, s->made)
        || s->made - s->gone > SHAPE_PIECES || !within(s->stretch, 0, s->made + SHAPE_HELD)
        || !within(s->corner_stretch, 0, s->made + SHAPE_HELD)
        || (s->corner && s->corner_made != s->made) || shape_count(s) < 0
        || !within(s->tail_points, 0, SHAPE_TAIL) || !within(s->marks, 0, most)
        || !within(s->marks_set, 0, s->marks) || !within(s->marks_gone, 0, s->marks_set)
        || s->marks - s->marks_gone > SHAPE_MARKS
        || !within(s->marks_loose, 0, s->marks - s->marks_set)) {
        return true;
    }
    for (int64_t k = s->gone; k < s->made; k++) {
        if (!piece_good(&s->piece[k % SHAPE_PIECES])) {
            return true;
        }
    }
    return (s->exact && !piece_good(&s->whole)) || (s->running && !run_good(s));
}

void shape_unused(const struct shape *s, bool on, struct spans *u)
{
    const struct shape_run *r = &s->run;
    const int64_t pieces = on ? s->made - s->gone : 0, marks = on ? s->marks - s->marks_gone : 0;

    if (!on) {
        spans_leave(u, s->tail, s->tail + SHAPE_TAIL);
    }
    if (on && s->running) {
        spans_leave(u, r->vertex + r->vertices, r->vertex + SHAPE_VERTICES);
    } else {
        spans_leave(u, r->control, r->vertex + SHAPE_VERTICES);
    }
    spans_ring(u, s->piece, sizeof s->piece[0], SHAPE_PIECES, (int32_t)(s->gone % SHAPE_PIECES),
               (int32_t)pieces);
    spans_ring(u, s->mark, sizeof s->mark[0], SHAPE_MARKS, (int32_t)(s->marks_gone % SHAPE_MARKS),
               (int32_t)marks);
}
