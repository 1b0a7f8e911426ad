/* double_double - arithmetic with some 106 bits: a number is the sum of two doubles, computed with
 * + - * / and sqrt alone. It also has the exact product and sum of two doubles, a double's bits,
 * and the test whether a rounding is certain. Inline, for the files of this core only. */
#ifndef DOUBLE_DOUBLE_H
#define DOUBLE_DOUBLE_H

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* The error bounds hold only if each operation is rounded once, to 53 bits. */
#if defined(__FAST_MATH__)
#error "elementary: not with -ffast-math"
#endif
#if FLT_EVAL_METHOD != 0
#error "elementary: here a sum has more bits than a double (x87): use -msse2 -mfpmath=sse"
#endif

/* The number h + l; h is the double nearest to it. */
struct dd {
    double h, l;
};

static inline struct dd dd_of(double h, double l)
{
    const struct dd x = { h, l };
    return x;
}

static inline uint64_t dd_bits(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static inline double dd_of_bits(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* 2^k, k in -1022 to 1023. */
static inline double dd_power(int k)
{
    return dd_of_bits((uint64_t)(k + 1023) << 52);
}

/* The nearest number of 24 bits, so that the product of two such numbers is exact;
 * 2^-126 < |x| < 2^127. */
static inline double dd_half(double x)
{
    return (double)(float)x;
}

/* a + b exactly, where a is 0 or |a| >= |b|. */
static inline struct dd dd_fast(double a, double b)
{
    const double h = a + b;
    return dd_of(h, b - (h - a));
}

/* a + b exactly. */
static inline struct dd dd_sum(double a, double b)
{
    const double h = a + b, c = h - a;
    return dd_of(h, (a - (h - c)) + (b - c));
}

/* a b exactly (Dekker), |a| and |b| below 2^500: halves of 26 bits have exact products. */
static inline struct dd dd_product(double a, double b)
{
    const double c = 134217729.0 * a, d = 134217729.0 * b; /* 2^27 + 1 */
    const double ah = c - (c - a), al = a - ah, bh = d - (d - b), bl = b - bh, h = a * b;
    return dd_of(h, ((ah * bh - h) + ah * bl + al * bh) + al * bl);
}

static inline struct dd dd_add(struct dd a, struct dd b)
{
    const struct dd s = dd_sum(a.h, b.h), t = dd_sum(a.l, b.l);
    const struct dd u = dd_fast(s.h, s.l + t.h);
    return dd_fast(u.h, u.l + t.l);
}

static inline struct dd dd_minus(struct dd a)
{
    return dd_of(-a.h, -a.l);
}

static inline struct dd dd_add_to(double a, struct dd b)
{
    return dd_add(dd_of(a, 0.0), b);
}

static inline struct dd dd_mul(struct dd a, struct dd b)
{
    const struct dd p = dd_product(a.h, b.h);
    return dd_fast(p.h, p.l + (a.h * b.l + a.l * b.h));
}

/* a b; exact if b is a power of two. */
static inline struct dd dd_times(struct dd a, double b)
{
    return dd_of(a.h * b, a.l * b);
}

static inline struct dd dd_div(struct dd a, struct dd b)
{
    const double q = a.h / b.h;
    const struct dd p = dd_product(q, b.h);
    return dd_fast(q, (((a.h - p.h) - p.l) + a.l - q * b.l) / b.h);
}

static inline struct dd dd_sqrt(struct dd a)
{
    const double h = sqrt(a.h);
    const struct dd p = dd_product(h, h);
    return h == 0.0 ? a : dd_fast(h, (((a.h - p.h) - p.l) + a.l) / (2.0 * h));
}

/* Rounding test: *y is h + l rounded. True if every number from h + l - error to h + l + error
 * rounds to the same double. */
static inline bool dd_settled(double h, double l, double error, double *y)
{
    *y = h + (l - error);
    return *y == h + (l + error);
}

/* a 2^k rounded once, 2^-100 < |a| < 2^100, |k| < 1200. A number that is closer than 2^-94 of
 * itself to the midpoint of two doubles is taken for that midpoint, which results of el_pow do
 * meet. */
static inline double dd_rounded(struct dd a, int k)
{
    a = dd_fast(a.h, a.l);
    const int exponent = (int)(dd_bits(a.h) >> 52 & 2047) - 1023;
    if (exponent + k < -1022) { /* subnormal: adding a large number rounds to its fewer bits */
        const double large = copysign(ldexp(1.0, -1022 - k), a.h);
        const struct dd s = dd_fast(large, a.h);
        return copysign(ldexp((s.h + (s.l + a.l)) - large, k), a.h);
    }
    const double grid = a.h * 0x1.8p-43;
    return ldexp(a.h + ((a.l + grid) - grid), k);
}

#endif
