#include "registers.h"

#include <math.h>
#include <string.h>

static enum epcio_status of_block(enum epcio_status base, int status)
{
    return status == 0 ? EPCIO_OK : (enum epcio_status)((int)base + status);
}

static bool within(int number, int count)
{
    return number >= 0 && number < count;
}

/* DDA and FIFO. */

enum epcio_status epcio_set_dda(struct epcio *card, int32_t length, int32_t divider)
{
    if (length < EPCIO_LENGTH_MIN || length > EPCIO_LENGTH_MAX)
        return EPCIO_BAD_LENGTH;
    if (divider < 1 || divider > EPCIO_DIVIDER_MAX)
        return EPCIO_BAD_DIVIDER;
    int32_t ticks = 1 << length;
    if (ticks == card->dda.next_ticks && divider == card->dda.next_divider)
        return EPCIO_OK;
    for (int i = 0; i < EPCIO_AXES && ticks < card->dda.next_ticks; i++)
        if (fifo_largest(&card->fifo[i], card->entry[i]) > dda_largest(ticks))
            return EPCIO_STOCK_TOO_LARGE;
    dda_set_time(&card->dda, ticks, divider, card->clock);
    return EPCIO_OK;
}

void epcio_set_run(struct epcio *card, bool run)
{
    card->run = run;
    epcio_plan(card);
}

enum epcio_status epcio_set_minimum(struct epcio *card, int32_t minimum)
{
    if (minimum == card->minimum)
        return EPCIO_OK;
    if (!within(minimum, EPCIO_FIFO_DEPTH))
        return EPCIO_BAD_MINIMUM;
    card->minimum = minimum;
    for (int i = 0; i < EPCIO_AXES; i++)
        epcio_watch_stock(card, i);
    return EPCIO_OK;
}

enum epcio_status epcio_post(struct epcio *card, const struct bus_write *write)
{
    if (write->count < 0 || write->count > BUS_FRAMES)
        return EPCIO_BAD_COUNT;
    if (!bus_post(&card->bus, write))
        return EPCIO_BUS_FULL;
    epcio_advance(card, card->clock);
    return EPCIO_OK;
}

enum epcio_status epcio_erase_last(struct epcio *card, int axis, int32_t n, int32_t *erased)
{
    if (!within(axis, EPCIO_AXES))
        return EPCIO_BAD_AXIS;
    if (n < 0)
        return EPCIO_BAD_COUNT;
    *erased = fifo_erase_last(&card->fifo[axis], n);
    epcio_watch_stock(card, axis);
    return EPCIO_OK;
}

enum epcio_status epcio_shift_out(struct epcio *card, int axis, int32_t *command)
{
    if (!within(axis, EPCIO_AXES))
        return EPCIO_BAD_AXIS;
    if (!fifo_pop(&card->fifo[axis], card->entry[axis], command))
        return EPCIO_FIFO_EMPTY;
    epcio_watch_stock(card, axis);
    return EPCIO_OK;
}

/* Encoders. */

enum epcio_status epcio_set_encoder(struct epcio *card, int encoder,
                                    const struct encoder_config *config)
{
    if (!within(encoder, EPCIO_ENCODERS))
        return EPCIO_BAD_AXIS;
    enum encoder_status s = encoder_check(config);
    if (s == ENCODER_OK)
        encoder_configure(&card->encoder[encoder], config);
    return of_block(EPCIO_ENCODER, s);
}

enum epcio_status epcio_clear_encoders(struct epcio *card, uint32_t encoders)
{
    if (encoders >> EPCIO_ENCODERS)
        return EPCIO_BAD_MASK;
    for (int i = 0; i < EPCIO_ENCODERS; i++)
        if (encoders & (uint32_t)1 << i)
            epcio_encoder_events(card, i, encoder_clear(&card->encoder[i], card->clock));
    return EPCIO_OK;
}

enum epcio_status epcio_set_compare(struct epcio *card, int encoder, bool on, int32_t value)
{
    if (!within(encoder, EPCIO_ENCODERS))
        return EPCIO_BAD_AXIS;
    struct encoder *e = &card->encoder[encoder];
    epcio_encoder_events(card, encoder, encoder_set_compare(e, on, value, card->clock));
    return EPCIO_OK;
}

