/* pcl - the position control task (PCL): it serves the card's interrupts and moves points from the
 * queue to the card's FIFO.
 *
 * A transaction is up to 16 frames under a number. It stays visible until the card acknowledges the
 * number; only then do its points leave the queue, except those that the card has refused. These
 * are the last ones, as the card takes frames in order until one does not fit. So no frame is lost
 * or doubled, whatever the link does. A card with n or fewer commands left and no service due gets
 * one: a late refill may have left the stock at n without a further edge of the interrupt.
 */
#ifndef PCL_H
#define PCL_H

#include "isr.h"
#include "link.h"
#include "task.h"

enum {
    PCL_FRAMES = LINK_FRAMES, /* most frames of a transaction */
    PCL_FIFO = 63,            /* [commands] depth of the card's FIFO */
    PCL_REFUSALS = 3          /* wholly refused transactions in a row that no full FIFO explains */
};

/* What one library has in a transaction. */
struct pcl_part {
    int32_t points; /* number of frames that are points of its queue; the others are standstill */
    bool late;      /* there are too few of them, in the middle of a motion */
};

/* What the card shows on its bus. */
struct pcl_card {
    int32_t irq_seq;              /* number of pulls of the interrupt line so far */
    int64_t irq_clock;            /* [clock] of the latest pull */
    int32_t irq_flags[ISR_PAGES]; /* sources of each page; bits 0 .. 5 of the first: FIFO */
    int32_t cmd_ack;              /* number of the latest transaction taken */
    int32_t frames_refused;       /* number of frames refused so far */
    int32_t stock;                /* [commands] in the FIFO of the watched axis */
};

struct pcl {
    int32_t min_stock, batch; /* [commands] n, the minimum stock, and N, frames of a refill */
    int32_t mask;             /* source that asks for commands: FIFO of the first used axis */
    int32_t axis;             /* that axis, whose stock is watched */
    int32_t prime;            /* frames still to be written before the first service */

    int32_t seq;          /* number of the latest transaction, 0 before the first */
    bool open;            /* the card has not yet acknowledged it */
    int64_t clock;        /* [clock] at which it reaches the card */
    int32_t count;        /* number of its frames */
    struct pcl_part part; /* what a library has in it that is alone on the card */
    int32_t frames[PCL_FRAMES][AXES];

    bool halted;              /* the emergency stop acts: nothing is written */
    int32_t refusals;         /* transactions in a row of which the card took no frame */
    int64_t pending;          /* interrupts of the FIFO that are not yet served */
    int64_t due;              /* [clock] of the next service; INT64_MAX: once its page is served */
    int64_t raised;           /* [clock] of its interrupt; -1: no interrupt asked for it */
    int32_t irq_seq, refused; /* the card's irq_seq and frames_refused as seen last */
    int32_t ack_seq;          /* number of the latest acknowledgement of an interrupt, */
    int32_t ack_flags[ISR_PAGES]; /* and the sources that it acknowledges */
    struct isr isr;               /* order of service of all pages */

    int32_t services, starved; /* refills after an interrupt; frames of standstill that were late */
    int64_t latency;           /* [clocks] of the latest service, from its interrupt to the write */
};

/* At rest, with these n and N; the first n + N frames prime the FIFO. */
void pcl_start(struct pcl *p, const struct machine *m, int32_t min_stock, int32_t batch,
               const struct isr_config *isr);

/* Latency of an interrupt, uniformly random from `least` to `least` + `width`. [clocks] */
int64_t pcl_latency(uint64_t *random, double least, double width);

/* Sources of a page that the library serves. */
static inline int32_t pcl_mask(const struct pcl *p, int page)
{
    return p->isr.config.mask[page] | (page == ISR_FIFO_PAGE ? p->mask : 0);
}

/* The emergency stop acts, or no longer acts. While it acts nothing is written, and a transaction
 * under way no longer counts; afterwards the empty FIFO is primed as at the start. */
void pcl_halt(struct pcl *p, bool halted);

/* True if an interrupt has come that pcl_notice has not seen. */
bool pcl_interrupt(const struct pcl *p, const struct pcl_card *card);

/* A look at the card, which several libraries may share, in three steps. First pcl_acknowledged
 * returns the number of frames that the card has taken of the transaction it has acknowledged, -1
 * if there is none. Then pcl_release drops the points of each library. Last pcl_notice looks for
 * interrupts, of which a new one gets this latency [clocks]. */
int32_t pcl_acknowledged(struct pcl *p, const struct pcl_card *card);
void pcl_notice(struct pcl *p, const struct pcl_card *card, int64_t now, int64_t latency);

/* The card has taken so many frames: drop the library's points among them. Returns the number of
 * frames of standstill that it got in the middle of a motion. */
int32_t pcl_release(struct mcc *m, const struct pcl_part *part, int32_t taken);

/* Clock of the next service: 0 while the FIFO is primed, INT64_MAX if none can be given now. */
int64_t pcl_due(const struct pcl *p);

/* The FIFO's page is served at this clock: refills that wait are due now. */
void pcl_turn(struct pcl *p, int64_t clock);

/* Make the frames of a transaction from the points that the queue has. */
void pcl_take(struct pcl *p, const struct mcc *m);

/* The same for several libraries: pcl_prepare makes frames of standstill, then pcl_merge puts in
 * the points of one library, whose axes are on these channels of the card (-1: none). */
void pcl_prepare(struct pcl *p);
void pcl_merge(struct pcl *p, const struct mcc *m, const int32_t channel[AXES],
               struct pcl_part *part);

/* The frames made last become a transaction that reaches the card at this clock. */
void pcl_write(struct pcl *p, int64_t clock);

#endif
