#include "profile.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

void profile_wait(struct profile *p, double seconds)
{
    p->s0 = p->v0 = p->length = p->t = 0.0;
    memset(p->time, 0, sizeof p->time);
    memset(p->acc, 0, sizeof p->acc);
    p->time[1] = seconds;
    p->tail = p->total = seconds;
    p->ends = true;
    p->smooth = false;
}

/* Rest at the end of the path by one deceleration that starts now. */
static void stop_at_end(struct profile *p, double way)
{
    p->ends = true;
    if (p->v0 > 0.0 && way > 0.0) {
        p->time[2] = 2.0 * way / p->v0;
        p->acc[2] = -p->v0 / p->time[2];
    }
}

static void plan_trapezoid(struct profile *p, const struct profile_limits *l)
{
    const double v = p->v0, acc = l->ramp.acc, dec = l->ramp.dec;
    const double way = el_max(0.0, p->length - p->s0);
    const double brake = v * v / (2.0 * dec); /* way to rest from now */

    memset(p->time, 0, sizeof p->time);
    memset(p->acc, 0, sizeof p->acc);
    if (brake >= way) {
        stop_at_end(p, way);
    } else if (l->speed <= 0.0) {
        p->time[0] = v / dec;
        p->acc[0] = -dec;
    } else if (v > l->speed) {
        p->ends = true;
        p->time[0] = (v - l->speed) / dec;
        p->acc[0] = -dec;
        p->time[1] = (way - brake) / l->speed;
        p->time[2] = l->speed / dec;
        p->acc[2] = -dec;
    } else {
        /* Peak speed of the triangle: (vp^2 - v^2)/(2 acc) + vp^2/(2 dec) = way. */
        const double peak = sqrt(dec * (2.0 * acc * way + v * v) / (acc + dec));
        const double top = el_max(v, el_min(l->speed, peak));
        const double ramps = (top * top - v * v) / (2.0 * acc) + top * top / (2.0 * dec);
        p->ends = true;
        p->time[0] = (top - v) / acc;
        p->acc[0] = acc;
        p->time[1] = top < peak ? el_max(0.0, (way - ramps) / top) : 0.0;
        p->time[2] = top / dec;
        p->acc[2] = -dec;
    }
    p->tail = p->time[0] + p->time[1];
    p->total = p->tail + p->time[2];
}

/* Way of the ramp to a speed and of the one from it to rest. */
static double ways(const struct scurve_start *from, double speed, const struct ramp_limits *l)
{
    const struct scurve_start top = { 0.0, speed, 0.0 };
    return ramp_way(*from, speed, l) + ramp_way(top, 0.0, l);
}

/* Highest speed, low .. high, whose two ramps fit into the way; low fits and high does not. False
 * position, and every third step halves the bounds. */
static double peak_speed(const struct scurve_start *from, double low, double high, double way,
                         const struct ramp_limits *l)
{
    enum { STEPS = 150 };
    double f = ways(from, low, l) - way, g = ways(from, high, l) - way;

    for (int i = 0; i < STEPS && high - low > 1e-15 * high; i++) {
        const double guess = i % 3 < 2 && g > f ? high - g * (high - low) / (g - f) : low;
        const double mid = guess > low && guess < high ? guess : 0.5 * (low + high);
        const double h = ways(from, mid, l) - way;
        if (h <= 0.0) {
            low = mid;
            f = h;
        } else {
            high = mid;
            g = h;
        }
    }
    return low;
}

/* A way to rest that is shorter than the way left by so much of the whole path just fits: to crawl
 * on to the end would take long. */
static const double ROUNDING = 1e-12;

static void plan_smooth(struct profile *p, const struct scurve_start *from,
                        const struct profile_limits *l)
{
    const struct ramp_limits *r = &l->ramp;
    const double way = el_max(0.0, p->length - p->s0);
    const double eased = el_max(0.0, from->a >= 0.0 ? ramp_eased(from, r) : 0.0);
    double top = l->speed;

    p->time[1] = 0.0;
    if (ramp_way(*from, 0.0, r) >= way - ROUNDING * p->length) {
        /* Slow down at once; what rounding leaves over lies before the ramp. */
        p->ends = true;
        p->rise.total = 0.0;
        ramp_plan(&p->fall, *from, 0.0, r);
    } else if (top <= 0.0) {
        ramp_plan(&p->rise, *from, 0.0, r);
        p->fall.total = 0.0;
    } else {
        p->ends = true;
        if (ways(from, top, r) > way) {
            top = peak_speed(from, eased < top ? eased : 0.0, top, way, r);
        }
        const struct scurve_start cruise = { 0.0, top, 0.0 };
        p->time[1] = top > 0.0 ? el_max(0.0, (way - ways(from, top, r)) / top) : 0.0;
        ramp_plan(&p->rise, *from, top, r);
        ramp_plan(&p->fall, cruise, 0.0, r);
    }
    p->tail = p->rise.total + p->time[1];
    p->total = p->tail + p->fall.total;
}

void profile_plan(struct profile *p, const struct scurve_start *from, double length,
                  const struct profile_limits *l)
{
    p->s0 = from->s;
    p->v0 = from->v;
    p->length = length;
    p->t = 0.0;
    p->ends = false;
    p->smooth = l->ramp.acc_jerk > 0.0 || l->ramp.dec_jerk > 0.0;
    if (p->smooth) {
        plan_smooth(p, from, l);
    } else {
        plan_trapezoid(p, l);
    }
}

static struct scurve_start smooth_state(const struct profile *p)
{
    struct scurve_start x;

    if (p->ends && p->t >= p->tail) {
        /* Seen from the end, so that it is met exactly. */
        x = ramp_state(&p->fall, el_min(p->t, p->total) - p->tail);
        x.s = p->t >= p->total ? p->length : p->length - (p->fall.s1 - x.s);
    } else {
        x = ramp_state(&p->rise, el_max(0.0, el_min(p->t, p->rise.total)));
        x.s += x.v * el_max(0.0, el_min(p->t, p->tail) - p->rise.total);
    }
    return x;
}

static struct scurve_start trapezoid_state(const struct profile *p)
{
    struct scurve_start x = { p->s0, p->v0, 0.0 };
    double left = el_max(0.0, p->t);

    if (p->ends && p->t >= p->tail) {
        /* Seen from the end: s = length - |a| left^2 / 2. */
        left = el_max(0.0, p->total - p->t);
        x.v = -p->acc[2] * left;
        x.s = p->length - 0.5 * x.v * left;
        return x;
    }
    for (int i = 0; i < PROFILE_PHASES; i++) {
        const double dt = el_min(left, p->time[i]);
        x.s += (x.v + 0.5 * p->acc[i] * dt) * dt;
        x.v += p->acc[i] * dt;
        left -= dt;
    }
    return x;
}

struct scurve_start profile_state(const struct profile *p)
{
    struct scurve_start x = p->smooth ? smooth_state(p) : trapezoid_state(p);

    if (p->t >= p->total) {
        x.v = x.a = 0.0;
    }
    x.v = el_max(0.0, x.v);
    x.s = el_min(x.s, p->length);
    return x;
}

double profile_left(const struct profile *p)
{
    return p->total - p->t;
}
