/* Hypotenuse and cube root: a first approximation and its correction by the residual, which is
 * computed without rounding where that matters. dd_half gives numbers of 24 bits, whose products
 * are exact. */
#include "elementary.h"
#include "double_double.h"
#include "el_cbrt_tables.h"

/* sqrt(x^2 + y^2), x >= y >= 0, 2^-100 < x < 2^100. With h the rounded root and d = h - x, which is
 * exact, the correction is (y^2 - 2 x d - d^2) / (2 h). */
static inline double long_side(double x, double y)
{
    const double h = sqrt(x * x + y * y), d = h - x;
    const double xh = dd_half(x), yh = dd_half(y), dh = dd_half(d), dl = d - dh;
    const double low = (y - yh) * (y + yh) - dl * (d + dh) - 2.0 * (xh * dl + (x - xh) * d);
    return h + ((yh * yh - 2.0 * xh * dh - dh * dh) + low) / (2.0 * h);
}

double el_hypot(double x, double y)
{
    const double a = fabs(x), b = fabs(y), most = a > b ? a : b, least = a > b ? b : a;
    if (most > 0x1p-100 && most < 0x1p100 && least >= 0.0) {
        return long_side(most, least);
    }
    if (isinf(a) || isinf(b)) {
        return INFINITY;
    }
    if (isnan(x) || isnan(y)) {
        return x + y;
    }
    if (least == 0.0) {
        return most;
    }
    const int scale = ilogb(most);
    return ldexp(long_side(ldexp(most, -scale), ldexp(least, -scale)), scale);
}

double el_cbrt(double x)
{
    uint64_t bits = dd_bits(fabs(x));
    int scale = 0;
    if (bits - 0x10000000000000 >= 0x7fe0000000000000) {
        if (x == 0.0 || !isfinite(x)) {
            return x + x;
        }
        bits = dd_bits(fabs(x) * 0x1p54);
        scale = -18;
    }
    const unsigned e = (unsigned)(bits >> 52); /* of 1: 1023 = 3 * 341 */
    const double m = dd_of_bits((bits & 0xfffffffffffff) | 0x3ff0000000000000);
    const double *c = CBRT_START, v = m * dd_power((int)(e % 3)); /* m 2^0..2 */
    double t = CBRTS[e % 3] * (c[0] + m * (c[1] + m * (c[2] + m * (c[3] + m * c[4]))));
    const double cube = t * t * t;
    t = dd_half(t * (cube + 2.0 * v) / (2.0 * cube + v)); /* Halley: 10 bits become 30 */
    const double square = t * t, first = dd_half(square), second = square - first; /* exact */
    const double share = ((v - first * t) - second * t) / (3.0 * square * t);
    /* (t + t s)^3 = v: s + s^2 + s^3 / 3 is the share */
    const double y = t + t * share * (1.0 - share * (1.0 - 5.0 / 3.0 * share));
    return copysign(y * dd_power((int)(e / 3) - 341 + scale), x);
}
