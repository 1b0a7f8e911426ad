/* card - constants of both generations of the motion card (EPCIO and single buffer): clock, number
 * of axes, range of the DDA time. */
#ifndef CARD_H
#define CARD_H

#include "dda.h"

enum {
    EPCIO_CLOCK_HZ = 40000000,
    EPCIO_CLOCK_NS = 1000000000 / EPCIO_CLOCK_HZ,
    EPCIO_AXES = 6,
};

/* One DDA time is 2^length * divider clocks; after reset 2^12 * 10 clocks = 1.024 ms. */
enum {
    EPCIO_LENGTH_MIN = 10,     /* [bit] */
    EPCIO_LENGTH_MAX = 15,     /* [bit] */
    EPCIO_DIVIDER_MAX = 65535, /* 16-bit register */
    EPCIO_RESET_LENGTH = 12,
    EPCIO_RESET_DIVIDER = 10,
};

#endif
