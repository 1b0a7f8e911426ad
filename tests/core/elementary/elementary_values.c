/* Special values of C11, Annex F; symmetry; order of neighbours; and sums that must be 1. */
#include "check.h"
#include "el_extremes.h"
#include "elementary.h"

typedef double (*of_one)(double);

static uint64_t seed = 19;

/* Random, with all binary exponents from low to high. */
static double some(int low, int high)
{
    const double m = check_real(&seed, 1.0, 2.0);
    return ldexp(check_random(&seed, 0, 1) ? m : -m, (int)check_random(&seed, low, high));
}

/* The same number, and the same sign of 0. */
static void is(double got, double want, int line)
{
    if (isnan(want) ? !isnan(got) : got != want || signbit(got) != signbit(want)) {
        printf("line %d: %a, want %a\n", line, got, want);
        check_failures++;
    }
}
#define IS(got, want) is(got, want, __LINE__)

static void special_values(void)
{
    static const of_one zeros[] = { el_sin,   el_tan,  el_asin, el_atan,
                                    el_expm1, el_sinh, el_tanh, el_cbrt };
    for (unsigned i = 0; i < sizeof zeros / sizeof *zeros; i++) {
        IS(zeros[i](0.0), 0.0);
        IS(zeros[i](-0.0), -0.0);
        IS(zeros[i](0x1p-1074), zeros[i] == el_cbrt ? 0x1p-358 : 0x1p-1074);
    }
    static const of_one all[] = { el_sin, el_cos,   el_tan,  el_asin, el_acos, el_atan, el_exp,
                                  el_log, el_expm1, el_sinh, el_cosh, el_tanh, el_cbrt };
    for (unsigned i = 0; i < sizeof all / sizeof *all; i++) {
        IS(all[i](NAN), NAN);
    }
    for (int i = 0; i < 3; i++) {
        IS(all[i](INFINITY), NAN);
        IS(all[i](-INFINITY), NAN);
    }
    IS(el_cos(0.0), 1.0);
    IS(el_asin(1.0), 0x1.921fb54442d18p0);
    IS(el_asin(-1.0), -0x1.921fb54442d18p0);
    IS(el_asin(1.0 + 0x1p-52), NAN);
    IS(el_acos(1.0), 0.0);
    IS(el_acos(-1.0), 0x1.921fb54442d18p1);
    IS(el_acos(0.0), 0x1.921fb54442d18p0);
    IS(el_acos(-INFINITY), NAN);
    IS(el_atan(INFINITY), 0x1.921fb54442d18p0);
    IS(el_atan(-INFINITY), -0x1.921fb54442d18p0);
    IS(el_exp(INFINITY), INFINITY);
    IS(el_exp(-INFINITY), 0.0);
    IS(el_exp(709.7827128933840), 0x1.fffffffffff2ap1023);
    IS(el_exp(709.7827128933841), INFINITY);
    IS(el_exp(-745.1332191019411), 0x1p-1074);
    IS(el_exp(-745.1332191019412), 0.0);
    IS(el_exp(0.0), 1.0);
    IS(el_exp(1.0), 0x1.5bf0a8b145769p1);
    IS(el_expm1(INFINITY), INFINITY);
    IS(el_expm1(-INFINITY), -1.0);
    IS(el_sinh(INFINITY), INFINITY);
    IS(el_sinh(-INFINITY), -INFINITY);
    IS(el_sinh(-711.0), -INFINITY);
    IS(el_cosh(-INFINITY), INFINITY);
    IS(el_cosh(711.0), INFINITY);
    IS(el_cosh(0.0), 1.0);
    IS(el_tanh(INFINITY), 1.0);
    IS(el_tanh(-INFINITY), -1.0);
    IS(el_log(0.0), -INFINITY);
    IS(el_log(-0.0), -INFINITY);
    IS(el_log(1.0), 0.0);
    IS(el_log(INFINITY), INFINITY);
    IS(el_log(-1.0), NAN);
    IS(el_log(-INFINITY), NAN);
    IS(el_log(0x1p-1074), -0x1.74385446d71c3p9);
    IS(el_cbrt(INFINITY), INFINITY);
    IS(el_cbrt(-INFINITY), -INFINITY);
    IS(el_hypot(INFINITY, NAN), INFINITY);
    IS(el_hypot(NAN, -INFINITY), INFINITY);
    IS(el_hypot(NAN, 0.0), NAN);
    IS(el_hypot(-0.0, 0.0), 0.0);
    IS(el_hypot(-3.0, 0.0), 3.0);
    IS(el_hypot(0x3p600, 0x4p600), 0x5p600);
    IS(el_hypot(3 * 0x1p-1074, 4 * 0x1p-1074), 5 * 0x1p-1074);
    IS(el_hypot(1.7e308, 1.7e308), INFINITY);
}

