#include "pwm.h"

#include <math.h>

#include "el_extremes.h"
#include "elementary.h"

static double amplify(const struct pwm_config *c, double filtered)
{
    return el_min(el_max(c->gain * (filtered - c->offset), -c->limit), c->limit);
}

double pwm_voltage(const struct pwm *p, const struct pwm_config *c)
{
    return amplify(c, p->filtered);
}

static void note(struct pwm *p, const struct pwm_config *c)
{
    const double v = pwm_voltage(p, c);
    p->least = el_min(p->least, v);
    p->most = el_max(p->most, v);
}

void pwm_reset(struct pwm *p, const struct pwm_config *c, double filtered, int32_t duty)
{
    *p = (struct pwm){ .wanted = duty, .duty = duty, .filtered = filtered };
    p->least = p->most = pwm_voltage(p, c);
}

/* Integral of the output voltage [V clocks] over `time` while Vc goes from x to y by the
 * exponential Vc = end + (x - end) e^(-t/tau), not limited. */
static double piece(const struct pwm_config *c, double end, double x, double y, double time)
{
    return c->gain * ((end - c->offset) * time + c->tau * (x - y));
}

/* Time [clocks] until the exponential that starts at x reaches `there`, limited to 0 .. time. */
static double crossing(double tau, double end, double x, double there, double time)
{
    const double share = (end - there) / (end - x);
    if (!(share > 0.0 && share < 1.0))
        return share >= 1.0 ? 0.0 : time;
    return el_min(-tau * el_log(share), time);
}

/* Let Vc run towards `end` for `time`, and add to the integral of the voltage, which is limited. */
static void charge(struct pwm *p, const struct pwm_config *c, double end, double time)
{
    const double from = p->filtered;
    const double to = end + (from - end) * el_exp(-time / c->tau);
    p->filtered = to;
    note(p, c);
    if (from == to) {
        p->area += pwm_voltage(p, c) * time;
        return;
    }
    const double low = c->offset - c->limit / c->gain, high = c->offset + c->limit / c->gain;
    if (el_min(from, to) >= low && el_max(from, to) <= high) {
        p->area += piece(c, end, from, to, time);
        return;
    }
    /* A rising voltage is below the limits first, then between them, then above; falling
     * reversed. */
    const double first = to > from ? low : high, last = to > from ? high : low;
    const double enter = crossing(c->tau, end, from, first, time);
    const double leave = el_max(crossing(c->tau, end, from, last, time), enter);
    const double sign = to > from ? 1.0 : -1.0;
    const double x = enter > 0.0 ? first : from, y = leave < time ? last : to;
    p->area += sign * c->limit * (time - leave - enter);
    if (leave > enter)
        p->area += piece(c, end, x, y, leave - enter);
}

static void next_period(struct pwm *p, const struct pwm_config *c)
{
    p->begin += c->period;
    p->duty = p->wanted;
    p->ripple = p->most - p->least;
    p->least = p->most = pwm_voltage(p, c);
}

void pwm_run(struct pwm *p, const struct pwm_config *c, int64_t clock)
{
    while (p->clock < clock) {
        const int64_t falls = p->begin + p->duty, ends = p->begin + c->period;
        const int64_t next = p->clock < falls ? falls : ends;
        const int64_t to = next < clock ? next : clock;
        charge(p, c, p->clock < falls ? c->high : 0.0, (double)(to - p->clock));
        p->clock = to;
        if (to == ends && to < clock)
            next_period(p, c);
    }
}

void pwm_write(struct pwm *p, const struct pwm_config *c, int32_t duty)
{
    p->wanted = duty < 0 ? 0 : duty > c->period ? c->period : duty;
}

double pwm_mean(struct pwm *p, const struct pwm_config *c)
{
    const int64_t time = p->clock - p->area_begin;
    const double mean = time > 0 ? p->area / (double)time : pwm_voltage(p, c);
    p->area = 0.0;
    p->area_begin = p->clock;
    return mean;
}
