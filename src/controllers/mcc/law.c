#include "law.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"
#include "elementary.h"

/* At rest, a remainder of the pre-filter's lag below this is set to 0. [pulses], [pulses/s] */
static const double NOTHING = 1e-6;

/* Two directions are opposite if 1 + their cosine is below this. */
static const double OPPOSITE = 1e-9;

bool law_crosses(const struct law_config *c)
{
    return c->cross_p > 0.0 || c->cross_i > 0.0 || c->cross_d > 0.0;
}

/* The lag from one instant to the next, exact for a command that is straight between them:
 *
 *   d' = c' - d/tau     d(T) = q d(0) + tau (1 - q) dc/T     q = exp(-T/tau)
 *
 * so that a steady speed v has d = tau v, and rest 0. */
static void prefilter(const struct law_config *c, struct law *s, const struct law_look *look)
{
    for (int i = 0; i < AXES; i++) {
        const double lag = c->axis[i].lag;
        if (!c->axis[i].on || lag == 0.0) {
            s->behind[i] = 0.0;
            s->speed[i] = look->speed[i];
            continue;
        }
        const double q = el_exp(-c->period / lag);
        const double moved = (int32_t)((uint32_t)look->pulses[i] - (uint32_t)s->pulses[i]);
        s->behind[i] = q * s->behind[i] + lag * (1.0 - q) * moved / c->period;
        s->speed[i] = q * s->speed[i] + (1.0 - q) * look->speed[i];
        if (moved == 0.0 && fabs(s->behind[i]) < NOTHING) {
            s->behind[i] = 0.0;
        }
        if (look->speed[i] == 0.0 && fabs(s->speed[i]) < NOTHING) {
            s->speed[i] = 0.0;
        }
    }
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* A vector across the path turns with it: the smallest turn that takes tangent a to b. What was
 * left of the path stays left of it, around a corner too. */
static void turn(double v[3], const double a[3], const double b[3])
{
    const double c = 1.0 + dot(a, b), ahead = dot(v, b);

    for (int k = 0; k < 3 && c > OPPOSITE; k++) {
        v[k] -= ahead / c * (a[k] + b[k]);
    }
    const double along = dot(v, b);
    for (int k = 0; k < 3; k++) {
        v[k] -= along * b[k];
    }
}

/* W(e) n: the speed [mm/s] of X Y Z that brings the tool back to the path. */
static void cross_coupled(const struct law_config *c, struct law *s,
                          const struct commanded_path_foot *foot, double speed[3])
{
    double before[3];
    const bool both =
        dot(foot->tangent, foot->tangent) > 0.0 && dot(s->foot.tangent, s->foot.tangent) > 0.0;

    memcpy(before, both ? s->foot.error : foot->error, sizeof before);
    if (both) {
        turn(s->sum, s->foot.tangent, foot->tangent);
        turn(before, s->foot.tangent, foot->tangent);
    }
    for (int k = 0; k < 3; k++) {
        s->sum[k] += foot->error[k] * c->period;
        speed[k] = c->cross_p * foot->error[k] + c->cross_i * s->sum[k]
                   + c->cross_d * (foot->error[k] - before[k]) / c->period;
    }
    s->foot = *foot;
}

void law_tick(const struct law_config *c, struct law *s, const struct law_look *look, double limit,
              double volts[AXES])
{
    double speed[3] = { 0.0 }, sum[3], behind[AXES];
    bool limited = false;

    if (!s->begun) {
        s->begun = true;
        memcpy(s->pulses, look->pulses, sizeof s->pulses);
    }
    memcpy(behind, s->behind, sizeof behind); /* the errors are of the instant before */
    prefilter(c, s, look);
    memcpy(sum, s->sum, sizeof sum);
    if (law_crosses(c)) {
        cross_coupled(c, s, &look->foot, speed);
    }
    for (int i = 0; i < AXES; i++) {
        const struct law_axis *a = &c->axis[i];
        if (!a->on) {
            continue;
        }
        double v = a->gain * (look->error[i] - behind[i]);
        v += a->volts * a->feed_forward * s->speed[i];
        if (i < 3) {
            v += a->volts * c->pulses_per_mm[i] * speed[i];
        }
        volts[i] = el_max(-limit, el_min(limit, v));
        limited = limited || (i < 3 && volts[i] != v);
    }
    if (limited) {
        memcpy(s->sum, sum, sizeof sum); /* the integral waits until the drives can follow */
    }
    memcpy(s->pulses, look->pulses, sizeof s->pulses);
}
