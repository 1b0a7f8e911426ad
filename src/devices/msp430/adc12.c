#include "adc12.h"

#include "el_extremes.h"
#include "fixed.h"

#include <math.h>

int16_t adc12_code(double volts, double reference)
{
    const double code = floor(ADC12_MAX * volts / reference + 0.5);
    return (int16_t)el_min(el_max(code, 0.0), ADC12_MAX);
}

int32_t adc12_share(int32_t speed, int16_t code)
{
    const int16_t share = (int16_t)(code == ADC12_MAX ? ADC12_MAX + 1 : code);
    return fixed_saturate32(fixed_multiply48(share, speed) >> 12);
}
