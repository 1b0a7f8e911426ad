/* Eight 16-bit converters from code to +-10 V. */
#ifndef ANALOG_H
#define ANALOG_H

#include <stdint.h>

enum { ANALOG_DACS = 8 };

/* One step of a converter: 20 V over 2^16 codes [V]. */
#define ANALOG_LSB (20.0 / 65536.0)

struct analog {
    int32_t next[ANALOG_DACS];  /* codes loaded at the latest instant */
    int32_t code[ANALOG_DACS];  /* codes at the outputs */
};

/* Nearest code of a voltage, halves away from zero, saturated; 0 if it is no number. */
int32_t analog_code(double volts);

/* Voltage of a code: -10 V .. +10 V less one step [V]. */
double analog_volts(int32_t code);

/* The conversion period is over: what was loaded stands at the outputs. */
void analog_convert(struct analog *a);

#endif
