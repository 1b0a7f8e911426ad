/* fpga_link - what crosses between a driver on a PC and its FPGA card, which plays pulses and
 * exchanges inputs and outputs: each member is declared once, for both sides.
 *
 *     driver   slots, outputs, analog outputs, levels -----------> card     struct fpga_host
 *     driver <- interrupts with their input image, counters ------ card     struct fpga_shown
 *
 * A mailbox has a sequence number (`..._seq`) and the clock at which its last byte reaches the
 * card; 0: no clock stated. What it asks for is done once for each new number, at that clock or at
 * once if it has passed. Levels say what the state of the card shall be. Lists, LINK_CARRY,
 * link_new and link_wrap are those of link.h.
 *
 * Time is a number of 25 ns clocks. The card exchanges its memories with its pins every slot, 200
 * clocks = 5 us, at the clocks k * 200.
 */
#ifndef FPGA_LINK_H
#define FPGA_LINK_H

#include "link.h"

enum {
    FPGA_CLOCK_HZ = 40000000,
    FPGA_CLOCK_NS = 1000000000 / FPGA_CLOCK_HZ,
    FPGA_AXES = 6,
    FPGA_PLAYED = 7,    /* axes whose pulses are played; the last is the external axis */
    FPGA_SLOT_AXES = 8, /* bytes of a slot: those axes and a spare byte, which must be 0 */
    FPGA_SLOT_WORDS = 2,
    FPGA_SLOTS = 128, /* slots of a pulse memory */
    FPGA_WORDS = FPGA_SLOTS * FPGA_SLOT_WORDS,
    FPGA_MEMORIES = 2,      /* pulse memories */
    FPGA_CHANNELS = 32,     /* digital inputs, and as many digital outputs */
    FPGA_ANALOG = 8,        /* analog inputs, and as many analog outputs */
    FPGA_ENTRIES = 8,       /* changes of digital outputs in a mailbox */
    FPGA_CLOCKS_A_PULSE = 4 /* least distance of two pulses [clocks]: 49 in a slot of 200 */
};

/* Memory map of the card's 4 KB [bytes], as a driver copies them: an input memory, an output memory
 * and two pulse memories. Of the first two only the first 32 bytes are in use. */
enum {
    FPGA_MEMORY_BYTES = 1024,
    FPGA_INPUT_AT = 0x000, /* 0 inputs, 4 ai[8] 16 bit each, 20 drives, 24 status, 28 irq */
    FPGA_INPUT_BYTES = 32,
    FPGA_OUTPUT_AT = 0x400, /* 0 mask, 4 value, 8 ao[8] 16 bit each, 24 servo, 28 control */
    FPGA_OUTPUT_BYTES = 32,
    FPGA_PULSES_AT = 0x800, /* memory 1 lies FPGA_MEMORY_BYTES behind memory 0 */
    FPGA_SLOT_BYTES = 8,
    FPGA_ALL_BYTES = 4096,
};

/* What the byte of an axis in a slot means. */
enum fpga_format {
    FPGA_COUNTS = 0, /* pulses of the axis in the slot, signed */
    FPGA_BITS = 1,   /* bit 0 a pulse, bit 1 it goes backward: at most one pulse per slot */
};

/* Mailbox: fill a pulse memory and mark it full. */
#define FPGA_WRITE(X) \
    X(int32_t, write_seq, ) \
    X(double, write_clock, )              /* [clock] at which copy and mark are complete */ \
    X(int32_t, write_memory, )            /* 0, 1 */ \
    X(int32_t, write_slots, )             /* 1 .. FPGA_SLOTS */ \
    X(int32_t, write_words, [FPGA_WORDS]) /* slot k in words 2 k, 2 k + 1 */

/* Mailbox: entries, each of which sets the digital outputs in its mask to its value at its
 * clock. */
#define FPGA_OUT(X) \
    X(int32_t, out_seq, ) \
    X(int32_t, out_count, )              /* 0 .. FPGA_ENTRIES */ \
    X(double, out_clock, [FPGA_ENTRIES]) /* [clock] */ \
    X(int32_t, out_mask, [FPGA_ENTRIES]) \
    X(int32_t, out_value, [FPGA_ENTRIES])

/* Mailbox: all analog outputs. */
#define FPGA_AO(X) \
    X(int32_t, ao_seq, ) \
    X(double, ao_clock, )        /* [clock] */ \
    X(double, ao, [FPGA_ANALOG]) /* [V] */

