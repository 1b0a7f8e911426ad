#include "ploop.h"

#include <stdlib.h>

static int64_t clamp(int64_t value, int64_t low, int64_t high)
{
    return value < low ? low : value > high ? high : value;
}

bool ploop_tick(const struct ploop_config *c, struct ploop *p, bool on, int64_t pulses,
                int64_t counts)
{
    if (!on) {
        *p = (struct ploop){ .on = false };
        return false;
    }
    if (!p->on)
        p->zero = pulses - counts;
    p->on = true;
    p->error = (int32_t)clamp(pulses - counts - p->zero, -INT32_MAX, INT32_MAX);
    bool was_over = p->over;
    p->over = abs(p->error) >= c->limit;
    return p->over && !was_over;
}

int32_t ploop_code(const struct ploop_config *c, int32_t error, int32_t gain)
{
    int64_t product = (int64_t)error * gain;
    int64_t half = ((int64_t)1 << c->scale) >> 1;
    int64_t size = (llabs(product) + half) >> c->scale;
    return (int32_t)clamp(product < 0 ? -size : size, INT16_MIN, INT16_MAX);
}
