/* x^y = e^(y log x): a quick way, and a slow one to 90 bits or more. */
#include "elementary.h"
#include "el_exp.h"
#include "el_log.h"

/* x^y for an infinite y, or x of 0 or infinity. */
static double limit(double x, double y, bool odd)
{
    const double a = fabs(x);
    if (isinf(y)) {
        return a == 1.0 ? 1.0 : (a > 1.0) == (y > 0.0) ? INFINITY : 0.0;
    }
    return copysign((a == 0.0) == (y > 0.0) ? 0.0 : INFINITY, odd ? x : 1.0);
}

/* The quick way, for |y log x| from 2^-50 to 700. False if it does not apply or the rounding is not
 * certain. */
static inline bool quick(double x, double y, double *result)
{
    double error;
    const struct dd l = el_log_quick(x, &error);
    const double size = fabs(l.h * y);
    if (!(size > 0x1p-50 && size < 700.0 && fabs(y) < 0x1p60)) {
        return false;
    }
    const struct dd z = dd_product(l.h, y);
    return el_exp_quick(dd_fast(z.h, z.l + l.l * y), error * fabs(y) + size * 0x1p-100, result);
}

/* CCN 20: a case for each of the special values that IEEE 754 names. */
double el_pow(double x, double y)
{
    double result;
    if (x >= 0x1p-1022 && x < INFINITY && quick(x, y, &result)) {
        return result;
    }
    if (y == 0.0 || x == 1.0) {
        return 1.0;
    }
    if (isnan(x) || isnan(y)) {
        return x + y;
    }
    const bool whole = floor(y) == y, odd = whole && fabs(y) < 0x1p53 && fmod(y, 2.0) != 0.0;
    if (isinf(y) || isinf(x) || x == 0.0) {
        return limit(x, y, odd);
    }
    if (x < 0.0 && !whole) {
        return NAN;
    }
    const double sign = odd ? x : 1.0, a = fabs(x);
    if (a == 1.0) {
        return copysign(1.0, sign);
    }
    const struct dd l = el_log_dd(a);
    const double size = l.h * y; /* beyond +-800 the result is infinite or 0 */
    if (fabs(size) > 800.0) {
        return copysign(size > 0.0 ? INFINITY : 0.0, sign);
    }
    if (fabs(size) < 0x1p-60) {
        return copysign(1.0, sign);
    }
    int k;
    const struct dd z = dd_product(l.h, y), e = el_exp_dd(dd_fast(z.h, z.l + l.l * y), &k);
    return copysign(dd_rounded(e, k), sign);
}
