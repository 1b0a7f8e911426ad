#include "guard.h"

#include <math.h>
#include <stdlib.h>

int guard_switch(const struct machine *m, const struct signals *s, const double way[AXES])
{
    const bool both =
        m->limit_mode == MACHINE_LIMIT_BOTH || m->limit_mode == MACHINE_LIMIT_BOTH_ERROR;

    for (int i = 0; m->limit_check && i < AXES; i++) {
        const bool upper = s->upper >> i & 1, lower = s->lower >> i & 1;
        if (m->axis[i].used
            && ((way[i] > 0.0 && (upper || (both && lower)))
                || (way[i] < 0.0 && (lower || (both && upper))))) {
            return i;
        }
    }
    return -1;
}

bool guard_switch_error(const struct machine *m)
{
    return m->limit_mode >= MACHINE_LIMIT_BOTH_ERROR;
}

int guard_change(const struct machine *m, const int32_t before[AXES], const int32_t frame[AXES])
{
    for (int i = 0; i < AXES; i++) {
        if (llabs((int64_t)frame[i] - before[i]) > m->axis[i].max_dda_acc) {
            return i;
        }
    }
    return -1;
}

int guard_track(const struct machine *m, const struct signals *s)
{
    for (int i = 0; i < AXES; i++) {
        const struct machine_axis *a = &m->axis[i];
        if (a->used && a->track_limit > 0 && llabs((int64_t)s->err[i]) > a->track_limit) {
            return i;
        }
    }
    return -1;
}

uint32_t guard_watched(const struct machine *m)
{
    uint32_t axes = 0;
    for (int i = 0; i < AXES; i++) {
        axes |= (uint32_t)(m->axis[i].used && m->axis[i].in_pos) << i;
    }
    return axes;
}

uint32_t guard_within(const struct machine *m, const struct signals *s)
{
    uint32_t axes = 0;
    for (int i = 0; i < AXES; i++) {
        const double error = fabs((double)s->err[i]) / machine_pulses_per_mm(&m->axis[i]);
        axes |= (uint32_t)(m->axis[i].used && error <= m->axis[i].inpos_tol) << i;
    }
    return axes;
}