/* Levels, and the mailbox that ends an emergency stop. */
#define FPGA_LEVELS(X) \
    X(bool, run, )          /* armed: running out of slots is an underrun */ \
    X(int32_t, servo, )     /* servo-on outputs, a bit an axis */ \
    X(int32_t, reset_seq, ) /* mailbox: end an emergency stop */

/* Interrupts: of the pulse memories or their timer, and of inputs that change. */
#define FPGA_INTERRUPTS(X) \
    X(int32_t, irq_seq, )            /* number of interrupts of memories or timer */ \
    X(double, irq_clock, )           /* [clock] of the latest of these interrupts */ \
    X(int32_t, irq_inputs, )         /* digital inputs as exchanged at it */ \
    X(double, irq_ai, [FPGA_ANALOG]) /* [V] analog inputs as exchanged at it */ \
    X(int32_t, input_irq_seq, )      /* number of interrupts of inputs that changed */ \
    X(double, input_irq_clock, )     /* [clock] of the latest input interrupt */ \
    X(int32_t, input_irq_image, )    /* digital inputs as exchanged at it */

/* The state of the card. */
#define FPGA_STATUS(X) \
    X(int32_t, inputs, )                 /* digital inputs as exchanged last */ \
    X(int32_t, drives, )                 /* bits 0 - 5 ready, 8 - 13 alarm */ \
    X(int32_t, memory, )                 /* pulse memory that plays: 0, 1; -1 none */ \
    X(int32_t, full, )                   /* bit m: memory m is marked full and waits */ \
    X(int32_t, slot, )                   /* slot that plays, of that memory */ \
    X(int32_t, write_ack, )              /* write_seq of the latest write that arrived */ \
    X(int32_t, refused, )                /* number of writes and entries refused */ \
    X(int32_t, underruns, )              /* number of underruns */ \
    X(int32_t, late, )                   /* number of mailboxes published behind their clock */ \
    X(bool, stopped, )                   /* emergency stop, until a reset */ \
    X(double, stopped_clock, )           /* [clock] of the latest emergency stop */ \
    X(int32_t, pulse_count, [FPGA_AXES]) /* [pulses] put out, forward minus backward */ \
    X(int32_t, dropped, [FPGA_AXES])     /* [pulses] dropped by stops, forward minus backward */ \
    X(int32_t, external_count, )         /* the same of the external axis: put out, */ \
    X(int32_t, external_dropped, )       /* and dropped */

LINK_STRUCT(fpga_host, FPGA_WRITE(LINK_MEMBER) FPGA_OUT(LINK_MEMBER) FPGA_AO(LINK_MEMBER)
                           FPGA_LEVELS(LINK_MEMBER));
LINK_STRUCT(fpga_shown, FPGA_INTERRUPTS(LINK_MEMBER) FPGA_STATUS(LINK_MEMBER));

/* Largest number of pulses of an axis in a slot of `slot_clocks`: 49 in 200 clocks; 1 in
 * FPGA_BITS. */
int32_t fpga_slot_most(enum fpga_format format, int32_t slot_clocks);

/* Pack the signed pulses of each axis, at most fpga_slot_most(), into the two words of a slot. Axis
 * 0 is the lowest byte of the first word. */
void fpga_slot_pack(int32_t word[FPGA_SLOT_WORDS], const int32_t pulses[FPGA_SLOT_AXES],
                    enum fpga_format format);

/* Unpack a slot into the signed pulses of each axis, forward positive. Returns the first axis, 0 ..
 * 7, whose byte is not a number of pulses up to `most`, or not 0 if the axis is spare; -1 if all
 * are right. */
int32_t fpga_slot_unpack(const int32_t word[FPGA_SLOT_WORDS], enum fpga_format format, int32_t most,
                         int32_t pulses[FPGA_SLOT_AXES]);

/* Clock, from the slot's first, of pulse j = 0 .. n - 1 of the n pulses of a slot:
 * floor((2 j + 1) slot_clocks / (2 n)). */
int32_t fpga_slot_clock(int32_t j, int32_t n, int32_t slot_clocks);

/* How many of its n pulses a slot has put out up to and including `clock`, 0 .. slot_clocks - 1
 * from its first. */
int32_t fpga_slot_played(int32_t n, int32_t clock, int32_t slot_clocks);

#endif
