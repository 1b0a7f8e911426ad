/* Whole numbers as the 16-bit part has them: words that wrap, results that saturate, products of
 * the hardware multiplier. Every narrowing of the core is done here.
 *
 * Qm.n is a number with m bits before the binary point (sign included) and n behind it. */
#ifndef FIXED_H
#define FIXED_H

#include <assert.h>
#include <stdint.h>

static_assert(-3 >> 1 == -2, "a shift to the right must be arithmetic, as RRA is");

/* The low word, as signed: what is left of a number in a 16-bit register. */
static inline int16_t fixed_word(int64_t x)
{
    const int32_t low = (int32_t)((uint64_t)x & 0xFFFFu);
    return (int16_t)(low > INT16_MAX ? low - 65536 : low);
}

/* a - b modulo 2^16, as SUB.W does: right as long as the true difference is within 16 bit. */
static inline int16_t fixed_subtract(uint16_t a, uint16_t b)
{
    return fixed_word((int64_t)a - (int64_t)b);
}

/* Nearest number of 16 bit. */
static inline int16_t fixed_saturate16(int64_t x)
{
    return (int16_t)(x > INT16_MAX ? INT16_MAX : x < INT16_MIN ? INT16_MIN : x);
}

/* Nearest number of 32 bit. */
static inline int32_t fixed_saturate32(int64_t x)
{
    return (int32_t)(x > INT32_MAX ? INT32_MAX : x < INT32_MIN ? INT32_MIN : x);
}

/* Signed product of the hardware multiplier (MPYS): 16 x 16 -> 32 bit, exact. */
static inline int32_t fixed_multiply(int16_t a, int16_t b)
{
    return (int32_t)a * b;
}

/* 16 x 32 -> 48 bit, exact: two products of the multiplier, shifted and added. */
static inline int64_t fixed_multiply48(int16_t a, int32_t b)
{
    return (int64_t)a * b;
}

/* x / 2^n, rounded to nearest, halves up: one is added to the bit below the point, then RRA. */
static inline int64_t fixed_scale(int64_t x, int n)
{
    return n == 0 ? x : (x + ((int64_t)1 << (n - 1))) >> n;
}

#endif
