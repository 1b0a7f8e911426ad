/* pcl - the position control task: interrupt service, points from the queue to the card.
 *
 * A transaction is up to 16 frames under a number. It stays visible until the card acknowledges the
 * number; only then its points leave the queue, less those the card refused (the last ones, for the
 * card takes frames in order until one does not fit). So no frame is lost or doubled, whatever the
 * wire does. A card with n or fewer commands left and no service due gets one: a late refill may
 * have left the stock at n without a further edge of the interrupt.
 */
#ifndef PCL_H
#define PCL_H

#include "isr.h"
#include "link.h"
#include "task.h"

enum {
    PCL_FRAMES = LINK_FRAMES,
    PCL_FIFO = 63,
    PCL_REFUSALS = 3 /* wholly refused transactions in a row that no full FIFO explains */
};

/* The part of one library in a transaction. */
struct pcl_part {
    int32_t points; /* number of frames from its queue; the others are standstill */
    bool late;      /* in the middle of a motion */
};

/* What the card shows on its bus. */
struct pcl_card {
    int32_t irq_seq;              /* pulls of the interrupt line */
    int64_t irq_clock;            /* of the latest pull */
    int32_t irq_flags[ISR_PAGES]; /* first page: DDA, bits 0 to 5 FIFO */
    int32_t cmd_ack;              /* latest transaction taken */
    int32_t frames_refused;
    int32_t stock; /* of the watched axis */
};

struct pcl {
    int32_t min_stock, batch; /* n and N */
    int32_t mask;             /* source that asks for commands: FIFO of the first used axis */
    int32_t axis;             /* that axis */
    int32_t prime;            /* frames still to write before the first service */

    int32_t seq;          /* the transaction: number, 0 before the first */
    bool open;            /* not yet acknowledged */
    int64_t clock;        /* when it reaches the card */
    int32_t count;        /* frames in it */
    struct pcl_part part; /* of a library that has the card for itself */
    int32_t frames[PCL_FRAMES][AXES];

    bool halted;              /* emergency stop: the card takes nothing */
    int32_t refusals;         /* transactions in a row of which the card took nothing */
    int64_t pending;          /* interrupts not served */
    int64_t due;              /* clock of the next service; INT64_MAX: with its page's */
    int64_t raised;           /* clock of its interrupt, -1 if none asked for it */
    int32_t irq_seq, refused; /* as seen last */
    int32_t ack_seq;          /* interrupt acknowledge to the card */
    int32_t ack_flags[ISR_PAGES];
    struct isr isr; /* the other sources */

    int32_t services, starved;
    int64_t latency; /* [clocks] of the latest service */
};

void pcl_start(struct pcl *p, const struct machine *m, int32_t min_stock, int32_t batch,
               const struct isr_config *isr);

/* Uniform random latency of an interrupt, from `least` on over a width. [clocks] */
int64_t pcl_latency(uint64_t *random, double least, double width);

/* Sources of a page that the library lets through. */
static inline int32_t pcl_mask(const struct pcl *p, int page)
{
    return p->isr.config.mask[page] | (page == ISR_FIFO_PAGE ? p->mask : 0);
}

/* The emergency stop acts, or no longer: while it does nothing is written, a transaction under way
 * is of no account; then the empty FIFO is primed as at the start. */
void pcl_halt(struct pcl *p, bool halted);

/* True if an interrupt has come that pcl_notice has not seen. */
bool pcl_interrupt(const struct pcl *p, const struct pcl_card *card);

/* A look at the card, which several libraries may share. Frames taken of the transaction that the
 * card has acknowledged, -1 if it has none; give each library its part back; then look at the
 * rest. */
int32_t pcl_acknowledged(struct pcl *p, const struct pcl_card *card);
void pcl_notice(struct pcl *p, const struct pcl_card *card, int64_t now, int64_t latency);

/* The card took so many frames: drop the points among them. Returns the frames of standstill that
 * were too late. */
int32_t pcl_release(struct mcc *m, const struct pcl_part *part, int32_t taken);

/* Clock of the next service: 0 while the FIFO is primed, INT64_MAX if none can be given now. */
int64_t pcl_due(const struct pcl *p);

/* The FIFO's page has its turn: the services that wait are due. */
void pcl_turn(struct pcl *p, int64_t clock);

/* Serve an interrupt: take the points that the queue has. */
void pcl_take(struct pcl *p, const struct mcc *m);

/* The same for several libraries: so many frames of standstill; then the points of each, its axes
 * on channels of the card (-1: none). */
void pcl_prepare(struct pcl *p);
void pcl_merge(struct pcl *p, const struct mcc *m, const int32_t channel[AXES],
               struct pcl_part *part);

/* What was taken last becomes a transaction that reaches the card at a clock. */
void pcl_write(struct pcl *p, int64_t clock);

#endif
