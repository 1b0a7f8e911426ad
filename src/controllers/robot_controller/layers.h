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
    struct latency interrupt; /* from an interrupt of the card to its routine */
    int64_t access;           /* [clocks] to read a register of the card and write another */
    int64_t tick;             /* [clocks] of the system clock */
    int64_t poll;             /* [clocks] between two polls of the user program */
    int64_t quantum;          /* [clocks] that a poll comes later if another thread is running */
    double crowded;           /* probability of that, 0 .. 1 */
    uint32_t follow[LAYERS];  /* outputs that follow their inputs */
};

/* The inputs in one copy of the driver. */
struct layers_copy {
    int64_t clock; /* at which the copy was complete */
    uint32_t inputs;
};

struct layers {
    uint64_t random;
    uint32_t shown[LAYERS];     /* outputs of each layer that follow, as put out last */
    int64_t tick, poll;         /* [clock] of the next tick and poll */
    int32_t polls;              /* number of polls so far */
    int32_t changes;            /* latest input_irq_seq served */
    struct layers_copy copy[2]; /* the latest first */
    uint32_t mask, value;       /* outputs that the user program has asked for; mask 0: none */
};

void layers_start(struct layers *l, const struct layers_config *c, int32_t seed);

/* Draw how long an interrupt of the card waits for its routine. [clocks] */
int64_t layers_wait(struct layers *l, const struct layers_config *c);

/* Answer what the card shows at an instant of the bus grid: the interrupt of a change, and all
 * ticks whose access is over before `until`. A tick sees the inputs of that instant, which are
 * older than the tick by up to until - instant - access. */
void layers_look(struct layers *l, const struct layers_config *c, const struct fpga_shown *card,
                 int64_t until, struct outbox *out);

/* Make the next poll, which sees the latest copy that was complete. False: the poll comes after
 * `until`, the clock up to which all copies are known. */
bool layers_poll(struct layers *l, const struct layers_config *c, int64_t until,
                 struct layers_copy *seen);

/* The driver has copied the inputs. */
void layers_copied(struct layers *l, int64_t clock, uint32_t inputs);

/* Put out what follows in the driver and what polls before its run have asked for, with the copy
 * that is complete at clock `done`. */
void layers_put(struct layers *l, const struct layers_config *c, uint32_t inputs, int64_t done,
                struct outbox *out);

#endif
