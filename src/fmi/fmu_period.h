/* Periods and times that have to be whole numbers of ticks. */
#ifndef FMU_PERIOD_H
#define FMU_PERIOD_H

#include <math.h>
#include <stdbool.h>

/* A decimal period such as 1e-4 s is not exact in binary: off by far less than this [ticks]. */
#define FMU_PERIOD_TOLERANCE 1e-6

/* Ticks beyond this are not whole numbers in a double any more: 2^53, of 25 ns 7 years. */
#define FMU_TICKS_MAX 9007199254740992.0

/* Whether so many ticks are a period: whole, and at least one. */
static inline bool fmu_is_period(double ticks)
{
    return ticks >= 1.0 && ticks < FMU_TICKS_MAX
           && fabs(ticks - round(ticks)) < FMU_PERIOD_TOLERANCE;
}

#endif
