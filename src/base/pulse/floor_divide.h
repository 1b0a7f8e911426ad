/* Division of whole numbers, rounded down; b is positive. */
#ifndef FLOOR_DIVIDE_H
#define FLOOR_DIVIDE_H

#include <stdint.h>

static inline int64_t floor_divide(int64_t a, int64_t b)
{
    return a / b - (a % b < 0);
}

#endif
