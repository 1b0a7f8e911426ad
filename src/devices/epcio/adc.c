#include "adc.h"

#include <math.h>

static double volts_min(enum adc_range range)
{
    return range == ADC_BIPOLAR ? -ADC_VOLTS_MAX : 0.0;
}

const char *adc_status_text(enum adc_status status)
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

enum adc_status adc_check_config(const struct adc_config *c)
{
    if (c->bits != 12 && c->bits != 14 && c->bits != 16)
        return ADC_BAD_BITS;
    return c->time < 1 ? ADC_BAD_TIME : ADC_OK;
}

/* CCN 18: a row of limits, each with its status. */
enum adc_status adc_check_control(const struct adc_control *set)
{
    if (set->mode != ADC_SINGLE && set->mode != ADC_FREE_RUN)
        return ADC_BAD_MODE;
    if (set->channel < 0 || set->channel >= ADC_CHANNELS)
        return ADC_BAD_CHANNEL;
    if ((set->enabled | set->compare_on | set->tagged) >> ADC_CHANNELS != 0)
        return ADC_BAD_MASK;
    for (int i = 0; i < ADC_CHANNELS; i++)
        if (set->range[i] != ADC_BIPOLAR && set->range[i] != ADC_UNIPOLAR)
            return ADC_BAD_RANGE;
    for (int i = 0; i < ADC_CHANNELS; i++)
        if (set->compare[i] != ADC_RISING && set->compare[i] != ADC_FALLING
            && set->compare[i] != ADC_BOTH)
            return ADC_BAD_COMPARE;
    for (int i = 0; i < ADC_CHANNELS; i++)
        if (!(set->compare_volts[i] >= volts_min(set->range[i])
              && set->compare_volts[i] <= ADC_VOLTS_MAX))
            return ADC_BAD_VOLTS;
    if (set->ignored_bits < 0 || set->ignored_bits > ADC_IGNORED_MAX)
        return ADC_BAD_IGNORED;
    return ADC_OK;
}

int32_t adc_code(const struct adc_config *c, enum adc_range range, double volts)
{
    if (isnan(volts))
        return 0;
    int32_t codes = 1 << c->bits;
    int32_t low = range == ADC_BIPOLAR ? -codes / 2 : 0, high = low + codes - 1;
    /* rounded only once, by the division: the product with 2^bits and the fraction are exact */
    double exact = volts * codes / (ADC_VOLTS_MAX - volts_min(range));
    if (!(exact > low && exact < high))
        return exact > low ? high : low;
    int32_t code = (int32_t)exact;
    double rest = exact - code;
    return code + (rest >= 0.5) - (rest <= -0.5); /* as round(), without a library call */
}

double adc_volts(const struct adc_config *c, enum adc_range range, int32_t code)
{
    return code * (ADC_VOLTS_MAX - volts_min(range)) / (1 << c->bits);
}

/* First enabled channel above `after`, wrapping around to `after` itself; -1 if none is enabled. */
static int next_channel(uint32_t enabled, int after)
{
    for (int i = after + 1; i <= after + ADC_CHANNELS; i++)
        if (enabled >> i % ADC_CHANNELS & 1)
            return i % ADC_CHANNELS;
    return -1;
}

static void begin(const struct adc_config *c, struct adc *a, int channel,
                  const double volts[ADC_CHANNELS], int64_t clock)
{
    a->busy = channel >= 0;
    if (!a->busy)
        return;
    a->channel = channel;
    a->held = volts[channel];
    a->due = clock + c->time;
}

void adc_start(const struct adc_config *c, const struct adc_control *set, struct adc *a,
               const double volts[ADC_CHANNELS], int64_t clock)
{
    if (set->mode == ADC_FREE_RUN) {
        a->seen = 0;
        a->grouped = 0;
    }
    int first = set->mode == ADC_FREE_RUN ? next_channel(set->enabled, -1) : set->channel;
    begin(c, a, first, volts, clock);
}

void adc_stop(struct adc *a)
{
    a->busy = false;
}

int64_t adc_due(const struct adc *a)
{
    return a->busy ? a->due : INT64_MAX;
}

static bool crossed(const struct adc_config *c, const struct adc_control *set, int channel,
                    int32_t before, int32_t now)
{
    int32_t keep = ~((1 << set->ignored_bits) - 1);
    int32_t preset = adc_code(c, set->range[channel], set->compare_volts[channel]) & keep;
    before &= keep;
    now &= keep;
    enum adc_compare way = set->compare[channel];
    return (way != ADC_FALLING && before < preset && now >= preset)
           || (way != ADC_RISING && before > preset && now <= preset);
}

static uint32_t store(const struct adc_config *c, const struct adc_control *set, struct adc *a)
{
    int i = a->channel;
    uint32_t bit = 1u << i;
    bool first = (a->seen & bit) == 0 || a->range[i] != set->range[i];
    int32_t before = a->code[i];
    a->code[i] = adc_code(c, set->range[i], a->held);
    a->range[i] = set->range[i];
    a->seen |= bit;
    a->conversions = a->conversions == INT32_MAX ? 0 : a->conversions + 1;
    bool fires = (set->compare_on & bit) != 0 && !first && crossed(c, set, i, before, a->code[i]);
    return fires ? bit << ADC_EVENT_COMPARE : 0;
}

uint32_t adc_finish(const struct adc_config *c, const struct adc_control *set, struct adc *a,
                    const double volts[ADC_CHANNELS])
{
    if (!a->busy)
        return 0;
    uint32_t events = store(c, set, a) | 1u << ADC_EVENT_DONE;
    a->grouped = (a->grouped | 1u << a->channel) & set->tagged;
    if (set->tagged != 0 && a->grouped == set->tagged) {
        events |= 1u << ADC_EVENT_TAG;
        a->grouped = 0;
    }
    int next = set->mode == ADC_FREE_RUN ? next_channel(set->enabled, a->channel) : -1;
    begin(c, a, next, volts, a->due);
    return events;
}
