/* Exponential and hyperbolic functions. With k = round(128 x / ln 2) and r = x - k ln 2 / 128,
 * e^x = 2^(k / 128) (1 + (e^r - 1)). */
#include "elementary.h"
#include "el_exp.h"
#include "el_exp_tables.h"
#include "el_extremes.h"
#include "el_series_tables.h"

/* Biased exponents of x for the quick way: for |x| < 2^-54 e^x rounds to 1; for |x| >= 512 it may
 * be infinite or subnormal. */
enum { LEAST = 1023 - 54, MOST = 1023 + 9 };
/* Bound of the relative error of the quick e^x. */
#define PART 0x1p-60
/* Bound of the error of the quick e^x - 1, relative to 2^j T r (see quick_less_one). */
#define REST_PART 0x1.5p-60

/* k as a double; in *k as an integer modulo 2^32 at least. */
static inline double steps_of(double x, uint64_t *k)
{
    const double turned = x * OCTAVE_STEPS[0] + 0x1.8p52;
    *k = dd_bits(turned);
    return turned - 0x1.8p52;
}

/* e^r - 1 = r (1 + r/2! + ...) in double-double, x = k ln 2 / 128 + r; the first omitted term is
 * |r|^12 / 12! = 2^-131. */
static struct dd rest_dd(struct dd x, uint64_t *k)
{
    const double n = steps_of(x.h, k);
    const struct dd first = dd_sum(x.h - n * OCTAVE_STEP[0], -n * OCTAVE_STEP[1]);
    const struct dd r = dd_add(first, dd_sum(-n * OCTAVE_STEP[2], x.l));
    double tail = 0.0;
    for (int i = 11; i >= 6; i--) {
        tail = FACTORIALS[i][0] + r.h * tail;
    }
    struct dd sum = { tail, 0.0 };
    for (int i = 5; i >= 1; i--) {
        sum = dd_add(dd_of(FACTORIALS[i][0], FACTORIALS[i][1]), dd_mul(sum, r));
    }
    return dd_mul(sum, r);
}

struct dd el_exp_dd(struct dd x, int *k)
{
    uint64_t n;
    const struct dd p = rest_dd(x, &n);
    const struct dd power = { POWERS[n % 128][0], POWERS[n % 128][1] };
    *k = (int32_t)(uint32_t)(n - n % 128) / 128;
    return dd_add(power, dd_mul(power, p));
}

/* e^x - 1 in double-double, |x| < 600. */
static struct dd expm1_dd(struct dd x)
{
    uint64_t n;
    int k;
    const struct dd p = rest_dd(x, &n);
    if ((uint32_t)n == 0) {
        return p;
    }
    const struct dd e = el_exp_dd(x, &k);
    return dd_add_to(-1.0, dd_times(e, dd_power(k)));
}

/* The quick way: e^(x + more), whose relative error is below `error`. False if the rounding is not
 * certain. */
static inline bool quick(double x, double more, double error, double *y)
{
    uint64_t k;
    const double n = steps_of(x, &k), r = ((x - n * OCTAVE_STEP[0]) - n * OCTAVE_STEP[1]) + more;
    const double *power = POWERS[k % 128];
    const double p =
        r + r * r * ((EXP_REST[0] + r * EXP_REST[1]) + r * r * (EXP_REST[2] + r * EXP_REST[3]));
    const bool good = dd_settled(power[0], power[1] + power[0] * p, 2.0 * error, y);
    *y *= dd_of_bits((k / 128 + 1023) << 52);
    return good;
}

bool el_exp_quick(struct dd x, double error, double *y)
{
    return quick(x.h, x.l, 1.25 * PART + 1.0000001 * error, y); /* one more rounding of r */
}

double el_exp(double x)
{
    const unsigned exponent = (unsigned)(dd_bits(x) >> 52 & 2047);
    double y;
    if (exponent - LEAST < MOST - LEAST && quick(x, -0.0, PART, &y)) {
        return y;
    }
    if (exponent < LEAST) {
        return 1.0;
    }
    if (!(fabs(x) < 800.0)) {
        return isnan(x) ? x : x > 0.0 ? INFINITY : 0.0;
    }
    int k;
    const struct dd e = el_exp_dd(dd_of(x, 0.0), &k);
    return dd_rounded(e, k);
}

/* A value and the bound of its absolute error. */
struct about {
    struct dd m;
    double error;
};

