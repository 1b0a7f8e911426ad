/* fixed - fixed-point arithmetic of the 16-bit MSP430: words that wrap, results that saturate,
 * products of the hardware multiplier. All narrowing conversions of the core are done here.
 *
 * Qm.n is a number with m bits before the binary point (sign included) and n behind it. */
#ifndef FIXED_H
#define FIXED_H

#include <assert.h>
#include <stdint.h>

static_assert(-3 >> 1 == -2, "a shift to the right must be arithmetic, as RRA is");

/* The low 16 bits as a signed number: what a 16-bit register keeps of x. */
static inline int16_t fixed_word(int64_t x)
{
    const int32_t low = (int32_t)((uint64_t)x & 0xFFFFu);
    return (int16_t)(low > INT16_MAX ? low - 65536 : low);
}

/* a - b modulo 2^16, as SUB.W does: right if the true difference fits into 16 bits. */
static inline int16_t fixed_subtract(uint16_t a, uint16_t b)
{
    return fixed_word((int64_t)a - (int64_t)b);
}

/* x limited to 16 bits. */
static inline int16_t fixed_saturate16(int64_t x)
{
    return (int16_t)(x > INT16_MAX ? INT16_MAX : x < INT16_MIN ? INT16_MIN : x);
}

/* x limited to 32 bits. */
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

/* x / 2^n rounded to nearest, halves up: 2^(n-1) is added before the arithmetic shift (RRA). */
static inline int64_t fixed_scale(int64_t x, int n)
{
    return n == 0 ? x : (x + ((int64_t)1 << (n - 1))) >> n;
}

#endif
