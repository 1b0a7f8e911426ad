/* The EPCIO card: six DDA channels with FIFO, nine encoder counters, six position loops, eight DAC,
 * interrupt latch. README.md has the timing diagrams.
 *
 *     struct epcio card;
 *     epcio_reset(&card, &config);
 *     for (clock = 0; ; clock += period) {        each sampling instant of the loops
 *         epcio_advance(&card, clock);            boundaries and bus writes up to and including it
 *         epcio_convert(&card);                   DAC codes of the instant before reach the outputs
 *         epcio_sample(&card, phase);             encoders
 *         ...                                     host: card.host, epcio_set_..., epcio_post
 *         epcio_control(&card);                   error counters, position loops, new DAC codes
 *     }
 */
#ifndef EPCIO_H
#define EPCIO_H

#include <stdbool.h>
#include <stdint.h>

#include "analog.h"
#include "bus.h"
#include "dda.h"
#include "encoder.h"
#include "fifo.h"
#include "irq.h"
#include "ploop.h"

enum {
    EPCIO_CLOCK_HZ = 40000000,
    EPCIO_CLOCK_NS = 25,
    EPCIO_AXES = 6,
    EPCIO_ENCODERS = 9,
};
_Static_assert((int)DDA_CHANNELS == (int)EPCIO_AXES && (int)BUS_AXES == (int)EPCIO_AXES,
               "a DDA channel per axis");

/* DDA length and divider after reset: one DDA time is 2^12 * 10 clocks = 1.024 ms. */
enum { EPCIO_RESET_LENGTH = 12, EPCIO_RESET_DIVIDER = 10 };

enum epcio_status {
    EPCIO_OK,
    EPCIO_FIFO_FULL,            /* a FIFO holds 63 commands already */
    EPCIO_COMMAND_TOO_LARGE,    /* |command| > 2^length - 1 */
    EPCIO_AXIS_UNUSED,          /* pulses for an axis that is not active */
    EPCIO_DROPPED,              /* an emergency stop caught the frame on its way */
    EPCIO_BAD_LENGTH,           /* not 10 .. 15 bit */
    EPCIO_BAD_DIVIDER,          /* not 1 .. 65535 */
    EPCIO_STOCK_TOO_LARGE,      /* a command in stock does not fit the shorter length */
    EPCIO_BUS_FULL,             /* eight transactions are on their way */
    EPCIO_BAD_PHASE,            /* an encoder phase is no number or beyond 2^50 lines */
};

struct epcio_config {
    bool active[EPCIO_AXES];                        /* an unused axis costs nothing */
    struct encoder_config encoder[EPCIO_ENCODERS];
    struct ploop_config loop;
};

/* Level registers of the host: read at each epcio_control(). */
struct epcio_host {
    int32_t gain[EPCIO_AXES];       /* P gain */
    bool    loop_on[EPCIO_AXES];
    bool    dac_loop[EPCIO_AXES];   /* DAC source: position loop, else software */
    double  volts[ANALOG_DACS];     /* [V] software voltage */
};

/* Why the latest refused frame was refused. */
struct epcio_refusal {
    enum epcio_status status;
    int32_t axis;                   /* 0 .. 5 */
    int32_t command;                /* [pulses] */
};

struct epcio {
    struct epcio_config config;
    struct epcio_host   host;
    int64_t             clock;                      /* [25 ns] everything up to here has happened */
    struct dda          dda;
    struct fifo         fifo[EPCIO_AXES];
    int32_t             minimum;                    /* minimum stock */
    int32_t             underflows[EPCIO_AXES];     /* DDA times begun empty after motion */
    struct bus          bus;
    int32_t             cmd_ack;                    /* latest transaction that arrived */
    int32_t             frames_taken;
    int32_t             frames_refused;
    struct epcio_refusal refusal;
    struct encoder      encoder[EPCIO_ENCODERS];
    struct ploop        loop[EPCIO_AXES];
    struct analog       analog;
    struct irq          irq;
};

/* What a status means, for messages. */
const char *epcio_status_text(enum epcio_status status);

/* Power on at clock 0: DDA running with the reset length and divider, FIFOs empty, mask 0. */
void epcio_reset(struct epcio *card, const struct epcio_config *config);

/* Do all that happens up to and including `clock`: DDA boundaries and arriving transactions, a
 * boundary before a transaction of the same clock. Costs per event, not per clock. */
void epcio_advance(struct epcio *card, int64_t clock);

/* DDA length [bit] and divider. They hold from the next boundary on (see dda_set_time). */
enum epcio_status epcio_set_dda(struct epcio *card, int32_t length, int32_t divider);

/* DDA and FIFO run. */
void epcio_set_run(struct epcio *card, bool run);

/* Minimum stock of all FIFOs; raising it to or above the stock is a fall too. */
void epcio_set_minimum(struct epcio *card, int32_t minimum);

/* Send a transaction; it is applied at its clock, now if that has passed. */
enum epcio_status epcio_post(struct epcio *card, const struct bus_write *write);

/* Write one command per axis to the FIFOs, all or none. */
enum epcio_status epcio_write_frame(struct epcio *card, const int32_t frame[EPCIO_AXES]);

/* Emergency stop: empty the FIFOs and drop the transactions on their way, whose frames count as
 * refused. The DDA time in progress ends as commanded. */
void epcio_clear(struct epcio *card);

/* Sample all encoders (the axes, then 7 to 9) at the card's clock. On EPCIO_BAD_PHASE
 * *bad is the encoder, and those before it have been sampled. */
enum epcio_status epcio_sample(struct epcio *card, const double phase[EPCIO_ENCODERS], int *bad);

/* Error counters, position loops, DAC codes at the card's clock. */
void epcio_control(struct epcio *card);

/* The DAC codes of the latest epcio_control() reach the outputs. */
void epcio_convert(struct epcio *card);

/* Choose the interrupt sources that pull the line; the same while acknowledging flags. */
void epcio_set_mask(struct epcio *card, uint32_t mask);
void epcio_acknowledge(struct epcio *card, uint32_t flags, uint32_t mask);

/* Pulses put out up to and including the card's clock, forward minus backward [pulses]. */
void epcio_pulses(const struct epcio *card, int64_t pulses[EPCIO_AXES]);

#endif
