#include "limited.h"

#include <math.h>

#include "el_extremes.h"

/* Share of a limit from which on it counts as reached. */
static const double REACHED = 1.0 - 1e-6;

struct limited limited_speed(const struct mechanism *m, const double slope[AXES], double speed)
{
    struct limited told = { .by = LIMITED_FEED };
    double most = REACHED;

    for (int i = 0; i < AXES && !m->kinematics; i++) {
        const double share = m->joint[i].used && m->joint[i].speed > 0.0
                                 ? fabs(slope[i]) * speed / m->joint[i].speed
                                 : 0.0;
        if (share >= most) {
            most = share;
            told = (struct limited){ .by = LIMITED_SPEED, .axis = i + 1 };
        }
    }
    return told;
}

/* Whether the acceleration of an S-shaped profile changes at this time. */
static bool bends(const struct profile *p)
{
    const double step = 1e-6 * p->total;
    struct profile before = *p, after = *p;

    before.t = p->t - step;
    after.t = p->t + step;
    const double a = profile_state(&before).a, b = profile_state(&after).a;
    return fabs(b - a) > 1e-9 * el_max(fabs(a), fabs(b));
}

struct limited limited_profile(const struct profile *p, struct limited held)
{
    const double rise = p->smooth ? p->rise.total : p->time[0];
    const struct limited ramp = { .by =
                                      p->smooth && bends(p) ? LIMITED_JERK : LIMITED_ACCELERATION };
    const bool slows = p->smooth ? profile_state(p).a < 0.0 : p->acc[0] < 0.0;

    if (p->ends && p->t >= p->tail) {
        return (struct limited){ .by = LIMITED_STOP };
    }
    return p->t >= rise || slows ? held : ramp;
}