enum epcio_status epcio_set_latch(struct epcio *card, int encoder, uint32_t source, bool keep_last)
{
    if (!within(encoder, EPCIO_ENCODERS))
        return EPCIO_BAD_AXIS;
    if (source >> LATCH_SOURCES)
        return EPCIO_BAD_MASK;
    latch_arm(&card->latch[encoder], source, keep_last);
    return EPCIO_OK;
}

/* Loops and analog. */

enum epcio_status epcio_set_host(struct epcio *card, const struct epcio_host *host)
{
    for (int i = 0; i < EPCIO_AXES; i++)
        if (host->gain[i] < 0 || host->gain[i] > PLOOP_GAIN_MAX)
            return EPCIO_BAD_GAIN;
    for (int i = 0; i < ANALOG_DACS; i++)
        if (!isfinite(host->volts[i]))
            return EPCIO_BAD_VOLTS;
    card->host = *host;
    for (int i = 0; i < EPCIO_AXES; i++)
        card->encoder[i].index_low = host->index_low[i];
    return EPCIO_OK;
}

enum epcio_status epcio_clear_loops(struct epcio *card, uint32_t loops)
{
    if (loops >> EPCIO_LOOPS)
        return EPCIO_BAD_MASK;
    for (int i = 0; i < EPCIO_LOOPS; i++)
        if (loops & (uint32_t)1 << i)
            card->loop[i] = (struct ploop){ 0 };
    return EPCIO_OK;
}

enum epcio_status epcio_set_trigger(struct epcio *card, int channel,
                                    const struct analog_trigger *trigger)
{
    if (!within(channel, ANALOG_DACS))
        return EPCIO_BAD_AXIS;
    return analog_set_trigger(&card->analog, channel, trigger) ? EPCIO_OK : EPCIO_BAD_VOLTS;
}

enum epcio_status epcio_set_adc(struct epcio *card, const struct adc_control *control)
{
    enum adc_status s = adc_check_control(control);
    if (s == ADC_OK)
        card->adc_control = *control;
    return of_block(EPCIO_ADC, s);
}

void epcio_start_adc(struct epcio *card)
{
    adc_start(&card->config.adc, &card->adc_control, &card->adc, card->lines.volts, card->clock);
    epcio_plan(card);
}

void epcio_stop_adc(struct epcio *card)
{
    adc_stop(&card->adc);
    epcio_plan(card);
}

/* I/O, timer, watchdog. */

enum epcio_status epcio_set_local_io(struct epcio *card, const struct local_io_control *control)
{
    enum local_io_status s = local_io_check_control(control);
    if (s == LOCAL_IO_OK)
        card->local_control = *control;
    if (local_io_stopped(&card->local_control, &card->local))
        epcio_clear(card);
    epcio_plan(card);
    return of_block(EPCIO_LOCAL_IO, s);
}

enum epcio_status epcio_set_remote_io(struct epcio *card, int set,
                                      const struct remote_io_control *control)
{
    if (!within(set, EPCIO_SETS))
        return EPCIO_BAD_AXIS;
    enum remote_io_status s = remote_io_check_control(control);
    if (s == REMOTE_IO_OK) {
        card->remote_control[set] = *control;
        card->remote_used = card->remote_used || control->on;
        remote_io_update(&card->config.remote, control, &card->lines.remote[set],
                         &card->remote[set], card->clock);
        epcio_plan(card);
    }
    return of_block(EPCIO_REMOTE_IO, s);
}

enum epcio_status epcio_set_timer(struct epcio *card, bool on, int64_t period)
{
    enum timer_status s = timer_set(&card->timer, on, period, card->clock);
    epcio_plan(card);
    return of_block(EPCIO_TIMER, s);
}

enum epcio_status epcio_set_watchdog(struct epcio *card, bool on, int32_t value, int64_t reset)
{
    enum timer_status s = watchdog_set(&card->watchdog, on, value, reset);
    epcio_plan(card);
    return of_block(EPCIO_TIMER, s);
}

void epcio_refresh_watchdog(struct epcio *card)
{
    watchdog_refresh(&card->watchdog);
    epcio_plan(card);
}

/* Interrupts. */

void epcio_set_mask(struct epcio *card, const uint32_t mask[IRQ_PAGES])
{
    irq_set_mask(&card->irq, mask, card->clock);
}

void epcio_acknowledge(struct epcio *card, const uint32_t flags[IRQ_PAGES],
                       const uint32_t mask[IRQ_PAGES])
{
    irq_acknowledge(&card->irq, flags, mask, card->clock);
}

