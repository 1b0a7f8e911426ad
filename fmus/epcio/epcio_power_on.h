/* epcio_power_on - makes the card's configuration and its first register values of the parameters
 * of the epcio FMU. Included by model.c after fmi_model.h. */
#ifndef EPCIO_POWER_ON_H
#define EPCIO_POWER_ON_H

#include "register_map.h"

static struct epcio_config config_of(const struct vars *v)
{
    struct epcio_config c = {
        .loop = { .limit = v->error_limit, .scale = v->p_scale },
        .adc = { .bits = v->adc_bits, .time = v->adc_time },
        .remote = { .time = v->rio_time },
    };
    for (int i = 0; i < EPCIO_AXES; i++) {
        c.active[i] = v->active[i];
        c.pulse[i] = (struct pulse_config){ (enum pulse_format)v->pulse_format[i],
                                            (uint32_t)v->pulse_wiring[i], v->pulse_width[i] };
    }
    for (int i = 0; i < EPCIO_ENCODERS; i++)
        c.encoder[i] = (struct encoder_config){ (enum encoder_format)v->enc_format[i],
                                                v->enc_rate[i], (uint32_t)v->enc_wiring[i],
                                                v->enc_filter[i], v->index_lines[i] };
    for (int i = 0; i < ANALOG_DACS; i++)
        c.trim[i] = (struct analog_trim){ v->dac_gain[i], v->dac_offset[i] };
    return c;
}

/* Report a refused configuration: the parameter is found by checking the parts one by one. */
static int refuse_config(struct fmu *f, enum epcio_status status)
{
    const struct vars *v = &f->s.v;
    const struct epcio_config c = config_of(v);
    const char *text = epcio_status_text(status);
    for (int i = 0; i < EPCIO_ENCODERS; i++) {
        if (encoder_check(&c.encoder[i]) == ENCODER_BAD_RATE)
            return fmu_fail(f, "enc_rate[%d] = %d: %s", i + 1, (int)v->enc_rate[i], text);
        if (encoder_check(&c.encoder[i]) == ENCODER_BAD_WIRING)
            return fmu_fail(f, "enc_wiring[%d] = %d: %s", i + 1, (int)v->enc_wiring[i], text);
    }
    if (adc_check_config(&c.adc) == ADC_BAD_BITS)
        return fmu_fail(f, "adc_bits = %d: %s", (int)v->adc_bits, text);
    return fmu_fail(f, "the card refuses its parameters: %s", text);
}

/* Write the elements of a parameter to the registers from `address` on; -1 after the first that is
 * refused. */
#define POWER_ON(name, address) \
    for (int i = 0; i < (int)(sizeof v->name / sizeof *ELEMENTS(v->name)); i++) { \
        const double value = (double)ELEMENTS(v->name)[i]; \
        const enum epcio_status s = epcio_write(card, (address) + i, value); \
        if (s != EPCIO_OK) \
            return fmu_fail(f, "%s[%d] = %g: %s", #name, i + 1, value, epcio_status_text(s)); \
    }

/* The first element of a scalar, an array or a table. */
#define ELEMENTS(x) _Generic((x), int32_t: &(x), bool: &(x), default: (x))

/* Write the first values of the registers, in an order in which none is refused because of a later
 * one. */
static int write_power_on(struct fmu *f)
{
    struct vars *v = &f->s.v;
    struct epcio *card = &f->s.m.card;
    POWER_ON(compare, REG_ENC_COMPARE)
    POWER_ON(compare_on, REG_ENC_COMPARE_ON)
    POWER_ON(latch_last, REG_ENC_LATCH_LAST)
    POWER_ON(latch_source, REG_ENC_LATCH)
    POWER_ON(dac_trigger_volts, REG_DAC_TRIGGER_VOLTS)
    for (int i = 0; i < ANALOG_DACS; i++) /* bit 31 is a source like the others */
        epcio_write(card, REG_DAC_TRIGGER + i, (double)(uint32_t)v->dac_trigger[i]);
    POWER_ON(adc_range, REG_ADC_RANGE)
    POWER_ON(adc_compare, REG_ADC_COMPARE)
    POWER_ON(adc_compare_volts, REG_ADC_COMPARE_VOLTS)
    POWER_ON(adc_mode, REG_ADC_MODE)
    POWER_ON(adc_channel, REG_ADC_CHANNEL)
    POWER_ON(adc_enabled, REG_ADC_ENABLED)
    POWER_ON(adc_compare_on, REG_ADC_COMPARE_ON)
    POWER_ON(adc_ignored_bits, REG_ADC_IGNORED_BITS)
    POWER_ON(adc_tagged, REG_ADC_TAGGED)
    POWER_ON(ldo_on, REG_LIO_OUTPUTS)
    POWER_ON(servo, REG_LIO_SERVO_ON)
    POWER_ON(ready, REG_LIO_POSITION_READY)
    POWER_ON(stop_enable, REG_LIO_STOP_ENABLE)
    POWER_ON(outputs_on, REG_LIO_GATE)
    POWER_ON(dfi_dedicated, REG_LIO_DEDICATED)
    POWER_ON(ldi_edge, REG_LIO_LDI_EDGE)
    POWER_ON(dfi_edge, REG_LIO_DFI_EDGE)
    POWER_ON(timer_period, REG_TIMER_PERIOD)
    POWER_ON(watchdog_reset, REG_WATCHDOG_RESET)
    POWER_ON(watchdog_value, REG_WATCHDOG_VALUE)
    POWER_ON(rio_retry, REG_RIO_RETRY)
    for (int i = 0; i < 24; i++) {
        epcio_write(card, REG_RIO_EDGE + i, v->rio_edge[i / 4][i % 4]);
        epcio_write(card, REG_RIO_OUT + i, v->rio_out_on[i / 4][i % 4]);
    }
    return 0;
}

#endif
