/* link - what crosses between a host and its motion card at the instants of the bus grid: each
 * member is declared once, for both sides and for the variables of a co-simulation.
 *
 *     host    levels, mailboxes ------------------> card      struct link_host
 *     host <- counters, interrupt pages, number --- card      struct link_card
 *
 * Each side reads at an instant of the grid what the other one published there. Levels say what the
 * state of the card shall be and may be read again. A mailbox has a sequence number (`..._seq`);
 * what it asks for is done once for each new number. A card shows 0 for an axis that it does not
 * use.
 *
 * The lists give type, name and elements of each member. A co-simulation has a variable of that
 * type for each, whose name has a prefix; LINK_CARRY copies one from or to it.
 */
#ifndef LINK_H
#define LINK_H

#include <assert.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

enum { LINK_AXES = 6, LINK_PAGES = 9, LINK_FRAMES = 16 };

/* DDA and interrupts: levels, and the mailboxes that clear interrupt flags and empty the FIFOs. */
#define LINK_DDA(X) \
    X(int32_t, dda_length, )            /* [bit] the DDA time has 2^dda_length ticks */ \
    X(int32_t, dda_divider, )           /* [clocks per tick] */ \
    X(bool, dda_run, )                  /* the divider runs */ \
    X(int32_t, irq_mask, [LINK_PAGES])  /* bits of the sources that pull the interrupt line */ \
    X(int32_t, ack_seq, )               /* mailbox: clear the flags below */ \
    X(int32_t, ack_flags, [LINK_PAGES]) /* bits of the flags to be cleared */ \
    X(int32_t, clear_seq, )             /* mailbox: empty all FIFOs */

/* FIFO, position loops, DAC and counters; the mailbox arms a latch for the next index pulse. */
#define LINK_LOOPS(X) \
    X(int32_t, min_stock, )             /* [commands] minimum of the stock comparators */ \
    X(int32_t, p_gain, [LINK_AXES])     /* gains of the position loops, in register units */ \
    X(bool, loop_on, [LINK_AXES])       /* the position loop's error counter counts */ \
    X(int32_t, dac_source, [LINK_AXES]) /* 0 the host's voltage, 1 position loop */ \
    X(double, dac_volts, [LINK_AXES])   /* [V] the host's voltage */ \
    X(bool, index_low, [LINK_AXES])     /* the index is on at the low level */ \
    X(int32_t, latch_seq, [LINK_AXES])  /* mailbox: arm the latch */
#define LINK_LEVELS(X) LINK_DDA(X) LINK_LOOPS(X)

/* Levels of channels beside the six pulse axes: DAC 7 and 8, the seventh error counter. */
#define LINK_LEVELS_AUX(X) \
    X(double, dac_volts_aux, [2]) /* [V] DAC 7, DAC 8 */ \
    X(bool, loop_on_aux, )        /* the seventh error counter counts */ \
    X(int32_t, command_aux, )     /* [pulses] its command position; may wrap */

/* The mailbox of frames: commands of all axes for the next DDA times. */
#define LINK_WRITE(X) \
    X(int32_t, cmd_seq, ) \
    X(double, cmd_clock, )                           /* [clock] at which they reach the card */ \
    X(int32_t, cmd_count, )                          /* number of frames, 0 .. LINK_FRAMES */ \
    X(int32_t, cmd_frames, [LINK_FRAMES][LINK_AXES]) /* [pulses] in a DDA time */

/* Interrupt line, transactions, stock and counters. */
#define LINK_SHOWN(X) \
    X(int32_t, irq_seq, )               /* number of times that the line was pulled */ \
    X(double, irq_clock, )              /* [clock] of the latest pull */ \
    X(int32_t, irq_flags, [LINK_PAGES]) /* interrupt flags, a bit a source */ \
    X(int32_t, cmd_ack, )               /* cmd_seq of the latest mailbox of frames taken */ \
    X(int32_t, frames_refused, )        /* number of frames that found a FIFO full */ \
    X(int32_t, stock, [LINK_AXES])      /* [commands] */ \
    X(int32_t, enc_count, [LINK_AXES])  /* [counts] */ \
    X(int32_t, enc_count_7, ) \
    X(int32_t, enc_count_8, ) \
    X(int32_t, enc_count_9, )

/* Pulses, loops, latches and switches. */
#define LINK_SHOWN_MACHINE(X) \
    X(int32_t, pulse_count, [LINK_AXES]) /* [pulses] put out */ \
    X(int32_t, err_count, [LINK_AXES])   /* [counts] error counters: following error */ \
    X(int32_t, latch_value, [LINK_AXES]) /* [counts] encoder count at the latest latch */ \
    X(int32_t, latch_seen, [LINK_AXES])  /* number of times that the counter has latched */ \
    X(int32_t, home, )                   /* home switches, a bit an axis */ \
    X(int32_t, over_travel, )            /* limit switches: 0 - 5 positive, 8 - 13 negative end */ \
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

/* The low 32 bits of a count: counters and sequence numbers wrap on the link. */
inline int32_t link_wrap(int64_t count)
{
    return (int32_t)(uint32_t)(uint64_t)count;
}

/* Whether the host has published nothing yet. Some importers begin with 0 on all wires; 0 is no
 * DDA time that a card would take. */
inline bool link_silent(const struct link_host *host)
{
    return host->dda_length == 0 && host->dda_divider == 0;
}

/* Whether a mailbox has a new number; remembers it in *taken. */
inline bool link_new(int32_t *taken, int32_t number)
{
    const bool fresh = number != *taken;

    *taken = number;
    return fresh;
}

#endif
