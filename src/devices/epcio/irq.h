/* irq - the card's interrupt latch: flags of all interrupt sources in nine pages, a mask, and the
 * one interrupt line to the host, which acknowledges flags. */
#ifndef IRQ_H
#define IRQ_H

#include <stdbool.h>
#include <stdint.h>

/* Pages of the interrupt source register, in the order the card's driver reads them. */
enum irq_page {
    IRQ_DDA,
    IRQ_ENC0, /* encoders 1 to 3 */
    IRQ_ENC3, /* encoders 4 to 6 */
    IRQ_ENC6, /* encoders 7 to 9 */
    IRQ_RIO0, /* remote I/O, first set of slaves */
    IRQ_RIO1, /* second set */
    IRQ_ADC,
    IRQ_LIO, /* local I/O and timer */
    IRQ_PCL, /* position loops */
    IRQ_PAGES,
};

/* First bit of each source in its page; a source of several channels has consecutive bits. */
enum {
    IRQ_DDA_FIFO = 0,       /* 6 bits: minimum stock */
    IRQ_DDA_CYCLE = 6,      /* DDA boundary */
    IRQ_ENC_COMP = 0,       /* 3 bits: counter at or beyond its compare value */
    IRQ_ENC_INDEX = 3,      /* 3 bits: index pulse */
    IRQ_RIO_DI = 0,         /* 4 bits per slave: its first four inputs */
    IRQ_RIO_FAIL = 12,      /* transmission failure */
    IRQ_RIO_NOT_READY = 13, /* a slave did not answer when it was switched on */
    IRQ_ADC_COMP = 0,       /* 8 bits: compare condition met */
    IRQ_ADC_CONV = 8,       /* a conversion is done */
    IRQ_ADC_TAG = 9,        /* the tagged channels have all been converted */
    IRQ_LIO_LDI = 0,        /* 8 bits: local inputs */
    IRQ_LIO_DFI = 8,        /* 7 bits: dual-function inputs */
    IRQ_LIO_TIMER = 15,     /* timer */
    IRQ_PCL_OV = 0,         /* 7 bits: error counter overflow */
};

struct irq {
    uint32_t flags[IRQ_PAGES]; /* sources that fired and were not acknowledged */
    uint32_t again[IRQ_PAGES]; /* those of `flags` that fired once more before the acknowledge */
    uint32_t mask[IRQ_PAGES];  /* sources that pull the line */
    bool line;                 /* level of the line: flags & mask is not 0 in some page */
    uint32_t seq;              /* number of rising edges of the line */
    int64_t clock;             /* [clock] of the latest rising edge */
};

/* The sources `bits` of a page fire. A second firing before the acknowledge is kept beside the
 * first. Events between two instants are raised at the later one: if `clock` is before the line's
 * latest rising edge, the edge moves there. */
void irq_raise(struct irq *q, enum irq_page page, uint32_t bits, int64_t clock);

/* Choose which sources pull the line. */
void irq_set_mask(struct irq *q, const uint32_t mask[IRQ_PAGES], int64_t clock);

/* The host clears the flags that it has read, and sets the mask in the same write. A flag whose
 * source fired again meanwhile stays up, so no firing that the host has not seen is lost. The line
 * is released; if a flag still pulls it, it rises anew at this clock. */
void irq_acknowledge(struct irq *q, const uint32_t flags[IRQ_PAGES], const uint32_t mask[IRQ_PAGES],
                     int64_t clock);

#endif
