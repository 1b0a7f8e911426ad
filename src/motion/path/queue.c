#include "queue.h"

#include <math.h>

#include "el_extremes.h"

static const double TURN = 6.283185307179586;

double outputs_spindle(const struct outputs_surface *s, double most, double x)
{
    if (s->speed == 0.0) {
        return most;
    }
    const double speed = s->speed / (TURN * fabs(x - s->centre)) * 60.0; /* no bound at X0 */
    return copysign(el_min(speed, fabs(most)), most);
}

void queue_clear(struct queue *q)
{
    q->head = q->count = 0;
}

void queue_push(struct queue *q, const struct point *p)
{
    q->item[(q->head + q->count) % QUEUE_SIZE] = *p;
    q->count++;
}

const struct point *queue_peek(const struct queue *q, int32_t i)
{
    return &q->item[(q->head + i) % QUEUE_SIZE];
}

void queue_drop(struct queue *q, int32_t n)
{
    q->head = (q->head + n) % QUEUE_SIZE;
    q->count -= n;
}

void queue_keep(struct queue *q, int32_t n)
{
    q->count = n;
}
