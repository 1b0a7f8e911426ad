#include "host.h"

#include <string.h>

#include "registers.h"

static void take_interrupts(struct mailbox *taken, struct epcio *card, const struct link_host *link)
{
    const uint32_t *mask = mailbox_pages(link->irq_mask);

    if (link_new(&taken->ack_seq, link->ack_seq))
        epcio_acknowledge(card, mailbox_pages(link->ack_flags), mask);
    else
        epcio_set_mask(card, mask);
}

static enum epcio_status take_loops(struct epcio *card, const struct link_host *link)
{
    struct epcio_host h;

    h.command = link->command_aux;
    memcpy(h.gain, link->p_gain, sizeof h.gain);
    memcpy(h.loop_on, link->loop_on, sizeof link->loop_on);
    h.loop_on[EPCIO_AXES] = link->loop_on_aux;
    for (int i = 0; i < EPCIO_AXES; i++)
        h.dac_loop[i] = link->dac_source[i] == 1;
    memcpy(h.volts, link->dac_volts, sizeof link->dac_volts);
    memcpy(h.volts + EPCIO_AXES, link->dac_volts_aux, sizeof link->dac_volts_aux);
    memcpy(h.index_low, link->index_low, sizeof h.index_low);
    return epcio_set_host(card, &h);
}

enum epcio_status host_take_levels(struct mailbox *taken, struct epcio *card,
                                   const struct link_host *link)
{
    if (link_silent(link))
        return EPCIO_OK;
    take_interrupts(taken, card, link);
    if (link_new(&taken->clear_seq, link->clear_seq))
        epcio_clear(card);
    for (int i = 0; i < EPCIO_AXES; i++)
        if (link_new(&taken->latch_seq[i], link->latch_seq[i]))
            epcio_set_latch(card, i, 1u << (LATCH_INDEX + i), false);
    const enum epcio_status dda = epcio_set_dda(card, link->dda_length, link->dda_divider);
    if (dda != EPCIO_OK && dda != EPCIO_STOCK_TOO_LARGE)
        return dda;
    if (card->run != link->dda_run)
        epcio_set_run(card, link->dda_run);
    enum epcio_status bad = epcio_set_minimum(card, link->min_stock);
    if (bad == EPCIO_OK)
        bad = take_loops(card, link);
    return bad == EPCIO_OK ? dda : bad;
}

enum epcio_status host_take_write(struct mailbox *taken, struct epcio *card,
                                  const struct link_host *link)
{
    struct bus_write w;

    if (!mailbox_write(taken, link, &w))
        return EPCIO_OK;
    const enum epcio_status bad = epcio_post(card, &w);
    if (bad == EPCIO_OK)
        taken->cmd_seq = w.seq;
    return bad;
}

static void show_axis(const struct epcio *card, int i, int64_t pulses, struct link_card *link)
{
    link->stock[i] = card->fifo[i].stock;
    link->pulse_count[i] = link_wrap(pulses);
    link->enc_count[i] = link_wrap(card->encoder[i].count);
    link->err_count[i] = card->loop[i].error;
    link->latch_value[i] = link_wrap(card->latch[i].value);
    link->latch_seen[i] = card->latch[i].seen;
}

void host_show(const struct epcio *card, struct link_card *link)
{
    const struct local_io_lines *local = &card->local.seen;
    int64_t pulses[EPCIO_AXES];

    *link = (struct link_card){ .irq_seq = link_wrap(card->irq.seq),
                                .irq_clock = (double)card->irq.clock,
                                .cmd_ack = card->cmd_ack,
                                .frames_refused = card->frames_refused,
                                .enc_count_7 = link_wrap(card->encoder[6].count),
                                .enc_count_8 = link_wrap(card->encoder[7].count),
                                .enc_count_9 = link_wrap(card->encoder[8].count),
                                .home = (int32_t)local->home,
                                .over_travel = (int32_t)(local->up | local->down << 8),
                                .stopped = local_io_stopped(&card->local_control, &card->local) };
    memcpy(link->irq_flags, card->irq.flags, sizeof link->irq_flags);
    epcio_pulses(card, pulses);
    for (int i = 0; i < EPCIO_AXES; i++)
        if (card->config.active[i])
            show_axis(card, i, pulses[i], link);
}
