/* mailbox - mailboxes of the link (link.h) for cards of both generations: the sequence numbers that
 * a card has taken, so that it does each thing once, and the transaction of frames. */
#ifndef MAILBOX_H
#define MAILBOX_H

#include "bus.h"
#include "irq.h"
#include "link.h"

/* Sequence numbers taken last. */
struct mailbox {
    int32_t ack_seq, cmd_seq, clear_seq;
    int32_t latch_seq[LINK_AXES];
};

/* Interrupt pages of the link in the card's type. */
static inline const uint32_t *mailbox_pages(const int32_t pages[LINK_PAGES])
{
    return (const uint32_t *)pages;
}

/* If the mailbox of frames has a new number, fill in the transaction and return true. The caller
 * keeps the number in m->cmd_seq when it has taken the transaction. */
bool mailbox_write(const struct mailbox *m, const struct link_host *link, struct bus_write *w);

#endif
