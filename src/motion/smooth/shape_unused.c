#include "shape.h"

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
