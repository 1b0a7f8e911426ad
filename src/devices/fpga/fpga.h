/* FPGA card: it plays pulse memories and exchanges inputs and outputs; all motion is made by the
 * host.
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
 *         fpga_advance(&card, clock);     all that happens up to and including it
 *         ...                             pins and host: fpga_set_..., fpga_post_...
 *     }
 *
 * At an exchange, in this order: inputs are seen that changed at its clock or before; outputs
 * change that were written so; a stop acts or ends; memories switch, of which only a mark before
 * its clock counts; interrupts. So a memory marked at the very clock of a switch is too late.
 */
#ifndef FPGA_H
#define FPGA_H

#include "slot_memory.h"

enum {
    FPGA_SLOT_CLOCKS_MIN = 8, /* two pulses need more than 4 clocks */
    FPGA_SLOT_CLOCKS_MAX = 4000,
    FPGA_WRITES = 4,    /* writes of pulse memories that may be on their way */
    FPGA_WAITING = 64,  /* entries for digital outputs, likewise */
    FPGA_AO_WRITES = 8, /* writes of the analog outputs, likewise */
};

enum fpga_status {
    FPGA_OK,
    FPGA_BAD_MEMORY, /* not 0 or 1 */
    FPGA_NO_SLOTS,   /* not 1 .. FPGA_SLOTS */
    FPGA_BAD_SLOT,   /* more pulses than a slot holds, or a byte that is no number of them */
    FPGA_NOT_FREE,   /* the memory is marked full and waits */
    FPGA_PLAYS,      /* the memory plays */
    FPGA_STOPPED,    /* a stop acts */
    FPGA_ON_THE_WAY, /* as many as there is room for are on their way */
};

struct fpga_config {
    int32_t slot_clocks; /* [clocks] FPGA_SLOT_CLOCKS_MIN .. MAX */
    enum fpga_format format;
    int64_t irq_every;       /* [clocks] while nothing plays; a whole number of slots */
    uint32_t input_irq_mask; /* inputs whose change raises the input interrupt */
    uint32_t follow_mask;    /* outputs that follow the input of their number */
    uint32_t stop_mask;      /* inputs that stop */
    uint32_t stop_low;       /* those of them that stop at the low level */
    bool alarm_stops;        /* an alarm of a drive stops */
    bool stop_servo_off;     /* a stop switches the drives off */
};

struct fpga_write {
    int32_t seq;
    int64_t clock; /* at which it reaches the card; 0 none stated */
    int32_t memory, slots;
    int32_t words[FPGA_WORDS];
};

struct fpga_entry {
    int64_t clock;
    uint32_t mask, value;
};

struct fpga_ao {
    int64_t clock;
    double volts[FPGA_ANALOG]; /* [V] */
};

/* Digital input pins: their levels, and those they will have at a clock to come. */
struct fpga_inputs {
    uint32_t level;  /* at the pins now */
    uint32_t coming; /* change at their clock */
    int64_t clock[FPGA_CHANNELS];
    int64_t first;  /* the least of those that are coming */
    uint32_t image; /* as exchanged last */
};

struct fpga_irq {
    int64_t seq, clock;
    uint32_t inputs;
    double ai[FPGA_ANALOG]; /* [V] */
};

/* What was refused last. */
struct fpga_refusal {
    enum fpga_status status;
    int32_t seq, memory;
    struct slot_fault at; /* FPGA_BAD_SLOT */
};

struct fpga {
    struct fpga_config config;
    int64_t clock; /* everything up to here has happened */
    bool pending;  /* levels changed: the next exchange has work to do */

    struct slot_memory memory[FPGA_MEMORIES];
    int32_t playing;            /* memory that plays, -1 none */
    int64_t start;              /* clock of its first slot */
    int64_t marks;              /* memories marked so far */
    int64_t base[FPGA_AXES];    /* [pulses] put out before it */
    double rate[FPGA_AXES];     /* [1/s] its mean */
    int64_t dropped[FPGA_AXES]; /* [pulses] by stops */
    int64_t underruns;
    bool run; /* armed */

