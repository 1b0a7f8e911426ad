/* Arc functions, all computed as the angle of a point (x, y). With i / 64 near y / x <= 1,
 *
 *     atan(y / x) = atan(i / 64) + atan z,   z = (y - x i / 64) / (x + y i / 64), |z| < 1/127.
 *
 * In the other octants this angle is subtracted from pi/2 or pi, or added to pi/2. */
#include "elementary.h"
#include "double_double.h"
#include "el_arc_tables.h"

/* Bound of the quick way's relative error. Its products are exact (24 bits by 24 or 7) or concern
 * the part 2^-24 of a number. So z = first + tail without its cubic part has an error of 2^-73.8 z
 * if i = 0, else of 2^-73.9, where the angle is at least 2^-7.01. This is 2^-66.8 of it. The sides
 * of asin and acos add 2^-74. The cubic part, 2^-15.5 z, has 16 roundings: 2^-64.5; four more sums
 * of it: 2^-66.5. Together 2^-63.9. */
#define PART 0x1.2p-64

/* The number h + l, h the nearest number of 24 bits. */
struct cut {
    double h, l;
};

static inline struct cut cut_of(double x)
{
    const double h = dd_half(x);
    return (struct cut){ h, x - h };
}

/* The quick way: angle of a point whose larger coordinate is x and smaller one y in magnitude, both
 * 2^-60 to 2^60; `start` is the row of ARC_STARTS for its octant. False if the rounding is not
 * certain. */
static inline bool quick(struct cut y, struct cut x, const double start[3], double *result)
{
    const int i = (int)(64.0F * ((float)y.h / (float)x.h) + 0.5F);
    const double c = i * 0x1p-6, over = y.h - c * x.h, over_rest = y.l - c * x.l;
    const double under = x.h + c * y.h, under_rest = x.l + c * y.l, all = under + under_rest;
    const double inverse = 1.0 / all, z = (over + over_rest) * inverse, u = z * z;
    const double first = dd_half(z), half = dd_half(all);
    const double left = (over - first * half) + (over_rest - first * (under - half + under_rest));
    const double cubic =
        z * u * (ATAN_REST[0] + u * (ATAN_REST[1] + u * (ATAN_REST[2] + u * ATAN_REST[3])));
    const double sign = start[2], tail = sign * (left * inverse + cubic);
    const struct dd a = dd_fast(start[0], sign * ANGLES[i][0]), b = dd_fast(a.h, sign * first);
    return dd_settled(b.h, a.l + b.l + (start[1] + sign * ANGLES[i][1] + tail), b.h * PART, result);
}

/* atan(y / x), x >= y > 0, by the series up to z^17 / 17; the rest is below 2^-124. */
static struct dd atan_of(struct dd y, struct dd x)
{
    const int i = (int)(64.0 * (y.h / x.h) + 0.5);
    const double c = -i / 64.0;
    const struct dd over = dd_add(y, dd_mul(x, dd_of(c, 0.0)));
    const struct dd under = dd_add(x, dd_mul(y, dd_of(-c, 0.0)));
    const struct dd z = dd_div(over, under), v = dd_minus(dd_mul(z, z));
    struct dd sum = { 0.0, 0.0 };
    for (int n = 8; n >= 0; n--) {
        sum = dd_add(dd_of(ODD_INVERSES[n][0], ODD_INVERSES[n][1]), dd_mul(sum, v));
    }
    return dd_add(dd_of(ANGLES[i][0], ANGLES[i][1]), dd_mul(sum, z));
}

/* The slow way: angle of a point, 0 to pi, y >= 0, in double-double. */
static double slow(struct dd y, struct dd x)
{
    const struct dd quarter = { ARC_STARTS[1][0], ARC_STARTS[1][1] };
    const struct dd a = x.h < 0.0 ? dd_minus(x) : x;
    const bool steep = y.h > a.h || (y.h == a.h && y.l > a.l);
    struct dd r = steep ? atan_of(a, y) : atan_of(y, a);
    r = steep ? dd_add(quarter, dd_minus(r)) : r;
    r = x.h < 0.0 ? dd_add(dd_times(quarter, 2.0), dd_minus(r)) : r;
    return dd_rounded(r, 0);
}

