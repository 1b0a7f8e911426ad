#include "register_map.h"

#include <math.h>

#include "registers.h"

/* Largest value that any register takes: 32 bits. */
#define VALUE_MAX 4294967295.0

/* A register is one member of a block's settings: the functions copy the settings, change the
 * member and set them all by registers.h, which checks them. */

static enum epcio_status write_fifo_erase(struct epcio *card, int i, double value)
{
    int32_t erased;
    const int32_t n = value > EPCIO_FIFO_DEPTH ? EPCIO_FIFO_DEPTH : (int32_t)value;
    return epcio_erase_last(card, i, n, &erased);
}

static enum epcio_status write_fifo_shift_out(struct epcio *card, int i)
{
    int32_t command;
    return epcio_shift_out(card, i, &command);
}

/* The value as int32_t; one that does not fit becomes INT32_MIN, which every block refuses. */
static int32_t small(double value)
{
    return fabs(value) <= INT32_MAX ? (int32_t)value : INT32_MIN;
}

static uint32_t bits(double value)
{
    return value >= 0.0 && value <= UINT32_MAX ? (uint32_t)value : UINT32_MAX;
}

static enum epcio_status write_encoder(struct epcio *card, int base, int i, double value)
{
    struct encoder_config c = card->encoder[i].config;
    switch (base) {
    case REG_ENC_FORMAT: c.format = (enum encoder_format)small(value); break;
    case REG_ENC_RATE:   c.rate = small(value); break;
    case REG_ENC_WIRING: c.wiring = bits(value); break;
    default:             c.filter = small(value); break;
    }
    return epcio_set_encoder(card, i, &c);
}

static bool is_flag(double value)
{
    return value == 0.0 || value == 1.0;
}

static enum epcio_status write_compare(struct epcio *card, int base, int i, double value)
{
    const struct encoder *e = &card->encoder[i];
    if (base == REG_ENC_COMPARE_ON)
        return is_flag(value) ? epcio_set_compare(card, i, value != 0.0, e->compare)
                              : EPCIO_BAD_VALUE;
    if (!(fabs(value) <= INT32_MAX))
        return EPCIO_BAD_VALUE;
    return epcio_set_compare(card, i, e->compare_on, (int32_t)value);
}

static enum epcio_status write_latch(struct epcio *card, int base, int i, double value)
{
    struct latch *l = &card->latch[i];
    if (base == REG_ENC_LATCH)
        return epcio_set_latch(card, i, bits(value), l->keep_last);
    if (!is_flag(value))
        return EPCIO_BAD_VALUE;
    return epcio_set_latch(card, i, l->source, value != 0.0);
}

static enum epcio_status write_trigger(struct epcio *card, int base, int i, double value)
{
    struct analog_trigger t = card->analog.trigger[i];
    if (base == REG_DAC_TRIGGER) {
        if (!(value >= 0.0))
            return EPCIO_BAD_MASK;
        t.source = bits(value);
    } else {
        t.volts = value;
    }
    return epcio_set_trigger(card, i, &t);
}

static enum epcio_status write_adc(struct epcio *card, int base, int i, double value)
{
    struct adc_control c = card->adc_control;
    switch (base) {
    case REG_ADC_MODE:         c.mode = (enum adc_mode)small(value); break;
    case REG_ADC_CHANNEL:      c.channel = small(value); break;
    case REG_ADC_ENABLED:      c.enabled = bits(value); break;
    case REG_ADC_COMPARE_ON:   c.compare_on = bits(value); break;
    case REG_ADC_IGNORED_BITS: c.ignored_bits = small(value); break;
    case REG_ADC_TAGGED:       c.tagged = bits(value); break;
    case REG_ADC_RANGE:        c.range[i] = (enum adc_range)small(value); break;
    case REG_ADC_COMPARE:      c.compare[i] = (enum adc_compare)small(value); break;
    default:                   c.compare_volts[i] = value; break;
    }
    return epcio_set_adc(card, &c);
}

static enum epcio_status run_adc(struct epcio *card, double value)
{
    if (!is_flag(value))
        return EPCIO_BAD_VALUE;
    if (value != 0.0)
        epcio_start_adc(card);
    else
        epcio_stop_adc(card);
    return EPCIO_OK;
}

