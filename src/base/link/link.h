/* link - what crosses between a host and its motion card on the bus grid, declared once.
 *
 *     host    levels, mailboxes ------------------> card      struct link_host
 *     host <- counters, interrupt pages, number --- card      struct link_card
 *
 * Both are read at an instant of the grid as they were published there. Levels say how things shall
 * be and may be read again. A mailbox has a number, and what it asks for is done once for each new
 * number. What a card shows of an axis it does not use is 0.
 *
 * The lists name type, name and elements of each member. A co-simulation has a variable of that
 * type for each, its name behind a prefix; LINK_CARRY copies one.
 */
#ifndef LINK_H
#define LINK_H

#include <assert.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

enum { LINK_AXES = 6, LINK_PAGES = 9, LINK_FRAMES = 16 };

/* DDA and interrupts: levels, and the numbers of the mailboxes that clear flags and empty FIFOs. */
#define LINK_DDA(X) \
    X(int32_t, dda_length, ) /* [bit] */ \
    X(int32_t, dda_divider, ) \
    X(bool, dda_run, ) \
    X(int32_t, irq_mask, [LINK_PAGES]) /* sources that pull the line */ \
    X(int32_t, ack_seq, ) \
    X(int32_t, ack_flags, [LINK_PAGES]) \
    X(int32_t, clear_seq, )

/* FIFO, position loops, DAC and counters; the number arms a latch for the next index. */
#define LINK_LOOPS(X) \
    X(int32_t, min_stock, ) /* [commands] */ \
    X(int32_t, p_gain, [LINK_AXES]) \
    X(bool, loop_on, [LINK_AXES]) \
    X(int32_t, dac_source, [LINK_AXES]) /* 0 the host's voltage, 1 position loop */ \
    X(double, dac_volts, [LINK_AXES])   /* [V] */ \
    X(bool, index_low, [LINK_AXES])     /* the index is on at the low level */ \
    X(int32_t, latch_seq, [LINK_AXES])
#define LINK_LEVELS(X) LINK_DDA(X) LINK_LOOPS(X)

/* Levels of what is no axis of pulses: DAC 7 and 8, the seventh error counter. */
#define LINK_LEVELS_AUX(X) \
    X(double, dac_volts_aux, [2]) /* [V] */ \
    X(bool, loop_on_aux, ) \
    X(int32_t, command_aux, ) /* [pulses] may wrap */

/* The mailbox of frames. */
#define LINK_WRITE(X) \
    X(int32_t, cmd_seq, ) \
    X(double, cmd_clock, ) /* [clock] at which they reach the card */ \
    X(int32_t, cmd_count, ) \
    X(int32_t, cmd_frames, [LINK_FRAMES][LINK_AXES]) /* [pulses] of a DDA time each */

/* Interrupt line, transactions, stock and counters. */
#define LINK_SHOWN(X) \
    X(int32_t, irq_seq, )  /* pulls of the line */ \
    X(double, irq_clock, ) /* [clock] of the latest */ \
    X(int32_t, irq_flags, [LINK_PAGES]) \
    X(int32_t, cmd_ack, ) /* the latest transaction taken */ \
    X(int32_t, frames_refused, ) \
    X(int32_t, stock, [LINK_AXES])     /* [commands] */ \
    X(int32_t, enc_count, [LINK_AXES]) /* [counts] */ \
    X(int32_t, enc_count_7, ) \
    X(int32_t, enc_count_8, ) \
    X(int32_t, enc_count_9, )

/* Pulses, loops, latches and switches. */
#define LINK_SHOWN_MACHINE(X) \
    X(int32_t, pulse_count, [LINK_AXES]) /* [pulses] put out */ \
    X(int32_t, err_count, [LINK_AXES])   /* [counts] error counters */ \
    X(int32_t, latch_value, [LINK_AXES]) /* [counts] */ \
    X(int32_t, latch_seen, [LINK_AXES])  /* times a counter has latched */ \
    X(int32_t, home, )                   /* switches, a bit an axis */ \
    X(int32_t, over_travel, )            /* bits 0 - 5 positive end, 8 - 13 negative end */ \
    X(bool, stopped, )                   /* the emergency stop acts */

#define LINK_MEMBER(type, name, elements) type name elements;
#define LINK_STRUCT(name, members) \
    struct name { \
        members \
    }
LINK_STRUCT(link_host,
            LINK_LEVELS(LINK_MEMBER) LINK_LEVELS_AUX(LINK_MEMBER) LINK_WRITE(LINK_MEMBER));
LINK_STRUCT(link_card, LINK_SHOWN(LINK_MEMBER) LINK_SHOWN_MACHINE(LINK_MEMBER));

#define LINK_CARRY(to, from) \
    do { \
        static_assert(sizeof(to) == sizeof(from), "one type on both sides of the link"); \
        memcpy(&(to), &(from), sizeof(to)); \
    } while (0);

/* Counters and numbers are 32-bit on the link: they wrap. */
inline int32_t link_wrap(int64_t count)
{
    return (int32_t)(uint32_t)(uint64_t)count;
}

/* Whether the host has published nothing yet: no card takes this DDA time. An importer there is
 * that begins its wires with 0. */
inline bool link_silent(const struct link_host *host)
{
    return host->dda_length == 0 && host->dda_divider == 0;
}

/* Has a mailbox a number that was not taken yet? It is now. */
inline bool link_new(int32_t *taken, int32_t number)
{
    const bool fresh = number != *taken;

    *taken = number;
    return fresh;
}

#endif
