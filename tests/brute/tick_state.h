/* What the model's files share: its state, and what one of them does for another. */
#ifndef TICK_STATE_H
#define TICK_STATE_H

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "tick_card.h"

enum { PAGE_DDA = 0, PAGE_ENC = 1, PAGE_LIO = 7, PAGE_PCL = 8 };
enum { CYCLE_BIT = 6, TIMER_BIT = 15, INDEX_BIT = 3 };
enum { LDIS = 8, DFIS = 7 };
enum { RISE, FALL, BOTH };

struct queue {
    int64_t command[TICK_DEPTH]; /* oldest first */
    int stock;
    bool high; /* stock > minimum at the last look */
};

struct transaction {
    int64_t seq, clock, count;
    int64_t frame[TICK_FRAMES][TICK_AXES];
};

struct line {
    bool level;     /* behind the filter */
    uint64_t looks; /* shift register of the pin, the latest look in bit 0 */
};

struct counter {
    bool wired; /* its axis is active */
    int64_t rate, wiring, filter, index_lines;
    int64_t from, to; /* [1/64 line] at the latest two instants */
    struct line a, b, c;
    int64_t count;
    int64_t behind; /* [edges] at the pins less those behind the filter */
    bool too_fast;
    int64_t index_seen, index_clock, index_count;
    bool compare_on, reached;
    int64_t compare, compare_clock;
    bool index_now;      /* at this clock */
    int64_t index_first; /* [clock] since the latest instant, -1 if none */
    bool met;            /* compare value since then */
};

struct latched {
    int64_t source, seen, value, clock;
    bool keep_last, armed, hit; /* hit: since the latest instant */
};

struct loop {
    bool wanted, on, over;
    int64_t zero, error;
};

struct tick {
    int64_t clock;
    bool active[TICK_AXES];
    bool run;
    int64_t length, divider, next_length, next_divider;
    int64_t part, ticks; /* clocks of this tick, ticks of this DDA time */
    int64_t command[TICK_AXES], accumulator[TICK_AXES];
    int64_t pulses[TICK_AXES], before[TICK_AXES];
    struct queue fifo[TICK_AXES];
    int64_t minimum, underflows[TICK_AXES], overflows, emptied[TICK_AXES];
    struct transaction bus[TICK_BUS];
    int on_the_way;
    int64_t cmd_ack, frames_taken, frames_refused, refusal[3];
    int64_t arrivals, arrived_seq[TICK_FRAMES], arrived_taken[TICK_FRAMES];
    struct counter encoder[TICK_ENCODERS];
    struct latched latch[TICK_ENCODERS];
    struct loop loop[TICK_LOOPS];
    int64_t told; /* command of the seventh */
    int64_t limit;
    int64_t edge[LDIS + DFIS], dedicated;
    bool stop_enable, gate, stop;
    int64_t seen[5], inputs;
    bool timer_on;
    int64_t timer_period, timer_now, timer_count;
    bool dog_on, expired, resetting;
    int64_t dog_value, dog_count, dog_reset, dog_left;
    int64_t pending[TICK_PAGES][TICK_BITS]; /* firings to be acknowledged; two at most are kept */
    int64_t fired[TICK_PAGES][TICK_BITS];
    int64_t mask[TICK_PAGES];
    bool line;
    int64_t irq_seq, irq_clock;
};

/* An interrupt source fires, perhaps at a clock that has passed (tick_card.c). */
void tick_fire(struct tick *m, int page, int bit, int64_t clock);

/* One clock of the DDA; transactions due at this clock (tick_fifo.c). */
void tick_dda_clock(struct tick *m);
void tick_arrive(struct tick *m);

/* Another DDA time, from the next boundary on. */
void tick_ask_time(struct tick *m, int64_t length, int64_t divider);

/* Clock n of the `span` clocks between two instants; what came is told at the second of them
 * (tick_encoder.c). */
void tick_encoder_clock(struct tick *m, int64_t n, int64_t span);
void tick_tell_encoder(struct tick *m, int encoder);

/* Local inputs at an instant. */
void tick_sample_local(struct tick *m, const int64_t *inputs);

void tick_reset_encoders(struct tick *m);

#endif
