/* Arc functions: all from the angle of a point. With i / 64 near y / x <= 1,
 *
 *     atan(y / x) = atan(i / 64) + atan z,   z = (y - x i / 64) / (x + y i / 64), |z| <= 1/125. */
#include "elementary.h"
#include "double_double.h"
#include "el_arc_tables.h"

/* What the angle is off by without the whole series, of its value. */
#define PART 0x1p-67

static struct dd atan_of(struct dd y, struct dd x, bool whole)
{
    const int i = (int)(64.0 * (y.h / x.h) + 0.5);
    const double c = -i / 64.0;
    const struct dd over = dd_add(y, dd_mul(x, dd_of(c, 0.0)));
    const struct dd under = dd_add(x, dd_mul(y, dd_of(-c, 0.0)));
    const struct dd z = dd_div(over, under), start = { ANGLES[i][0], ANGLES[i][1] };
    const double u = z.h * z.h;
    if (!whole) {
        const double rest = z.h * u * (ATAN_REST[0] + u * (ATAN_REST[1] + u * (ATAN_REST[2] +
                                                                               u * ATAN_REST[3])));
        return dd_add(start, dd_fast(z.h, z.l + rest));
    }
    const struct dd v = dd_minus(dd_mul(z, z));
    struct dd sum = { 0.0, 0.0 };
    for (int n = 8; n >= 0; n--) {
        sum = dd_add(dd_of(ODD_INVERSES[n][0], ODD_INVERSES[n][1]), dd_mul(sum, v));
    }
    return dd_add(start, dd_mul(sum, z));
}

/* The angle of a point, 0 to pi; y >= 0. */
static double angle(struct dd y, struct dd x)
{
    const struct dd quarter = { ARC_QUARTER[0], ARC_QUARTER[1] };
    const struct dd a = x.h < 0.0 ? dd_minus(x) : x;
    const bool steep = y.h > a.h || (y.h == a.h && y.l > a.l);
    for (bool whole = false;; whole = true) {
        struct dd r = steep ? atan_of(a, y, whole) : atan_of(y, a, whole);
        r = steep ? dd_add(quarter, dd_minus(r)) : r;
        r = x.h < 0.0 ? dd_add(dd_times(quarter, 2.0), dd_minus(r)) : r;
        double rounded;
        if (whole) {
            return dd_rounded(r, 0);
        }
        if (dd_settled(r.h, r.l, r.h * PART, &rounded)) {
            return rounded;
        }
    }
}

/* Where y and x differ by 2^60 or one is 0 or infinite; both >= 0 but for the sign of x. */
static double limit(double y, double x)
{
    const double pi = 2.0 * ARC_QUARTER[0], less = 2.0 * ARC_QUARTER[1], a = fabs(x);
    if (isinf(y) && isinf(x)) {
        return angle(dd_of(1.0, 0.0), dd_of(copysign(1.0, x), 0.0));
    }
    if (y == 0.0 || a > y) {
        const double small = y == 0.0 || isinf(x) ? 0.0 : y / a;
        return signbit(x) ? pi + (less - small) : small;
    }
    return ARC_QUARTER[0] + (ARC_QUARTER[1] - (isinf(y) ? 0.0 : x / y));
}

double el_atan2(double y, double x)
{
    if (isnan(x) || isnan(y)) {
        return x + y;
    }
    const double b = fabs(y), a = fabs(x);
    const int scale = (int)(dd_bits(fmax(a, b)) >> 52) - 1023;
    const double least = fmin(a, b), most = fmax(a, b);
    if (!(least >= most * 0x1p-60) || most == 0.0 || isinf(most)) {
        return copysign(limit(b, x), y);
    }
    if (scale < -200 || scale > 200) {
        return copysign(angle(dd_of(ldexp(b, -scale), 0.0),
                              dd_of(ldexp(x, -scale), 0.0)), y);
    }
    return copysign(angle(dd_of(b, 0.0), dd_of(x, 0.0)), y);
}

double el_atan(double x)
{
    return fabs(x) < 0x1p-27 ? x : el_atan2(x, 1.0);
}

/* sqrt(1 - x^2) */
static struct dd other(double x)
{
    return dd_sqrt(dd_mul(dd_sum(1.0, -x), dd_sum(1.0, x)));
}

double el_asin(double x)
{
    const double a = fabs(x);
    if (!(a >= 0x1p-26 && a <= 1.0)) {
        return a > 1.0 ? NAN : x;
    }
    return copysign(angle(dd_of(a, 0.0), other(a)), x);
}

double el_acos(double x)
{
    const double a = fabs(x);
    if (!(a <= 1.0)) {
        return a > 1.0 ? NAN : x;
    }
    if (a < 0x1p-60) {
        return ARC_QUARTER[0] + (ARC_QUARTER[1] - x);
    }
    return angle(other(x), dd_of(x, 0.0));
}
