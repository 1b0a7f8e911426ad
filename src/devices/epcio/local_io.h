/* local_io - the card's local I/O: digital inputs with edge interrupts, home and over-travel
 * switches of the axes, emergency stop, and outputs behind a gate. */
#ifndef LOCAL_IO_H
#define LOCAL_IO_H

#include <stdbool.h>
#include <stdint.h>

enum {
    LOCAL_IO_AXES = 6,
    LOCAL_IO_LDIS = 8,     /* local inputs LDI0 .. LDI7 */
    LOCAL_IO_DFIS = 7,     /* dual-function inputs DFI0 .. DFI6 */
    LOCAL_IO_LDOS = 8,     /* local outputs LDO0 .. LDO7 */
    LOCAL_IO_DFI_STOP = 6, /* the dual-function input of the emergency stop */
};

/* First bits of events and of `inputs`, in the order of the interrupt latch. */
enum local_io_event {
    LOCAL_IO_EVENT_LDI = 0, /* 8 bits: LDI0 .. LDI7 */
    LOCAL_IO_EVENT_DFI = 8, /* 7 bits: DFI0 .. DFI6 */
};

/* Edge at which an input fires. */
enum local_io_edge {
    LOCAL_IO_RISE,
    LOCAL_IO_FALL,
    LOCAL_IO_BOTH,
};

/* Levels at the terminals; 1 is active, whatever the wiring. Bits beyond the last are ignored. */
struct local_io_lines {
    uint32_t ldi;  /* bits 0 .. 7 */
    uint32_t dfi;  /* bits 0 .. 6 */
    uint32_t home; /* bits 0 .. 5: home switch of axis 1 .. 6 */
    uint32_t up;   /* bits 0 .. 5: over-travel switch at the positive end */
    uint32_t down; /* bits 0 .. 5: over-travel switch at the negative end */
    bool stop;     /* emergency stop is pressed */
    bool power;    /* 24 V field power is present */
};

/* Registers of the host. They may change at any clock; edges and `dedicated` are read when a sample
 * is taken, the others act at once. */
struct local_io_control {
    enum local_io_edge ldi_edge[LOCAL_IO_LDIS];
    enum local_io_edge dfi_edge[LOCAL_IO_DFIS];
    uint32_t dedicated; /* bits 0 .. 6: DFI i reads its dedicated signal, else its terminal */
    uint32_t ldo;       /* bits 0 .. 7: local outputs */
    uint32_t servo_on;  /* bits 0 .. 5: servo-on outputs */
    bool position_ready;
    bool stop_enable; /* the emergency stop acts on the card, whatever `dedicated` says */
    bool gate;        /* the gate is open: outputs reach their terminals */
};

/* All zero is the state after power on: nothing sampled, so no field power yet. */
struct local_io {
    struct local_io_lines seen; /* latest sample */
    uint32_t inputs;            /* its LDI and DFI in the bits of local_io_event */
    bool primed;                /* the first sample has come */
};

/* Levels at the output terminals. */
struct local_io_outputs {
    uint32_t ldo;      /* bits 0 .. 7 */
    uint32_t servo_on; /* bits 0 .. 5 */
    bool position_ready;
};

enum local_io_status {
    LOCAL_IO_OK,
    LOCAL_IO_BAD_EDGE,      /* not a local_io_edge */
    LOCAL_IO_BAD_DEDICATED, /* dedicated has a bit above 6 */
    LOCAL_IO_BAD_LDO,       /* ldo has a bit above 7 */
    LOCAL_IO_BAD_SERVO_ON,  /* servo_on has a bit above 5 */
};

/* What a status but 0 says, in a sentence without a full stop. */
const char *local_io_status_text(enum local_io_status status);

/* LOCAL_IO_OK, or the first error in the order of local_io_status. The other functions take only
 * what passed this check. */
enum local_io_status local_io_check_control(const struct local_io_control *set);

/* Sample the terminals. Returns the events in the bits of local_io_event; the first sample has
 * none.
 *
 * A dedicated DFI0 .. DFI5 is the over-travel signal of axis 1 .. 6, up or down: one switch closing
 * while the other stays closed is no edge. A dedicated DFI6 is the emergency stop.
 * An input fires if the signal chosen now differs from that same signal a sample ago, in the
 * direction chosen now. So a change of `dedicated` or of an edge type fires nothing by itself, and
 * an edge of the new signal is not lost. A pulse between two samples is not seen.
 * Inputs are read also without field power. */
uint32_t local_io_sample(const struct local_io_control *set, struct local_io *io,
                         const struct local_io_lines *lines);

/* Whether the emergency stop acts: enabled now and pressed at the latest sample; it is not
 * latched. */
bool local_io_stopped(const struct local_io_control *set, const struct local_io *io);

/* Outputs at the terminals. All of them, position ready too, are driven by the field power: they
 * are 0 without it, with the gate closed, while the emergency stop acts, and with `off` (the
 * watchdog holds them off). They come back by themselves when the last of these conditions ends. */
struct local_io_outputs local_io_outputs(const struct local_io_control *set,
                                         const struct local_io *io, bool off);

#endif
