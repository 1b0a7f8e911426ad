/* floor_divide - floor(a / b) of whole numbers, b > 0, where C's a / b rounds toward zero: counts
 * and positions below 0 need it. */
#ifndef FLOOR_DIVIDE_H
#define FLOOR_DIVIDE_H

#include <stdint.h>

static inline int64_t floor_divide(int64_t a, int64_t b)
{
    return a / b - (a % b < 0);
}

#endif
