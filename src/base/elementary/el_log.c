/* Natural logarithm. With x = 2^k m, m from 0.707 to 1.414, and c near 1/m from a table,
 *
 *     log x = k ln 2 - log c + log(1 + r),   r = m c - 1.
 *
 * Around x = 1, c = 1 and k = 0, so that only log(1 + r) is left. */
#include "elementary.h"
#include "el_log.h"
#include "el_log_tables.h"

/* Bits of the smallest m, 181 / 256 = 0.707. */
#define LOWEST 0x3fe6a00000000000
/* Bound of the quick way's relative error. */
#define PART 0x1.8p-61

/* x = 2^k m and what the table has for m. */
struct split {
    double k;
    const double *row; /* of LOGARITHMS: c; -log c in three parts */
    double high, low;  /* r = high + low exactly: c has 10 bits, each half of m 24 to 29 */
};

static inline struct split split_of(double x)
{
    const uint64_t bits = dd_bits(x), above = bits - LOWEST;
    const int64_t k = (int64_t)above >> 52;
    const double m = dd_of_bits(bits - ((uint64_t)k << 52)), half = dd_half(m);
    const double *row = LOGARITHMS[above >> 45 & 127];
    return (struct split){ (double)k, row, row[0] * half - 1.0, row[0] * (m - half) };
}

/* x, if it is subnormal scaled to a normal number by 2^54; *k is the exponent to be added. */
static inline double normal(double x, double *k)
{
    *k = x < 0x1p-1022 ? -54.0 : 0.0;
    return x < 0x1p-1022 ? x * 0x1p54 : x;
}

/* In double-double, with log(1 + r) = r - r^2/2 + ... up to r^15, |r| <= 2^-7. */
struct dd el_log_dd(double x)
{
    double k;
    const struct split s = split_of(normal(x, &k));
    const struct dd r = dd_sum(s.high, s.low);
    k += s.k;
    double tail = 0.0;
    for (int i = 15; i >= 9; i--) {
        tail = INVERSES[i][0] - r.h * tail;
    }
    struct dd sum = { tail, 0.0 };
    for (int i = 8; i >= 1; i--) {
        sum = dd_add(dd_of(INVERSES[i][0], INVERSES[i][1]), dd_minus(dd_mul(sum, r)));
    }
    sum = dd_mul(sum, r);
    const struct dd low =
        dd_add(dd_sum(s.row[2], s.row[3]), dd_add(dd_product(k, LN2[1]), dd_of(k * LN2[2], 0.0)));
    return dd_add_to(k * LN2[0] + s.row[1], dd_add(low, sum));
}

/* r = a + b with a of 24 bits, so that a^2 / 2 is exact and the rest of r^2 is 2^-23 of it. The
 * polynomial's error is 2^-71 at r = 2^-7; r^3 / 3 and its sums have nine roundings: 2^-72.4.
 * Around x = 1 both errors shrink as r^3. */
struct dd el_log_quick(double x, double *error)
{
    const struct split s = split_of(x);
    const struct dd r = dd_fast(s.high, s.low);
    const double a = dd_half(r.h), b = (r.h - a) + r.l, u = r.h * r.h;
    const double rest =
        r.h * u
        * ((LOG_REST[0] + r.h * LOG_REST[1])
           + u * ((LOG_REST[2] + r.h * LOG_REST[3]) + u * (LOG_REST[4] + r.h * LOG_REST[5])));
    const struct dd first = dd_fast(s.k * LN2[0] + s.row[1], a);
    const struct dd sum = dd_fast(first.h, -0.5 * a * a);
    const double low = (s.row[2] + s.k * LN2[1] + b) + (rest - b * (a + 0.5 * b));
    *error = s.k == 0.0 && s.row[0] == 1.0 ? fabs(a) * 0x1p-63 : 0x1p-70;
    return dd_fast(sum.h, first.l + sum.l + low);
}

double el_log(double x)
{
    if (!(x >= 0x1p-1022 && x < INFINITY)) {
        return x == 0.0 ? -INFINITY : x < 0.0 ? NAN : x < 1.0 ? dd_rounded(el_log_dd(x), 0) : x;
    }
    const struct split s = split_of(x);
    const struct dd r = dd_fast(s.high, s.low), sum = dd_fast(s.k * LN2[0] + s.row[1], r.h);
    const double u = r.h * r.h;
    const double rest =
        r.h * u
        * ((LOG_REST[0] + r.h * LOG_REST[1])
           + u * ((LOG_REST[2] + r.h * LOG_REST[3]) + u * (LOG_REST[4] + r.h * LOG_REST[5])));
    double y;
    const double low = sum.l + ((s.row[2] + s.k * LN2[1] + r.l) + (rest - 0.5 * u));
    if (dd_settled(sum.h, low, fabs(sum.h) * PART, &y)) {
        return y;
    }
    return dd_rounded(el_log_dd(x), 0);
}
