/* block_status - texts for the statuses of the card's blocks: pulses, encoders, ADC, I/O, timer. */
#include "registers.h"

static const char *pulse_text(int status)
{
    switch (status) {
    case PULSE_BAD_FORMAT: return "the pulse format is 0 to 3";
    case PULSE_BAD_WIRING: return "the pulse wiring is a sum of 1, 2, 4";
    default:               return "the pulse width is 1 to 65535 clocks";
    }
}

static const char *encoder_text(int status)
{
    switch (status) {
    case ENCODER_BAD_FORMAT: return "the encoder format is 0 to 3";
    case ENCODER_BAD_RATE:   return "an encoder multiplies by 0, 1, 2 or 4";
    case ENCODER_BAD_WIRING:
        return "the encoder wiring is a sum of 1, 2, 4, 8; pulse and direction cannot be swapped";
    case ENCODER_BAD_FILTER: return "the encoder filter is 0 to 65535 clocks";
    default:                 return "there is at least one line period between two index pulses";
    }
}

static const char *adc_text(int status)
{
    switch (status) {
    case ADC_BAD_BITS:    return "the ADC has 12, 14 or 16 bit";
    case ADC_BAD_TIME:    return "a conversion takes one clock or more";
    case ADC_BAD_MODE:    return "the ADC mode is 0 (single) or 1 (free run)";
    case ADC_BAD_CHANNEL: return "the ADC channel is 0 to 7";
    case ADC_BAD_MASK:    return "a mask of ADC channels is 0 to 255";
    case ADC_BAD_RANGE:   return "the ADC range is 0 (bipolar) or 1 (unipolar)";
    case ADC_BAD_COMPARE: return "the ADC compares rising (0), falling (1) or both (2)";
    case ADC_BAD_VOLTS:   return "the compare voltage is outside the range of its channel";
    default:              return "the ADC comparison ignores 0 to 3 low bits";
    }
}

static const char *local_text(int status)
{
    switch (status) {
    case LOCAL_IO_BAD_EDGE:      return "an edge is rising (0), falling (1) or both (2)";
    case LOCAL_IO_BAD_DEDICATED: return "there are 7 dual-function inputs";
    case LOCAL_IO_BAD_LDO:       return "there are 8 local outputs";
    default:                     return "there are 6 servo-on outputs";
    }
}

static const char *timer_text(int status)
{
    switch (status) {
    case TIMER_BAD_PERIOD: return "the timer period is 1 to 4294967295 clocks";
    case TIMER_BAD_VALUE:  return "the watchdog waits 1 to 65535 timer periods";
    default:               return "the watchdog resets for 1 to 4294967295 clocks";
    }
}

const char *epcio_status_text(enum epcio_status status)
{
    int number = (int)status & 0xFF;
    switch ((int)status & ~0xFF) {
    case EPCIO_PULSE:     return pulse_text(number);
    case EPCIO_ENCODER:   return encoder_text(number);
    case EPCIO_ADC:       return adc_text(number);
    case EPCIO_LOCAL_IO:  return local_text(number);
    case EPCIO_REMOTE_IO: return remote_io_status_text((enum remote_io_status)number);
    case EPCIO_TIMER:     return timer_text(number);
    default:              return card_status_text(status);
    }
}
