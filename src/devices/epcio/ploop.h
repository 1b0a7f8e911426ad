/* ploop - error counter (command pulses minus encoder counts, the following error) and proportional
 * position loop of one axis of the card. */
#ifndef PLOOP_H
#define PLOOP_H

#include <stdbool.h>
#include <stdint.h>

enum { PLOOP_GAIN_MAX = 65535, PLOOP_LIMIT_MAX = 32767, PLOOP_SCALE_MAX = 15 };

struct ploop_config {
    int32_t limit; /* [counts] |error| that fires the overflow interrupt, >= 1 */
    int32_t scale; /* DAC code = error * gain / 2^scale, 0 .. 15 */
};

struct ploop {
    bool on;       /* state at the latest tick */
    int64_t zero;  /* pulses - counts when the loop was switched on */
    int32_t error; /* [counts] pulses - counts since then; 0 while off */
    bool over;     /* |error| >= limit */
};

/* Update the error at a sampling instant of the loop. Switching on starts from zero, off clears it.
 * Returns true when |error| reaches the limit, once until it falls below again. */
bool ploop_tick(const struct ploop_config *c, struct ploop *p, bool on, int64_t pulses,
                int64_t counts);

/* DAC code: error * gain / 2^scale rounded to nearest, halves away from zero, saturated at 16
 * bits. */
int32_t ploop_code(const struct ploop_config *c, int32_t error, int32_t gain);

#endif
