/* mcc_check - what the mcc test programs share: real numbers beside check.h, and a machine. */
#ifndef MCC_CHECK_H
#define MCC_CHECK_H

#include <math.h>
#include <string.h>

#include "check.h"
#include "machine.h"

/* Two numbers may differ by so much. */
#define CHECK_NEAR(got, want, tolerance) \
    do { \
        const double check_got = (got), check_want = (want); \
        if (!(fabs(check_got - check_want) <= (tolerance))) { \
            check_failures++; \
            printf("%s:%d: %s = %.17g, want %.17g\n", __FILE__, __LINE__, #got, check_got, \
                   check_want); \
        } \
    } while (0)

/* Uniform in [low, high), the same sequence on every machine (xorshift64). */
static inline double mcc_random(uint64_t *state, double low, double high)
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return low + (high - low) * ((double)(*state >> 11) * 0x1p-53);
}

/* Three axes of 1000 pulses/mm, 500 mm/s; DDA time 1.024 ms; ramps of 0.1 s. */
static inline struct machine mcc_machine(void)
{
    struct machine m = {
        .dda_time = 1e-3, .dda_length = 12, .queue_depth = 64,
        .feed = 10.0, .max_feed = 1000.0, .acc_time = 0.1, .dec_time = 0.1
    };
    for (int i = 0; i < AXES; i++) {
        m.axis[i] = (struct machine_axis){
            .used = i < 3, .pitch = 10.0, .gear_ratio = 1.0, .ppr = 10000, .rpm = 3000.0,
            .p_gain = 60
        };
    }
    return m;
}

#endif
