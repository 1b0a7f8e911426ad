#include "scurve_reach.h"

#include <float.h>
#include <math.h>

#include "el_extremes.h"
#include "elementary.h"

/* How the times are found.
 *
 * For a total time T the points that can be reached with speed v1 form an interval: controls and
 * limits are convex. At the least T, that of the fastest change of speed, it is one point. So a
 * target beyond that point is first met by the upper end of the interval: the motion that gets as
 * far as possible within T. It goes up first: a rises to a peak x, falls to -y, rises to 0.
 *
 *     a0 -> x, hold (x = acc), x -> 0, cruise at top, 0 -> -y, hold (y = dec), -y -> 0
 *
 * With the start moved to a = 0 on its own line of jerk 1 (backwards in time if a0 > 0),
 *
 *     base = v - a0^2/2,   way' = way + v a0 - a0^3/3,
 *
 * there remain two symmetrical pulses, base -> w and w -> v1, each with the mean of its speeds:
 *
 *     way'(w) = (base + w)/2 pulse(w - base, acc) + (w + v1)/2 pulse(w - v1, dec)
 *     pulse(d, m) = 2 sqrt(d) if d <= m^2, else d/m + m
 *
 * If a0 < 0 and v1 <= base the peak may stay below 0 ("sag"): then the first pulse counts negative,
 * w = base + x^2. Along T, d way'/dT = w + x y/2; it never falls but within a sag. For v1 >= 0 it
 * is never below 0. So the first T that meets the target lies before a local maximum within a sag
 * that is far enough, else between two corners of the cases (x = acc, y = dec, x = 0). */

/* Most roots take 4 or 5 steps. Where rounding leads them astray the bounds are halved instead. */
enum { FREE_STEPS = 12, STEPS = 100 };

/* Where z^4 + c[3] z^3 + c[2] z^2 + c[1] z + c[0] turns from negative to positive between low and
 * high, to the last digits; the bound itself if it does not. A good guess saves time; one outside
 * the bounds stands for high. */
static double root(const double c[4], double low, double guess, double high)
{
    double z = guess > low && guess < high ? guess : high;
    for (int i = 0; i < STEPS; i++) {
        const double f = (((z + c[3]) * z + c[2]) * z + c[1]) * z + c[0];
        const double d = ((4.0 * z + 3.0 * c[3]) * z + 2.0 * c[2]) * z + c[1];
        const double h = (12.0 * z + 6.0 * c[3]) * z + 2.0 * c[2];
        /* Laguerre's step, n = 4: n f/(f' +- sqrt((n - 1)^2 f'^2 - n (n - 1) f f'')). It triples
         * the correct digits, and from far away it still goes at once to where the root may be. */
        const double r = sqrt(el_max(0.0, 9.0 * d * d - 12.0 * f * h));
        double next = z - 4.0 * f / (d + (d < 0.0 ? -r : r));
        if (f > 0.0) {
            high = z;
        } else {
            low = z;
        }
        if (i >= FREE_STEPS || !(next >= low && next <= high)) {
            next = low + (high - low) / 2.0;
        }
        if (fabs(next - z) <= 4.0 * DBL_EPSILON * fabs(z)) {
            return next;
        }
        z = next;
    }
    return z;
}

struct pulses {
    double base, v1, acc, dec; /* [s^2], [s^2], [s], [s] as above */
    double way;                /* [s^3] way' as above */
};

struct shape {
    double x, hold_acc, cruise, y, hold_dec; /* [s] */
};

struct range {
    double low, high;
};

static struct shape shape_of(const struct pulses *p, double w)
{
    struct shape s = { 0 };
    s.x = scurve_leg_peak(w - p->base, p->acc, &s.hold_acc);
    s.y = scurve_leg_peak(w - p->v1, p->dec, &s.hold_dec);
    return s;
}

/* way'(w); `sag`: the first pulse counts negative. */
static double way_of(const struct pulses *p, double w, int sag)
{
    const struct shape s = shape_of(p, w);
    const double first = sag ? -sqrt(el_max(0.0, w - p->base)) : s.x + s.hold_acc / 2.0;
    return (p->base + w) * first + (w + p->v1) * (s.y + s.hold_dec / 2.0);
}

/* Neither held. With u = x + y and d = v1 - base = x^2 - y^2 = u (x - y):
 *     u^4 + 4 (base + v1) u^2 - 4 way u - d^2 = 0 */
static struct shape triangles(const struct pulses *p, struct range range)
{
    const double d = p->v1 - p->base;
    const double c[4] = { -d * d, -4.0 * p->way, 4.0 * (p->base + p->v1), 0.0 };
    const double rest = el_cbrt(4.0 * p->way); /* the root if base = v1 = 0 */
    const double u = root(c, range.low, rest, range.high);
    const double skew = u > 0.0 ? d / u : 0.0;
    return (struct shape){ .x = (u + skew) / 2.0, .y = (u - skew) / 2.0 };
}

/* One pulse, between w and `flat`, holds its peak m; the other, between w and `free`, peaks at z:
 *     z^4 + 2 m z^3 + (2 free + m^2) z^2 + 4 m free z
 *         + (flat + free) (free - flat + m^2) - 2 m way = 0 */
static double held(double flat, double free, double m, double way, struct range z)
{
    const double c[4] = { (flat + free) * (free - flat + m * m) - 2.0 * m * way, 4.0 * m * free,
                          2.0 * free + m * m, 2.0 * m };
    /* The root if flat = free = 0: z^2 + m z = sqrt(2 m way). */
    const double q = sqrt(el_max(0.0, -c[0])), rest = q / (m / 2.0 + sqrt(m * m / 4.0 + q));
    return root(c, z.low, rest, z.high);
}

