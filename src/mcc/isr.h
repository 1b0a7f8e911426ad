/* isr - the order in which one interrupt line's many sources are served.
 *
 * The card latches sources on nine pages. At an interrupt the host reads them all, acknowledges
 * what it has read, and serves the pages one after another, the lowest priority number first, pages
 * of one number in their order on the card. The first begins after the interrupt latency, each
 * keeps the PC for its service time. Pages of an earlier interrupt that still wait join the new
 * order.
 */
#ifndef ISR_H
#define ISR_H

#include <stdint.h>

enum {
    ISR_PAGES = 9,
    ISR_FIFO_PAGE = 0,  /* its FIFO source asks for commands, see pcl */
    ISR_LOOP_PAGE = 8   /* overflow of the error counters, a bit an axis */
};

struct isr_config {
    int32_t mask[ISR_PAGES];        /* sources served beside the FIFO */
    int32_t priority[ISR_PAGES];
    int64_t service;                /* [clocks] the PC needs for a page */
};

struct isr {
    struct isr_config config;
    int32_t waiting[ISR_PAGES];     /* sources read and not served */
    int64_t raised[ISR_PAGES];      /* [clock] of the interrupt that brought the first of them */
    int64_t due[ISR_PAGES];         /* [clock] of the page's service */
    int64_t busy;                   /* [clock] up to which the PC serves */
    int     page;                   /* served until then; -1 before the first */

    int32_t order;                  /* services begun so far */
    int32_t served[ISR_PAGES];      /* of each page */
    int32_t sources[ISR_PAGES];     /* that the latest service of the page found */
    int64_t latency[ISR_PAGES];     /* [clocks] of the latest, from the interrupt to its begin */
};

void isr_start(struct isr *q, const struct isr_config *config);

/* These sources were read, `fifo` being the one that asks for commands: line up their pages behind
 * clock `begin`. Returns the clock at which the FIFO's page is served; `begin` if it does not
 * wait. */
int64_t isr_read(struct isr *q, const int32_t flags[ISR_PAGES], int32_t fifo, int64_t raised,
                 int64_t begin);

/* Mark the pages served that are due before `end`. */
void isr_run(struct isr *q, int64_t end);

#endif
