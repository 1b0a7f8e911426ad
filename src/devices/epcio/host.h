/* host - the card's side of the link to its host (link.h): what the host has published is taken
 * over at an instant, and the card's state is shown to it. */
#ifndef HOST_H
#define HOST_H

#include "epcio.h"
#include "mailbox.h"

/* Take over levels and all mailboxes but the frames. The first value out of range ends that, and
 * its status is returned; EPCIO_STOCK_TOO_LARGE only means that the new DDA length has to wait.
 * From a host that has published nothing yet (link_silent) nothing is taken. */
enum epcio_status host_take_levels(struct mailbox *taken, struct epcio *card,
                                   const struct link_host *link);

/* Take over the mailbox of frames if it has a new number. A refused transaction stays untaken. */
enum epcio_status host_take_write(struct mailbox *taken, struct epcio *card,
                                  const struct link_host *link);

/* Show counters, interrupts and switches to the host. */
void host_show(const struct epcio *card, struct link_card *link);

#endif
