#include "signals.h"

struct signals signals_turned(const struct signals *s, const struct machine *m)
{
    struct signals t = *s;

    for (int i = 0; i < AXES; i++) {
        if (m->axis[i].inverted) {
            t.pulses[i] = -t.pulses[i];
            t.enc[i] = -t.enc[i];
            t.err[i] = -t.err[i];
            t.latch[i] = -t.latch[i];
        }
    }
    return t;
}
