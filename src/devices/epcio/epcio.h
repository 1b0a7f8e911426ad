/* epcio - the EPCIO motion card: six DDA channels with FIFO, nine encoder counters, six position
 * loops, eight DAC and ADC channels, local and remote I/O, timer and watchdog, interrupt latch.
 * This file lets time pass on the card; registers.h has what the host writes, README.md the timing.
 *
 *     struct epcio card;
 *     epcio_reset(&card, &config);
 *     for (clock = 0; ; clock += period) {        each sampling instant of the loops
 *         epcio_advance(&card, clock);            all events up to and including this clock
 *         epcio_convert(&card);                   DAC codes of the instant before reach the outputs
 *         epcio_sample(&card, &lines, &bad);      encoders, local inputs, voltages
 *         ...                                     host: registers.h
 *         epcio_control(&card);                   error counters, position loops, new DAC codes
 *     }
 */
#ifndef EPCIO_H
#define EPCIO_H

#include <assert.h>
#include <stdbool.h>
#include <stdint.h>

#include "adc.h"
#include "analog.h"
#include "bus.h"
#include "card.h"
#include "dda.h"
#include "encoder.h"
#include "fifo.h"
#include "irq.h"
#include "latch.h"
#include "local_io.h"
#include "ploop.h"
#include "pulse.h"
#include "remote_io.h"
#include "status.h"
#include "timer.h"

enum {
    EPCIO_ENCODERS = 9,
    EPCIO_LOOPS = 7, /* error counters: one for each axis, and one for a command position
                      * that the host writes */
    EPCIO_SETS = 2,  /* sets of remote I/O slaves */
    EPCIO_FIFO_DEPTH = 63,
    EPCIO_WIDTH_MAX = 65535, /* [clocks] of a pulse: 16-bit register */
};
static_assert((int)EPCIO_AXES <= (int)DDA_CHANNELS_MAX, "a DDA channel per axis");

/* Wiring and settings that are fixed before power on. */
struct epcio_config {
    bool active[EPCIO_AXES]; /* the axis is used; others cost no computing time */
    struct pulse_config pulse[EPCIO_AXES];
    struct encoder_config encoder[EPCIO_ENCODERS];
    struct ploop_config loop;
    struct analog_trim trim[ANALOG_DACS];
    struct adc_config adc;
    struct remote_io_config remote;
};

/* Level registers of the host, read at each epcio_control(). */
struct epcio_host {
    int32_t gain[EPCIO_AXES];   /* P gain of the position loop, 0 .. 65535 (ploop.h) */
    bool loop_on[EPCIO_LOOPS];  /* the error counter counts; off, it is 0 */
    int32_t command;            /* [pulses] command of the seventh error counter; may wrap */
    bool dac_loop[EPCIO_AXES];  /* source of the DAC: position loop, else software */
    double volts[ANALOG_DACS];  /* [V] software voltage; saturates at +-10 V */
    bool index_low[EPCIO_AXES]; /* index on at the low level, behind the wiring's inversion */
};

/* Inputs of the card at its pins at an instant. */
struct epcio_lines {
    double phase[EPCIO_ENCODERS];   /* [line periods] of the encoders */
    bool unplugged[EPCIO_ENCODERS]; /* the encoder's plug is out */
    double volts[ADC_CHANNELS];     /* [V] of the ADC, held until the next instant */
    struct local_io_lines local;
    bool remote_kept;                          /* `remote` is not given: it has not changed */
    struct remote_io_lines remote[EPCIO_SETS]; /* held until the next instant */
};

