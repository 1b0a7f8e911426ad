#include "bus.h"

bool bus_post(struct bus *b, const struct bus_write *w)
{
    if (b->used == BUS_DEPTH)
        return false;
    b->slot[(b->head + b->used) % BUS_DEPTH] = *w;
    b->used++;
    return true;
}

int64_t bus_due(const struct bus *b)
{
    return b->used > 0 ? b->slot[b->head].clock : INT64_MAX;
}

struct bus_write bus_take(struct bus *b)
{
    struct bus_write w = b->slot[b->head];
    b->head = (b->head + 1) % BUS_DEPTH;
    b->used--;
    return w;
}
