#include "ramp.h"

#include <math.h>
#include <stdbool.h>

#include "el_extremes.h"

/* An unlimited jerk is one that is done with the acceleration in this time. [s] */
static const double AT_ONCE = 1e-9;

static double jerk_of(const struct ramp_limits *l, bool up)
{
    return up ? (l->acc_jerk > 0.0 ? l->acc_jerk : l->acc / AT_ONCE)
              : (l->dec_jerk > 0.0 ? l->dec_jerk : l->dec / AT_ONCE);
}

double ramp_eased(const struct scurve_start *from, const struct ramp_limits *l)
{
    return from->v + from->a * fabs(from->a) / (2.0 * jerk_of(l, from->a > 0.0));
}

/* An unlimited jerk forgets the acceleration of the start. */
static struct scurve_start begin(struct scurve_start from, const struct ramp_limits *l)
{
    if (from.a > 0.0 ? l->acc_jerk <= 0.0 : l->dec_jerk <= 0.0) {
        from.a = 0.0;
    }
    return from;
}

/* Whether the ramp has to come to a = 0 before it can turn to the new speed. */
static bool turns(const struct scurve_start *from, double speed, const struct ramp_limits *l)
{
    const double eased = ramp_eased(from, l);
    return from->a > 0.0 ? speed < eased : from->a < 0.0 && speed > eased;
}

static struct scurve_limits limits(const struct scurve_start *from, double speed, double jerk,
                                   const struct ramp_limits *l)
{
    return (struct scurve_limits){ el_max(fabs(from->v), speed) + 1.0, l->acc, l->dec, jerk };
}

void ramp_plan(struct ramp *r, struct scurve_start from, double speed, const struct ramp_limits *l)
{
    from = begin(from, l);
    r->ease.total = 0.0;
    if (turns(&from, speed, l)) {
        const double eased = ramp_eased(&from, l), jerk = jerk_of(l, from.a > 0.0);
        const struct scurve_limits own = limits(&from, fabs(eased), jerk, l);
        scurve_plan_speed(&r->ease, &from, eased, &own);
        from = (struct scurve_start){ r->ease.s1, r->ease.v1, 0.0 };
    }
    const bool up = from.a > 0.0 || (from.a == 0.0 && speed > from.v);
    const struct scurve_limits own = limits(&from, speed, jerk_of(l, up), l);
    scurve_plan_speed(&r->change, &from, speed, &own);
    r->total = r->ease.total + r->change.total;
    r->s1 = r->change.s1;
}

double ramp_way(struct scurve_start from, double speed, const struct ramp_limits *l)
{
    double way = 0.0;

    from = begin(from, l);
    if (turns(&from, speed, l)) {
        const double eased = ramp_eased(&from, l), jerk = jerk_of(l, from.a > 0.0);
        const double t = fabs(from.a) / jerk;
        way = t * (from.v + t * from.a / 3.0); /* jerk -a/t: a t^2/2 - a t^2/6 */
        from = (struct scurve_start){ 0.0, eased, 0.0 };
    }
    const bool up = from.a > 0.0 || (from.a == 0.0 && speed > from.v);
    const struct scurve_limits own = limits(&from, speed, jerk_of(l, up), l);
    return way + scurve_way(&from, speed, &own);
}

struct scurve_start ramp_state(const struct ramp *r, double t)
{
    struct scurve_start x;
    double jerk;

    if (t < r->ease.total) {
        scurve_state(&r->ease, t, &x.s, &x.v, &x.a, &jerk);
    } else {
        scurve_state(&r->change, t - r->ease.total, &x.s, &x.v, &x.a, &jerk);
    }
    return x;
}

struct ramp_rule ramp_to(const struct ramp_rule *r, double speed)
{
    if (r->time <= 0.0) {
        return *r;
    }
    if (r->share <= 0.0) {
        return (struct ramp_rule){ .acc = speed / r->time };
    }
    /* Half of the share at each end: speed = acc (time - share time / 2). */
    const double acc = speed / (r->time * (1.0 - 0.5 * r->share));
    return (struct ramp_rule){ .acc = acc, .jerk = acc / (0.5 * r->share * r->time) };
}

struct ramp_limits ramp_both(const struct ramp_rule *up, const struct ramp_rule *down, double speed)
{
    const struct ramp_rule acc = ramp_to(up, speed), dec = ramp_to(down, speed);
    return (struct ramp_limits){ acc.acc, dec.acc, acc.jerk, dec.jerk };
}
