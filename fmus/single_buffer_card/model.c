/* FMU of the single-buffer card (core epcio, single_buffer.h): bus grid, level and mailbox inputs,
 * outputs. */
#include <string.h>

#include "mailbox.h"
#include "single_buffer.h"
#include "vars.h"

struct model {
    struct single_buffer card;
    int64_t period;        /* [clocks] grid of the host bus */
    int64_t instant;       /* [clock] next instant of that grid */
    struct mailbox taken;  /* sequence numbers taken last from the host */
    int32_t warned_length; /* DDA length that has to wait and was warned of */
    int32_t warned_frames; /* number of refused frames that were warned of */
};

#include "fmi_model.h"
#include "card_wires.h"

static int model_start(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    struct single_buffer_config c = { .latched = v->latched };
    for (int i = 0; i < EPCIO_AXES; i++)
        c.active[i] = v->active[i];
    m->period = wires_period(f);
    if (m->period == 0)
        return -1;
    single_buffer_reset(&m->card, &c);
    return 0;
}

static int read_host(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct single_buffer *card = &f->s.m.card;
    struct mailbox *taken = &f->s.m.taken;
    struct link_host link;
    LINK_DDA(WIRES_READ)
    if (link_silent(&link))
        return 0;
    const uint32_t *mask = mailbox_pages(link.irq_mask);
    if (link_new(&taken->ack_seq, link.ack_seq))
        single_buffer_acknowledge(card, mailbox_pages(link.ack_flags), mask);
    else
        single_buffer_set_mask(card, mask);
    if (link_new(&taken->clear_seq, link.clear_seq))
        single_buffer_clear(card);
    if (wires_dda(f, single_buffer_set_dda(card, link.dda_length, link.dda_divider)))
        return -1;
    single_buffer_set_run(card, link.dda_run);
    struct bus_write w;
    const int command = wires_command(f, &w);
    return command > 0 ? wires_sent(f, &w, single_buffer_post(card, &w)) : command;
}

static void publish(struct fmu *f)
{
    struct vars *v = &f->s.v;
    const struct single_buffer *card = &f->s.m.card;
    int64_t pulses[EPCIO_AXES];
    single_buffer_pulses(card, pulses);
    for (int i = 0; i < EPCIO_AXES; i++) {
        v->stock[i] = card->config.active[i] ? single_buffer_stock(card) : 0;
        v->underflows[i] = single_buffer_underflows(card, i);
        v->gap_clocks[i] = (double)card->gap[i];
        v->pulse_count[i] = link_wrap(pulses[i]);
    }
}

/* Inputs are read at the instants in [t0, t1); the outputs show the state at t1. */
static int model_step(struct fmu *f, int64_t t0, int64_t t1)
{
    struct model *m = &f->s.m;
    int64_t end = t1 / EPCIO_CLOCK_NS;
    (void)t0;
    for (; m->instant < end; m->instant += m->period) {
        single_buffer_advance(&m->card, m->instant);
        if (read_host(f))
            return -1;
    }
    single_buffer_advance(&m->card, end);
    wires_refused(f);
    wires_publish(f);
    publish(f);
    return 0;
}
