/* Interrupt latch: many sources, one line to the host. */
#ifndef IRQ_H
#define IRQ_H

#include <stdbool.h>
#include <stdint.h>

/* Bit numbers of the sources. */
enum {
    IRQ_FIFO = 0,       /* 6: minimum stock */
    IRQ_CYCLE = 6,      /* DDA boundary */
    IRQ_OVERFLOW = 7,   /* 6: error counter */
    IRQ_INDEX = 13,     /* 9: encoder index */
    IRQ_SOURCES = 22,
};

struct irq {
    uint32_t flags;     /* sources that fired and were not acknowledged */
    uint32_t again;     /* of these, the ones that fired once more since */
    uint32_t mask;      /* sources that pull the line */
    bool     line;      /* (flags & mask) != 0 */
    uint32_t seq;       /* rising edges of the line */
    int64_t  clock;     /* [clock] of the latest rising edge */
};

/* A source fires. A second firing before the acknowledge is kept beside the first. */
void irq_raise(struct irq *q, int source, int64_t clock);

/* Choose which sources pull the line. */
void irq_set_mask(struct irq *q, uint32_t mask, int64_t clock);

/* The host acknowledges what it saw, and sets the mask in the same write. A flag whose source fired
 * again meanwhile stays up, so no firing that the host has not seen is lost. The line is released;
 * if a flag still pulls it, it rises anew at this clock. */
void irq_acknowledge(struct irq *q, uint32_t flags, uint32_t mask, int64_t clock);

#endif
