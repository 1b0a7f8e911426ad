#include "mover.h"

void mover_unused(const struct mover *p, const struct mover_beside *b, struct spans *s)
{
    spans_ring(s, b->ring->entry, sizeof b->ring->entry[0], RING_SIZE, b->ring->head,
               b->ring->count);
    if (p->motion != MOVER_CHAIN) {
        spans_leave(s, b->mean, b->mean + 1);
    }
    if (b->curve) {
        shape_unused(&b->curve->shape, p->motion == MOVER_CURVE, s);
        pace_unused(&b->curve->pace, p->motion == MOVER_CURVE, s);
    }
}

void queue_unused(const struct queue *q, struct spans *s)
{
    spans_ring(s, q->item, sizeof q->item[0], QUEUE_SIZE, q->head, q->count);
}