static void special_angles(void)
{
    const double pi = 0x1.921fb54442d18p1, least = 0x1p-1074;
    for (int i = 0; i < 2; i++) {
        const double s = i ? -1.0 : 1.0;
        IS(el_atan2(s * 0.0, -0.0), s * pi);
        IS(el_atan2(s * 0.0, 0.0), s * 0.0);
        IS(el_atan2(s * 0.0, -1.0), s * pi);
        IS(el_atan2(s * 0.0, 1.0), s * 0.0);
        IS(el_atan2(s, 0.0), s * pi / 2);
        IS(el_atan2(s, -0.0), s * pi / 2);
        IS(el_atan2(s, -INFINITY), s * pi);
        IS(el_atan2(s, INFINITY), s * 0.0);
        IS(el_atan2(s * INFINITY, -1.0), s * pi / 2);
        IS(el_atan2(s * INFINITY, -INFINITY), s * 0x1.2d97c7f3321d2p1);
        IS(el_atan2(s * INFINITY, INFINITY), s * pi / 4);
        IS(el_atan2(s * least, least), s * pi / 4);
        IS(el_atan2(s * least, 1.0), s * least);
        IS(el_atan2(s * 1e-300, 1e300), s * 0.0);
        IS(el_atan2(s * 1e300, -1e300), s * 0x1.2d97c7f3321d2p1);
    }
    IS(el_atan2(NAN, 1.0), NAN);
    IS(el_atan2(1.0, NAN), NAN);
}

/* Of equals the second, whatever sign a zero has; what is a number beside one that is none. */
static void special_extremes(void)
{
    for (int i = 0; i < 2; i++) {
        double (*const f)(double, double) = i ? el_max : el_min;
        IS(f(0.0, -0.0), -0.0);
        IS(f(-0.0, 0.0), 0.0);
        IS(f(NAN, -0.0), -0.0);
        IS(f(-0.0, NAN), -0.0);
        IS(f(NAN, NAN), NAN);
        IS(f(-INFINITY, 1.0), i ? 1.0 : -INFINITY);
        IS(f(1.0, -INFINITY), i ? 1.0 : -INFINITY);
    }
}

/* All of C11, F.10.4.4. */
static void special_powers(void)
{
    static const double none[] = { 0.0, -0.0 }, odd[] = { 3.0, 0x1.fffffffffffffp52, 1.0 };
    static const double other[] = { 2.0, 2.5, 0x1p53, 0x1p60 };
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 3; k++) {
            IS(el_pow(none[i], -odd[k]), copysign(INFINITY, none[i]));
            IS(el_pow(none[i], odd[k]), none[i]);
            IS(el_pow(-INFINITY, -odd[k]), -0.0);
            IS(el_pow(-INFINITY, odd[k]), -INFINITY);
        }
        for (int k = 0; k < 4; k++) {
            IS(el_pow(none[i], -other[k]), INFINITY);
            IS(el_pow(none[i], other[k]), 0.0);
            IS(el_pow(-INFINITY, -other[k]), 0.0);
            IS(el_pow(-INFINITY, other[k]), INFINITY);
            IS(el_pow(INFINITY, -other[k]), 0.0);
            IS(el_pow(INFINITY, other[k]), INFINITY);
        }
        IS(el_pow(none[i], -INFINITY), INFINITY);
        IS(el_pow(none[i], INFINITY), 0.0);
        IS(el_pow(NAN, none[i]), 1.0);
        IS(el_pow(-1.0, i ? INFINITY : -INFINITY), 1.0);
    }
    IS(el_pow(1.0, NAN), 1.0);
    IS(el_pow(-2.0, 0.5), NAN);
    IS(el_pow(NAN, 1.0), NAN);
    IS(el_pow(2.0, NAN), NAN);
    IS(el_pow(0.5, -INFINITY), INFINITY);
    IS(el_pow(2.0, -INFINITY), 0.0);
    IS(el_pow(0.5, INFINITY), 0.0);
    IS(el_pow(-2.0, INFINITY), INFINITY);
    IS(el_pow(-2.0, 3.0), -8.0);
    IS(el_pow(-2.0, -1.0), -0.5);
    IS(el_pow(10.0, 22.0), 1e22);
    IS(el_pow(10.0, 23.0), 1e23);
    IS(el_pow(10.0, 308.0), 1e308);
    IS(el_pow(10.0, -320.0), 1e-320);
    IS(el_pow(2.0, -1074.0), 0x1p-1074);
    IS(el_pow(2.0, -1075.0), 0.0);
    IS(el_pow(2.0, 1024.0), INFINITY);
    IS(el_pow(-2.0, 1023.0), -0x1p1023);
    IS(el_pow(-1e300, 3.0), -INFINITY);
    IS(el_pow(67108865.0, 2.0), 4503599761588225.0);   /* (2^26 + 1)^2, 53 bits */
    IS(el_pow(134217729.0, 2.0), 18014398777917440.0); /* (2^27 + 1)^2, in the middle */
}

