/* Sine, cosine, tangent. With k the nearest multiple of the step 2 pi / 256 and r = x - k steps,
 *
 *     sin x = S + C r + (S (cos r - 1) + C (sin r - r)),  S = sin(2 pi k / 256),  C its cosine,
 *
 * where S and C are rounded to 26 bits and r to 27, so that S + C r is exact as a sum of two
 * doubles. The rounding errors of S, C and r go into the bracket, which is 2^-13 of the result. */
#include "elementary.h"
#include "double_double.h"
#include "el_lanes.h"
#include "el_series_tables.h"
#include "el_sine_tables.h"

/* Biased exponents of x for the quick way: for |x| < 2^-27 sin x = x and cos x = 1; for |x| >= 2^17
 * k has too many bits. */
enum { LEAST = 1023 - 27, MOST = 1023 + 17 };
/* Bound of the quick way's error: relative to the value, plus the rounding of l <= 2^-34. */
#define PART 0x1.2p-64
#define REST 0x1p-87

/* x = k 2 pi / 256 + r with r = h + l. */
struct rest {
    unsigned k;
    double h, sine, cosine; /* h, sin r - h, cos r - 1 */
};

static inline bool is_quick(double x)
{
    return (unsigned)(dd_bits(x) >> 52 & 2047) - LEAST < MOST - LEAST;
}

static inline struct rest rest_of(double x)
{
    const double turned = x * TURN_STEPS[0] + 0x1.8p52, k = turned - 0x1.8p52;
    const double first = x - k * TURN_STEP[0], second = k * TURN_STEP[1]; /* exact, both */
    const double h = (first - second + 0x1.8p19) - 0x1.8p19;              /* a multiple of 2^-33 */
    const double l = (first - h - second) - k * TURN_STEP[2], r = h + l, u = r * r;
    return (struct rest){
        .k = (unsigned)dd_bits(turned),
        .h = h,
        .sine = l + r * u * (SINE_REST[0] + u * (SINE_REST[1] + u * SINE_REST[2])),
        .cosine = u * (COSINE_REST[0] + u * (COSINE_REST[1] + u * COSINE_REST[2])),
    };
}

/* sin(2 pi k / 256 + r). */
static inline struct dd sine_at(const struct rest *r, unsigned k)
{
    const double *s = SINES[k % 256], *c = SINES[(k + 64) % 256];
    const struct dd sum = dd_fast(s[0], c[0] * r->h);
    return dd_of(sum.h, sum.l + (s[1] + c[1] * r->h + c[2] * r->sine + s[2] * r->cosine));
}

static inline bool settled(struct dd a, double *y)
{
    return dd_settled(a.h, a.l, fabs(a.h) * PART + REST, y);
}

/* Argument reduction (Payne and Hanek): x = quarter pi / 2 + r, |r| <= pi / 4, for any finite x =
 * m 2^e. Of 2 / pi it takes nine words of 32 bits, from the first one whose product with x is not a
 * multiple of whole turns. They are 288 bits, of which m takes 53, the quarter 34, and the closest
 * double to a zero of sine or cosine cancels 62 at most. */
static struct dd turned(double x, unsigned *quarter)
{
    enum { TAKEN = 9, LIMBS = TAKEN + 2 };
    const uint64_t m = (dd_bits(x) & 0xfffffffffffff) | 0x10000000000000;
    const int e = (int)(dd_bits(x) >> 52 & 2047) - 1075, first = e < 2 ? 0 : (e - 2) / 32;
    if (fabs(x) < 0.78) {
        *quarter = 0;
        return dd_of(x, 0.0);
    }
    uint32_t limb[LIMBS + 1] = { 0 }; /* of the product, the last ones first */
    for (int part = 0; part < 2; part++) {
        uint64_t carry = 0;
        const uint64_t factor = part ? m >> 32 : m & 0xffffffff;
        for (int i = 0; i < TAKEN; i++) {
            const int word = first + TAKEN - 1 - i;
            carry += factor * WORDS[word] + limb[i + part];
            limb[i + part] = (uint32_t)carry;
            carry >>= 32;
        }
        limb[TAKEN + part] = (uint32_t)carry;
    }
    const int behind = 32 * (first + TAKEN) - e; /* bits behind the point, 223 to 341 */
    uint32_t part[8];                            /* the first 256 of these bits */
    for (int i = 0; i < 8; i++) {
        const int bit = behind - 32 * (i + 1);
        uint64_t two = 0;
        if (bit >= 0) {
            two = limb[bit / 32] | (uint64_t)limb[bit / 32 + 1] << 32;
            two >>= bit % 32;
        } else if (bit > -32) {
            two = (uint64_t)limb[0] << -bit;
        }
        part[i] = (uint32_t)two;
    }
    const int point = behind / 32;
    const uint64_t whole = limb[point] | (uint64_t)limb[point + 1] << 32;
    unsigned turns = (unsigned)(whole >> behind % 32);
    const bool over = part[0] >> 31;
    struct dd f = { 0.0, 0.0 };
    double scale = 0x1p-256;
    for (int i = 7; i >= 0; i--, scale *= 0x1p32) {
        f = dd_add_to((double)(over ? ~part[i] : part[i]) * scale, f);
    }
    turns += over;
    f = over ? dd_minus(f) : f;
    const bool back = x < 0.0;
    *quarter = back ? 0u - turns : turns;
    const struct dd r = dd_mul(f, dd_of(QUARTER[0], QUARTER[1]));
    return back ? dd_minus(r) : r;
}

