#include "machine.h"

#include <math.h>
#include <stddef.h>

#include "dda.h"

enum { DIVIDER_MAX = 65535 }; /* 16-bit register of the card */

static const double JERK_SHARE = 0.5;

bool machine_positive(double x)
{
    return x >= 1e-9 && x <= 1e9;
}

bool machine_share(double x)
{
    return machine_positive(x) && x <= 1.0;
}

static bool number(double x)
{
    return isfinite(x) && x >= 0.0;
}

static bool guard_valid(const struct machine *m, const struct machine_axis *a)
{
    return isfinite(a->high_limit) && isfinite(a->low_limit) && isfinite(a->hot_offset)
           && isfinite(a->lot_offset) && (!a->check_ot || machine_low(a) <= machine_high(a))
           && a->max_dda_acc >= 0 && a->max_dda_acc <= 2 * machine_dda_limit(m)
           && a->track_limit >= 0 && number(a->inpos_tol)
           && (a->acc == 0.0 || machine_positive(a->acc))
           && (a->jerk == 0.0 || (a->acc > 0.0 && machine_positive(a->jerk)));
}

static bool axis_valid(const struct machine *m, const struct machine_axis *a)
{
    return machine_positive(a->pitch) && machine_positive(a->gear_ratio) && a->ppr >= 1
           && machine_positive(a->rpm) && a->p_gain >= 0 && a->p_gain <= 65535 && a->max_dda >= 0
           && a->max_dda <= machine_dda_limit(m) && guard_valid(m, a);
}

static bool type_valid(char type)
{
    return type == 0 || type == 'T' || type == 'S';
}

static bool asyn_valid(const struct machine_asyn *r)
{
    for (int i = 0; i < AXES; i++) {
        if (!type_valid(r->acc_type[i]) || !type_valid(r->dec_type[i])
            || !(r->acc_time[i] == 0.0 || machine_positive(r->acc_time[i]))
            || !(r->dec_time[i] == 0.0 || machine_positive(r->dec_time[i]))) {
            return false;
        }
    }
    return true;
}

/* True for a share, or for 0, which stands for the library's own value. */
static bool share_valid(double x)
{
    return x == 0.0 || machine_share(x);
}

/* CCN 24: a row of limits that all must hold. */
bool machine_valid(const struct machine *m)
{
    if (m->dda_length < 10 || m->dda_length > 15 || m->queue_depth < 1) {
        return false;
    }
    for (int i = 0; i < AXES; i++) {
        if (!axis_valid(m, &m->axis[i])) {
            return false;
        }
    }
    if (m->limit_mode < 0 || m->limit_mode > MACHINE_LIMIT_TOWARD_ERROR || m->inpos_mode < 0
        || m->inpos_mode > MACHINE_INPOS_SETTLE_UNBLOCK || !number(m->inpos_settle)
        || !number(m->inpos_timeout)) {
        return false;
    }
    return machine_positive(m->dda_time) && machine_positive(m->feed)
           && machine_positive(m->max_feed)
           && (m->arc_tolerance == 0.0 || machine_positive(m->arc_tolerance))
           && type_valid(m->acc_type) && type_valid(m->dec_type) && share_valid(m->jerk_share)
           && share_valid(m->ptp_ratio) && asyn_valid(&m->asyn) && m->feed <= m->max_feed
           && machine_positive(m->acc_time) && machine_positive(m->dec_time);
}

void machine_complete_asyn(struct machine *m)
{
    struct machine_asyn *r = &m->asyn;

    for (int i = 0; i < AXES; i++) {
        r->acc_type[i] = r->acc_type[i] ? r->acc_type[i] : m->acc_type;
        r->dec_type[i] = r->dec_type[i] ? r->dec_type[i] : m->dec_type;
        r->acc_time[i] = r->acc_time[i] > 0.0 ? r->acc_time[i] : m->acc_time;
        r->dec_time[i] = r->dec_time[i] > 0.0 ? r->dec_time[i] : m->dec_time;
    }
}

