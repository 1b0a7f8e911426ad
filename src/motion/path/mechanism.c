#include "mechanism.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

/* A rate between the places looked at may be so much of itself above those found. */
static const double MARGIN = 1e-3;

/* A cubic turns by no more than this. [rad] */
static const double TAU = 6.283185307179586;

bool mechanism_joints(const struct mechanism *m, const double place[AXES], double joint[AXES])
{
    if (m->kinematics) {
        return m->kinematics->joints(m->geometry, place, joint);
    }
    memcpy(joint, place, AXES * sizeof *joint);
    return true;
}

bool mechanism_first(const struct mechanism *m, const double place[AXES], double joint[AXES])
{
    if (m->kinematics) {
        memcpy(joint, m->near, AXES * sizeof *joint);
    }
    return mechanism_joints(m, place, joint);
}

void mechanism_near(const struct mechanism *m, const int32_t pulses[AXES], double joint[AXES])
{
    for (int i = 0; i < AXES && m->kinematics; i++) {
        joint[i] = m->joint[i].used ? pulses[i] / m->joint[i].scale : 0.0;
    }
}

void mechanism_place(const struct mechanism *m, const double joint[AXES], double place[AXES])
{
    if (m->kinematics) {
        m->kinematics->place(m->geometry, joint, place);
    } else {
        memcpy(place, joint, AXES * sizeof *place);
    }
}

void mechanism_pulses(const struct mechanism *m, const double joint[AXES], int32_t pulses[AXES])
{
    for (int i = 0; i < AXES; i++) {
        if (m->joint[i].used) {
            pulses[i] = (int32_t)lround(joint[i] * m->joint[i].scale);
        }
    }
}

static void cartesian_way(const struct mechanism *m, const struct path *p, struct mechanism_way *w)
{
    w->reached = true;
    for (int i = 0; i < AXES; i++) {
        w->share[i] = path_share(p, i);
        w->low[i] = -INFINITY;
        w->high[i] = INFINITY;
        if (m->joint[i].used && isfinite(p->length)) {
            path_extent(p, i, 0.0, p->length, &w->low[i], &w->high[i]);
        }
    }
}

/* Joints and rates at three places in a row. */
struct trio {
    double joint[3][AXES], rate[3][AXES];
};

static void include(double low[AXES], double high[AXES], int i, double x)
{
    low[i] = el_min(low[i], x);
    high[i] = el_max(high[i], x);
}

/* Top or bottom of the parabola through a, b, c, if it lies among them; else b. */
static double vertex(double a, double b, double c)
{
    const double bend = a - 2.0 * b + c, slope = 0.5 * (c - a);
    return fabs(slope) < fabs(bend) ? b - 0.5 * slope * slope / bend : b;
}

static void kinematic_way(const struct mechanism *m, const struct path *p, struct mechanism_way *w)
{
    const double turn = p->arc ? el_max(1.0, fabs(p->sweep)) : p->cubic ? TAU : 1.0;
    const int64_t places = (int64_t)ceil(MECHANISM_PLACES * turn);
    double low[AXES], high[AXES], place[AXES], slope[AXES]; /* low, high: of rates */
    struct trio t = { 0 };

    w->reached = isfinite(p->length);
    for (int64_t k = 0; k <= places && w->reached; k++) {
        memmove(t.joint[0], t.joint[1], 2 * sizeof t.joint[0]);
        memmove(t.rate[0], t.rate[1], 2 * sizeof t.rate[0]);
        memcpy(t.joint[2], k == 0 ? m->near : t.joint[1], sizeof t.joint[2]);
        path_at(p, (double)k / (double)places * p->length, place, slope);
        w->reached = m->kinematics->joints(m->geometry, place, t.joint[2])
                     && m->kinematics->rates(m->geometry, t.joint[2], slope, t.rate[2]);
        for (int i = 0; i < AXES && w->reached; i++) {
            if (k == 0) {
                w->low[i] = w->high[i] = t.joint[2][i];
                low[i] = high[i] = t.rate[2][i];
            }
            include(w->low, w->high, i, t.joint[2][i]);
            include(low, high, i, t.rate[2][i]);
            if (k >= 2) {
                include(w->low, w->high, i, vertex(t.joint[0][i], t.joint[1][i], t.joint[2][i]));
                include(low, high, i, vertex(t.rate[0][i], t.rate[1][i], t.rate[2][i]));
            }
        }
    }
    for (int i = 0; i < AXES && w->reached; i++) {
        w->share[i] = (1.0 + MARGIN) * el_max(fabs(low[i]), fabs(high[i]));
    }
}

void mechanism_way(const struct mechanism *m, const struct path *p, struct mechanism_way *w)
{
    if (m->kinematics) {
        kinematic_way(m, p, w);
    } else {
        cartesian_way(m, p, w);
    }
}

static bool bounded(const struct joint *j)
{
    return j->used && j->bounded;
}

/* Whether motion from a place to these extremes leads too far: 1 up, -1 down, 0 no. [pulses] */
static int beyond(const struct joint *j, double from, double low, double high)
{
    return high > el_max(round(j->high * j->scale), from) ? 1
           : low < el_min(round(j->low * j->scale), from) ? -1
                                                          : 0;
}

int mechanism_beyond(const struct mechanism *m, const double from[AXES], const double low[AXES],
                     const double high[AXES], int *side)
{
    for (int i = 0; i < AXES; i++) {
        const struct joint *j = &m->joint[i];
        if (!bounded(j)) {
            continue;
        }
        *side = beyond(j, from[i], round(low[i] * j->scale), round(high[i] * j->scale));
        if (*side != 0) {
            return i;
        }
    }
    return -1;
}

int mechanism_outside(const struct mechanism *m, const int32_t from[AXES], const int32_t to[AXES])
{
    for (int i = 0; i < AXES; i++) {
        const struct joint *j = &m->joint[i];
        if (bounded(j) && beyond(j, from[i], to[i], to[i]) != 0) {
            return i;
        }
    }
    return -1;
}

bool mechanism_bounded(const struct mechanism *m)
{
    bool any = false;
    for (int i = 0; i < AXES; i++) {
        any = any || bounded(&m->joint[i]);
    }
    return any;
}