/* sin r (first = 1) or cos r (first = 0): the sum of +-r^n / n!, n = first, first + 2, ... up to
 * 29, where (pi / 4)^29 / 29! = 2^-113. */
static struct dd series(struct dd r, int first)
{
    const struct dd u = dd_minus(dd_mul(r, r));
    struct dd sum = { 0.0, 0.0 };
    for (int n = 28 + first; n >= first; n -= 2) {
        sum = dd_add(dd_of(FACTORIALS[n][0], FACTORIALS[n][1]), dd_mul(sum, u));
    }
    return first ? dd_mul(sum, r) : sum;
}

/* sin(x + more pi / 2) in double-double, |x| >= 2^-27. */
static struct dd exact(double x, unsigned more)
{
    unsigned quarter;
    const struct dd r = turned(x, &quarter);
    quarter += more;
    const struct dd s = series(r, quarter % 2 ? 0 : 1);
    return quarter / 2 % 2 ? dd_minus(s) : s;
}

static double slow(double x, unsigned more)
{
    if (!isfinite(x)) {
        return x - x;
    }
    if (fabs(x) < 0x1p-27) {
        return more ? 1.0 : x;
    }
    return dd_rounded(exact(x, more), 0);
}

double el_sin(double x)
{
    double y;
    if (is_quick(x)) {
        const struct rest r = rest_of(x);
        if (settled(sine_at(&r, r.k), &y)) {
            return y;
        }
    }
    return slow(x, 0);
}

double el_cos(double x)
{
    double y;
    if (is_quick(x)) {
        const struct rest r = rest_of(x);
        if (settled(sine_at(&r, r.k + 64), &y)) {
            return y;
        }
    }
    return slow(x, 1);
}

struct el_turn el_sincos(double x)
{
    struct el_turn t;
    bool sine = false, cosine = false; /* they are settled */
    if (is_quick(x)) {
        const struct rest r = rest_of(x);
        sine = settled(sine_at(&r, r.k), &t.sine);
        cosine = settled(sine_at(&r, r.k + 64), &t.cosine);
    }
    t.sine = sine ? t.sine : slow(x, 0);
    t.cosine = cosine ? t.cosine : slow(x, 1);
    return t;
}

void el_turns_each(int n, const double *restrict angle, double *restrict sine,
                   double *restrict cosine)
{
    for (int i = 0; i < n; i++) {
        const struct el_turn t = el_sincos(angle[i]);
        sine[i] = t.sine;
        cosine[i] = t.cosine;
    }
}

#ifdef EL_WIDE
typedef double four __attribute__((vector_size(32)));
typedef int64_t four_bits __attribute__((vector_size(32)));

EL_AVX2 static inline four column(const int64_t row[4], int j)
{
    return (four){ SINES[row[0]][j], SINES[row[1]][j], SINES[row[2]][j], SINES[row[3]][j] };
}

EL_AVX2 static inline four size_of(four x)
{
    return (four)((four_bits)x & INT64_MAX);
}

/* The quick way of el_sincos in four lanes. Returns the lanes in which the rounding is not
 * certain. */
