/* The chip's 12-bit converter. */
#ifndef ADC12_H
#define ADC12_H

#include <stdint.h>

enum { ADC12_MAX = 4095 };

/* Code of a voltage: 4095 volts / reference, to the nearest, within 0 .. 4095. */
int16_t adc12_code(double volts, double reference);

/* A speed limit [Q16.16] times code / 4096, the full code standing for the whole speed: 16 x 32
 * bit. */
int32_t adc12_share(int32_t speed, int16_t code);

#endif
