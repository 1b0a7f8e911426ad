#include "home_motion.h"

#include <math.h>
#include <stdlib.h>

#include "el_extremes.h"

/* Error of sums of speeds by rounding, by which the last step may miss the target. [pulses] */
static const double ROUNDING = 1e-6;

static int32_t put_out(struct home_motion *m, int64_t pulses)
{
    m->commanded += pulses;
    m->still = pulses == 0 && m->speed == 0.0 ? m->still + (m->still < INT32_MAX) : 0;
    return (int32_t)pulses;
}

/* Speed nearest to the wanted one that may follow the present speed. [pulses/period] */
static double next_speed(const struct home_motion *m, const struct home_limits *l, double want)
{
    const double free = el_max(l->acc, l->start);
    double low = m->speed - l->acc, high = m->speed + l->acc;

    if (m->speed == 0.0) {
        low = -free, high = free;
    } else if (fabs(m->speed) <= free) {
        low = el_min(low, 0.0), high = el_max(high, 0.0);
    }
    return el_min(el_max(want, low), high);
}

int32_t home_motion_run(struct home_motion *m, const struct home_limits *l, double speed)
{
    m->speed = next_speed(m, l, speed);
    const double pulses = floor(m->rest + m->speed);
    m->rest += m->speed - pulses;
    return put_out(m, (int64_t)pulses);
}

/* Braking from speed v covers the distance left: v + (v - a) + .. + (v - k a). The last step is no
 * larger than a step from which the axis may stop. */
int32_t home_motion_to(struct home_motion *m, const struct home_limits *l, int64_t target,
                       double speed)
{
    const double left = (double)(target - m->commanded) - m->rest, size = fabs(left),
                 k = floor(0.5 * (sqrt(1.0 + 8.0 * size / l->acc) - 1.0)),
                 brake = 0.5 * k * l->acc + size / (k + 1.0),
                 most = size <= el_max(l->acc, l->start) ? size : el_min(speed, brake),
                 next = next_speed(m, l, copysign(most, left));

    if (fabs(next - left) < ROUNDING) {
        m->speed = next;
        m->rest = 0.0;
        return put_out(m, target - m->commanded);
    }
    return home_motion_run(m, l, next);
}

bool home_motion_at(const struct home_motion *m, int64_t target)
{
    return m->commanded == target && m->rest == 0.0;
}
