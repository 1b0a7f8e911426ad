/* Writing frames of commands into the FIFOs, and emptying these at an emergency stop. */
#include "epcio.h"

static enum epcio_status refuse(struct epcio *card, enum epcio_status status, int axis,
                                int32_t command)
{
    card->refusal = (struct epcio_refusal){ status, axis, command };
    return status;
}

static bool closed(const struct epcio *card)
{
    return card->watchdog.expired || local_io_stopped(&card->local_control, &card->local);
}

enum epcio_status epcio_write_frame(struct epcio *card, const int32_t frame[EPCIO_AXES])
{
    int32_t largest = dda_largest(card->dda.next_ticks);
    if (closed(card))
        return refuse(card, EPCIO_STOPPED, 0, frame[0]);
    for (int i = 0; i < EPCIO_AXES; i++) {
        if (!card->config.active[i] && frame[i] != 0)
            return refuse(card, EPCIO_AXIS_UNUSED, i, frame[i]);
        if (frame[i] > largest || frame[i] < -largest)
            return refuse(card, EPCIO_COMMAND_TOO_LARGE, i, frame[i]);
        if (card->fifo[i].stock == EPCIO_FIFO_DEPTH) {
            card->overflows++;
            return refuse(card, EPCIO_FIFO_FULL, i, frame[i]);
        }
    }
    for (int i = 0; i < EPCIO_AXES; i++)
        if (card->config.active[i]) {
            fifo_push(&card->fifo[i], card->entry[i], frame[i]);
            epcio_watch_stock(card, i);
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
        epcio_watch_stock(card, i);
    }
}