int32_t machine_dda_divider(const struct machine *m)
{
    return dda_divider(1 << m->dda_length, m->dda_time * CLOCK_HZ, DIVIDER_MAX);
}

int64_t machine_dda_clocks(const struct machine *m)
{
    return dda_time(1 << m->dda_length, machine_dda_divider(m));
}

double machine_dda_time(const struct machine *m)
{
    return (double)machine_dda_clocks(m) / CLOCK_HZ;
}

int32_t machine_dda_limit(const struct machine *m)
{
    return dda_largest(1 << m->dda_length);
}

static double jerk_share(const struct machine *m)
{
    return m->jerk_share > 0.0 ? m->jerk_share : JERK_SHARE;
}

/* Ramp between rest and a speed that takes `time` [s]. For type 'T' its jerk has no limit. */
static struct ramp_rule rule(const struct machine *m, char type, double time)
{
    return (struct ramp_rule){ .time = time, .share = type == 'S' ? jerk_share(m) : 0.0 };
}

/* Time of the mean that gives a motion with ramps of constant acceleration the jerk of S-shaped
 * ramps; 0 for type 'T'. [s] */
static double smooth(const struct machine *m)
{
    const double up = m->acc_type == 'S' ? m->acc_time : 0.0;
    const double down = m->dec_type == 'S' ? m->dec_time : 0.0;
    return 0.5 * jerk_share(m) * (up + down); /* from +acc to -dec at most: (acc + dec) / jerk */
}

/* Share of the safe motor speed for rapids. */
static double rapid(const struct machine *m)
{
    return m->ptp_ratio > 0.0 ? m->ptp_ratio : 1.0;
}

struct motion_limits machine_limits(const struct machine *m)
{
    return (struct motion_limits){ .feed = m->max_feed,
                                   .rapid = rapid(m),
                                   .smooth = smooth(m),
                                   .up = rule(m, m->acc_type, m->acc_time),
                                   .down = rule(m, m->dec_type, m->dec_time) };
}

struct speed_limits machine_speed_limits(const struct machine *m)
{
    struct speed_limits l = { .acc = { 0.0 } };

    for (int i = 0; i < AXES; i++) {
        const struct machine_axis *a = &m->axis[i];
        l.speed[i] = a->used ? machine_axis_speed(a) : 0.0;
        l.acc[i] = a->acc;
        l.jerk[i] = a->jerk;
    }
    return l;
}

struct mechanism machine_mechanism(const struct machine *m)
{
    struct mechanism k = { .kinematics = NULL };

    for (int i = 0; i < AXES; i++) {
        const struct machine_axis *a = &m->axis[i];
        struct joint *j = &k.joint[i];
        if (!a->used) {
            continue;
        }
        k.axis[i] = j->used = true;
        j->scale = machine_pulses_per_mm(a);
        j->speed = machine_axis_speed(a);
        j->bounded = a->check_ot;
        if (j->bounded) {
            j->low = machine_low(a);
            j->high = machine_high(a);
        }
    }
    return k;
}

struct axes_limits machine_axis_limits(const struct machine *m, int axis, double speed)
{
    const struct machine_asyn *r = &m->asyn;
    const struct ramp_rule up = rule(m, r->acc_type[axis], r->acc_time[axis]);
    const struct ramp_rule down = rule(m, r->dec_type[axis], r->dec_time[axis]);
    return axes_limits_of(&up, &down, speed, machine_axis_speed(&m->axis[axis]));
}

double machine_pulses_per_mm(const struct machine_axis *a)
{
    return a->ppr * a->gear_ratio / a->pitch;
}

double machine_axis_speed(const struct machine_axis *a)
{
    return a->rpm / 60.0 * a->pitch / a->gear_ratio;
}

double machine_ptp_speed(const struct machine *m, int axis)
{
    return machine_axis_speed(&m->axis[axis]) * rapid(m);
}

double machine_high(const struct machine_axis *a)
{
    return a->high_limit - fabs(a->hot_offset);
}

double machine_low(const struct machine_axis *a)
{
    return a->low_limit + fabs(a->lot_offset);
}
