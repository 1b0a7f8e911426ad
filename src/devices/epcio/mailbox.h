/* mailbox - what a card of either generation takes of the link once for each number. */
#ifndef MAILBOX_H
#define MAILBOX_H

#include "bus.h"
#include "irq.h"
#include "link.h"

/* Numbers taken last. */
struct mailbox {
    int32_t ack_seq, cmd_seq, clear_seq;
    int32_t latch_seq[LINK_AXES];
};

/* Pages of the link, as the card has them. */
static inline const uint32_t *mailbox_pages(const int32_t pages[LINK_PAGES])
{
    return (const uint32_t *)pages;
}

/* True with the transaction if there is a new one. It counts as taken when its number is kept. */
bool mailbox_write(const struct mailbox *m, const struct link_host *link, struct bus_write *w);

#endif
