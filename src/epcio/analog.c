#include "analog.h"

#include <math.h>

int32_t analog_code(double volts)
{
    if (isnan(volts))
        return 0;
    double code = round(volts / ANALOG_LSB);
    return (int32_t)fmax(INT16_MIN, fmin(INT16_MAX, code));
}

double analog_volts(int32_t code)
{
    return code * ANALOG_LSB;
}

void analog_convert(struct analog *a)
{
    for (int i = 0; i < ANALOG_DACS; i++)
        a->code[i] = a->next[i];
}