/* Angle of a point whose coordinates differ by a factor of 2^60 or more, or one of which is 0 or
 * infinite; y >= 0. */
static double limit(double y, double x)
{
    const double pi = ARC_STARTS[2][0], less = ARC_STARTS[2][1], a = fabs(x);
    if (isinf(y) && isinf(x)) {
        return slow(dd_of(1.0, 0.0), dd_of(copysign(1.0, x), 0.0));
    }
    if (y == 0.0 || a > y) {
        const double small = y == 0.0 || isinf(x) ? 0.0 : y / a;
        return signbit(x) ? pi + (less - small) : small;
    }
    return ARC_STARTS[1][0] + (ARC_STARTS[1][1] - (isinf(y) ? 0.0 : x / y));
}

double el_atan2(double y, double x)
{
    const double b = fabs(y), a = fabs(x);
    const double least = b < a ? b : a, most = b < a ? a : b;
    double angle;
    if (least > 0x1p-60 && most < 0x1p60
        && quick(cut_of(least), cut_of(most), ARC_STARTS[2 * (x < 0.0) + (b > a)], &angle)) {
        return copysign(angle, y);
    }
    if (isnan(x) || isnan(y)) {
        return x + y;
    }
    if (!(least >= most * 0x1p-60) || most == 0.0 || isinf(most)) {
        return copysign(limit(b, x), y);
    }
    const int scale = (int)(dd_bits(most) >> 52) - 1023;
    if (scale < -200 || scale > 200) {
        return copysign(slow(dd_of(ldexp(b, -scale), 0.0), dd_of(ldexp(x, -scale), 0.0)), y);
    }
    return copysign(slow(dd_of(b, 0.0), dd_of(x, 0.0)), y);
}

double el_atan(double x)
{
    return fabs(x) < 0x1p-27 ? x : el_atan2(x, 1.0);
}

/* sqrt(1 - x^2), the other side of the triangle with hypotenuse 1. */
static struct dd other(double x)
{
    return dd_sqrt(dd_mul(dd_sum(1.0, -x), dd_sum(1.0, x)));
}

/* The same with a relative error of 2^-74.3, 0 <= x < 1: first^2 is within 2^-22 of high, so that
 * their difference is exact. */
static inline struct cut quick_other(double x)
{
    const struct dd a = dd_fast(1.0, -x), b = dd_fast(1.0, x);
    const struct cut c = cut_of(a.h), d = cut_of(b.h);
    const double high = c.h * d.h;
    const double low = (c.h * d.l + c.l * b.h) + (a.h * b.l + a.l * b.h), root = sqrt(high + low);
    const double first = dd_half(root);
    return (struct cut){ first, ((high - first * first) + low) / (root + first) };
}

double el_asin(double x)
{
    const double a = fabs(x);
    if (!(a >= 0x1p-26 && a <= 1.0)) {
        return a > 1.0 ? NAN : x;
    }
    if (a < 1.0) {
        const struct cut sides[2] = { cut_of(a), quick_other(a) };
        const bool steep = sides[0].h > sides[1].h;
        double angle;
        if (quick(sides[steep], sides[!steep], ARC_STARTS[steep], &angle)) {
            return copysign(angle, x);
        }
    }
    return copysign(slow(dd_of(a, 0.0), other(a)), x);
}

double el_acos(double x)
{
    const double a = fabs(x);
    if (!(a <= 1.0)) {
        return a > 1.0 ? NAN : x;
    }
    if (a < 0x1p-60) {
        return ARC_STARTS[1][0] + (ARC_STARTS[1][1] - x);
    }
    if (a < 1.0) {
        const struct cut sides[2] = { quick_other(a), cut_of(a) };
        const bool steep = sides[0].h > sides[1].h;
        double angle;
        if (quick(sides[steep], sides[!steep], ARC_STARTS[2 * (x < 0.0) + steep], &angle)) {
            return angle;
        }
    }
    return slow(other(x), dd_of(x, 0.0));
}
