/* layers - where a PC can answer an input of its card, from the quickest to the slowest.
 *
 *     input --+-- interrupt of the change    its wait, one access to the card
 *             +-- driver                     image of the cycle's interrupt, out with the copy
 *             +-- timer of the driver        at the ticks of the system clock, one access
 *             +-- user program               its own polls: what the driver has copied, out with
 *                                            the driver's next copy
 *
 * Each layer can let outputs follow the inputs of the same numbers, so that its time shows. The
 * card's own logic is quicker than all of them. A layer does not take the processor from another:
 * the PC has two, one of them the driver's.
 */
#ifndef LAYERS_H
#define LAYERS_H

#include "latency.h"
#include "outbox.h"

enum layer { LAYER_INTERRUPT, LAYER_DRIVER, LAYER_TIMER, LAYER_USER, LAYERS };

struct layers_config {
    struct latency interrupt; /* wait of the card's interrupts */
    int64_t access;           /* [clocks] a register of the card read, another written */
    int64_t tick;             /* [clocks] of the system clock */
    int64_t poll;             /* [clocks] between two polls of the user program, */
    int64_t quantum;          /* [clocks] more if another thread has the processor then, */
    double crowded;           /* with this probability */
    uint32_t follow[LAYERS];  /* outputs that follow their inputs */
};

/* Inputs as a copy of the driver had them. */
struct layers_copy {
    int64_t clock; /* at which the copy was complete */
    uint32_t inputs;
};

struct layers {
    uint64_t random;
    uint32_t shown[LAYERS];     /* outputs that follow, as put out last */
    int64_t tick, poll;         /* [clock] the next ones */
    int32_t polls;              /* so far */
    int32_t changes;            /* input_irq_seq served */
    struct layers_copy copy[2]; /* the latest first */
    uint32_t mask, value;       /* outputs the user program has asked for; mask 0: none */
};

void layers_start(struct layers *l, const struct layers_config *c, int32_t seed);

/* A wait for an interrupt of the card. [clocks] */
int64_t layers_wait(struct layers *l, const struct layers_config *c);

/* What the card shows at an instant: the interrupt of a change, and all ticks whose access is over
 * before `until`. Their image is that of the instant, so it is older than the tick by up to
 * until - instant - access. */
void layers_look(struct layers *l, const struct layers_config *c, const struct fpga_shown *card,
                 int64_t until, struct outbox *out);

/* The next poll, if it is not behind a clock up to which all copies are known; false if it is. It
 * sees the latest copy that was complete. */
bool layers_poll(struct layers *l, const struct layers_config *c, int64_t until,
                 struct layers_copy *seen);

/* The driver has copied the inputs. */
void layers_copied(struct layers *l, int64_t clock, uint32_t inputs);

/* What the driver puts out for itself and for polls up to its begin, with the copy that is complete
 * at `done`. */
void layers_put(struct layers *l, const struct layers_config *c, uint32_t inputs, int64_t done,
                struct outbox *out);

#endif
