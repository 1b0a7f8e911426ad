/* Eight 16-bit converters from code to +-10 V, with trim and trigger output. */
#ifndef ANALOG_H
#define ANALOG_H

#include <stdbool.h>
#include <stdint.h>

enum { ANALOG_DACS = 8 };

/* One step of a converter: 20 V over 2^16 codes [V]. */
#define ANALOG_LSB (20.0 / 65536.0)

/* Output range of the amplifier behind a converter [V]. */
#define ANALOG_RANGE 10.0

/* Trim of a channel: volts = code volts * gain + offset, within +-10 V. */
struct analog_trim {
    double gain;   /* 0.5 .. 1.5 */
    double offset; /* [V] -1 .. 1 */
};

/* Sources that can trigger an output, as bits of `source`. */
enum {
    ANALOG_BY_ENC = 0,   /* 8: compare of encoder 1 to 8 */
    ANALOG_BY_ADC = 8,   /* 8: compare of ADC channel 1 to 8 */
    ANALOG_BY_LDI = 16,  /* 4: local inputs LDI0-3 */
    ANALOG_BY_DFI = 20,  /* 4: dual-function inputs DFI0-3 */
    ANALOG_BY_R0DI = 24, /* 4: remote inputs DI0-3 of the first slave of set 0 */
    ANALOG_BY_R1DI = 28, /* 4: of set 1 */
};

struct analog_trigger {
    uint32_t source; /* 0: no trigger */
    double volts;    /* [V] put out from the trigger on */
};

struct analog {
    struct analog_trigger trigger[ANALOG_DACS];
    uint32_t armed;            /* channels that wait for their trigger */
    uint32_t fired;            /* channels that put out their trigger voltage */
    int32_t next[ANALOG_DACS]; /* codes loaded at the latest instant */
    int32_t code[ANALOG_DACS]; /* codes at the outputs */
};

/* The trim is within its range. */
bool analog_trim_ok(const struct analog_trim *t);

/* Nearest code of a voltage, halves away from zero, saturated; 0 if it is no number. */
int32_t analog_code(double volts);

/* Voltage of a code: -10 V .. +10 V less one step [V]. */
double analog_volts(int32_t code);

/* Voltage at the terminal of a channel [V]. */
double analog_output(const struct analog_trim *t, int32_t code);

/* Set the trigger of a channel and arm it; source 0 gives the channel back to its own source. False
 * and nothing changed if the voltage is no number or beyond +-10 V. */
bool analog_set_trigger(struct analog *a, int channel, const struct analog_trigger *t);

/* Sources fire: the armed channels that wait for one of them put out their voltage at once. */
void analog_fire(struct analog *a, uint32_t sources);

/* The conversion period is over: what was loaded stands at the outputs that no trigger holds. */
void analog_convert(struct analog *a);

#endif
