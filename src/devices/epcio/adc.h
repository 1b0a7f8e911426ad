/* Eight-channel ADC: one converter behind a multiplexer, comparator per channel, tagged group. */
#ifndef ADC_H
#define ADC_H

#include <stdbool.h>
#include <stdint.h>

enum { ADC_CHANNELS = 8, ADC_IGNORED_MAX = 3 };

/* Upper end of both input ranges [V]. */
#define ADC_VOLTS_MAX 10.0

enum adc_range {
    ADC_BIPOLAR,  /* -10 V .. +10 V, two's complement: -2^(bits-1) .. 2^(bits-1) - 1 */
    ADC_UNIPOLAR, /* 0 V .. +10 V: 0 .. 2^bits - 1 */
};
enum adc_mode {
    ADC_SINGLE,   /* a start converts one channel once */
    ADC_FREE_RUN, /* the enabled channels in ascending order, over and over */
};
enum adc_compare {
    ADC_RISING,  /* from below to at or above the preset */
    ADC_FALLING, /* from above to at or below the preset */
    ADC_BOTH,
};

/* Bits of adc_finish(), in the order of the interrupt latch. */
enum adc_event {
    ADC_EVENT_COMPARE = 0, /* 8: compare condition of channel 0 .. 7 */
    ADC_EVENT_DONE = 8,    /* a conversion is done */
    ADC_EVENT_TAG = 9,     /* the tagged channels have all been converted */
};

/* Fixed at power on. */
struct adc_config {
    int32_t bits; /* 12, 14 or 16 */
    int32_t time; /* [clocks] of one conversion, >= 1 */
};

/* Registers of the host. They may change at any clock; all are looked at when a conversion ends,
 * `mode`, `channel` and `enabled` at a start too. */
struct adc_control {
    enum adc_mode mode;
    int32_t channel;  /* 0 .. 7, single mode */
    uint32_t enabled; /* channels of free run */
    enum adc_range range[ADC_CHANNELS];
    uint32_t compare_on; /* channels with comparison */
    enum adc_compare compare[ADC_CHANNELS];
    double compare_volts[ADC_CHANNELS]; /* [V] preset, within the range */
    int32_t ignored_bits;               /* 0 .. 3 low bits left out of comparisons */
    uint32_t tagged;                    /* channels of the group */
};

/* All zero is the state after power on. */
struct adc {
    int32_t code[ADC_CHANNELS];         /* latest conversion of each channel */
    enum adc_range range[ADC_CHANNELS]; /* that it was made in */
    uint32_t seen;                      /* channels with a predecessor to compare */
    uint32_t grouped;                   /* tagged channels converted since the group fired */
    int32_t channel;                    /* of the conversion under way, or of the latest */
    double held;                        /* [V] sampled when it began */
    int64_t due;                        /* [clock] of its end, if busy */
    int32_t conversions;                /* ended since power on; 0 after 2^31 - 1 */
    bool busy;                          /* a conversion is under way */
};

enum adc_status {
    ADC_OK,
    ADC_BAD_BITS,    /* not 12, 14 or 16 */
    ADC_BAD_TIME,    /* below 1 clock */
    ADC_BAD_MODE,    /* no adc_mode */
    ADC_BAD_CHANNEL, /* not 0 .. 7 */
    ADC_BAD_MASK,    /* enabled, compare_on or tagged has a bit above 7 */
    ADC_BAD_RANGE,   /* no adc_range */
    ADC_BAD_COMPARE, /* no adc_compare */
    ADC_BAD_VOLTS,   /* a preset is no number or outside its channel's range, ends included */
    ADC_BAD_IGNORED, /* not 0 .. 3 */
};

/* What a status but 0 says, in a sentence without a full stop. */
const char *adc_status_text(enum adc_status status);

/* Say what is wrong, the first in the order of adc_status. Every member must be right, also those
 * not in use at present. The other functions take only what was found right here. */
enum adc_status adc_check_config(const struct adc_config *c);
enum adc_status adc_check_control(const struct adc_control *set);

/* Nearest code of a voltage, halves away from zero, saturated; 0 if it is no number. */
int32_t adc_code(const struct adc_config *c, enum adc_range range, double volts);

/* Voltage of a code [V]: code * 20 V / 2^bits, unipolar code * 10 V / 2^bits. */
double adc_volts(const struct adc_config *c, enum adc_range range, int32_t code);

/* Begin at `clock`: the channel of single mode, or the lowest enabled one, is sampled from `volts`
 * [V]. A conversion under way is dropped: no code, no event. Free run starts afresh: no channel has
 * a predecessor, the group is empty; with no channel enabled the converter then stands still.
 * Single mode keeps both, or neither comparison nor group could ever fire there. */
void adc_start(const struct adc_config *c, const struct adc_control *set, struct adc *a,
               const double volts[ADC_CHANNELS], int64_t clock);

/* Stop; a conversion under way is dropped. Codes, predecessors and the group stay. */
void adc_stop(struct adc *a);

/* Clock at which the conversion under way ends; INT64_MAX if there is none. */
int64_t adc_due(const struct adc *a);

/* At the clock adc_due(), before what the host does at that clock: the held voltage is coded in the
 * range set now, then compared, then counted for the group; events in the bits of adc_event. Then
 * free run samples the next enabled channel from `volts` [V] at this clock; with single mode or an
 * empty mask set by now it stops, and only a start lets it go on. Not busy: 0, nothing changes.
 *
 * Compared are codes, the preset's too, each rounded down to a multiple of 2^ignored_bits. This
 * code and the one before are both held against the preset set now, so moving a preset fires
 * nothing by itself. The first conversion of a channel (since power on, since a start of free run,
 * or in another range than the one before) fires nothing either. The group fires when all channels
 * tagged now have been converted, while tagged, since it fired last; without a tag never. */
uint32_t adc_finish(const struct adc_config *c, const struct adc_control *set, struct adc *a,
                    const double volts[ADC_CHANNELS]);

#endif
