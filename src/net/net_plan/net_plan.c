#include "net_plan.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "el_extremes.h"
#include "elementary.h"

/* A shorter distance [mm] counts as none. */
static const double NONE = 1e-9;

void net_plan_start(struct net_plan *p, const struct net_plan_config *config)
{
    memset(p, 0, offsetof(struct net_plan, chain));
    p->config = *config;
    p->lowered = true; /* the pen's state is not known, so it is raised first */
    p->chain.open = false;
}

/* The part of a limit that the plan may use, without the reserve. */
static double planned(const struct net_plan *p, double limit)
{
    return limit * (1.0 - p->config.reserve);
}

static double period(const struct net_plan *p)
{
    return 1e-9 * p->config.period_ns;
}

/* Begin a line at the latest vertex. */
static void begin_line(struct net_plan *p)
{
    struct speed_limits l;
    double place[AXES] = { 0.0 };

    for (int i = 0; i < AXES; i++) {
        const int k = i < 2 ? i : 0;
        l.speed[i] = p->config.axis[k].speed;
        l.acc[i] = planned(p, p->config.axis[k].acc);
        l.jerk[i] = planned(p, p->config.axis[k].jerk);
    }
    memcpy(place, p->goal, sizeof p->goal);
    plan_chain_start(&p->chain, place, p->config.tolerance, &l);
    p->drawing = true;
}

bool net_plan_take(struct net_plan *p, const struct net_plan_vertex *v)
{
    const double place[AXES] = { v->point[0], v->point[1] };

    if (v->kind == NET_PLAN_MOVE) {
        if (p->drawing) {
            plan_chain_end(&p->chain);
            return false;
        }
        if (p->moving) {
            return false;
        }
        memcpy(p->goal, v->point, sizeof p->goal);
        memcpy(p->target, v->point, sizeof p->target);
        p->moving = true;
        return true;
    }
    if (p->drawing && !p->chain.open) {
        return false;
    }
    if (!p->drawing) {
        p->stops += p->lowered && p->told && !p->moving;
        begin_line(p);
    }
    if (!plan_chain_line(&p->chain, place, v->feed)) {
        return false;
    }
    memcpy(p->goal, v->point, sizeof p->goal);
    if (v->kind == NET_PLAN_STOP) {
        plan_chain_end(&p->chain);
    }
    return true;
}

void net_plan_end(struct net_plan *p)
{
    p->over = true;
    if (p->drawing) {
        plan_chain_end(&p->chain);
    }
}

/* Begin a straight move from rest to rest, each axis within its limits. */
static void slide(struct net_plan *p, const double to[JOB_AXES])
{
    struct scurve_limits l = { p->config.rapid, INFINITY, INFINITY, INFINITY };
    double way = 0.0;

    for (int i = 0; i < JOB_AXES; i++) {
        way += (to[i] - p->place[i]) * (to[i] - p->place[i]);
    }
    way = sqrt(way);
    memcpy(p->from, p->place, sizeof p->from);
    for (int i = 0; i < JOB_AXES; i++) {
        p->slope[i] = (to[i] - p->place[i]) / way;
        const double share = fabs(p->slope[i]);
        if (share > 0.0) {
            l.speed = el_min(l.speed, p->config.axis[i].speed / share);
            l.acc = el_min(l.acc, planned(p, p->config.axis[i].acc) / share);
            l.jerk = el_min(l.jerk, planned(p, p->config.axis[i].jerk) / share);
        }
    }
    l.dec = l.acc;
    scurve_plan(&p->slide, &(struct scurve_start){ 0.0, 0.0, 0.0 }, way, &l);
    p->step = NET_PLAN_SLIDES;
    p->time = 0.0;
}

static void move_pen(struct net_plan *p, bool down, int32_t *event)
{
    p->lowered = down;
    p->told = true;
    if (p->config.pen == NET_PLAN_OUTPUT) {
        *event = down ? NET_PLAN_LOWER : NET_PLAN_RAISE;
        p->step = NET_PLAN_RESTS;
        p->rest = (int32_t)el_max(1.0, ceil(p->config.dwell / period(p) * (1.0 - 1e-9)));
        return;
    }
    double to[JOB_AXES];
    memcpy(to, p->place, sizeof to);
    to[p->config.pen_axis] = down ? p->config.down : p->config.up;
    if (fabs(to[p->config.pen_axis] - p->place[p->config.pen_axis]) > NONE) {
        slide(p, to);
    }
}

/* At rest: begin the next motion, which may have no length. False if there is nothing to do now. */
static bool choose(struct net_plan *p, int32_t *event)
{
    if (p->lowered && (!p->told || p->moving || (p->over && !p->drawing))) {
        move_pen(p, false, event);
        return true;
    }
    if (p->moving) {
        p->moving = false;
        if (el_hypot(p->target[0] - p->place[0], p->target[1] - p->place[1]) > NONE) {
            const double to[JOB_AXES] = { p->target[0], p->target[1], p->place[2], p->place[3] };
            slide(p, to);
        }
        return true;
    }
    if (p->drawing && !p->lowered) {
        move_pen(p, true, event);
        return true;
    }
    p->step = p->drawing && plan_chain_ready(&p->chain) ? NET_PLAN_DRAWS : NET_PLAN_NOTHING;
    return p->step != NET_PLAN_NOTHING;
}

/* Plan one period of the motion under way. */
static void advance(struct net_plan *p)
{
    double s, v, a, j;

    if (p->step == NET_PLAN_RESTS) {
        p->step = --p->rest > 0 ? NET_PLAN_RESTS : NET_PLAN_NOTHING;
    } else if (p->step == NET_PLAN_SLIDES) {
        p->time += period(p);
        scurve_state(&p->slide, p->time, &s, &v, &a, &j);
        for (int i = 0; i < JOB_AXES; i++) {
            p->place[i] = p->from[i] + s * p->slope[i];
        }
        p->step = p->time < scurve_total(&p->slide) ? NET_PLAN_SLIDES : NET_PLAN_NOTHING;
    } else {
        plan_chain_advance(&p->chain, period(p));
        memcpy(p->place, p->chain.place, 2 * sizeof p->place[0]);
        if (plan_chain_done(&p->chain)) {
            p->step = NET_PLAN_NOTHING;
            p->drawing = false;
            p->stops += p->chain.stops;
        }
    }
}

enum net_plan_result net_plan_next(struct net_plan *p, struct net_plan_frame *f)
{
    if (p->step == NET_PLAN_DRAWS && !plan_chain_ready(&p->chain)) {
        return NET_PLAN_WANTS;
    }
    memset(f, 0, sizeof *f);
    while (p->step == NET_PLAN_NOTHING && choose(p, &f->job.event)) {
    }
    if (p->step == NET_PLAN_NOTHING) {
        return p->over && !p->drawing ? NET_PLAN_OVER : NET_PLAN_WANTS;
    }
    f->step = p->step;
    advance(p);
    for (int i = 0; i < JOB_AXES; i++) {
        const double pulses = floor(p->place[i] * p->config.axis[i].pulses_per_mm + 0.5);
        const double command = pulses - (double)p->pulses[i];
        f->place[i] = p->place[i];
        f->job.command[i] = (int32_t)el_min(el_max(command, -2147483647.0), 2147483647.0);
        p->pulses[i] = (int64_t)pulses;
    }
    return NET_PLAN_FRAME;
}