static struct shape acc_held(const struct pulses *p, struct range range)
{
    const double y = held(p->base, p->v1, p->acc, p->way, range);
    const double gain = p->v1 - p->base + y * y;
    return (struct shape){ .x = p->acc, .hold_acc = gain / p->acc - p->acc, .y = y };
}

static struct shape dec_held(const struct pulses *p, struct range range)
{
    const double x = held(p->v1, p->base, p->dec, p->way, range);
    const double loss = p->base - p->v1 + x * x;
    return (struct shape){ .x = x, .y = p->dec, .hold_dec = loss / p->dec - p->dec };
}

/* Both held: w^2 + acc dec w = q. The larger root; below it the way falls with T. */
static struct shape both_held(const struct pulses *p)
{
    const double a = p->acc, d = p->dec;
    const double q = (2.0 * p->way + p->base * (p->base / a - a) + p->v1 * (p->v1 / d - d))
                     / (1.0 / a + 1.0 / d);
    const double half = a * d / 2.0;
    const double w = q / (half + sqrt(el_max(0.0, half * half + q)));
    return (struct shape){
        .x = a, .hold_acc = (w - p->base) / a - a, .y = d, .hold_dec = (w - p->v1) / d - d
    };
}

/* The peak x >= 0: w rises with T from `low` to top, the cases change at two corners. */
static struct shape rising(const struct pulses *p, double low, double top)
{
    const double corner_acc = p->base + p->acc * p->acc, corner_dec = p->v1 + p->dec * p->dec;
    const double corner[2] = { el_min(corner_acc, corner_dec), el_max(corner_acc, corner_dec) };
    const double to_top = way_of(p, top, 0);
    double high = top;

    if (to_top <= p->way) {
        struct shape s = shape_of(p, top);
        s.cruise = (p->way - to_top) / top;
        return s;
    }
    for (int i = 0; i < 2 && corner[i] < top; i++) {
        if (corner[i] > low) {
            if (way_of(p, corner[i], 0) >= p->way) {
                high = corner[i];
                break;
            }
            low = corner[i];
        }
    }
    const struct shape from = shape_of(p, low), to = shape_of(p, high);
    if (corner_acc <= low) {
        return corner_dec <= low ? both_held(p) : acc_held(p, (struct range){ from.y, to.y });
    }
    return corner_dec <= low ? dec_held(p, (struct range){ from.x, to.x })
                             : triangles(p, (struct range){ from.x + from.y, to.x + to.y });
}

/* The peak stays below 0, dec held, x in the range. False if the target is not met. */
static int sag_held(const struct pulses *p, struct range x, struct shape *s)
{
    /* d way/dT = x^2 + dec x/2 + base: its smaller zero is a local maximum. */
    const double root = p->dec * p->dec - 16.0 * p->base;
    const double top = -(p->dec + sqrt(el_max(0.0, root))) / 4.0;
    if (root > 0.0 && top > x.low && top < x.high && way_of(p, p->base + top * top, 1) >= p->way) {
        x.high = top;
    } else if (way_of(p, p->base + x.high * x.high, 1) < p->way) {
        return 0;
    }
    *s = dec_held(p, x);
    return 1;
}

/* The peak stays below 0, dec not reached, u = x + y in the range. */
static int sag_free(const struct pulses *p, struct range u, struct shape *s)
{
    /* 2 d way/dT = 3 u^2/4 + sum + d^2/(4 u^2): its smaller zero is a local maximum. */
    const double sum = p->base + p->v1, d = p->v1 - p->base;
    const double root = 4.0 * sum * sum - 3.0 * d * d;
    const double top = sqrt(d * d / (sqrt(el_max(0.0, root)) - 2.0 * sum));
    const double x = (top + d / top) / 2.0;
    if (sum < 0.0 && root > 0.0 && top > u.low && top < u.high
        && way_of(p, p->base + x * x, 1) >= p->way) {
        u.high = top;
    } else if (way_of(p, p->base, 1) < p->way) {
        return 0;
    }
    *s = triangles(p, u);
    return 1;
}

/* The peak stays below 0: x from a < 0 to 0, w falls with T to base. */
static int sagging(const struct pulses *p, double a, struct shape *s)
{
    const double loss = p->base - p->v1, held_to = p->dec * p->dec - loss; /* x^2 where y = dec */
    double low = a;
    if (a * a > held_to) {
        const double high = held_to > 0.0 ? -sqrt(held_to) : 0.0;
        if (sag_held(p, (struct range){ a, high }, s)) {
            return 1;
        }
        low = high;
    }
    const struct range u = { low + sqrt(loss + low * low), sqrt(loss) };
    return held_to > 0.0 && sag_free(p, u, s);
}

void scurve_reach(const struct scurve_leg *l, double t[SCURVE_LEG_PHASES])
{
    const double a = l->a, base = l->v - a * a / 2.0;
    const struct pulses p = { base, l->v1, l->acc, l->dec, l->way + a * (l->v - a * a / 3.0) };
    struct shape s;

    if (!(a < 0.0 && l->v1 <= base && sagging(&p, a, &s))) {
        s = rising(&p, el_min(l->top, el_max(l->v1, a > 0.0 ? base + a * a : base)), l->top);
    }
    t[0] = el_max(0.0, s.x - a);
    t[1] = el_max(0.0, s.hold_acc);
    t[2] = el_max(0.0, s.cruise > 0.0 ? s.x : s.x + s.y);
    t[3] = s.cruise;
    t[4] = s.cruise > 0.0 ? s.y : 0.0;
    t[5] = el_max(0.0, s.hold_dec);
    t[6] = el_max(0.0, s.y);
}
