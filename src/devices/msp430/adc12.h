/* adc12 - the MSP430's 12-bit analog-to-digital converter, whose voltage scales the positioner's
 * speed limit. */
#ifndef ADC12_H
#define ADC12_H

#include <stdint.h>

enum { ADC12_MAX = 4095 };

/* Code of a voltage [V]: 4095 volts / reference rounded to nearest, limited to 0 .. 4095. */
int16_t adc12_code(double volts, double reference);

/* A speed limit [Q16.16 counts/tick] times code / 4096; the full code stands for the whole
 * speed. */
int32_t adc12_share(int32_t speed, int16_t code);

#endif
