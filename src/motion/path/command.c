#include "command.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

/* Whether the joints can take a way. */
static enum command_status check_range(const struct path *p, const struct mechanism *m,
                                       const struct mechanism_way *w, struct command_refusal *r)
{
    double start[AXES];
    int side;

    for (int i = 0; i < AXES; i++) {
        const struct joint *j = &m->joint[i];
        const double most = el_max(fabs(w->low[i]), fabs(w->high[i]));
        if (j->used && !(most * j->scale < COMMAND_PULSES_MAX)) {
            return COMMAND_FAR;
        }
    }
    if (!mechanism_bounded(m)) {
        return COMMAND_OK;
    }
    mechanism_first(m, p->start, start);
    for (int i = 0; i < AXES; i++) {
        start[i] = round(start[i] * m->joint[i].scale);
    }
    r->joint = mechanism_beyond(m, start, w->low, w->high, &side);
    if (r->joint < 0) {
        return COMMAND_OK;
    }
    r->value = side > 0 ? w->high[r->joint] : w->low[r->joint];
    r->limit = side > 0 ? m->joint[r->joint].high : m->joint[r->joint].low;
    return COMMAND_OUTSIDE;
}

/* Speed along the path at which the first joint reaches its highest. [mm/s] */
static double safe_speed(const struct mechanism_way *w, const struct mechanism *m, int *joint)
{
    double least = INFINITY;
    *joint = 0;
    for (int i = 0; i < AXES; i++) {
        const double share = w->share[i];
        if (m->joint[i].used && share > 0.0 && m->joint[i].speed / share < least) {
            least = m->joint[i].speed / share;
            *joint = i;
        }
    }
    return least;
}

/* The lower of a value and what a joint allows along the path; 0 is no limit. */
static double lower(double value, double joint, double share)
{
    const double most = joint / share;
    return !(share > 0.0 && joint > 0.0) || (value > 0.0 && value <= most) ? value : most;
}

static void set_speed(struct command *c, const struct mechanism *m, const struct mechanism_way *w,
                      const struct motion_limits *l, double feed, double cap)
{
    struct ramp_limits r = ramp_both(&l->up, &l->down, feed);

    for (int i = 0; i < AXES; i++) {
        const struct joint *j = &m->joint[i];
        r.acc = lower(r.acc, j->acc, w->share[i]);
        r.dec = lower(r.dec, j->acc, w->share[i]);
        r.acc_jerk = lower(r.acc_jerk, j->jerk, w->share[i]);
        r.dec_jerk = lower(r.dec_jerk, j->jerk, w->share[i]);
    }
    c->feed = feed;
    c->cap = cap;
    c->smooth = l->smooth;
    c->ramp = r;
}

enum command_status command_move(struct command *c, const struct mechanism *m,
                                 const struct motion_limits *l, enum command_type type, double feed,
                                 struct command_refusal *r)
{
    struct mechanism_way w;
    int joint;

    c->type = type;
    mechanism_way(m, &c->path, &w);
    if (!w.reached) {
        return COMMAND_FAR;
    }
    const double safe = safe_speed(&w, m, &joint);
    if (feed > safe) {
        *r = (struct command_refusal){ joint, feed / safe, 1.0, safe };
        return COMMAND_FAST;
    }
    set_speed(c, m, &w, l, feed, el_min(safe, l->feed));
    return check_range(&c->path, m, &w, r);
}

enum command_status command_ptp(struct command *c, const struct mechanism *m,
                                const struct motion_limits *l, struct command_refusal *r)
{
    struct mechanism_way w;
    int joint;

    c->type = COMMAND_PTP;
    c->blend = false;
    mechanism_way(m, &c->path, &w);
    if (!w.reached) {
        return COMMAND_FAR;
    }
    const double safe = safe_speed(&w, m, &joint);
    set_speed(c, m, &w, l, safe * l->rapid, safe);
    return check_range(&c->path, m, &w, r);
}

enum command_status command_ptp_asyn(struct command *c, const struct mechanism *m,
                                     struct command_refusal *r)
{
    struct mechanism joints = *m;
    struct mechanism_way w;

    joints.kinematics = NULL;
    c->type = COMMAND_PTP_ASYN;
    c->blend = false;
    mechanism_way(&joints, &c->path, &w);
    return check_range(&c->path, &joints, &w, r);
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
    const bool helix = p->plane != PATH_TILTED && p->start[p->plane] != p->end[p->plane];
    if (p->sweep > 0.0) {
        return helix ? COMMAND_CCW_HELIX : COMMAND_CCW_ARC;
    }
    return helix ? COMMAND_CW_HELIX : COMMAND_CW_ARC;
}

bool command_lasts(const struct command *c)
{
    return c->type <= COMMAND_DELAY || c->type == COMMAND_PTP_ASYN || c->type == COMMAND_CUBIC;
}

bool command_blends(const struct command *c)
{
    return !c->probes
           && ((c->type >= COMMAND_LINE && c->type <= COMMAND_CCW_HELIX)
               || c->type == COMMAND_CUBIC);
}

double command_speed(const struct command *c, double override)
{
    return el_min(c->feed * override, c->cap);
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
