/* outbox - changes of the card's digital outputs that wait for the link to it, each with its
 * clock. */
#ifndef OUTBOX_H
#define OUTBOX_H

#include "fpga_link.h"

enum { OUTBOX_SIZE = 64 };

struct outbox_entry {
    int64_t clock; /* at which the change reaches the card */
    uint32_t mask, value;
};

struct outbox {
    int32_t count;
    struct outbox_entry entry[OUTBOX_SIZE];
    int32_t seq; /* number of the latest mailbox */
};

/* From a clock on the outputs of the mask are those of the value. If the outbox is full, the last
 * entry takes the change in. */
void outbox_put(struct outbox *o, int64_t clock, uint32_t mask, uint32_t value);

/* Move the oldest entries into the next mailbox, as many as it has room for. */
void outbox_post(struct outbox *o, struct fpga_host *host);

#endif