/* f(-x) = sign f(x). */
static void symmetry(void)
{
    static const of_one odd[] = { el_sin, el_tan, el_asin, el_atan, el_sinh, el_tanh, el_cbrt };
    static const of_one even[] = { el_cos, el_cosh };
    for (int i = 0; i < 20000; i += CHECK_EACH) {
        const double x = some(-40, 9), y = some(-40, 40), large = some(10, 1023);
        for (unsigned k = 0; k < sizeof odd / sizeof *odd; k++) {
            IS(odd[k](-x), -odd[k](x));
        }
        for (unsigned k = 0; k < sizeof even / sizeof *even; k++) {
            IS(even[k](-x), even[k](x));
        }
        IS(el_sin(-large), -el_sin(large));
        IS(el_cos(-large), el_cos(large));
        IS(el_atan2(-y, x), -el_atan2(y, x));
        IS(el_hypot(x, y), el_hypot(y, -x));
        IS(el_hypot(ldexp(x, 600), ldexp(y, 600)), ldexp(el_hypot(x, y), 600));
        IS(el_cbrt(ldexp(x, -900)), ldexp(el_cbrt(x), -300));
        IS(el_atan2(ldexp(y, 700), ldexp(x, 700)), el_atan2(y, x));
    }
}

/* Where a function rises or falls it does so from each double to the next. */
static void order(void)
{
    static const struct {
        of_one f;
        int low, high; /* exponents of the argument */
        double sign;
    } rising[] = {
        { el_sin, -40, -1, 1 },   { el_asin, -40, -1, 1 }, { el_tan, -40, -1, 1 },
        { el_atan, -40, 40, 1 },  { el_exp, -54, 9, 1 },   { el_expm1, -54, 9, 1 },
        { el_sinh, -40, 9, 1 },   { el_tanh, -40, 5, 1 },  { el_cbrt, -1070, 1023, 1 },
        { el_acos, -40, -1, -1 },
    };
    for (unsigned k = 0; k < sizeof rising / sizeof *rising; k++) {
        for (int i = 0; i < 1000; i += CHECK_EACH) {
            double x = some(rising[k].low, rising[k].high), y = rising[k].sign * rising[k].f(x);
            for (int n = 0; n < 20; n++) {
                x = nextafter(x, INFINITY);
                const double next = rising[k].sign * rising[k].f(x);
                CHECK(next >= y);
                y = next;
            }
        }
    }
    for (int i = 0; i < 1000; i += CHECK_EACH) {
        double x = fabs(some(-1022, 1022)), a = fabs(some(-20, 3)), y = el_log(x), c = el_cosh(a);
        double q = check_real(&seed, 0.0, 1.5), d = el_cos(q);
        for (int n = 0; n < 20; n++) {
            x = nextafter(x, INFINITY), a = nextafter(a, INFINITY), q = nextafter(q, INFINITY);
            CHECK(el_log(x) >= y && el_cosh(a) >= c && el_cos(q) <= d);
            y = el_log(x), c = el_cosh(a), d = el_cos(q);
        }
    }
}

/* sin^2 + cos^2 = 1 to two units of the last place, and what belongs together. */
static void together(void)
{
    for (int i = 0; i < 50000; i += CHECK_EACH) {
        const double x = i % 2 ? some(-40, 20) : some(-40, 1023);
        const struct el_turn t = el_sincos(x);
        const double s = t.sine, c = t.cosine;
        IS(s, el_sin(x));
        IS(c, el_cos(x));
        CHECK_NEAR(s * s + c * c, 1.0, 0x1p-51);
        const double a = check_real(&seed, -3.1, 3.1);
        CHECK_NEAR(el_atan2(el_sin(a), el_cos(a)), a, 0x1p-50);
        CHECK_NEAR(el_asin(s) + el_acos(s), el_acos(0.0), 0x1p-51);
        CHECK_NEAR(el_log(el_exp(a)), a, 0x1p-49);
    }
    for (int i = 1; i < 200000; i += 7) { /* whole numbers are met */
        const double n = i;
        IS(el_cbrt(n * n * n), n);
        IS(el_hypot(3.0 * n, -4.0 * n), 5.0 * n);
        IS(el_pow(n, 2.0), n * n);
        IS(el_pow(n, 0.5), sqrt(n));
        IS(el_pow(n, -1.0), 1.0 / n);
    }
}

int main(void)
{
    special_values();
    special_angles();
    special_extremes();
    special_powers();
    symmetry();
    order();
    together();
    return check_result();
}