/* Module resets. */

static void reset_dda(struct epcio *card)
{
    epcio_clear(card);
    dda_set_time(&card->dda, 1 << EPCIO_RESET_LENGTH, EPCIO_RESET_DIVIDER, card->clock);
}

static void reset_encoders(struct epcio *card)
{
    for (int i = 0; i < EPCIO_ENCODERS; i++) {
        encoder_set_compare(&card->encoder[i], false, 0, card->clock);
        encoder_clear(&card->encoder[i], card->clock);
        card->latch[i] = (struct latch){ 0 };
    }
}

static void reset_remote(struct epcio *card, int set)
{
    static const struct remote_io_control OFF;
    card->remote_control[set] = OFF;
    remote_io_update(&card->config.remote, &OFF, &card->lines.remote[set], &card->remote[set],
                     card->clock);
}

static void reset_local(struct epcio *card)
{
    card->local_control = (struct local_io_control){ .gate = true };
    timer_set(&card->timer, false, 1, card->clock);
    watchdog_set(&card->watchdog, false, 1, 1);
}

static void reset_one(struct epcio *card, enum epcio_module module)
{
    switch (module) {
    case EPCIO_RESET_DDA:  reset_dda(card); break;
    case EPCIO_RESET_ENC:  reset_encoders(card); break;
    case EPCIO_RESET_RIO0: reset_remote(card, 0); break;
    case EPCIO_RESET_RIO1: reset_remote(card, 1); break;
    case EPCIO_RESET_ADC:
        card->adc = (struct adc){ 0 };
        card->adc_control = (struct adc_control){ 0 };
        break;
    case EPCIO_RESET_LIO: reset_local(card); break;
    case EPCIO_RESET_PCL:
        memset(card->host.gain, 0, sizeof card->host.gain);
        memset(card->host.loop_on, 0, sizeof card->host.loop_on);
        memset(card->loop, 0, sizeof card->loop);
        break;
    case EPCIO_RESET_DAC:
        memset(card->host.dac_loop, 0, sizeof card->host.dac_loop);
        memset(card->host.volts, 0, sizeof card->host.volts);
        card->analog = (struct analog){ 0 };
        break;
    default: break;
    }
}

enum epcio_status epcio_reset_module(struct epcio *card, enum epcio_module module)
{
    int first = module, last = module;
    if ((int)module < EPCIO_RESET_DDA || module > EPCIO_RESET_ALL)
        return EPCIO_BAD_MODULE;
    if (module == EPCIO_RESET_PERI) {
        first = EPCIO_RESET_ENC;
        last = EPCIO_RESET_LIO;
    } else if (module == EPCIO_RESET_ALL) {
        first = EPCIO_RESET_DDA;
        last = EPCIO_RESET_DAC;
    }
    const struct irq silent = { .seq = card->irq.seq, .clock = card->irq.clock };
    if (module == EPCIO_RESET_ALL)
        card->irq = silent; /* emptying the FIFOs must not pull the line */
    for (int i = first; i <= last; i++)
        reset_one(card, (enum epcio_module)i);
    if (module == EPCIO_RESET_ALL)
        card->irq = silent;
    epcio_plan(card);
    return EPCIO_OK;
}

/* Of the card's widest pulse. */
static const char *pulse_text(int status)
{
    switch (status) {
    case PULSE_BAD_FORMAT: return "the pulse format is 0 to 3";
    case PULSE_BAD_WIRING: return "the pulse wiring is a sum of 1, 2, 4";
    default:               return "the pulse width is 1 to 65535 clocks";
    }
}

const char *epcio_status_text(enum epcio_status status)
{
    int number = (int)status & 0xFF;
    switch ((int)status & ~0xFF) {
    case EPCIO_PULSE:     return pulse_text(number);
    case EPCIO_ENCODER:   return encoder_status_text((enum encoder_status)number);
    case EPCIO_ADC:       return adc_status_text((enum adc_status)number);
    case EPCIO_LOCAL_IO:  return local_io_status_text((enum local_io_status)number);
    case EPCIO_REMOTE_IO: return remote_io_status_text((enum remote_io_status)number);
    case EPCIO_TIMER:     return timer_status_text((enum timer_status)number);
    default:              return card_status_text(status);
    }
}
