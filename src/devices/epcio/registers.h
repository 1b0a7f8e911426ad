/* registers - everything that the host can write to the EPCIO card (epcio.h), as functions. A value
 * out of range is refused with a status and changes nothing. Axes, encoders and channels count from
 * 0. */
#ifndef REGISTERS_H
#define REGISTERS_H

#include "epcio.h"

/* DDA and FIFO. */

/* DDA length [bit] and divider [clocks per tick]. They hold from the next boundary on (see
 * dda_set_time); dda_divider() gives the divider nearest to a wanted DDA time. */
enum epcio_status epcio_set_dda(struct epcio *card, int32_t length, int32_t divider);

/* Let DDA and FIFO run, or freeze them. */
void epcio_set_run(struct epcio *card, bool run);

/* Minimum stock of all FIFOs, 0 .. 62. Raising it to or above the stock interrupts like a fall of
 * the stock. */
enum epcio_status epcio_set_minimum(struct epcio *card, int32_t minimum);

/* Send a transaction of frames; it is applied at its clock, or now if that has passed. */
enum epcio_status epcio_post(struct epcio *card, const struct bus_write *write);

/* Take back up to n of the newest commands of an axis; *erased is their number. */
enum epcio_status epcio_erase_last(struct epcio *card, int axis, int32_t n, int32_t *erased);

/* Remove the oldest command of an axis unused; EPCIO_FIFO_EMPTY if there is none. */
enum epcio_status epcio_shift_out(struct epcio *card, int axis, int32_t *command);

/* Encoders. */

/* Format, rate, wiring, filter and index of a counter; its value stays. */
enum epcio_status epcio_set_encoder(struct epcio *card, int encoder,
                                    const struct encoder_config *config);

/* Set counters to zero; `encoders` has a bit for each. */
enum epcio_status epcio_clear_encoders(struct epcio *card, uint32_t encoders);

/* Switch the comparator of a counter and set its value [counts]; see encoder_set_compare(). */
enum epcio_status epcio_set_compare(struct epcio *card, int encoder, bool on, int32_t value);

/* Choose the sources (bits of latch.h) that latch a counter, and arm it for the first trigger, or
 * with keep_last for each. */
enum epcio_status epcio_set_latch(struct epcio *card, int encoder, uint32_t source, bool keep_last);

/* Loops and analog. */

/* Gains, loops, DAC sources, voltages and levels of the index, at once. */
enum epcio_status epcio_set_host(struct epcio *card, const struct epcio_host *host);

/* Set error counters to zero; `loops` has a bit for each. */
enum epcio_status epcio_clear_loops(struct epcio *card, uint32_t loops);

/* Set the trigger output of a DAC (analog.h) and arm it; source 0 gives the channel back. */
enum epcio_status epcio_set_trigger(struct epcio *card, int channel,
                                    const struct analog_trigger *trigger);

/* Set the ADC's registers; start it; stop it (adc.h). */
enum epcio_status epcio_set_adc(struct epcio *card, const struct adc_control *control);
void epcio_start_adc(struct epcio *card);
void epcio_stop_adc(struct epcio *card);

/* Registers of local I/O (local_io.h), of a set of remote I/O (remote_io.h), timer and watchdog
 * (timer.h; periods in [clocks]). */
enum epcio_status epcio_set_local_io(struct epcio *card, const struct local_io_control *control);
enum epcio_status epcio_set_remote_io(struct epcio *card, int set,
                                      const struct remote_io_control *control);
enum epcio_status epcio_set_timer(struct epcio *card, bool on, int64_t period);
enum epcio_status epcio_set_watchdog(struct epcio *card, bool on, int32_t value, int64_t reset);
void epcio_refresh_watchdog(struct epcio *card);

/* Interrupts. */

/* Choose the interrupt sources that pull the line; the same, and clear the flags that were read. */
void epcio_set_mask(struct epcio *card, const uint32_t mask[IRQ_PAGES]);
void epcio_acknowledge(struct epcio *card, const uint32_t flags[IRQ_PAGES],
                       const uint32_t mask[IRQ_PAGES]);

/* Module resets. */
enum epcio_module {
    EPCIO_RESET_DDA = 1, /* FIFOs empty, transactions dropped, reset DDA time from the next
                               boundary on */
    EPCIO_RESET_ENC,     /* counters zero, latches and comparators off */
    EPCIO_RESET_RIO0,    /* remote I/O of set 0 off, outputs 0 */
    EPCIO_RESET_RIO1,    /* likewise of set 1 */
    EPCIO_RESET_ADC,     /* stopped, registers 0 */
    EPCIO_RESET_LIO,     /* local outputs off, edges rising, timer and watchdog off */
    EPCIO_RESET_PCL,     /* gains 0, loops off */
    EPCIO_RESET_DAC,     /* software source, 0 V, triggers off */
    EPCIO_RESET_PERI,    /* the six modules from ENC to LIO */
    EPCIO_RESET_ALL,     /* all of these, and interrupt flags and mask */
};

/* Reset a module. Statistics (frames, pulses, underflows) stay. */
enum epcio_status epcio_reset_module(struct epcio *card, enum epcio_module module);

/* Text for any status, of the card or of a block, for messages; no full stop. */
const char *epcio_status_text(enum epcio_status status);

#endif
