/* The motion card before the EPCIO: a single buffer per axis, one interrupt and one command per DDA
 * time. What it does with a late command is its difference from a FIFO; two readings:
 *
 *     direct: the DDA is the buffer. It waits for the write and starts at that clock.
 *         DDA time    |==== 1 ====|   |==== 2 ====|   |==== 3 ====|       period T + L
 *         interrupt               ^               ^               ^
 *         write       1           <-L-> 2         <-L-> 3
 *
 *     latched: a register before the DDA; boundaries are free running, every T.
 *         DDA time    |==== 1 ====|==== 2 ====|           |==== 3 ====|   a late write costs T
 *         interrupt   ^           ^                       ^
 *         write   1     2         <---- L ----> 3            4
 *
 *     struct single_buffer card;
 *     single_buffer_reset(&card, &config);
 *     for (clock = 0; ; clock += period) {
 *         single_buffer_advance(&card, clock);    boundaries and writes up to and including it
 *         ...                                     host: single_buffer_set_..., single_buffer_post
 *     }
 *
 * All axes are written together (a frame), so all buffers are free or not free together.
 */
#ifndef SINGLE_BUFFER_H
#define SINGLE_BUFFER_H

#include <assert.h>
#include <stdbool.h>
#include <stdint.h>

#include "bus.h"
#include "card.h"
#include "dda.h"
#include "irq.h"
#include "status.h"

static_assert((int)EPCIO_AXES <= (int)DDA_CHANNELS_MAX, "a DDA channel per axis");

struct single_buffer_config {
    bool active[EPCIO_AXES];
    bool latched; /* a register before the DDA, else the DDA is the buffer */
};

struct single_buffer {
    struct single_buffer_config config;
    int64_t clock;               /* [25 ns] everything up to here has happened */
    struct dda dda;              /* direct, without command: its start is when the wait began */
    bool running;                /* the DDA has a command, perhaps of 0 pulses */
    bool waits;                  /* latched: the register holds a command */
    int32_t command[EPCIO_AXES]; /* [pulses] that command */
    int32_t last[EPCIO_AXES];    /* [pulses] command that went into the DDA last */
    bool stopped;                /* emergency stop since then: what follows is no gap */
    int64_t stood;               /* [clocks] of the DDA times without command since then; latched */
    int32_t underflows[EPCIO_AXES]; /* without the wait in progress */
    int64_t gap[EPCIO_AXES];        /* [clocks] stood still between two commands that
                                                   both move the axis */
    struct bus bus;
    int32_t cmd_ack; /* latest transaction that arrived */
    int32_t frames_taken;
    int32_t frames_refused;
    struct epcio_refusal refusal;
    struct irq irq; /* only page IRQ_DDA is used */
};

/* Power on at clock 0: buffer free, no command in the DDA, the reset length and divider, DDA
 * running, mask 0. Latched, the first boundary is one DDA time later. */
void single_buffer_reset(struct single_buffer *card, const struct single_buffer_config *config);

/* Do all that happens up to and including `clock`, which is not before the card's: ends of DDA
 * times and arriving transactions, an end before a transaction of the same clock. So a direct card
 * written at the very end of its DDA time goes on without a gap; a latched one is too late then.
 *
 * Interrupts, page IRQ_DDA: the FIFO bits of the active axes when the buffer becomes free (as an
 * EPCIO with minimum stock 0), CYCLE at each end. Costs per event, not per clock. */
void single_buffer_advance(struct single_buffer *card, int64_t clock);

/* DDA length [10 .. 15 bit] and divider [1 .. 65535]. They hold for the DDA times that begin from
 * now on, and for one of no pulses that begins at this very clock (see dda_set_time). Refused, and
 * nothing changed: BAD_LENGTH, BAD_DIVIDER, COMMAND_WAITS. */
enum epcio_status single_buffer_set_dda(struct single_buffer *card, int32_t length,
                                        int32_t divider);

/* Switch the DDA: off, it freezes and its time stands, so that is no gap. A direct card takes a
 * command meanwhile, which begins when it is switched on. */
void single_buffer_set_run(struct single_buffer *card, bool run);

/* Send a transaction of 0 .. BUS_FRAMES frames; it arrives at its clock, now if that has passed,
 * and not before those sent earlier. Its frames are written in order; after a refused one the rest
 * is refused too, so of several all but the first are. BAD_COUNT or BUS_FULL: nothing sent. */
enum epcio_status single_buffer_post(struct single_buffer *card, const struct bus_write *write);

/* Write one command per axis, |command| <= 2^length - 1 [pulses], now; all or none. Refused with
 * AXIS_UNUSED, COMMAND_TOO_LARGE (the first such axis) or else NOT_FREE. */
enum epcio_status single_buffer_write_frame(struct single_buffer *card,
                                            const int32_t frame[EPCIO_AXES]);

/* Emergency stop: drop the waiting command (the buffer becomes free: interrupt) and the
 * transactions on their way, whose frames count as refused. The command in the DDA ends as
 * commanded; the next one starts anew, so the standstill before it is no gap. */
void single_buffer_clear(struct single_buffer *card);

/* Choose the interrupt sources that pull the line; the same while acknowledging flags. */
void single_buffer_set_mask(struct single_buffer *card, const uint32_t mask[IRQ_PAGES]);
void single_buffer_acknowledge(struct single_buffer *card, const uint32_t flags[IRQ_PAGES],
                               const uint32_t mask[IRQ_PAGES]);

/* Commands in the buffer, 0 or 1. Direct: in the DDA; latched: in the register. */
int32_t single_buffer_stock(const struct single_buffer *card);

/* How often an axis (0 .. 5) ran out of commands after one that moved it. Direct: waits longer than
 * 0 clocks, the one in progress too; latched: DDA times begun empty right after a moving one. */
int32_t single_buffer_underflows(const struct single_buffer *card, int axis);

/* Pulses put out up to and including the card's clock, forward minus backward [pulses]. */
void single_buffer_pulses(const struct single_buffer *card, int64_t pulses[EPCIO_AXES]);

#endif
