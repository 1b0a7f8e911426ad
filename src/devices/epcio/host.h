/* The host on the link: what it has published is taken at an instant, what the card shows it. */
#ifndef HOST_H
#define HOST_H

#include "epcio.h"
#include "mailbox.h"

/* Take all but the frames. The first value out of range is refused with its status and ends it; but
 * EPCIO_STOCK_TOO_LARGE only says that the DDA length waits. Of a silent host nothing is taken: the
 * card stays as it is, at power on with the DDA running. */
enum epcio_status host_take_levels(struct mailbox *taken, struct epcio *card,
                                   const struct link_host *link);

/* Take new frames. A transaction that is refused is none. */
enum epcio_status host_take_write(struct mailbox *taken, struct epcio *card,
                                  const struct link_host *link);

void host_show(const struct epcio *card, struct link_card *link);

#endif
