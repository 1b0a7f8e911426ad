#include "analog.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

bool analog_trim_ok(const struct analog_trim *t)
{
    return fabs(t->gain - 1.0) <= 0.5 && fabs(t->offset) <= 1.0;
}

int32_t analog_code(double volts)
{
    if (isnan(volts))
        return 0;
    double code = round(volts / ANALOG_LSB);
    return (int32_t)el_max(INT16_MIN, el_min(INT16_MAX, code));
}

double analog_volts(int32_t code)
{
    return code * ANALOG_LSB;
}

double analog_output(const struct analog_trim *t, int32_t code)
{
    double volts = analog_volts(code) * t->gain + t->offset;
    return el_max(-ANALOG_RANGE, el_min(ANALOG_RANGE, volts));
}

bool analog_set_trigger(struct analog *a, int channel, const struct analog_trigger *t)
{
    uint32_t bit = (uint32_t)1 << channel;
    if (!(fabs(t->volts) <= ANALOG_RANGE))
        return false;
    a->trigger[channel] = *t;
    a->fired &= ~bit;
    a->armed = t->source ? a->armed | bit : a->armed & ~bit;
    return true;
}

void analog_fire(struct analog *a, uint32_t sources)
{
    for (int i = 0; i < ANALOG_DACS && a->armed != 0; i++) {
        uint32_t bit = (uint32_t)1 << i;
        if (!(a->armed & bit) || !(a->trigger[i].source & sources))
            continue;
        a->armed &= ~bit;
        a->fired |= bit;
        a->code[i] = analog_code(a->trigger[i].volts);
    }
}

void analog_convert(struct analog *a)
{
    if (a->fired == 0) {
        memcpy(a->code, a->next, sizeof a->code);
        return;
    }
    for (int i = 0; i < ANALOG_DACS; i++)
        if (!(a->fired & (uint32_t)1 << i))
            a->code[i] = a->next[i];
}
