/* isr - the order in which the PC serves the sources of the card's one interrupt line.
 *
 * The card latches its sources on nine pages. At an interrupt the host reads all pages,
 * acknowledges what it has read, and serves the pages one after another: the lowest priority number
 * first, pages of one number in their order on the card. Service may begin when the latency of the
 * interrupt has passed. Pages of an earlier interrupt that still wait then wait for the new
 * latency, too, except that of a FIFO that asks for commands. No page interrupts another. pc
 * decides when the PC serves.
 */
#ifndef ISR_H
#define ISR_H

#include <stdbool.h>
#include <stdint.h>

enum {
    ISR_PAGES = 9,
    ISR_FIFO_PAGE = 0, /* page of the DDA, whose FIFO source asks for commands: see pcl.h */
    ISR_LOOP_PAGE = 8  /* page of the position loops: overflow of error counters, a bit an axis */
};

struct isr_config {
    int32_t mask[ISR_PAGES];     /* sources that are served, beside the FIFO's own */
    int32_t priority[ISR_PAGES]; /* of each page; the lowest number is served first */
    int64_t service;             /* [clocks] that the PC needs for a page */
};

struct isr {
    struct isr_config config;
    int32_t waiting[ISR_PAGES]; /* sources of each page that are read and not yet served */
    int64_t raised[ISR_PAGES];  /* [clock] of the interrupt that brought the first of these */
    int64_t ready[ISR_PAGES];   /* [clock] from which the page may be served */
    int page;                   /* page served last; -1 before the first */

    int32_t order;              /* number of services begun so far */
    int32_t served[ISR_PAGES];  /* number of services of each page */
    int32_t sources[ISR_PAGES]; /* sources that the latest service of each page found */
    int64_t latency[ISR_PAGES]; /* [clocks] of that service, from the interrupt to its begin */
};

void isr_start(struct isr *q, const struct isr_config *config);

/* Take the sources that were read at an interrupt of clock `raised`: their pages wait to be served
 * from clock `ready` on. `fifo` is the source that asks for commands; with `asks`, an earlier
 * request of it that still waits keeps its clock. */
void isr_read(struct isr *q, const int32_t flags[ISR_PAGES], int32_t fifo, bool asks,
              int64_t raised, int64_t ready);

/* Clock from which the first page may be served; INT64_MAX if none waits. */
int64_t isr_ready(const struct isr *q);

/* Page to be served next at a clock; -1 if none may be served yet. */
int isr_next(const struct isr *q, int64_t clock);

/* Begin the service of a page that waits. */
void isr_begin(struct isr *q, int page, int64_t clock);

#endif
