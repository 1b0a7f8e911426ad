#include "mailbox.h"

#include <math.h>
#include <string.h>

_Static_assert(sizeof((struct link_host *)0)->cmd_frames == sizeof((struct bus_write *)0)->frame
                   && (int)LINK_PAGES == (int)IRQ_PAGES,
               "the card is that of the link");

bool mailbox_write(const struct mailbox *m, const struct link_host *link, struct bus_write *w)
{
    if (link->cmd_seq == m->cmd_seq)
        return false;
    *w = (struct bus_write){ .seq = link->cmd_seq,
                             .clock = (int64_t)ceil(link->cmd_clock),
                             .count = link->cmd_count };
    for (int k = 0; k < BUS_FRAMES && k < w->count; k++)
        memcpy(w->frame[k], link->cmd_frames[k], sizeof w->frame[k]);
    return true;
}
