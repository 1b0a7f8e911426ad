#include "ring.h"

#include <stddef.h>

void ring_clear(struct ring *r)
{
    r->head = r->count = 0;
}

bool ring_full(const struct ring *r)
{
    return r->count == RING_SIZE;
}

void ring_push(struct ring *r, const struct command *c)
{
    r->count++;
    ring_at(r, r->count - 1)->command = *c;
}

const struct command *ring_head(const struct ring *r)
{
    return r->count ? &ring_peek(r, 0)->command : NULL;
}

void ring_pop(struct ring *r)
{
    r->head = (r->head + 1) % RING_SIZE;
    r->count--;
}

struct ring_item *ring_at(struct ring *r, int32_t i)
{
    return &r->item[(r->head + i) % RING_SIZE];
}

const struct ring_item *ring_peek(const struct ring *r, int32_t i)
{
    return &r->item[(r->head + i) % RING_SIZE];
}