EL_AVX2 static inline four_bits quick_four(four x, four *sine, four *cosine)
{
    const four_bits size = (four_bits)size_of(x), tiny = size < (int64_t)LEAST << 52;
    const four turned = x * TURN_STEPS[0] + 0x1.8p52, k = turned - 0x1.8p52;
    const four first = x - k * TURN_STEP[0], second = k * TURN_STEP[1];
    const four h = (first - second + 0x1.8p19) - 0x1.8p19;
    const four l = (first - h - second) - k * TURN_STEP[2], r = h + l, u = r * r;
    const four s = l + r * u * (SINE_REST[0] + u * (SINE_REST[1] + u * SINE_REST[2]));
    const four c = u * (COSINE_REST[0] + u * (COSINE_REST[1] + u * COSINE_REST[2]));
    const four_bits k0 = (four_bits)turned & 255, k1 = (k0 + 64) & 255;
    const int64_t at[4] = { k0[0], k0[1], k0[2], k0[3] }, on[4] = { k1[0], k1[1], k1[2], k1[3] };
    const four sh = column(at, 0), sl = column(at, 1), sd = column(at, 2);
    const four ch = column(on, 0), cl = column(on, 1), cd = column(on, 2);
    const four p = ch * h, ph = sh + p, pl = (p - (ph - sh)) + (sl + cl * h + cd * s + sd * c);
    const four q = sh * h, qh = ch - q, ql = ((ch - qh) - q) + (cl - sl * h - sd * s + cd * c);
    const four pe = size_of(ph) * PART + REST, qe = size_of(qh) * PART + REST;
    const four y = ph + (pl - pe), z = qh + (ql - qe);
    *sine = (four)((tiny & (four_bits)x) | (~tiny & (four_bits)y));
    *cosine = z;
    return ((y != ph + (pl + pe)) & ~tiny) | (z != qh + (ql + qe)) | (size >= (int64_t)MOST << 52);
}

#define APART __attribute__((noinline))
/* Turn those of up to four angles again whose rounding is not certain: rarely, so never inlined. */
EL_AVX2 static APART void turn_again(four_bits open, int n, const double *restrict angle,
                                     double *restrict sine, double *restrict cosine)
{
    for (int k = 0; k < n; k++) {
        if (open[k]) {
            el_turns_each(1, angle + k, sine + k, cosine + k);
        }
    }
}

EL_AVX2 static inline bool any(four_bits open)
{
    return (open[0] | open[1] | open[2] | open[3]) != 0;
}

EL_AVX2 void el_turns_avx2(int n, const double *restrict angle, double *restrict sine,
                           double *restrict cosine)
{
    int i = 0;
    for (; i + 4 <= n; i += 4) {
        four x, s, c;
        memcpy(&x, angle + i, sizeof x);
        const four_bits open = quick_four(x, &s, &c);
        memcpy(sine + i, &s, sizeof s);
        memcpy(cosine + i, &c, sizeof c);
        if (any(open)) {
            turn_again(open, 4, angle + i, sine + i, cosine + i);
        }
    }
    if (n - i == 2) {
        const four x = { angle[i], angle[i + 1] };
        four s, c;
        const four_bits open = quick_four(x, &s, &c);
        sine[i] = s[0];
        sine[i + 1] = s[1];
        cosine[i] = c[0];
        cosine[i + 1] = c[1];
        if (any(open)) {
            turn_again(open, 2, angle + i, sine + i, cosine + i);
        }
    } else {
        el_turns_each(n - i, angle + i, sine + i, cosine + i);
    }
}
#else
void el_turns_avx2(int n, const double *restrict angle, double *restrict sine,
                   double *restrict cosine)
{
    el_turns_each(n, angle, sine, cosine);
}
#endif

double el_tan(double x)
{
    double y;
    if (is_quick(x)) {
        const struct rest r = rest_of(x);
        const struct dd s = sine_at(&r, r.k), c = sine_at(&r, r.k + 64);
        const struct dd t = dd_div(dd_fast(s.h, s.l), dd_fast(c.h, c.l));
        const double part = 4.0 * PART + REST / fabs(s.h) + REST / fabs(c.h);
        if (dd_settled(t.h, t.l, fabs(t.h) * part, &y)) {
            return y;
        }
    }
    if (!isfinite(x) || fabs(x) < 0x1p-27) {
        return isfinite(x) ? x : x - x;
    }
    return dd_rounded(dd_div(exact(x, 0), exact(x, 1)), 0);
}
