/* el_extremes - the smaller and the larger of two numbers with the same bits everywhere. C11 leaves
 * open which zero fmin(+0, -0) returns, and C libraries, compilers and processors differ. */
#ifndef EL_EXTREMES_H
#define EL_EXTREMES_H

/* y if both are equal, also for +0 and -0; the other one if one is NaN. */
static inline double el_min(double x, double y)
{
    return x < y || y != y ? x : y;
}

static inline double el_max(double x, double y)
{
    return x > y || y != y ? x : y;
}

#endif
