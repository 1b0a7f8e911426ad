#include "guard.h"

#include <math.h>
#include <stdlib.h>

/* Software limits in pulses. */
struct range { double low, high; };

static struct range range_of(const struct machine_axis *a)
{
    const double unit = machine_pulses_per_mm(a);
    return (struct range){ round(machine_low(a) * unit), round(machine_high(a) * unit) };
}

static bool checked(const struct machine_axis *a)
{
    return a->used && a->check_ot;
}

/* Whether motion from a place to these bounds leads too far: 1 up, -1 down, 0 no. [pulses] */
static int beyond(const struct machine_axis *a, double from, double low, double high)
{
    const struct range r = range_of(a);
    return high > fmax(r.high, from) ? 1 : low < fmin(r.low, from) ? -1 : 0;
}

enum fault guard_path(const struct machine *m, const struct path *p, struct fault_report *r)
{
    for (int i = 0; i < AXES; i++) {
        const struct machine_axis *a = &m->axis[i];
        const double unit = machine_pulses_per_mm(a);
        double low, high;
        if (!checked(a)) {
            continue;
        }
        path_extent(p, i, 0.0, p->length, &low, &high);
        const int side = beyond(a, round(p->start[i] * unit), round(low * unit),
                                round(high * unit));
        if (side != 0) {
            r->axis = i;
            r->value = side > 0 ? high : low;
            r->limit = side > 0 ? machine_high(a) : machine_low(a);
            return FAULT_TRAVEL;
        }
    }
    return FAULT_NONE;
}

bool guard_limited(const struct machine *m)
{
    bool any = false;
    for (int i = 0; i < AXES; i++) {
        any = any || checked(&m->axis[i]);
    }
    return any;
}

int guard_travel(const struct machine *m, const int32_t from[AXES], const int32_t to[AXES])
{
    for (int i = 0; i < AXES; i++) {
        if (checked(&m->axis[i]) && beyond(&m->axis[i], from[i], to[i], to[i]) != 0) {
            return i;
        }
    }
    return -1;
}

int guard_reach(const struct machine *m, const int32_t from[AXES], const double low[AXES],
                const double high[AXES])
{
    for (int i = 0; i < AXES; i++) {
        const struct machine_axis *a = &m->axis[i];
        const double unit = machine_pulses_per_mm(a);
        if (checked(a) && beyond(a, from[i], round(low[i] * unit), round(high[i] * unit)) != 0) {
            return i;
        }
    }
    return -1;
}

int guard_switch(const struct machine *m, const struct signals *s, const double way[AXES])
{
    const bool both = m->limit_mode == MACHINE_LIMIT_BOTH ||
                      m->limit_mode == MACHINE_LIMIT_BOTH_ERROR;

    for (int i = 0; m->limit_check && i < AXES; i++) {
        const bool upper = s->upper >> i & 1, lower = s->lower >> i & 1;
        if (m->axis[i].used && ((way[i] > 0.0 && (upper || (both && lower))) ||
                                (way[i] < 0.0 && (lower || (both && upper))))) {
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
