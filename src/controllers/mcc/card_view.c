#include "card_view.h"

#include <string.h>

_Static_assert((int)LINK_AXES == (int)AXES && (int)LINK_PAGES == (int)ISR_PAGES,
               "the library is that of the link");

struct pcl_card card_of(const struct pcl *p, const struct link_card *link)
{
    struct pcl_card c = { .irq_seq = link->irq_seq,
                          .irq_clock = (int64_t)link->irq_clock,
                          .cmd_ack = link->cmd_ack,
                          .frames_refused = link->frames_refused,
                          .stock = link->stock[p->axis] };

    memcpy(c.irq_flags, link->irq_flags, sizeof c.irq_flags);
    return c;
}

void card_signals(const struct link_card *link, struct signals *s)
{
    s->stop = link->stopped;
    s->home = (uint32_t)link->home;
    s->upper = link->over_travel & 0x3f;
    s->lower = (link->over_travel >> 8) & 0x3f;
    s->enc_aux[0] = link->enc_count_7;
    s->enc_aux[1] = link->enc_count_8;
    s->enc_aux[2] = link->enc_count_9;
    memcpy(s->pulses, link->pulse_count, sizeof s->pulses);
    memcpy(s->enc, link->enc_count, sizeof s->enc);
    memcpy(s->err, link->err_count, sizeof s->err);
    memcpy(s->latch, link->latch_value, sizeof s->latch);
    memcpy(s->latched, link->latch_seen, sizeof s->latched);
}

void card_write(const struct pcl *p, const struct machine *m, bool used, struct link_host *link)
{
    link->dda_length = m->dda_length;
    link->dda_divider = machine_dda_divider(m);
    link->dda_run = used;
    link->min_stock = p->min_stock;
    link->ack_seq = p->ack_seq;
    link->clear_seq = 0; /* never: an emergency stop empties the FIFOs in the card */
    memset(link->irq_mask, 0, sizeof link->irq_mask);
    if (used) {
        memcpy(link->irq_mask, p->isr.config.mask, sizeof link->irq_mask);
        link->irq_mask[ISR_FIFO_PAGE] = pcl_mask(p, ISR_FIFO_PAGE);
    }
    memcpy(link->ack_flags, p->ack_flags, sizeof link->ack_flags);
    for (int i = 0; i < AXES; i++) {
        link->p_gain[i] = m->axis[i].p_gain;
    }
    if (p->seq != link->cmd_seq) {
        link->cmd_seq = p->seq;
        link->cmd_clock = (double)p->clock;
        link->cmd_count = p->count;
        memcpy(link->cmd_frames, p->frames, sizeof link->cmd_frames);
    }
}
