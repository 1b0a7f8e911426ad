/* adc - the EPCIO's analog-to-digital converter: one converter behind a multiplexer of eight
 * channels, single or free running, with a comparator per channel and a tagged group of channels
 * that fires when all of them have been converted. */
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
    ADC_FREE_RUN, /* a start converts the enabled channels in ascending order, over and over */
};
enum adc_compare {
    ADC_RISING,  /* from below to at or above the preset */
    ADC_FALLING, /* from above to at or below the preset */
    ADC_BOTH,
};

/* Bits of adc_finish(), in the order of the interrupt latch. */
enum adc_event {
    ADC_EVENT_COMPARE = 0, /* 8 bits: compare condition of channel 0 .. 7 */
    ADC_EVENT_DONE = 8,    /* a conversion is done */
    ADC_EVENT_TAG = 9,     /* the tagged channels have all been converted */
};

/* Fixed at power on. */
struct adc_config {
    int32_t bits; /* resolution, 12, 14 or 16 */
    int32_t time; /* [clocks] duration of a conversion, >= 1 */
};

/* Registers of the host. They may change at any clock; all are read when a conversion ends, `mode`,
 * `channel` and `enabled` at a start, too. */
struct adc_control {
    enum adc_mode mode;
    int32_t channel;  /* channel of single mode, 0 .. 7 */
    uint32_t enabled; /* channels of free run, a bit each */
    enum adc_range range[ADC_CHANNELS];
    uint32_t compare_on; /* channels with comparison, a bit each */
    enum adc_compare compare[ADC_CHANNELS];
    double compare_volts[ADC_CHANNELS]; /* [V] preset, within the range */
    int32_t ignored_bits;               /* number of low bits left out of comparisons, 0 .. 3 */
    uint32_t tagged;                    /* channels of the tagged group, a bit each */
};

/* All zero is the state after power on. */
struct adc {
    int32_t code[ADC_CHANNELS];         /* latest conversion of each channel */
    enum adc_range range[ADC_CHANNELS]; /* input range of that conversion */
    uint32_t seen;                      /* channels with an earlier code to compare with */
    uint32_t grouped;                   /* tagged channels converted since the group fired */
    int32_t channel;                    /* channel of the conversion under way, or of the latest */
    double held;                        /* [V] sampled when that conversion began */
    int64_t due;                        /* [clock] of its end, if busy */
    int32_t conversions;                /* number since power on; 0 follows 2^31 - 1 */
    bool busy;                          /* a conversion is under way */
};

enum adc_status {
    ADC_OK,
    ADC_BAD_BITS,    /* not 12, 14 or 16 */
    ADC_BAD_TIME,    /* below 1 clock */
    ADC_BAD_MODE,    /* not an adc_mode */
    ADC_BAD_CHANNEL, /* not 0 .. 7 */
    ADC_BAD_MASK,    /* enabled, compare_on or tagged has a bit above 7 */
    ADC_BAD_RANGE,   /* not an adc_range */
    ADC_BAD_COMPARE, /* not an adc_compare */
    ADC_BAD_VOLTS,   /* a preset is not a number or outside its channel's range, ends included */
    ADC_BAD_IGNORED, /* not 0 .. 3 */
};

/* What a status but 0 says, in a sentence without a full stop. */
const char *adc_status_text(enum adc_status status);

/* ADC_OK, or the first error in the order of adc_status. Members that are not in use at present are
 * checked, too. The other functions take only what passed these checks. */
enum adc_status adc_check_config(const struct adc_config *c);
enum adc_status adc_check_control(const struct adc_control *set);

/* Code nearest to a voltage [V], halves away from zero, saturated; 0 if it is not a number. */
int32_t adc_code(const struct adc_config *c, enum adc_range range, double volts);

/* Voltage of a code [V]: code * 20 V / 2^bits, unipolar code * 10 V / 2^bits. */
double adc_volts(const struct adc_config *c, enum adc_range range, int32_t code);

/* Start at `clock`: sample the channel of single mode, or the lowest enabled one, from `volts` [V].
 * A conversion under way is dropped: no code, no event. In free run no channel has an earlier code
 * to compare with and the group is empty; without an enabled channel the converter stands still.
 * Single mode keeps both, because neither comparison nor group could ever fire there otherwise. */
void adc_start(const struct adc_config *c, const struct adc_control *set, struct adc *a,
               const double volts[ADC_CHANNELS], int64_t clock);

/* Stop. A conversion under way is dropped; codes and the state of comparators and group stay. */
void adc_stop(struct adc *a);

/* Clock at which the conversion under way ends; INT64_MAX if there is none. */
int64_t adc_due(const struct adc *a);

/* End the conversion; call it at the clock adc_due(), before what the host does at that clock. The
 * held voltage is coded in the range set now, compared, and counted for the group. Then free run
 * samples the next enabled channel from `volts` [V] at this clock; it stops if single mode or an
 * empty mask is set by now. Returns the events as bits of adc_event; 0 if it is not busy.
 *
 * The comparison is of codes, that of the preset too, each rounded down to a multiple of
 * 2^ignored_bits. This code and the one before are both compared with the preset set now, so moving
 * a preset fires nothing by itself. The first conversion of a channel (since power on, since a
 * start of free run, or in another range than the one before) fires nothing either. The group fires
 * when all channels tagged now have been converted, while tagged, since it fired last. */
uint32_t adc_finish(const struct adc_config *c, const struct adc_control *set, struct adc *a,
                    const double volts[ADC_CHANNELS]);

#endif
