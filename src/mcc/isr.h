/* isr - the order in which one interrupt line's many sources are served.
 *
 * The card latches sources on nine pages. At an interrupt the host reads them all, acknowledges what
 * it has read, and serves the pages one after another, the lowest priority number first, pages of one
 * number in their order on the card. The first begins after the interrupt latency, each keeps the PC
 * for its service time. Pages of an earlier interrupt that still wait take part in the new order.
 */
#ifndef ISR_H
#define ISR_H

#include <stdbool.h>
#include <stdint.h>

enum {
    ISR_PAGES = 9,
    ISR_FIFO_PAGE = 0   /* its FIFO source asks for commands, see pcl */
};

struct isr_config {
    int32_t mask[ISR_PAGES];        /* sources let through beside the FIFO */
    int32_t priority[ISR_PAGES];
    int64_t service;                /* [clocks] the PC needs for a page */
};

struct isr {
    struct isr_config config;
    int32_t waiting[ISR_PAGES];     /* sources read and not served */
    int64_t raised[ISR_PAGES];      /* [clock] of the interrupt that brought the first of them */
    int64_t due[ISR_PAGES];         /* [clock] of the page's service */
    int64_t busy;                   /* [clock] up to which the PC serves */

    int32_t order;                  /* services begun so far */
    int32_t served[ISR_PAGES];      /* of each page */
    int32_t sources[ISR_PAGES];     /* that the latest service of the page found */
    int64_t latency[ISR_PAGES];     /* [clocks] of the latest, from the interrupt to its begin */
};

void isr_start(struct isr *q, const struct isr_config *config);

/* These sources were read: line up their pages behind clock `begin`, the FIFO's too if `fifo`.
 * Returns the clock of the FIFO's service, `begin` at the earliest. */
int64_t isr_read(struct isr *q, const int32_t flags[ISR_PAGES], bool fifo, int64_t raised,
                 int64_t begin);

/* Serve the pages due before `end`. */
void isr_run(struct isr *q, int64_t end);

#endif
