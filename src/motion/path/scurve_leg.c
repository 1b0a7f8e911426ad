#include "scurve_leg.h"

#include <float.h>
#include <math.h>

#include "el_extremes.h"

const double SCURVE_LEG_JERK[SCURVE_LEG_PHASES] = { 1.0, 0.0, -1.0, 0.0, -1.0, 0.0, 1.0 };

/* A state on the edge of the speed limit is inside: rounding of a sum of a few terms. */
static const double ROUNDING = 8.0 * DBL_EPSILON;

struct scurve_leg scurve_leg_seen(const struct scurve_leg *l, double sign)
{
    if (sign > 0.0) {
        return *l;
    }
    return (struct scurve_leg){ -l->v, -l->a, -l->way, -l->v1, l->dec, l->acc, l->top };
}

/* Let t pass with jerk j. */
static void advance(struct scurve_leg *l, double j, double t)
{
    l->way -= t * (l->v + t * (l->a / 2.0 + t * j / 6.0));
    l->v += t * (l->a + t * j / 2.0);
    l->a += t * j;
}

/* Down with the speed, by jerk -1 and then a = -dec, until v is top again:
 *     v + a t - t^2/2 = top          t = a + sqrt(a^2 + 2 (v - top))
 * or earlier, if from then on jerk 1 leads to -top:
 *     (v + a t - t^2/2) - (a - t)^2/2 = -top     t = a + sqrt(a^2/2 + v + top) */
static void slow_down(const struct scurve_leg *l, double t[SCURVE_LEG_BRAKES])
{
    const double back = l->a + sqrt(l->a * l->a + 2.0 * (l->v - l->top));
    const double low = l->a + sqrt(l->a * l->a / 2.0 + l->v + l->top);
    const double level = l->a + l->dec;
    if (level < el_min(back, low)) {
        const double v = l->v + level * (l->a - level / 2.0);
        t[0] = level;
        t[1] = el_max(0.0, el_min(v - l->top, v + l->top - l->dec * l->dec / 2.0) / l->dec);
    } else {
        t[0] = el_max(0.0, el_min(back, low));
        t[1] = 0.0;
    }
}

/* Above the limit or bound to exceed it. Not if already bound to fall below the other limit. */
static int too_fast(const struct scurve_leg *l)
{
    const double gain = l->a * l->a / 2.0;
    const double most = l->top + ROUNDING * (l->top + fabs(l->v) + gain);
    return l->a > 0.0 ? l->v + gain > most : l->v > most && l->v - gain > -l->top;
}

void scurve_leg_brake(struct scurve_leg *l, int speed, double jerk[SCURVE_LEG_BRAKES],
                      double t[SCURVE_LEG_BRAKES])
{
    jerk[0] = jerk[1] = t[0] = t[1] = 0.0;
    if (l->a > l->acc || l->a < -l->dec) {
        const double edge = l->a > 0.0 ? l->acc : -l->dec;
        jerk[0] = edge < l->a ? -1.0 : 1.0;
        t[0] = fabs(l->a - edge);
        advance(l, jerk[0], t[0]);
        l->a = edge;
    }
    for (double sign = 1.0; speed && sign >= -1.0; sign -= 2.0) {
        struct scurve_leg seen = scurve_leg_seen(l, sign);
        if (too_fast(&seen)) {
            double more[SCURVE_LEG_BRAKES];
            slow_down(&seen, more);
            advance(l, -sign, more[0]);
            advance(l, 0.0, more[1]);
            jerk[0] = more[0] > 0.0 ? -sign : jerk[0]; /* 0 if a came down from the other edge */
            t[0] += more[0];
            t[1] = more[1];
            break;
        }
    }
}

/* By how much v1 is above the speed once a has gone to 0, and what of it may be rounding. [s^2] */
static double lacking(const struct scurve_leg *l, double *rounding)
{
    const double gain = l->a * fabs(l->a) / 2.0;
    *rounding = ROUNDING * (fabs(l->v1) + fabs(l->v) + fabs(gain));
    return l->v1 - l->v - gain;
}

double scurve_leg_sign(const struct scurve_leg *l)
{
    double rounding;
    const double more = lacking(l, &rounding);
    return (fabs(more) > rounding ? more : l->a) >= 0.0 ? 1.0 : -1.0;
}

double scurve_leg_peak(double d, double most, double *hold)
{
    if (d <= most * most) {
        *hold = 0.0;
        return sqrt(el_max(0.0, d));
    }
    *hold = d / most - most;
    return most;
}

double scurve_leg_speed(const struct scurve_leg *l, double t[SCURVE_LEG_PHASES], double *rounding)
{
    const double a = l->a, base = l->v - a * a / 2.0, sum = fabs(base) + fabs(l->v1);
    const double start = a * (a * a / 3.0 - l->v);
    double noise, x = scurve_leg_peak(l->v1 - base, l->acc, &t[1]);
    if (lacking(l, &noise) <= noise) {
        x = a; /* on the last phase: v1 - base would leave sqrt(noise) instead */
        t[1] = noise = 0.0;
    }
    const double half = x + t[1] / 2.0;
    t[0] = el_max(0.0, x - a);
    t[2] = x;
    t[3] = t[4] = t[5] = t[6] = 0.0;
    *rounding = ROUNDING * (fabs(l->v * a) + fabs(start) + sum * half)
                + (noise > 0.0 ? sum * noise / x : 0.0);
    return start + (base + l->v1) * half;
}
