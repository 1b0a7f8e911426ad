/* mcc_check - the machine that the tests of the motion library use. */
#ifndef MCC_CHECK_H
#define MCC_CHECK_H

#include <string.h>

#include "check.h"
#include "machine.h"

/* Three axes of 1000 pulses/mm, 500 mm/s; DDA time 1.024 ms; ramps of 0.1 s. */
static inline struct machine mcc_machine(void)
{
    struct machine m = { .dda_time = 1e-3,
                         .dda_length = 12,
                         .queue_depth = 64,
                         .feed = 10.0,
                         .max_feed = 1000.0,
                         .acc_time = 0.1,
                         .dec_time = 0.1 };
    for (int i = 0; i < AXES; i++) {
        m.axis[i] = (struct machine_axis){ .used = i < 3,
                                           .pitch = 10.0,
                                           .gear_ratio = 1.0,
                                           .ppr = 10000,
                                           .rpm = 3000.0,
                                           .p_gain = 60 };
    }
    return m;
}

#endif
