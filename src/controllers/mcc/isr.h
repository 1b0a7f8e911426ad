/* isr - the order in which one interrupt line's many sources are served.
 *
 * The card latches sources on nine pages. At an interrupt the host reads them all, acknowledges
 * what it has read, and serves the pages one after another, the lowest priority number first, pages
 * of one number in their order on the card. They may begin when the latency of the interrupt has
 * passed; pages of an earlier one that still wait join the new order, but for a FIFO that asks. A
 * page is not interrupted by another. When the PC serves it is for pc to say.
 */
#ifndef ISR_H
#define ISR_H

#include <stdbool.h>
#include <stdint.h>

enum {
    ISR_PAGES = 9,
    ISR_FIFO_PAGE = 0, /* its FIFO source asks for commands, see pcl */
    ISR_LOOP_PAGE = 8  /* overflow of the error counters, a bit an axis */
};

struct isr_config {
    int32_t mask[ISR_PAGES]; /* sources served beside the FIFO */
    int32_t priority[ISR_PAGES];
    int64_t service; /* [clocks] the PC needs for a page */
};

struct isr {
    struct isr_config config;
    int32_t waiting[ISR_PAGES]; /* sources read and not served */
    int64_t raised[ISR_PAGES];  /* [clock] of the interrupt that brought the first of them */
    int64_t ready[ISR_PAGES];   /* [clock] from which it may be served */
    int page;                   /* served last; -1 before the first */

    int32_t order;              /* services begun so far */
    int32_t served[ISR_PAGES];  /* of each page */
    int32_t sources[ISR_PAGES]; /* that the latest service of the page found */
    int64_t latency[ISR_PAGES]; /* [clocks] of the latest, from the interrupt to its begin */
};

void isr_start(struct isr *q, const struct isr_config *config);

/* These sources were read, `fifo` being the one that asks for commands: their pages wait, to be
 * served from clock `ready` on. A FIFO that asks already keeps its clock. */
void isr_read(struct isr *q, const int32_t flags[ISR_PAGES], int32_t fifo, bool asks,
              int64_t raised, int64_t ready);

/* Clock from which a page may be served; INT64_MAX if none waits. */
int64_t isr_ready(const struct isr *q);

/* The page to serve next at a clock; -1 if none may be. */
int isr_next(const struct isr *q, int64_t clock);

/* The service of a page that waits begins. */
void isr_begin(struct isr *q, int page, int64_t clock);

#endif
