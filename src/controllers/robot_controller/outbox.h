/* outbox - changes of the card's digital outputs on their way to it, each with its clock. */
#ifndef OUTBOX_H
#define OUTBOX_H

#include "fpga_link.h"

enum { OUTBOX_SIZE = 64 };

struct outbox_entry {
    int64_t clock; /* at which it is at the card */
    uint32_t mask, value;
};

struct outbox {
    int32_t count;
    struct outbox_entry entry[OUTBOX_SIZE];
    int32_t seq; /* of the latest mailbox */
};

/* Outputs of the mask become those of the value. In a full box that joins the last entry. */
void outbox_put(struct outbox *o, int64_t clock, uint32_t mask, uint32_t value);

/* Move what the next mailbox has room for into it. */
void outbox_post(struct outbox *o, struct fpga_host *host);

#endif
