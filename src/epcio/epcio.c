#include "epcio.h"

#include <stdlib.h>

const char *epcio_status_text(enum epcio_status status)
{
    switch (status) {
    case EPCIO_OK:
        return "ok";
    case EPCIO_FIFO_FULL:
        return "the FIFO holds 63 commands already";
    case EPCIO_COMMAND_TOO_LARGE:
        return "the command is larger than the DDA length allows";
    case EPCIO_AXIS_UNUSED:
        return "the axis is not active";
    case EPCIO_DROPPED:
        return "an emergency stop caught the frame on its way";
    case EPCIO_BAD_LENGTH:
        return "the DDA length is 10 to 15 bit";
    case EPCIO_BAD_DIVIDER:
        return "the DDA divider is 1 to 65535";
    case EPCIO_STOCK_TOO_LARGE:
        return "a command in the FIFO is too large for the shorter DDA length";
    case EPCIO_BUS_FULL:
        return "eight transactions are on their way to the card already";
    case EPCIO_BAD_PHASE:
        return "the phase is no number or beyond 2^50 line periods";
    }
    return "unknown status";
}

void epcio_reset(struct epcio *card, const struct epcio_config *config)
{
    *card = (struct epcio){.config = *config};
    dda_reset(&card->dda, EPCIO_RESET_LENGTH, EPCIO_RESET_DIVIDER);
}

static void watch_stock(struct epcio *card, int axis)
{
    if (fifo_fell(&card->fifo[axis], card->minimum))
        irq_raise(&card->irq, IRQ_FIFO + axis, card->clock);
}

static void boundary(struct epcio *card)
{
    int32_t next[EPCIO_AXES] = {0};
    for (int i = 0; i < EPCIO_AXES; i++) {
        if (!card->config.active[i])
            continue;
        if (!fifo_pop(&card->fifo[i], &next[i]) && card->dda.command[i] != 0)
            card->underflows[i]++;
        watch_stock(card, i);
    }
    dda_begin(&card->dda, next);
    irq_raise(&card->irq, IRQ_CYCLE, card->clock);
}

static void arrive(struct epcio *card)
{
    struct bus_write w = bus_take(&card->bus);
    bool refused = false;   /* what follows a refused frame is refused: nothing overtakes */
    for (int k = 0; k < w.count; k++) {
        refused = refused || epcio_write_frame(card, w.frame[k]) != EPCIO_OK;
        if (refused)
            card->frames_refused++;
        else
            card->frames_taken++;
    }
    card->cmd_ack = w.seq;
}

void epcio_advance(struct epcio *card, int64_t clock)
{
    for (;;) {
        int64_t end = dda_boundary(&card->dda);
        int64_t due = bus_due(&card->bus);
        int64_t next = end <= due ? end : due;
        if (next > clock)
            break;
        card->clock = next > card->clock ? next : card->clock;
        if (end <= due)
            boundary(card);
        else
            arrive(card);
    }
    card->clock = clock;
}

enum epcio_status epcio_set_dda(struct epcio *card, int32_t length, int32_t divider)
{
    if (length == card->dda.next_length && divider == card->dda.next_divider)
        return EPCIO_OK;
    if (length < DDA_LENGTH_MIN || length > DDA_LENGTH_MAX)
        return EPCIO_BAD_LENGTH;
    if (divider < 1 || divider > DDA_DIVIDER_MAX)
        return EPCIO_BAD_DIVIDER;
    for (int i = 0; i < EPCIO_AXES && length < card->dda.next_length; i++)
        if (fifo_largest(&card->fifo[i]) > dda_largest(length))
            return EPCIO_STOCK_TOO_LARGE;
    dda_set_time(&card->dda, length, divider, card->clock);
    return EPCIO_OK;
}

void epcio_set_run(struct epcio *card, bool run)
{
    dda_set_run(&card->dda, run, card->clock);
}

void epcio_set_minimum(struct epcio *card, int32_t minimum)
{
    if (minimum == card->minimum)
        return;
    card->minimum = minimum;
    for (int i = 0; i < EPCIO_AXES; i++)
        watch_stock(card, i);
}

