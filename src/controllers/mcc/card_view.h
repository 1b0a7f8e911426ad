/* card_view - the library's side of the link to the card: it reads what the card shows and writes
 * what the card is given. */
#ifndef CARD_VIEW_H
#define CARD_VIEW_H

#include "link.h"
#include "pcl.h"
#include "signals.h"

/* What the card shows: FIFO and interrupts, with the stock of the axis that p watches; and its
 * signals of the machine, all but probe, digital and analog inputs. */
struct pcl_card card_of(const struct pcl *p, const struct link_card *link);
void card_signals(const struct link_card *link, struct signals *s);

/* Write what the card is given: settings of DDA and interrupts, and the transaction of p if its
 * number is new. With `used` the DDA runs and the sources pull the interrupt line. */
void card_write(const struct pcl *p, const struct machine *m, bool used, struct link_host *link);

#endif
