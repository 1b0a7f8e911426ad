#include "signals.h"

/* The counters wrap, so the lowest value has itself as its opposite. */
static int32_t opposite(int32_t count)
{
    return (int32_t)(0u - (uint32_t)count);
}

struct signals signals_turned(const struct signals *s, const struct machine *m)
{
    struct signals t = *s;

    for (int i = 0; i < AXES; i++) {
        if (m->axis[i].inverted) {
            t.pulses[i] = opposite(t.pulses[i]);
            t.enc[i] = opposite(t.enc[i]);
            t.err[i] = opposite(t.err[i]);
            t.latch[i] = opposite(t.latch[i]);
        }
    }
    return t;
}
