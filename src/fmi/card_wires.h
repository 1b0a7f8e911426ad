/* card_wires - what the FMUs of both generations of the motion card (epcio, single_buffer_card) do
 * alike with their variables: grid of the host bus, DDA time, mailbox of commands, interrupts.
 * Included after fmi_model.h by a model whose struct has the members card, period, instant, taken,
 * warned_length and warned_frames. */
#ifndef CARD_WIRES_H
#define CARD_WIRES_H

#include "fmu_period.h"
#include "mailbox.h"
#include "status.h"

/* Set a member of a struct link_host from the input of its name. */
#define WIRES_READ(type, name, elements) LINK_CARRY(link.name, v->host_##name)

/* The parameter loop_period in clocks; 0 after fmu_fail(). */
static int64_t wires_period(struct fmu *f)
{
    const double period = f->s.v.loop_period, clocks = period * EPCIO_CLOCK_HZ;
    if (fmu_is_period(clocks))
        return (int64_t)round(clocks);
    fmu_fail(f, "loop_period = %.17g s: not a whole number of 25 ns clocks", period);
    return 0;
}

/* Report the card's status of a new DDA time: -1 after fmu_fail() if it is out of range. A length
 * that has to wait is a warning, given once. */
static int wires_dda(struct fmu *f, enum epcio_status s)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    const bool waits = s == EPCIO_STOCK_TOO_LARGE || s == EPCIO_COMMAND_WAITS;
    if (s == EPCIO_BAD_LENGTH)
        return fmu_fail(f, "host_dda_length = %d: %s", (int)v->host_dda_length,
                        card_status_text(s));
    if (s == EPCIO_BAD_DIVIDER)
        return fmu_fail(f, "host_dda_divider = %d: %s", (int)v->host_dda_divider,
                        card_status_text(s));
    if (waits && m->warned_length != v->host_dda_length)
        fmu_warn(f, "host_dda_length = %d waits: %s", (int)v->host_dda_length, card_status_text(s));
    m->warned_length = waits ? v->host_dda_length : 0;
    return 0;
}

/* If the mailbox of frames has a new number, fill in its transaction and return 1; 0 if not, -1
 * after fmu_fail(). */
static int wires_command(struct fmu *f, struct bus_write *w)
{
    const struct vars *v = &f->s.v;
    struct link_host link;
    if (v->host_cmd_seq == f->s.m.taken.cmd_seq)
        return 0;
    if (!(fabs(v->host_cmd_clock) < FMU_TICKS_MAX))
        return fmu_fail(f, "host_cmd_clock = %g: not a clock", v->host_cmd_clock);
    LINK_WRITE(WIRES_READ)
    return mailbox_write(&f->s.m.taken, &link, w);
}

/* Report the card's status of a transaction that was sent to it, and mark it as taken if it is
 * right. */
static int wires_sent(struct fmu *f, const struct bus_write *w, enum epcio_status s)
{
    if (s == EPCIO_BAD_COUNT)
        return fmu_fail(f, "host_cmd_count = %d: %s", (int)w->count, card_status_text(s));
    if (s != EPCIO_OK)
        return fmu_fail(f, "host_cmd_seq = %d: %s", (int)w->seq, card_status_text(s));
    f->s.m.taken.cmd_seq = w->seq;
    return 0;
}

/* Warn of frames that the card has refused since the latest call. */
static void wires_refused(struct fmu *f)
{
    struct model *m = &f->s.m;
    const struct epcio_refusal *r = &m->card.refusal;
    if (m->card.frames_refused == m->warned_frames)
        return;
    fmu_warn(f, "%d frames refused up to transaction %d; axis %d, command %d: %s",
             (int)(m->card.frames_refused - m->warned_frames), (int)m->card.cmd_ack,
             (int)r->axis + 1, (int)r->command, card_status_text(r->status));
    m->warned_frames = m->card.frames_refused;
}

/* Set the outputs of interrupts and transactions. */
static void wires_publish(struct fmu *f)
{
    struct vars *v = &f->s.v;
    const struct irq *irq = &f->s.m.card.irq;
    v->irq = irq->line;
    v->irq_seq = link_wrap(irq->seq);
    v->irq_clock = (double)irq->clock;
    memcpy(v->irq_flags, irq->flags, sizeof v->irq_flags);
    v->cmd_ack = f->s.m.card.cmd_ack;
    v->frames_taken = f->s.m.card.frames_taken;
    v->frames_refused = f->s.m.card.frames_refused;
}
_Static_assert(sizeof((struct vars *)0)->irq_flags == sizeof((struct irq *)0)->flags,
               "the wires are as wide as the card's registers");

#endif
