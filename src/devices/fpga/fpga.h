/* fpga - an FPGA card that plays pulses from two memories and exchanges inputs and outputs at a
 * fixed cycle, the slot. It plans no motion: a driver on the host computes the pulses of every
 * slot.
 *
 *     exchange   |    |    |    |    |    |    |    |    |    every slot: 200 clocks = 5 us
 *     plays      |== memory 0 ==|== memory 1 ==|.........|== memory 0 ==
 *     mark         1                                  0
 *     interrupt  ^              ^                        ^
 *                                              underrun: no mark before this clock
 *
 *     struct fpga card;
 *     fpga_reset(&card, &config);
 *     for (clock = 0; ; clock += period) {
 *         fpga_advance(&card, clock);     all events up to and including this clock
 *         ...                             pins and host: fpga_set_..., fpga_post_...
 *     }
 *
 * An exchange does, in this order: read the inputs that changed at its clock or before; set outputs
 * that are due; begin or end a stop; switch memories, if the other one was marked full before this
 * clock; interrupt. So a memory marked at the very clock of a switch is too late.
 */
#ifndef FPGA_H
#define FPGA_H

#include "slot_memory.h"

enum {
    FPGA_SLOT_CLOCKS_MIN = 8, /* two pulses need more than 4 clocks */
    FPGA_SLOT_CLOCKS_MAX = 4000,
    FPGA_WRITES = 4,    /* most writes of pulse memories on their way */
    FPGA_WAITING = 64,  /* most entries for digital outputs on their way */
    FPGA_AO_WRITES = 8, /* most writes of the analog outputs on their way */
};

enum fpga_status {
    FPGA_OK,
    FPGA_BAD_MEMORY, /* not 0 or 1 */
    FPGA_NO_SLOTS,   /* number of slots not 1 .. FPGA_SLOTS */
    FPGA_BAD_SLOT,   /* more pulses than a slot holds, or a byte that is not a number of pulses */
    FPGA_NOT_FREE,   /* the memory is marked full and waits */
    FPGA_PLAYS,      /* the memory plays */
    FPGA_STOPPED,    /* a stop acts */
    FPGA_ON_THE_WAY, /* too many writes or entries are on their way */
};

struct fpga_config {
    int32_t slot_clocks;     /* [clocks] length of a slot, FPGA_SLOT_CLOCKS_MIN .. MAX */
    enum fpga_format format; /* meaning of the bytes in the pulse memories */
    int64_t irq_every;       /* [clocks] between interrupts while nothing plays, whole slots */
    uint32_t input_irq_mask; /* inputs whose change raises the input interrupt */
    uint32_t follow_mask;    /* outputs that follow the input of their number */
    uint32_t stop_mask;      /* inputs that cause a stop */
    uint32_t stop_low;       /* those of stop_mask that do so at the low level */
    bool alarm_stops;        /* an alarm of a drive causes a stop */
    bool stop_servo_off;     /* a stop switches the drives off */
};

/* Write of a pulse memory. */
struct fpga_write {
    int32_t seq;               /* sequence number of the mailbox */
    int64_t clock;             /* [clock] at which it reaches the card; 0: none stated */
    int32_t memory, slots;     /* number of the memory; number of slots */
    int32_t words[FPGA_WORDS]; /* two words per slot (fpga_link.h) */
};

/* Change of digital outputs: those in `mask` get the levels of `value`. */
struct fpga_entry {
    int64_t clock; /* [clock] 0: none stated */
    uint32_t mask, value;
};

struct fpga_ao {
    int64_t clock;             /* [clock] 0: none stated */
    double volts[FPGA_ANALOG]; /* [V] */
};

/* Digital input pins: their levels, and the changes that are known to come. */
struct fpga_inputs {
    uint32_t level;               /* at the pins now, a bit each */
    uint32_t coming;              /* inputs that change at their `clock` */
    int64_t clock[FPGA_CHANNELS]; /* [clock] */
    int64_t first;                /* [clock] earliest of those changes */
    uint32_t image;               /* levels as exchanged last */
};

/* The latest interrupt, with inputs as exchanged at it. */
struct fpga_irq {
    int64_t seq, clock;     /* number of interrupts; [clock] of the latest */
    uint32_t inputs;        /* digital inputs */
    double ai[FPGA_ANALOG]; /* [V] analog inputs */
};

/* The latest refusal: why, and of which write. */
struct fpga_refusal {
    enum fpga_status status;
    int32_t seq, memory;
    struct slot_fault at; /* with FPGA_BAD_SLOT */
};

struct fpga {
    struct fpga_config config;
    int64_t clock; /* [25 ns] all events up to and including it have happened */
    bool pending;  /* levels changed: the next exchange has work to do */