    struct fpga_inputs inputs;
    double ai[FPGA_ANALOG];      /* [V] quantised */
    uint32_t drive_pins, drives; /* at the pins, as exchanged: bits 0 - 5 ready, 8 - 13 alarm */
    uint32_t host_outputs, outputs;
    int64_t output_clock[FPGA_CHANNELS]; /* latest change */
    double ao[FPGA_ANALOG];              /* [V] quantised */
    uint32_t host_servo, servo;          /* a bit an axis */

    bool emergency; /* input */
    bool reset;     /* asked for */
    bool stopped;
    int64_t stopped_clock;

    int64_t timer; /* clock of the next interrupt if nothing plays until then */
    struct fpga_irq irq, input_irq;

    struct fpga_write writes[FPGA_WRITES];
    int32_t writing; /* of them on their way, in the order they were sent */
    struct fpga_entry entries[FPGA_WAITING];
    int32_t entering; /* likewise, in the order of their clocks */
    struct fpga_ao aos[FPGA_AO_WRITES];
    int32_t ao_waiting;
    int32_t write_ack; /* latest write that arrived */
    int64_t refused;   /* writes and entries */
    int64_t late;      /* what was posted behind the exchange it was meant for */
    struct fpga_refusal refusal;
};

/* Power on at clock 0: memories free, outputs low and 0 V, not armed; the first interrupt is one
 * irq_every later. */
void fpga_reset(struct fpga *f, const struct fpga_config *config);

/* Do all that happens up to and including `clock`, which is not before the card's. A write arrives
 * behind an exchange of the same clock. Costs per event, not per slot. */
void fpga_advance(struct fpga *f, int64_t clock);

/* Send a write of a pulse memory. It arrives at its clock, now if that has passed, and not before
 * those sent earlier; then it is taken whole, or refused whole and counted. */
enum fpga_status fpga_post_write(struct fpga *f, const struct fpga_write *w);

/* Send a change of the outputs of its mask; at the first exchange at or behind its clock they have
 * the levels of value. Of one clock the latest sent wins. */
enum fpga_status fpga_post_entry(struct fpga *f, const struct fpga_entry *e);

/* Send all analog outputs [V], 16 bit of +-10 V, likewise and in the order they were sent. */
enum fpga_status fpga_post_ao(struct fpga *f, const struct fpga_ao *a);

/* Levels of the host, from the next exchange on. */
void fpga_set_host(struct fpga *f, bool run, uint32_t servo);

/* End a stop at the next exchange if no cause of it is left then. */
void fpga_reset_stop(struct fpga *f);

/* Channels whose input is to have another level than it has or is about to take; and such a change
 * of one, with the clock at which it was or will be taken, 0 unknown: now. An exchange sees what
 * changed at its clock or before. */
uint32_t fpga_inputs_changed(const struct fpga *f, uint32_t levels);
void fpga_change_input(struct fpga *f, int channel, int64_t clock);

/* Analog inputs [V], 16 bit of +-10 V; drives, bits 0 - 5 ready, 8 - 13 alarm; emergency stop. From
 * the next exchange on. */
void fpga_set_ai(struct fpga *f, const double volts[FPGA_ANALOG]);
void fpga_set_drives(struct fpga *f, uint32_t drives, bool emergency_stop);

/* Pulses put out up to and including the card's clock, forward minus backward [pulses]. */
void fpga_pulses(const struct fpga *f, int64_t pulses[FPGA_AXES]);

/* Slot of the memory that plays; 0 if none. */
int32_t fpga_slot(const struct fpga *f);

/* What a status means, in words. */
const char *fpga_status_text(enum fpga_status s);

/* Within the core: the clock of the first exchange behind the card's clock, and of the first at or
 * behind a clock; what an exchange and a stop do with the pulse memories; a refusal. */
int64_t fpga_next_exchange(const struct fpga *f);
int64_t fpga_exchange_of(const struct fpga *f, int64_t clock);
void fpga_play_exchange(struct fpga *f);
void fpga_play_stop(struct fpga *f);
enum fpga_status fpga_refuse(struct fpga *f, enum fpga_status s);

#endif
