#include "irq.h"

static void drive_line(struct irq *q, int64_t clock)
{
    bool up = (q->flags & q->mask) != 0;
    if (up && !q->line) {
        q->seq++;
        q->clock = clock;
    }
    q->line = up;
}

void irq_raise(struct irq *q, int source, int64_t clock)
{
    uint32_t bit = (uint32_t)1 << source;
    q->again |= q->flags & bit;
    q->flags |= bit;
    drive_line(q, clock);
}

void irq_set_mask(struct irq *q, uint32_t mask, int64_t clock)
{
    q->mask = mask;
    drive_line(q, clock);
}

void irq_acknowledge(struct irq *q, uint32_t flags, uint32_t mask, int64_t clock)
{
    q->flags = (q->flags & ~flags) | q->again;
    q->again &= ~flags;
    q->mask = mask;
    q->line = false;
    drive_line(q, clock);
}
