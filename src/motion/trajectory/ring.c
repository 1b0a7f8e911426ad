#include "ring.h"

#include <stddef.h>
#include <string.h>

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

void ring_push_asyn(struct ring *r, const struct command *c, const struct axes_limits axis[AXES])
{
    ring_push(r, c);
    memcpy(ring_at(r, r->count - 1)->axis, axis, AXES * sizeof *axis);
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