static enum epcio_status write_local(struct epcio *card, int base, int i, double value)
{
    struct local_io_control c = card->local_control;
    bool flag =
        base == REG_LIO_POSITION_READY || base == REG_LIO_STOP_ENABLE || base == REG_LIO_GATE;
    if (flag && !is_flag(value))
        return EPCIO_BAD_VALUE;
    switch (base) {
    case REG_LIO_OUTPUTS:        c.ldo = bits(value); break;
    case REG_LIO_SERVO_ON:       c.servo_on = bits(value); break;
    case REG_LIO_POSITION_READY: c.position_ready = value != 0.0; break;
    case REG_LIO_STOP_ENABLE:    c.stop_enable = value != 0.0; break;
    case REG_LIO_GATE:           c.gate = value != 0.0; break;
    case REG_LIO_DEDICATED:      c.dedicated = bits(value); break;
    case REG_LIO_LDI_EDGE:       c.ldi_edge[i] = (enum local_io_edge)small(value); break;
    default:                     c.dfi_edge[i] = (enum local_io_edge)small(value); break;
    }
    return epcio_set_local_io(card, &c);
}

static enum epcio_status write_timer(struct epcio *card, int base, double value)
{
    const struct watchdog *w = &card->watchdog;
    int64_t reset = w->reset_period > 0 ? w->reset_period : 1;
    switch (base) {
    case REG_TIMER_PERIOD:
        return value == 0.0 ? epcio_set_timer(card, false, 1)
                            : epcio_set_timer(card, true, (int64_t)value);
    case REG_WATCHDOG_RESET:
        return epcio_set_watchdog(card, w->on, w->value > 0 ? w->value : 1, (int64_t)value);
    default:
        return value == 0.0 ? epcio_set_watchdog(card, false, 1, reset)
                            : epcio_set_watchdog(card, true, small(value), reset);
    }
}

static enum epcio_status write_remote(struct epcio *card, int base, int i, double value)
{
    enum { INPUTS = 4, SLAVES = REMOTE_IO_SLAVES };
    bool whole_set = base == REG_RIO_RETRY || base == REG_RIO_ENABLED;
    int set = whole_set ? i : i / (INPUTS * SLAVES);
    int slave = i / INPUTS % SLAVES, place = i % INPUTS;
    struct remote_io_control c = card->remote_control[set];
    switch (base) {
    case REG_RIO_RETRY: c.retry_limit = small(value); break;
    case REG_RIO_ENABLED:
        c.enabled = bits(value);
        c.on = value != 0.0;
        break;
    case REG_RIO_EDGE: c.edge[slave][place] = (enum remote_io_edge)small(value); break;
    default:
        if (!(value >= 0.0 && value <= UINT16_MAX))
            return EPCIO_BAD_VALUE;
        c.out[slave][place] = (uint16_t)value;
        break;
    }
    return epcio_set_remote_io(card, set, &c);
}

/* CCN 17: a case for each register with an effect of its own, then the blocks by their ranges. */
static enum epcio_status write_one(struct epcio *card, int base, int i, double value)
{
    switch (base) {
    case REG_FIFO_ERASE:       return write_fifo_erase(card, i, value);
    case REG_FIFO_SHIFT_OUT:   return write_fifo_shift_out(card, i);
    case REG_ENC_CLEAR:        return epcio_clear_encoders(card, (uint32_t)1 << i);
    case REG_ENC_COMPARE:
    case REG_ENC_COMPARE_ON:   return write_compare(card, base, i, value);
    case REG_ENC_LATCH:
    case REG_ENC_LATCH_LAST:   return write_latch(card, base, i, value);
    case REG_PCL_CLEAR:        return epcio_clear_loops(card, (uint32_t)1 << i);
    case REG_ADC_RUN:          return run_adc(card, value);
    case REG_WATCHDOG_REFRESH: epcio_refresh_watchdog(card); return EPCIO_OK;
    case REG_MODULE_RESET:     return epcio_reset_module(card, (enum epcio_module)small(value));
    default:                   break;
    }
    if (base >= REG_RIO_RETRY)
        return write_remote(card, base, i, value);
    if (base >= REG_TIMER_PERIOD)
        return write_timer(card, base, value);
    if (base >= REG_LIO_OUTPUTS)
        return write_local(card, base, i, value);
    if (base >= REG_ADC_MODE)
        return write_adc(card, base, i, value);
    return base >= REG_DAC_TRIGGER_VOLTS ? write_trigger(card, base, i, value)
                                         : write_encoder(card, base, i, value);
}

enum epcio_status epcio_write(struct epcio *card, int32_t address, double value)
{
    int base = -1;
#define EPCIO_REGISTER(first, name, count) \
    if (address >= (first) && address < (first) + (count)) \
        base = REG_##name;
    EPCIO_REGISTERS(EPCIO_REGISTER)
#undef EPCIO_REGISTER
    if (base < 0)
        return EPCIO_BAD_REGISTER;
    bool volts = base == REG_DAC_TRIGGER_VOLTS || base == REG_ADC_COMPARE_VOLTS;
    if (!(fabs(value) <= VALUE_MAX) || (!volts && value != floor(value)))
        return EPCIO_BAD_VALUE;
    return write_one(card, base, address - base, value);
}
