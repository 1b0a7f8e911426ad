#include "irq.h"

#include <string.h>

static void drive_line(struct irq *q, int64_t clock)
{
    uint32_t pulling = 0;
    for (int i = 0; i < IRQ_PAGES; i++)
        pulling |= q->flags[i] & q->mask[i];
    bool up = pulling != 0;
    if (up && !q->line) {
        q->seq++;
        q->clock = clock;
    }
    q->line = up;
}

void irq_raise(struct irq *q, enum irq_page page, uint32_t bits, int64_t clock)
{
    q->again[page] |= q->flags[page] & bits;
    q->flags[page] |= bits;
    if ((bits & q->mask[page]) == 0)
        return;
    if (!q->line)
        drive_line(q, clock);
    else if (clock < q->clock)
        q->clock = clock; /* raised later, but it happened first */
}

void irq_set_mask(struct irq *q, const uint32_t mask[IRQ_PAGES], int64_t clock)
{
    if (memcmp(q->mask, mask, sizeof q->mask) == 0)
        return;
    memcpy(q->mask, mask, sizeof q->mask);
    drive_line(q, clock);
}

void irq_acknowledge(struct irq *q, const uint32_t flags[IRQ_PAGES], const uint32_t mask[IRQ_PAGES],
                     int64_t clock)
{
    for (int i = 0; i < IRQ_PAGES; i++) {
        q->flags[i] = (q->flags[i] & ~flags[i]) | q->again[i];
        q->again[i] &= ~flags[i];
    }
    memcpy(q->mask, mask, sizeof q->mask);
    q->line = false;
    drive_line(q, clock);
}
