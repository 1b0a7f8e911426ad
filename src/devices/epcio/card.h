/* What both generations of the card have: clock, axes, range of the DDA time. */
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
    EPCIO_LENGTH_MIN = 10,          /* [bit] */
    EPCIO_LENGTH_MAX = 15,          /* [bit] */
    EPCIO_DIVIDER_MAX = 65535,      /* 16-bit register */
    EPCIO_RESET_LENGTH = 12,
    EPCIO_RESET_DIVIDER = 10,
};

/* Whether the DDA of a state from outside can be worked with; `ticks`: it runs, so that its
 * boundary lies ahead. */
static inline bool card_dda_sound(const struct dda *d, bool ticks, int64_t clock)
{
    const int32_t least = 1 << EPCIO_LENGTH_MIN, most = 1 << EPCIO_LENGTH_MAX;
    const bool good = dda_sound(d, EPCIO_AXES) && d->ticks >= least && d->ticks <= most &&
                      !(d->ticks & (d->ticks - 1)) && d->next_ticks >= least &&
                      d->next_ticks <= most && !(d->next_ticks & (d->next_ticks - 1)) &&
                      d->divider >= 1 && d->divider <= EPCIO_DIVIDER_MAX &&
                      d->next_divider >= 1 && d->next_divider <= EPCIO_DIVIDER_MAX &&
                      d->start >= 0 && d->start <= clock && d->stop >= 0 && d->stop <= clock;
    return good && (!ticks || dda_boundary(d) > clock);
}

#endif
