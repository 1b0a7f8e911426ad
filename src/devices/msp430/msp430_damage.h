/* msp430_damage - whether a controller whose state comes back from outside can be worked with:
 * every index and divisor is in its range, and what is due has not been due for long. Booleans and
 * enumerations must have been looked at; values that are only wrong are not seen. */
#ifndef MSP430_DAMAGE_H
#define MSP430_DAMAGE_H

#include "msp430.h"

/* What is wrong, in words, or NULL. The pins were sampled at the chip's clock. */
const char *msp430_damage(const struct msp430 *m);

#endif
