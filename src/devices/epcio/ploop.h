/* Error counter and proportional position loop of one axis. */
#ifndef PLOOP_H
#define PLOOP_H

#include <stdbool.h>
#include <stdint.h>

enum { PLOOP_GAIN_MAX = 65535, PLOOP_LIMIT_MAX = 32767, PLOOP_SCALE_MAX = 15 };

struct ploop_config {
    int32_t limit; /* [counts] size of the error that latches the overflow interrupt, >= 1 */
    int32_t scale; /* DAC code = error * gain / 2^scale, 0 .. 15 */
};

struct ploop {
    bool on;
    int64_t zero;  /* pulses - counts when the loop was switched on */
    int32_t error; /* [counts] pulses - counts since then; 0 while off */
    bool over;     /* |error| >= limit */
};

/* Count at a loop instant. Switching on starts from zero, off clears. True when the error has just
 * reached the limit: once until it falls below it again. */
bool ploop_tick(const struct ploop_config *c, struct ploop *p, bool on, int64_t pulses,
                int64_t counts);

/* error * gain / 2^scale rounded to nearest, halves away from zero, within 16 bit [DAC codes]. */
int32_t ploop_code(const struct ploop_config *c, int32_t error, int32_t gain);

#endif
