/* What the host writes. A value out of range is refused with a status and changes nothing; axes,
 * encoders and channels count from 0. */
#ifndef REGISTERS_H
#define REGISTERS_H

#include "epcio.h"

/* DDA and FIFO. */

/* DDA length [bit] and divider. They hold from the next boundary on (see dda_set_time);
 * dda_divider() gives the divider nearest to a wanted DDA time. */
enum epcio_status epcio_set_dda(struct epcio *card, int32_t length, int32_t divider);

/* DDA and FIFO run. */
void epcio_set_run(struct epcio *card, bool run);

/* Minimum stock of all FIFOs, 0 .. 62; raising it to or above the stock is a fall too. */
enum epcio_status epcio_set_minimum(struct epcio *card, int32_t minimum);

/* Send a transaction; it is applied at its clock, now if that has passed. */
enum epcio_status epcio_post(struct epcio *card, const struct bus_write *write);

/* Take back the newest commands of an axis, at most n; *erased tells how many. */
enum epcio_status epcio_erase_last(struct epcio *card, int axis, int32_t n, int32_t *erased);

/* Shift the oldest command of an axis out unused; EPCIO_FIFO_EMPTY if there is none. */
enum epcio_status epcio_shift_out(struct epcio *card, int axis, int32_t *command);

/* Encoders. */

/* Format, rate, wiring, filter and index of a counter; its value stays. */
enum epcio_status epcio_set_encoder(struct epcio *card, int encoder,
                                    const struct encoder_config *config);

/* Set counters to zero, a bit each. */
enum epcio_status epcio_clear_encoders(struct epcio *card, uint32_t encoders);

/* Comparator of a counter; see encoder_set_compare(). */
enum epcio_status epcio_set_compare(struct epcio *card, int encoder, bool on, int32_t value);

/* Choose what latches a counter, and arm: only the first trigger, or each. */
enum epcio_status epcio_set_latch(struct epcio *card, int encoder, uint32_t source, bool keep_last);

/* Loops and analog. */

/* Gains, loops, DAC sources, voltages and levels of the index, at once. */
enum epcio_status epcio_set_host(struct epcio *card, const struct epcio_host *host);

/* Error counters begin anew from zero, a bit each. */
enum epcio_status epcio_clear_loops(struct epcio *card, uint32_t loops);

/* Trigger output of a DAC; source 0 gives the channel back. */
enum epcio_status epcio_set_trigger(struct epcio *card, int channel,
                                    const struct analog_trigger *trigger);

/* ADC registers; epcio_start_adc() begins. */
enum epcio_status epcio_set_adc(struct epcio *card, const struct adc_control *control);
void epcio_start_adc(struct epcio *card);
void epcio_stop_adc(struct epcio *card);

/* I/O, timer, watchdog. */
enum epcio_status epcio_set_local_io(struct epcio *card, const struct local_io_control *control);
enum epcio_status epcio_set_remote_io(struct epcio *card, int set,
                                      const struct remote_io_control *control);
enum epcio_status epcio_set_timer(struct epcio *card, bool on, int64_t period);
enum epcio_status epcio_set_watchdog(struct epcio *card, bool on, int32_t value, int64_t reset);
void epcio_refresh_watchdog(struct epcio *card);

/* Interrupts. */

/* Choose the interrupt sources that pull the line; the same while acknowledging flags. */
void epcio_set_mask(struct epcio *card, const uint32_t mask[IRQ_PAGES]);
void epcio_acknowledge(struct epcio *card, const uint32_t flags[IRQ_PAGES],
                       const uint32_t mask[IRQ_PAGES]);

/* Module resets. */
enum epcio_module {
    EPCIO_RESET_DDA = 1, /* FIFOs empty, transactions dropped, reset DDA time from the next
                               boundary on */
    EPCIO_RESET_ENC,     /* counters, latches and comparators */
    EPCIO_RESET_RIO0,    /* remote I/O of a set off, outputs 0 */
    EPCIO_RESET_RIO1,
    EPCIO_RESET_ADC,  /* stopped, registers 0 */
    EPCIO_RESET_LIO,  /* local outputs off, edges rising, timer and watchdog off */
    EPCIO_RESET_PCL,  /* gains 0, loops off */
    EPCIO_RESET_DAC,  /* software source, 0 V, triggers off */
    EPCIO_RESET_PERI, /* the six modules from ENC to LIO */
    EPCIO_RESET_ALL,  /* all of these, and interrupt flags and mask */
};

/* Reset a module; what has been counted (frames, pulses, underflows) stays. */
enum epcio_status epcio_reset_module(struct epcio *card, enum epcio_module module);

/* What any status means, those of blocks too, for messages. */
const char *epcio_status_text(enum epcio_status status);

#endif
