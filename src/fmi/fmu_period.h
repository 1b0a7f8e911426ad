/* fmu_period - check that a period given in seconds is a whole number of ticks, as every periodic
 * parameter must be. */
#ifndef FMU_PERIOD_H
#define FMU_PERIOD_H

#include <math.h>
#include <stdbool.h>

/* Tolerance [ticks] for decimal periods such as 1e-4 s, which are not exact in binary. */
#define FMU_PERIOD_TOLERANCE 1e-6

/* Largest number of ticks, 2^53 (7 years of 25 ns): beyond it a double has no exact integers. */
#define FMU_TICKS_MAX 9007199254740992.0

/* Whether so many ticks are a period: whole, and at least one. */
static inline bool fmu_is_period(double ticks)
{
    return ticks >= 1.0 && ticks < FMU_TICKS_MAX
           && fabs(ticks - round(ticks)) < FMU_PERIOD_TOLERANCE;
}

#endif
