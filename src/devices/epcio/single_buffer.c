#include "single_buffer.h"

#include <stdlib.h>
#include <string.h>

static const int32_t NO_COMMAND[EPCIO_AXES];

void single_buffer_reset(struct single_buffer *card, const struct single_buffer_config *config)
{
    memset(card, 0, sizeof *card);
    card->config = *config;
    dda_reset(&card->dda, EPCIO_AXES, 1 << EPCIO_RESET_LENGTH, EPCIO_RESET_DIVIDER);
}

/* Interrupt bits "FIFO at minimum stock" of the active axes. */
static uint32_t fifo_bits(const struct single_buffer *card)
{
    uint32_t bits = 0;
    for (int i = 0; i < EPCIO_AXES; i++)
        if (card->config.active[i])
            bits |= 1u << (IRQ_DDA_FIFO + i);
    return bits;
}

/* Time of the DDA [clock], which stands still while it is off. */
static int64_t dda_clock(const struct single_buffer *card)
{
    return card->dda.run ? card->clock : card->dda.stop;
}

/* Time that a direct card has waited for a command so far [clocks]; 0 if it does not wait. */
static int64_t waited(const struct single_buffer *card)
{
    return card->config.latched || card->running ? 0 : dda_clock(card) - card->dda.start;
}

int32_t single_buffer_underflows(const struct single_buffer *card, int axis)
{
    return card->underflows[axis] + (waited(card) > 0 && card->last[axis] != 0 ? 1 : 0);
}

/* Put a command into the DDA and account for the standstill before it. */
static void take(struct single_buffer *card, const int32_t command[EPCIO_AXES])
{
    for (int i = 0; i < EPCIO_AXES; i++) {
        if (!card->stopped && card->last[i] != 0 && command[i] != 0)
            card->gap[i] += card->stood;
        card->last[i] = command[i];
    }
    card->stood = 0;
    card->stopped = false;
    card->running = true;
    dda_begin(&card->dda, command);
}

/* Direct: the command starts the next DDA time at this clock. */
static void start(struct single_buffer *card, const int32_t command[EPCIO_AXES])
{
    struct dda *d = &card->dda;
    for (int i = 0; i < EPCIO_AXES; i++)
        card->underflows[i] = single_buffer_underflows(card, i);
    card->stood = waited(card);
    d->start = dda_clock(card) - dda_time(d->ticks, d->divider); /* as if a DDA time ended now */
    take(card, command);
}

/* Direct: the command is complete, the DDA waits for the next one. Returns the interrupt sources
 * that fire. */
static uint32_t end_direct(struct single_buffer *card)
{
    card->running = false;
    dda_begin(&card->dda, NO_COMMAND);
    return fifo_bits(card);
}

/* Latched: the waiting command goes into the DDA; without one the axes stand still for a DDA time.
 * Returns the interrupt sources that fire. */
static uint32_t end_latched(struct single_buffer *card)
{
    struct dda *d = &card->dda;
    if (!card->running)
        card->stood += dda_time(d->ticks, d->divider);
    if (card->waits) {
        card->waits = false;
        take(card, card->command);
        return fifo_bits(card);
    }
    for (int i = 0; i < EPCIO_AXES; i++)
        card->underflows[i] += d->command[i] != 0 ? 1 : 0;
    card->running = false;
    dda_begin(d, NO_COMMAND);
    return 0;
}

static void boundary(struct single_buffer *card)
{
    uint32_t freed = card->config.latched ? end_latched(card) : end_direct(card);
    irq_raise(&card->irq, IRQ_DDA, freed | 1u << IRQ_DDA_CYCLE, card->clock);
}

static void arrive(struct single_buffer *card)
{
    struct bus_write w = bus_take(&card->bus);
    bool refused = false; /* frames behind a refused one are refused, too: nothing overtakes */
    for (int k = 0; k < w.count; k++) {
        refused = refused || single_buffer_write_frame(card, w.frame[k]) != EPCIO_OK;
        if (refused)
            card->frames_refused++;
        else
            card->frames_taken++;
    }
    card->cmd_ack = w.seq;
}

