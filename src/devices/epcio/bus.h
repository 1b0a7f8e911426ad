/* Host bus: write transactions on their way to the card, each with the clock of its arrival. */
#ifndef BUS_H
#define BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "card.h"
#include "link.h"

enum {
    BUS_FRAMES = LINK_FRAMES, /* in one transaction */
    BUS_DEPTH = 8, /* transactions on their way; the host sends one per bus period and at most
                           two periods ahead, so two would do */
};

struct bus_write {
    int32_t seq;                           /* number the host gave it */
    int64_t clock;                         /* [clock] of its arrival */
    int32_t count;                         /* frames used */
    int32_t frame[BUS_FRAMES][EPCIO_AXES]; /* [pulses] per DDA time */
};

struct bus {
    struct bus_write slot[BUS_DEPTH]; /* ring */
    int32_t head;
    int32_t used;
};

/* Send a transaction. It waits behind those sent before, even if its own clock is earlier.
 * False, and nothing sent, if BUS_DEPTH are on their way. */
bool bus_post(struct bus *b, const struct bus_write *w);

/* Clock of the transaction that arrives next, perhaps past; INT64_MAX if none is on its way. */
int64_t bus_due(const struct bus *b);

/* Take the transaction that arrives next; bus_due() must have been finite. */
struct bus_write bus_take(struct bus *b);

#endif