enum epcio_status epcio_post(struct epcio *card, const struct bus_write *write)
{
    if (!bus_post(&card->bus, write))
        return EPCIO_BUS_FULL;
    epcio_advance(card, card->clock);
    return EPCIO_OK;
}

static enum epcio_status refuse(struct epcio *card, enum epcio_status status, int axis,
                                int32_t command)
{
    card->refusal = (struct epcio_refusal){status, axis, command};
    return status;
}

enum epcio_status epcio_write_frame(struct epcio *card, const int32_t frame[EPCIO_AXES])
{
    int32_t largest = dda_largest(card->dda.next_length);
    for (int i = 0; i < EPCIO_AXES; i++) {
        if (!card->config.active[i] && frame[i] != 0)
            return refuse(card, EPCIO_AXIS_UNUSED, i, frame[i]);
        if (frame[i] > largest || frame[i] < -largest)
            return refuse(card, EPCIO_COMMAND_TOO_LARGE, i, frame[i]);
        if (card->fifo[i].stock == FIFO_DEPTH)
            return refuse(card, EPCIO_FIFO_FULL, i, frame[i]);
    }
    for (int i = 0; i < EPCIO_AXES; i++)
        if (card->config.active[i]) {
            fifo_push(&card->fifo[i], frame[i]);
            watch_stock(card, i);
        }
    return EPCIO_OK;
}

void epcio_clear(struct epcio *card)
{
    while (bus_due(&card->bus) != INT64_MAX) {
        struct bus_write w = bus_take(&card->bus);
        card->cmd_ack = w.seq;
        card->frames_refused += w.count;
        if (w.count > 0)
            refuse(card, EPCIO_DROPPED, 0, w.frame[0][0]);
    }
    for (int i = 0; i < EPCIO_AXES; i++) {
        fifo_clear(&card->fifo[i]);
        watch_stock(card, i);
    }
}

enum epcio_status epcio_sample(struct epcio *card, const double phase[EPCIO_ENCODERS], int *bad)
{
    for (int i = 0; i < EPCIO_ENCODERS; i++) {
        if (i < EPCIO_AXES && !card->config.active[i])
            continue;
        struct encoder *e = &card->encoder[i];
        enum encoder_event event =
            encoder_sample(&card->config.encoder[i], e, phase[i], card->clock);
        if (event == ENCODER_BAD_PHASE) {
            *bad = i;
            return EPCIO_BAD_PHASE;
        }
        if (event == ENCODER_INDEX)
            irq_raise(&card->irq, IRQ_INDEX + i, e->index_clock);
    }
    return EPCIO_OK;
}

void epcio_control(struct epcio *card)
{
    const struct epcio_config *c = &card->config;
    const struct epcio_host *h = &card->host;
    int64_t pulses[EPCIO_AXES];
    epcio_pulses(card, pulses);
    for (int i = 0; i < EPCIO_AXES; i++) {
        if (!c->active[i])
            continue;
        struct ploop *p = &card->loop[i];
        if (ploop_tick(&c->loop, p, h->loop_on[i], pulses[i], card->encoder[i].count))
            irq_raise(&card->irq, IRQ_OVERFLOW + i, card->clock);
        card->analog.next[i] = h->dac_loop[i] ? ploop_code(&c->loop, p->error, h->gain[i])
                                              : analog_code(h->volts[i]);
    }
    for (int i = EPCIO_AXES; i < ANALOG_DACS; i++)
        card->analog.next[i] = analog_code(h->volts[i]);
}

void epcio_convert(struct epcio *card)
{
    analog_convert(&card->analog);
}

void epcio_set_mask(struct epcio *card, uint32_t mask)
{
    irq_set_mask(&card->irq, mask, card->clock);
}

void epcio_acknowledge(struct epcio *card, uint32_t flags, uint32_t mask)
{
    irq_acknowledge(&card->irq, flags, mask, card->clock);
}

void epcio_pulses(const struct epcio *card, int64_t pulses[EPCIO_AXES])
{
    dda_counts(&card->dda, card->clock, pulses);
}
