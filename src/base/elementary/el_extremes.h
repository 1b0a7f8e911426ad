/* The smaller and the larger of two numbers, where C libraries differ in the sign of a zero (C11
 * leaves it open; processors and compilers have instructions of their own). */
#ifndef EL_EXTREMES_H
#define EL_EXTREMES_H

/* y if both are equal, +0 and -0 too; the other one if one is no number. */
static inline double el_min(double x, double y)
{
    return x < y || y != y ? x : y;
}

static inline double el_max(double x, double y)
{
    return x > y || y != y ? x : y;
}

#endif
