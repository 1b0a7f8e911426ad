#include "command.h"

#include <math.h>
#include <string.h>

#include "guard.h"

/* The counters of card and library are 32-bit, and path mixing adds up three positions. [pulses] */
static const double PULSES_MAX = 2147483647.0 / 3.0;

static enum fault check_range(const struct path *p, const struct machine *m,
                              struct fault_report *r)
{
    for (int i = 0; i < AXES; i++) {
        const struct machine_axis *a = &m->axis[i];
        if (a->used && !(path_reach(p, i) * machine_pulses_per_mm(a) < PULSES_MAX)) {
            return FAULT_RANGE;
        }
    }
    return guard_path(m, p, r);
}

/* Speed along the path at which the first axis reaches its safe motor speed. [mm/s] */
static double safe_speed(const struct path *p, const struct machine *m, int *axis)
{
    double least = INFINITY;
    *axis = 0;
    for (int i = 0; i < AXES; i++) {
        const double share = path_share(p, i);
        if (share > 0.0 && machine_axis_speed(&m->axis[i]) / share < least) {
            least = machine_axis_speed(&m->axis[i]) / share;
            *axis = i;
        }
    }
    return least;
}

static void set_speed(struct command *c, const struct machine *m, double feed, double cap)
{
    c->feed = feed;
    c->cap = cap;
    const struct machine_ramp up = machine_ramp(m, m->acc_type, feed, m->acc_time);
    const struct machine_ramp down = machine_ramp(m, m->dec_type, feed, m->dec_time);
    c->smooth = machine_smooth(m);
    c->ramp = (struct ramp_limits){ up.acc, down.acc, up.jerk, down.jerk };
}

enum fault command_move(struct command *c, const struct machine *m, enum command_type type,
                        double feed, struct fault_report *r)
{
    int axis;
    const double safe = safe_speed(&c->path, m, &axis);

    c->type = type;
    if (feed > safe) {
        r->value = feed / safe * m->axis[axis].rpm;
        r->limit = m->axis[axis].rpm;
        return FAULT_SPEED;
    }
    set_speed(c, m, feed, fmin(safe, m->max_feed));
    return check_range(&c->path, m, r);
}

enum fault command_ptp(struct command *c, const struct machine *m, struct fault_report *r)
{
    int axis;
    const double safe = safe_speed(&c->path, m, &axis);

    c->type = COMMAND_PTP;
    c->blend = false;
    set_speed(c, m, m->ptp_ratio > 0.0 ? safe * m->ptp_ratio : safe, safe);
    return check_range(&c->path, m, r);
}

enum fault command_ptp_asyn(struct command *c, const struct machine *m, struct fault_report *r)
{
    c->type = COMMAND_PTP_ASYN;
    c->blend = false;
    return check_range(&c->path, m, r);
}

void command_delay(struct command *c, const double point[AXES], double seconds)
{
    path_line(&c->path, point, point);
    c->type = COMMAND_DELAY;
    c->blend = false;
    c->feed = c->cap = 0.0;
    c->ramp = (struct ramp_limits){ 0.0, 0.0, 0.0, 0.0 };
    c->dwell = seconds;
}

enum command_type command_arc_type(const struct path *p)
{
    const bool helix = p->start[p->plane] != p->end[p->plane];
    if (p->sweep > 0.0) {
        return helix ? COMMAND_CCW_HELIX : COMMAND_CCW_ARC;
    }
    return helix ? COMMAND_CW_HELIX : COMMAND_CW_ARC;
}

bool command_lasts(const struct command *c)
{
    return c->type <= COMMAND_DELAY || c->type == COMMAND_PTP_ASYN;
}

bool command_blends(const struct command *c)
{
    return c->type >= COMMAND_LINE && c->type <= COMMAND_CCW_HELIX;
}

double command_speed(const struct command *c, double override)
{
    return fmin(c->feed * override, c->cap);
}

void command_start(const struct command *c, double override, struct profile *p)
{
    if (c->type == COMMAND_DELAY) {
        profile_wait(p, c->dwell);
    } else {
        const struct profile_limits l = { command_speed(c, override), c->ramp };
        const struct scurve_start rest = { 0.0, 0.0, 0.0 };
        profile_plan(p, &rest, c->path.length, &l);
    }
}