struct epcio {
    struct epcio_config config;
    struct epcio_host host;
    struct epcio_lines lines; /* inputs as sampled last */
    int64_t clock;            /* [25 ns] all events up to and including it have happened */
    struct dda dda;
    struct pulse pulse[EPCIO_AXES];
    struct fifo fifo[EPCIO_AXES];
    int32_t entry[EPCIO_AXES][EPCIO_FIFO_DEPTH]; /* [pulses] commands in the FIFOs */
    int32_t minimum;                /* minimum stock, below or at which a FIFO interrupts */
    int32_t underflows[EPCIO_AXES]; /* number of DDA times that found an empty FIFO after motion */
    int32_t overflows;              /* number of frames refused because a FIFO was full */
    struct bus bus;
    int32_t cmd_ack; /* sequence number of the latest transaction that arrived */
    int32_t frames_taken;
    int32_t frames_refused;
    struct epcio_refusal refusal; /* reason of the latest refusal */
    struct encoder encoder[EPCIO_ENCODERS];
    int32_t counter[EPCIO_ENCODERS]; /* the encoders that count: of active axes, and 7 to 9 */
    int counters;                    /* how many count */
    struct latch latch[EPCIO_ENCODERS];
    struct latch_moments moments; /* latch triggers since the latest instant */
    struct ploop loop[EPCIO_LOOPS];
    int64_t command; /* [pulses] command of the seventh error counter, unwrapped */
    struct analog analog;
    struct adc_control adc_control;
    struct adc adc;
    struct local_io_control local_control;
    struct local_io local;
    struct remote_io_control remote_control[EPCIO_SETS];
    struct remote_io remote[EPCIO_SETS];
    bool remote_used; /* a set has been on since power on */
    struct timer timer;
    struct watchdog watchdog;
    int64_t slow_due; /* [clock] of the next event of ADC, remote I/O, timer and watchdog */
    bool run;         /* the host lets the DDA run */
    struct irq irq;
};

/* Six active axes, A/B encoders x4 with 2500 lines, pulse and direction of 1 us, P loop scale 6,
 * ADC of 14 bit and 10 us, remote exchanges of 144 us. */
struct epcio_config epcio_default_config(void);

/* Power on at clock 0: the DDA runs with the reset length and divider, FIFOs are empty, the
 * interrupt mask is 0, the gate of the outputs is open. A wrong configuration is refused and
 * changes nothing. */
enum epcio_status epcio_reset(struct epcio *card, const struct epcio_config *config);

/* Write one command per axis to the FIFOs, all or none. */
enum epcio_status epcio_write_frame(struct epcio *card, const int32_t frame[EPCIO_AXES]);

/* Emergency stop: empty the FIFOs and drop the transactions on their way, whose frames count as
 * refused. The DDA time in progress ends as commanded. */
void epcio_clear(struct epcio *card);

/* Let time pass up to and including `clock`. The order at one clock is: DDA boundary; timer,
 * watchdog, ADC, remote I/O; arriving transactions. The computing time is per event, not per
 * clock. */
void epcio_advance(struct epcio *card, int64_t clock);

/* Sample the pins at the card's clock. On EPCIO_BAD_PHASE or EPCIO_BAD_VOLTS nothing was sampled
 * and *bad is the encoder or the channel. */
enum epcio_status epcio_sample(struct epcio *card, const struct epcio_lines *lines, int *bad);

/* Run error counters and position loops at the card's clock and load the new DAC codes. */
void epcio_control(struct epcio *card);

/* The DAC codes of the latest epcio_control() reach the outputs. */
void epcio_convert(struct epcio *card);

/* Whether the outputs are held off: gate closed, emergency stop, or watchdog expired. Then the DACs
 * are at 0 V before trim and local outputs off. The DDA stands still; only an emergency stop lets
 * the DDA time in progress end and keeps the FIFOs empty. */
bool epcio_off(const struct epcio *card);

/* Pulses of each axis up to and including the card's clock, forward minus backward. */
void epcio_pulses(const struct epcio *card, int64_t pulses[EPCIO_AXES]);

/* Voltage at the terminal of a DAC [V], channel 0 .. 7. */
double epcio_volts(const struct epcio *card, int channel);

/* For the card's own files: evaluate the minimum-stock comparator of an axis; pass on events of an
 * encoder counter to interrupts and triggers; find the next event after a register has changed. */
void epcio_watch_stock(struct epcio *card, int axis);
void epcio_encoder_events(struct epcio *card, int encoder, int events);
void epcio_plan(struct epcio *card);

#endif
