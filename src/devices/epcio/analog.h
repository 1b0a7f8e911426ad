/* analog - the EPCIO's analog outputs: eight 16-bit digital-to-analog converters for +-10 V, with
 * trim and with trigger output, by which an event switches a channel to a preset voltage. */
#ifndef ANALOG_H
#define ANALOG_H

#include <stdbool.h>
#include <stdint.h>

enum { ANALOG_DACS = 8 };

/* One step of a converter: 20 V over 2^16 codes [V]. */
#define ANALOG_LSB (20.0 / 65536.0)

/* Output range of the amplifier behind a converter [V]. */
#define ANALOG_RANGE 10.0

/* Trim of a channel: voltage at the terminal = voltage of the code * gain + offset, limited to
 * +-10 V. */
struct analog_trim {
    double gain;   /* 0.5 .. 1.5 */
    double offset; /* [V] -1 .. 1 */
};

/* Sources that can trigger an output: the first of their bits in `source`. */
enum {
    ANALOG_BY_ENC = 0,   /* 8 bits: compare of encoder 1 to 8 */
    ANALOG_BY_ADC = 8,   /* 8 bits: compare of ADC channel 1 to 8 */
    ANALOG_BY_LDI = 16,  /* 4 bits: local inputs LDI0-3 */
    ANALOG_BY_DFI = 20,  /* 4 bits: dual-function inputs DFI0-3 */
    ANALOG_BY_R0DI = 24, /* 4 bits: remote inputs DI0-3 of the first slave of set 0 */
    ANALOG_BY_R1DI = 28, /* 4 bits: likewise of set 1 */
};

struct analog_trigger {
    uint32_t source; /* bits of the sources; 0: no trigger */
    double volts;    /* [V] voltage from the trigger on */
};

struct analog {
    struct analog_trigger trigger[ANALOG_DACS];
    uint32_t armed;            /* channels that wait for their trigger, a bit each */
    uint32_t fired;            /* channels that put out their trigger voltage, a bit each */
    int32_t next[ANALOG_DACS]; /* codes loaded at the latest instant, in conversion */
    int32_t code[ANALOG_DACS]; /* codes at the outputs */
};

/* Whether gain and offset are within their ranges. */
bool analog_trim_ok(const struct analog_trim *t);

/* Code nearest to a voltage [V], halves away from zero, saturated; 0 if it is not a number. */
int32_t analog_code(double volts);

/* Voltage of a code [V]: -10 V .. +10 V - ANALOG_LSB. */
double analog_volts(int32_t code);

/* Voltage of a code at the terminal of a channel [V], with its trim. */
double analog_output(const struct analog_trim *t, int32_t code);

/* Set the trigger of a channel and arm it; source 0 gives the channel back to position loop or
 * software. False, and nothing changed, if the voltage is not a number or beyond +-10 V. */
bool analog_set_trigger(struct analog *a, int channel, const struct analog_trigger *t);

/* Events of `sources`: the armed channels that wait for one of them switch to their voltage. */
void analog_fire(struct analog *a, uint32_t sources);

/* The conversion period is over: the codes loaded reach the outputs that no trigger holds. */
void analog_convert(struct analog *a);

#endif
