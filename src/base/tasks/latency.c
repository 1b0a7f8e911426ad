#include "latency.h"

#include <math.h>

#include "elementary.h"

double latency_uniform(uint64_t *random)
{
    uint64_t x = *random += 0x9e3779b97f4a7c15u;

    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return ldexp((double)((x ^ (x >> 31)) >> 11), -53);
}

int64_t latency_draw(const struct latency *l, uint64_t *random)
{
    const double which = latency_uniform(random), u = latency_uniform(random);
    const double wait = which < l->rare ? u * (l->most - l->least)
                        : l->mean > 0.0 ? -l->mean * el_log(1.0 - u)
                                        : 0.0;

    return (int64_t)llround(l->least + wait);
}
