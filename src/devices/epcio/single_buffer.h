/* single_buffer - the motion card of the generation before the EPCIO, for comparison: a single
 * buffer per axis instead of a FIFO, so one interrupt and one command per DDA time. A command that
 * comes L late makes a gap in the motion; the source document allows two readings of how:
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
    bool active[EPCIO_AXES]; /* the axis is used */
    bool latched;            /* a register before the DDA, else the DDA is the buffer */
};

struct single_buffer {
    struct single_buffer_config config;
    int64_t clock;               /* [25 ns] all events up to and including it have happened */
    struct dda dda;              /* direct, without command: `start` is where the wait began */
    bool running;                /* the DDA has a command, perhaps of 0 pulses */
    bool waits;                  /* latched: the register holds a command */
    int32_t command[EPCIO_AXES]; /* [pulses] the command in the register */
    int32_t last[EPCIO_AXES];    /* [pulses] command that went into the DDA last */
    bool stopped;                /* emergency stop since that command: the standstill is no gap */
    int64_t stood;               /* [clocks] of standstill before the next command */
    int32_t underflows[EPCIO_AXES]; /* underflows, without the wait in progress */
    int64_t gap[EPCIO_AXES];        /* [clocks] sum of standstills between two commands that
                                                   both move the axis */
    struct bus bus;
    int32_t cmd_ack; /* sequence number of the latest transaction that arrived */
    int32_t frames_taken;
    int32_t frames_refused;
    struct epcio_refusal refusal;
    struct irq irq; /* only page IRQ_DDA is used */
};

/* Power on at clock 0: the buffer is free, the DDA runs without a command at the reset length and
 * divider, the interrupt mask is 0. Latched, the first boundary is one DDA time later. */
void single_buffer_reset(struct single_buffer *card, const struct single_buffer_config *config);

/* Let time pass up to and including `clock`, which is not before the card's. At one clock the end
 * of a DDA time comes before an arriving transaction. So a direct card that is written at the very
 * end of its DDA time goes on without a gap; for a latched card that write is too late.
 *
 * Interrupts, page IRQ_DDA: the FIFO bits of the active axes when the buffer becomes free (as an
 * EPCIO with minimum stock 0), CYCLE at each end. The computing time is per event, not per
 * clock. */
void single_buffer_advance(struct single_buffer *card, int64_t clock);

/* DDA length, 10 .. 15 bit, and divider, 1 .. 65535 clocks per tick. They hold for the DDA times
 * that begin from now on, and for one without pulses that begins at this very clock (see
 * dda_set_time). BAD_LENGTH, BAD_DIVIDER or COMMAND_WAITS, and nothing changed, if refused. */
enum epcio_status single_buffer_set_dda(struct single_buffer *card, int32_t length,
                                        int32_t divider);

/* Switch the DDA on or off. Off, it freezes; that time is no gap. A direct card takes a command
 * meanwhile, which begins when it is switched on. */
void single_buffer_set_run(struct single_buffer *card, bool run);

/* Send a transaction of 0 .. BUS_FRAMES frames. It arrives at its clock, or now if that has passed,
 * and not before those sent earlier. Its frames are written in order; as the buffer holds one
 * command, all but the first are refused. BAD_COUNT or BUS_FULL: nothing is sent. */
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

/* Number of times that an axis (0 .. 5) ran out of commands after one that moved it. Direct: waits
 * longer than 0 clocks, the one in progress too; latched: DDA times that began without a command
 * right after one with motion. */
int32_t single_buffer_underflows(const struct single_buffer *card, int axis);

/* Pulses put out up to and including the card's clock, forward minus backward [pulses]. */
void single_buffer_pulses(const struct single_buffer *card, int64_t pulses[EPCIO_AXES]);

#endif
