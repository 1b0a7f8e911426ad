#include "queue.h"

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