/* e^x - 1 = 2^j T - 1 + 2^j T (e^r - 1), j = floor(k / 128), T = 2^((k mod 128) / 128), |x| < 100.
 * r has two parts. T r is an exact product of 24 bits by 24 and a rest that is 2^-24 of it. The
 * other terms of T (e^r - 1), from T r^2 / 2 on, are 2^-9.53 of T r and have seven roundings:
 * 2^-59.72 of T r; the polynomial adds 2^-66; the error of r is 2^-97 k. */
static inline struct about quick_less_one(double x)
{
    uint64_t k;
    const double n = steps_of(x, &k), *power = POWERS[k % 128];
    const double scale = dd_of_bits((k / 128 + 1023) << 52);
    const struct dd r = dd_fast(x - n * OCTAVE_STEP[0], -n * OCTAVE_STEP[1]);
    const double u = r.h * r.h, cubic = u * r.h
                                        * (LESS_REST[0] + r.h * LESS_REST[1]
                                           + u * (LESS_REST[2] + r.h * LESS_REST[3]));
    const double rest = 0.5 * u + (cubic + (r.l - n * OCTAVE_STEP[2]));
    const double a = dd_half(r.h), b = dd_half(power[0]), product = scale * (a * b);
    const double low = b * (r.h - a) + (power[0] - b) * r.h;
    const struct dd first = dd_sum(scale * power[0], -1.0), sum = dd_fast(first.h, product);
    const double more = scale * (low + (power[1] + power[1] * r.h + power[0] * rest));
    return (struct about){ dd_fast(sum.h, first.l + sum.l + more),
                           fabs(product) * REST_PART + fabs(sum.h) * 0x1p-90 };
}

double el_expm1(double x)
{
    if (!(fabs(x) >= 0x1p-54)) {
        return x;
    }
    if (!(fabs(x) < 100.0)) {
        return x > 0.0 ? el_exp(x) : -1.0;
    }
    const struct about e = quick_less_one(x);
    double y;
    return dd_settled(e.m.h, e.m.l, e.error, &y) ? y : dd_rounded(expm1_dd(dd_of(x, 0.0)), 0);
}

/* sinh x = (m + m / (1 + m)) / 2, m = e^x - 1; its relative error is at most that of m. */
double el_sinh(double x)
{
    const double a = fabs(x);
    int k;
    if (!(a >= 0x1p-26) || isinf(x)) {
        return x;
    }
    if (a >= 40.0) { /* e^-a is less than 2^-115 of e^a */
        const struct dd e = el_exp_dd(dd_of(el_min(a, 800.0), 0.0), &k);
        return copysign(dd_rounded(e, k - 1), x);
    }
    const struct about e = quick_less_one(a);
    struct dd both = dd_add(e.m, dd_div(e.m, dd_add_to(1.0, e.m)));
    double y;
    if (dd_settled(both.h, both.l, both.h * (e.error / e.m.h), &y)) {
        return copysign(0.5 * y, x);
    }
    const struct dd m = expm1_dd(dd_of(a, 0.0));
    both = dd_add(m, dd_div(m, dd_add_to(1.0, m)));
    return copysign(dd_rounded(both, -1), x);
}

/* cosh x = (e + 1 / e) / 2, e = e^x; its error is below that of e. */
double el_cosh(double x)
{
    const double a = fabs(x);
    int k;
    if (!(a < 800.0)) {
        return a;
    }
    if (a < 40.0) {
        const struct about m = quick_less_one(a);
        const struct dd e = dd_add_to(1.0, m.m), both = dd_add(e, dd_div(dd_of(1.0, 0.0), e));
        double y;
        if (dd_settled(both.h, both.l, m.error + both.h * 0x1p-90, &y)) {
            return 0.5 * y;
        }
    }
    struct dd e = el_exp_dd(dd_of(a, 0.0), &k);
    if (a < 40.0) {
        e = dd_times(e, dd_power(k));
        e = dd_add(e, dd_div(dd_of(1.0, 0.0), e));
        k = 0;
    }
    return dd_rounded(e, k - 1);
}

/* tanh x = m / (2 + m), m = e^(2 x) - 1; its relative error is at most that of m. */
double el_tanh(double x)
{
    const double a = fabs(x);
    if (!(a >= 0x1p-27) || a >= 22.0) {
        return a >= 22.0 ? copysign(1.0, x) : x;
    }
    const struct about e = quick_less_one(2.0 * a);
    const struct dd share = dd_div(e.m, dd_add_to(2.0, e.m));
    double y;
    if (dd_settled(share.h, share.l, share.h * (e.error / e.m.h), &y)) {
        return copysign(y, x);
    }
    const struct dd m = expm1_dd(dd_of(2.0 * a, 0.0));
    return copysign(dd_rounded(dd_div(m, dd_add_to(2.0, m)), 0), x);
}