void single_buffer_advance(struct single_buffer *card, int64_t clock)
{
    for (;;) {
        bool ticks = card->config.latched || card->running;
        int64_t end = ticks ? dda_boundary(&card->dda) : INT64_MAX;
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

enum epcio_status single_buffer_set_dda(struct single_buffer *card, int32_t length, int32_t divider)
{
    if (length < EPCIO_LENGTH_MIN || length > EPCIO_LENGTH_MAX)
        return EPCIO_BAD_LENGTH;
    if (divider < 1 || divider > EPCIO_DIVIDER_MAX)
        return EPCIO_BAD_DIVIDER;
    int32_t ticks = 1 << length;
    if (ticks == card->dda.next_ticks && divider == card->dda.next_divider)
        return EPCIO_OK;
    for (int i = 0; i < EPCIO_AXES && card->waits; i++)
        if (abs(card->command[i]) > dda_largest(ticks))
            return EPCIO_COMMAND_WAITS;
    dda_set_time(&card->dda, ticks, divider, card->clock);
    return EPCIO_OK;
}

void single_buffer_set_run(struct single_buffer *card, bool run)
{
    dda_set_run(&card->dda, run, card->clock);
}

enum epcio_status single_buffer_post(struct single_buffer *card, const struct bus_write *write)
{
    if (write->count < 0 || write->count > BUS_FRAMES)
        return EPCIO_BAD_COUNT;
    if (!bus_post(&card->bus, write))
        return EPCIO_BUS_FULL;
    single_buffer_advance(card, card->clock);
    return EPCIO_OK;
}

static enum epcio_status refuse(struct single_buffer *card, enum epcio_status status, int axis,
                                int32_t command)
{
    card->refusal = (struct epcio_refusal){ status, axis, command };
    return status;
}

enum epcio_status single_buffer_write_frame(struct single_buffer *card,
                                            const int32_t frame[EPCIO_AXES])
{
    int32_t largest = dda_largest(card->dda.next_ticks);
    int first = -1; /* first active axis, which a refusal names */
    for (int i = 0; i < EPCIO_AXES; i++) {
        if (!card->config.active[i] && frame[i] != 0)
            return refuse(card, EPCIO_AXIS_UNUSED, i, frame[i]);
        if (frame[i] > largest || frame[i] < -largest)
            return refuse(card, EPCIO_COMMAND_TOO_LARGE, i, frame[i]);
        first = card->config.active[i] && first < 0 ? i : first;
    }
    first = first < 0 ? 0 : first;
    if (single_buffer_stock(card) > 0)
        return refuse(card, EPCIO_NOT_FREE, first, frame[first]);
    if (card->config.latched) {
        memcpy(card->command, frame, sizeof card->command);
        card->waits = true;
    } else {
        start(card, frame);
    }
    return EPCIO_OK;
}

void single_buffer_clear(struct single_buffer *card)
{
    while (bus_due(&card->bus) != INT64_MAX) {
        struct bus_write w = bus_take(&card->bus);
        card->cmd_ack = w.seq;
        card->frames_refused += w.count;
        if (w.count > 0)
            refuse(card, EPCIO_DROPPED, 0, w.frame[0][0]);
    }
    if (card->waits)
        irq_raise(&card->irq, IRQ_DDA, fifo_bits(card), card->clock);
    card->waits = false;
    card->stopped = true;
}

void single_buffer_set_mask(struct single_buffer *card, const uint32_t mask[IRQ_PAGES])
{
    irq_set_mask(&card->irq, mask, card->clock);
}

void single_buffer_acknowledge(struct single_buffer *card, const uint32_t flags[IRQ_PAGES],
                               const uint32_t mask[IRQ_PAGES])
{
    irq_acknowledge(&card->irq, flags, mask, card->clock);
}

int32_t single_buffer_stock(const struct single_buffer *card)
{
    return card->config.latched ? card->waits : card->running;
}

void single_buffer_pulses(const struct single_buffer *card, int64_t pulses[EPCIO_AXES])
{
    dda_counts(&card->dda, card->clock, pulses);
}
