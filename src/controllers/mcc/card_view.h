/* card_view - the library's side of the link: what the card shows, what it is given. */
#ifndef CARD_VIEW_H
#define CARD_VIEW_H

#include "link.h"
#include "pcl.h"
#include "signals.h"

/* FIFO and interrupts of a card whose position control is p; what it tells of the machine. */
struct pcl_card card_of(const struct pcl *p, const struct link_card *link);
struct signals card_signals(const struct link_card *link);

/* DDA, interrupts, and the transaction if it has a new number. `used`: the DDA runs, sources pull
 * the line. */
void card_write(const struct pcl *p, const struct machine *m, bool used, struct link_host *link);

#endif