    struct slot_memory memory[FPGA_MEMORIES];
    int32_t playing;              /* memory that plays, -1 none */
    int64_t start;                /* [clock] of its first slot */
    int64_t marks;                /* number of marks "full" so far */
    int64_t base[FPGA_PLAYED];    /* [pulses] before this memory */
    double rate[FPGA_PLAYED];     /* [pulses/s] mean speed of this memory */
    int64_t dropped[FPGA_PLAYED]; /* [pulses] dropped by stops */
    int64_t underruns;
    bool run; /* the host is armed: running out of slots is an underrun */

    struct fpga_inputs inputs;
    double ai[FPGA_ANALOG];              /* [V] analog inputs, quantised */
    uint32_t drive_pins, drives;         /* of the drives, at the pins; as exchanged last: bits
                                          * 0 - 5 ready, 8 - 13 alarm */
    uint32_t host_outputs, outputs;      /* digital outputs, as the host wants; at the pins */
    int64_t output_clock[FPGA_CHANNELS]; /* [clock] of the latest change of each output */
    int64_t switched;                    /* number of times that outputs changed */
    double ao[FPGA_ANALOG];              /* [V] analog outputs, quantised */
    uint32_t host_servo, servo;          /* servo-on, as the host wants; at the pins; bit an axis */

    bool emergency;        /* emergency stop input */
    bool reset;            /* the host asks for the end of a stop */
    bool stopped;          /* a stop acts */
    int64_t stopped_clock; /* [clock] of the latest stop */

    int64_t timer; /* [clock] of the next interrupt if nothing plays until then */
    struct fpga_irq irq, input_irq;

    struct fpga_write writes[FPGA_WRITES];
    int32_t writing; /* number of writes on their way, in the order they were sent */
    struct fpga_entry entries[FPGA_WAITING];
    int32_t entering; /* number of entries on their way, in the order of their clocks */
    struct fpga_ao aos[FPGA_AO_WRITES];
    int32_t ao_waiting; /* number of these on their way, in the order they were sent */
    int32_t write_ack;  /* sequence number of the latest write that arrived */
    int64_t refused;    /* number of writes and entries refused */
    int64_t late;       /* number of posts behind the exchange that they were meant for */
    struct fpga_refusal refusal;
};

/* Power on at clock 0: memories free, outputs low and 0 V, not armed; the first interrupt is one
 * irq_every later. */
void fpga_reset(struct fpga *f, const struct fpga_config *config);

/* Let time pass up to and including `clock`, which is not before the card's. A write arrives after
 * an exchange of the same clock. The computing time is per event, not per slot. */
void fpga_advance(struct fpga *f, int64_t clock);

/* Send a write of a pulse memory. It arrives at its clock, or now if that has passed, and not
 * before those sent earlier; then it is taken whole, or refused whole and counted. */
enum fpga_status fpga_post_write(struct fpga *f, const struct fpga_write *w);

/* Send a change of digital outputs; it acts at the first exchange at or behind its clock. If two
 * have the same clock, the one sent last wins. */
enum fpga_status fpga_post_entry(struct fpga *f, const struct fpga_entry *e);

/* Send all analog outputs [V], 16 bits for +-10 V; they act likewise, in the order they were
 * sent. */
enum fpga_status fpga_post_ao(struct fpga *f, const struct fpga_ao *a);

/* Levels of the host: armed at once, servo-on from the next exchange on. */
void fpga_set_host(struct fpga *f, bool run, uint32_t servo);

/* Ask for the end of a stop; it ends at the next exchange if no cause is left then. */
void fpga_reset_stop(struct fpga *f);

/* Digital inputs whose level in `levels` is neither the present nor the coming one. */
uint32_t fpga_inputs_changed(const struct fpga *f, uint32_t levels);

/* An input changes, at a clock that has passed or is to come; 0: unknown, now. An exchange sees the
 * changes at its clock or before. */
void fpga_change_input(struct fpga *f, int channel, int64_t clock);

/* Analog inputs [V], 16 bits for +-10 V; drives, bits 0 - 5 ready, 8 - 13 alarm; emergency stop.
 * They act at the next exchange. */
void fpga_set_ai(struct fpga *f, const double volts[FPGA_ANALOG]);
void fpga_set_drives(struct fpga *f, uint32_t drives, bool emergency_stop);

/* Pulses of each axis up to and including the card's clock, forward minus backward. */
void fpga_pulses(const struct fpga *f, int64_t pulses[FPGA_PLAYED]);

/* Number of the slot that plays, in its memory; 0 if none. */
int32_t fpga_slot(const struct fpga *f);

/* Text for a status, for messages; no full stop. */
const char *fpga_status_text(enum fpga_status s);

/* For the core's own files: clock of the first exchange behind the card's clock, and of the first
 * at or behind a clock; what an exchange and a stop do with the pulse memories; count a refusal. */
int64_t fpga_next_exchange(const struct fpga *f);
int64_t fpga_exchange_of(const struct fpga *f, int64_t clock);
void fpga_play_exchange(struct fpga *f);
void fpga_play_stop(struct fpga *f);
enum fpga_status fpga_refuse(struct fpga *f, enum fpga_status s);

#endif
