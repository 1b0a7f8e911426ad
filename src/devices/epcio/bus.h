/* bus - queue of the host's write transactions on their way to the card over the PC bus, each with
 * frames of commands and the clock of its arrival. */
#ifndef BUS_H
#define BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "card.h"
#include "link.h"

enum {
    BUS_FRAMES = LINK_FRAMES, /* most frames in one transaction */
    BUS_DEPTH = 8, /* most transactions on their way; the host sends one per bus period and at most
                           two periods ahead, so two would do */
};

struct bus_write {
    int32_t seq;                           /* sequence number that the host gave it */
    int64_t clock;                         /* [clock] of its arrival */
    int32_t count;                         /* number of frames */
    int32_t frame[BUS_FRAMES][EPCIO_AXES]; /* [pulses] command of each axis for a DDA time */
};

struct bus {
    struct bus_write slot[BUS_DEPTH]; /* ring buffer */
    int32_t head;                     /* index of the oldest transaction */
    int32_t used;                     /* number of transactions */
};

/* Send a transaction. It waits behind those sent before, even if its own clock is earlier.
 * False, and nothing sent, if BUS_DEPTH are on their way. */
bool bus_post(struct bus *b, const struct bus_write *w);

/* Arrival clock of the next transaction, which may have passed; INT64_MAX if none is on its way. */
int64_t bus_due(const struct bus *b);

/* Remove and return the next transaction; there must be one. */
struct bus_write bus_take(struct bus *b);

#endif
