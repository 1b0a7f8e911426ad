/* Two cards with the same functions, for ctypes: card_... is the EPCIO core (shim.c), tick_... a
 * naive model of it that advances one clock of 25 ns at a time (tick_card.c, tick_fifo.c,
 * tick_encoder.c).
 *
 * What the model leaves out: ADC, remote I/O, DAC, pulse formats, encoders other than A/B, and
 * encoders faster than an edge a clock. */
#ifndef TICK_CARD_H
#define TICK_CARD_H

#include <stdint.h>

enum {
    TICK_AXES = 6,
    TICK_LOOPS = 7,
    TICK_ENCODERS = 9,
    TICK_DEPTH = 63,      /* commands in a FIFO */
    TICK_FRAMES = 16,     /* frames in a transaction */
    TICK_BUS = 8,         /* transactions on their way */
    TICK_PAGES = 9,       /* of the interrupt latch */
    TICK_BITS = 16,       /* sources in a page */
    TICK_UNIT = 64,       /* phases are whole 64ths of a line period: all sums are exact */
    TICK_FILTER_MAX = 63, /* [clocks] looks in the model's shift register */
};

/* What a call returns: 0, or why it was refused. */
enum tick_status {
    TICK_OK,
    TICK_FIFO_FULL,
    TICK_FIFO_EMPTY,
    TICK_COMMAND_TOO_LARGE,
    TICK_AXIS_UNUSED,
    TICK_DROPPED,
    TICK_STOPPED,
    TICK_STOCK_TOO_LARGE,
    TICK_BUS_FULL,
};

/* All that can be seen of a card. X(name, how many numbers). */
#define CARD_VIEW(X) \
    X(clock, 1) \
    X(length, 1) \
    X(divider, 1) \
    X(next_length, 1) \
    X(next_divider, 1) \
    X(before, 6)  /* [pulses] put out by the DDA times before */ \
    X(command, 6) /* [pulses] of the DDA time in progress */ \
    X(pulses, 6)  /* [pulses] put out up to now */ \
    X(minimum, 1) \
    X(stock, 6) \
    X(underflows, 6) \
    X(overflows, 1) \
    X(queue, 378) /* [pulses] 63 places an axis, oldest first, then 0 */ \
    X(on_the_way, 1) \
    X(cmd_ack, 1) \
    X(frames_taken, 1) \
    X(frames_refused, 1) \
    X(refusal, 3) /* status, axis, command */ \
    X(count, 9) \
    X(too_fast, 9) \
    X(index_seen, 9) \
    X(index_clock, 9) \
    X(index_count, 9) \
    X(reached, 9) \
    X(compare_clock, 9) \
    X(latch_armed, 9) \
    X(latch_seen, 9) \
    X(latch_value, 9) \
    X(latch_clock, 9) \
    X(error, 7) \
    X(over, 7) \
    X(inputs, 1) \
    X(off, 1) \
    X(timer_count, 1) \
    X(timer_now, 1) \
    X(expired, 1) \
    X(resetting, 1) \
    X(watchdog_count, 1) \
    X(flags, 9) \
    X(again, 9) \
    X(mask, 9) \
    X(line, 1) \
    X(irq_seq, 1) \
    X(irq_clock, 1)

struct view {
#define CARD_MEMBER(name, count) int64_t name[count];
    CARD_VIEW(CARD_MEMBER)
#undef CARD_MEMBER
};

/* The layout of a view as text: "clock 1 length 1 ...". */
const char *view_layout(void);

/* The functions of both; P is card or tick. They take and return int64_t only, arrays by pointer.
 * Time goes round as in epcio.h: sample, what the host does, control, sample at a later clock ...
 *
 * create       setup[0] active axes (bits), [1] limit of the error counters, then for each encoder
 *              rate, wiring, filter, index_lines; it is sampled at clock 0 with `phase`, inputs 0
 * sample       advance to `clock` and look at the pins: phases [1/64 line], which moved there on a
 *              straight line; inputs: ldi, dfi, up, down, stop
 * erase        returns how many
 * shift_out    *command is what came out
 * set_loops    error counters (bits) that are on
 * set_command  of the seventh; the card gets its low 32 bits
 * set_local    8 edges LDI, 7 edges DFI (0 rising, 1 falling, 2 both), dedicated, stop_enable, gate
 * reset_module the number as in registers.h */
#define CARD_FUNCTIONS(P) \
    void *P##_create(const int64_t *setup, const int64_t *phase); \
    void P##_free(void *card); \
    void P##_view(const void *card, struct view *v); \
    void P##_sample(void *card, int64_t clock, const int64_t *phase, const int64_t *inputs); \
    void P##_control(void *card); \
    int64_t P##_set_dda(void *card, int64_t length, int64_t divider); \
    int64_t P##_set_run(void *card, int64_t run); \
    int64_t P##_set_minimum(void *card, int64_t minimum); \
    int64_t P##_post(void *card, int64_t seq, int64_t clock, int64_t count, \
                     const int64_t *frames); \
    int64_t P##_write_frame(void *card, const int64_t *frame); \
    int64_t P##_erase_last(void *card, int64_t axis, int64_t n); \
    int64_t P##_shift_out(void *card, int64_t axis, int64_t *command); \
    int64_t P##_clear(void *card); \
    int64_t P##_set_encoder(void *card, int64_t encoder, const int64_t *config); \
    int64_t P##_clear_encoders(void *card, int64_t encoders); \
    int64_t P##_set_compare(void *card, int64_t encoder, int64_t on, int64_t value); \
    int64_t P##_set_latch(void *card, int64_t encoder, int64_t source, int64_t keep_last); \
    int64_t P##_set_loops(void *card, int64_t loops); \
    int64_t P##_clear_loops(void *card, int64_t loops); \
    int64_t P##_set_command(void *card, int64_t command); \
    int64_t P##_set_local(void *card, const int64_t *set); \
    int64_t P##_set_timer(void *card, int64_t on, int64_t period); \
    int64_t P##_set_watchdog(void *card, int64_t on, int64_t value, int64_t reset); \
    int64_t P##_refresh_watchdog(void *card); \
    int64_t P##_set_mask(void *card, const int64_t *mask); \
    int64_t P##_acknowledge(void *card, const int64_t *flags, const int64_t *mask); \
    int64_t P##_reset_module(void *card, int64_t module);

CARD_FUNCTIONS(card)
CARD_FUNCTIONS(tick)

/* The k-th write out of range, k = 0, 1, ...: 0 if the card refused it for the right reason and not
 * one byte of it changed, 1 wrong status, 2 something changed, -1 there is no k-th. */
int64_t card_write_badly(void *card, int64_t k);

/* The model's log. Firings of each interrupt source since power on: 9 pages of 16. */
void tick_fired(const void *card, int64_t *fired);

/* Pulses of commands that were emptied out of the FIFOs since power on, an axis each. */
void tick_emptied(const void *card, int64_t *pulses);

/* Transactions that arrived or were dropped since the last call: how many, for each its number and
 * how many of its frames were taken; at most 16. */
int64_t tick_arrivals(void *card, int64_t *seq, int64_t *taken);

#endif
