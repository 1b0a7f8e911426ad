#include "axes.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

/* A ramp without limit of jerk is one whose acceleration takes 1 ns to rise and to fall. It takes
 * 1 ns longer, and ends half the speed times 1 ns (0.25 nm at 500 mm/s) from where the trapezium's
 * would. [s] */
static const double AT_ONCE = 1e-9;

struct axes_limits axes_limits_of(const struct ramp_rule *up, const struct ramp_rule *down,
                                  double speed, double cap)
{
    struct ramp_limits l = ramp_both(up, down, speed);
    l.acc_jerk = l.acc_jerk > 0.0 ? l.acc_jerk : l.acc / AT_ONCE;
    l.dec_jerk = l.dec_jerk > 0.0 ? l.dec_jerk : l.dec / AT_ONCE;
    return (struct axes_limits){ speed, cap, l.acc, l.dec, el_min(l.acc_jerk, l.dec_jerk) };
}

void axes_start(struct axes *a, const double place[AXES], double ratio)
{
    memset(a, 0, sizeof *a);
    a->ratio = ratio;
    for (int i = 0; i < AXES; i++) {
        a->axis[i].side = 1.0;
        a->axis[i].plan.s1 = place[i];
    }
}

/* A running axis goes on at the speed its plan ends with. */
static struct scurve_start state(const struct axes_axis *x)
{
    struct scurve_start at;
    double jerk;

    scurve_state(&x->plan, x->t, &at.s, &at.v, &at.a, &jerk);
    at.s += x->plan.v1 * el_max(0.0, x->t - x->plan.total);
    return (struct scurve_start){ x->side * at.s, x->side * at.v, x->side * at.a };
}

static double speed_of(const struct axes *a, const struct axes_axis *x)
{
    const double full = x->order == AXES_RUN ? fabs(x->goal) : x->limits.speed;
    return x->order == AXES_STAND ? 0.0 : el_min(full * a->ratio, x->limits.cap);
}

/* Plan in the coordinates of x->side. */
static void make(struct axes_axis *x, const struct scurve_start *at, double speed,
                 const struct scurve_limits *l)
{
    if (speed > 0.0 && x->order == AXES_GO) {
        scurve_plan(&x->plan, at, x->side * x->goal, l);
    } else {
        scurve_plan_speed(&x->plan, at, speed, l);
    }
}

/* The axis moves as ordered, or on if it is only to come to rest: that way is positive. */
static double side_of(const struct axes_axis *x, const struct scurve_start *at, double speed)
{
    const double way = speed == 0.0 ? at->v : x->order == AXES_GO ? x->goal - at->s : x->goal;
    return (way != 0.0 ? way : at->v != 0.0 ? at->v : at->a) < 0.0 ? -1.0 : 1.0;
}

/* Plan anew from where the axis is. */
static void replan(const struct axes *a, struct axes_axis *x)
{
    struct scurve_start at = state(x);
    const double speed = speed_of(a, x);
    struct scurve_limits l = { speed > 0.0 ? speed : x->limits.cap, x->limits.acc, x->limits.dec,
                               x->limits.jerk };

    if (l.speed <= 0.0) {
        return; /* the axis never had an order */
    }
    x->side = side_of(x, &at, speed);
    at.s *= x->side;
    at.v *= x->side;
    at.a *= x->side;
    x->t = 0.0;
    make(x, &at, speed, &l);
    if (l.acc != l.dec && scurve_slowest(&x->plan) < 0.0) {
        l.acc = l.dec = el_min(l.acc, l.dec); /* the axis turns round */
        make(x, &at, speed, &l);
    }
}

void axes_stand(struct axes *a, int axis)
{
    struct axes_axis *x = &a->axis[axis];
    x->order = AXES_STAND;
    replan(a, x);
}

/* Limits of an order. Those of a slow one are slow too: an axis under way keeps the steeper ramps,
 * or it would come down from a fast motion as slowly as it climbs to a slow one. */
static void set_limits(struct axes *a, int axis, const struct axes_limits *l)
{
    const struct axes_limits old = a->axis[axis].limits;
    struct axes_limits *now = &a->axis[axis].limits;

    *now = *l;
    if (!axes_rests(a, axis)) {
        now->acc = el_max(now->acc, old.acc);
        now->dec = el_max(now->dec, old.dec);
        now->jerk = el_max(now->jerk, old.jerk);
    }
}

void axes_run(struct axes *a, int axis, double speed, const struct axes_limits *l)
{
    struct axes_axis *x = &a->axis[axis];
    x->order = AXES_RUN;
    x->goal = speed;
    set_limits(a, axis, l);
    replan(a, x);
}

void axes_go(struct axes *a, int axis, double place, const struct axes_limits *l)
{
    struct axes_axis *x = &a->axis[axis];
    x->order = AXES_GO;
    x->goal = place;
    set_limits(a, axis, l);
    replan(a, x);
}

void axes_set_ratio(struct axes *a, double ratio)
{
    if (a->ratio != ratio) {
        a->ratio = ratio;
        for (int i = 0; i < AXES; i++) {
            replan(a, &a->axis[i]);
        }
    }
}

void axes_advance(struct axes *a, double dt)
{
    for (int i = 0; i < AXES; i++) {
        a->axis[i].t += dt;
    }
}

void axes_state(const struct axes *a, int axis, double *place, double *speed)
{
    const struct scurve_start at = state(&a->axis[axis]);
    *place = at.s;
    *speed = at.v;
}

void axes_reach(const struct axes *a, int axis, double *low, double *high, double *acc)
{
    const struct axes_axis *x = &a->axis[axis];
    const struct scurve_start at = state(x);
    double fastest = fabs(at.v), begin = 0.0;

    *acc = 0.0;
    for (int i = 0; i < x->plan.count; i++) {
        const struct scurve_phase *h = &x->plan.phase[i]; /* it may pass a peak of speed, a = 0 */
        fastest =
            el_max(fastest, fabs(h->v) + (h->j != 0.0 ? h->a * h->a / fabs(2.0 * h->j) : 0.0));
        *acc = el_max(*acc, el_max(fabs(h->a + h->j * (begin - h->t)),
                                   fabs(h->a + h->j * (h->end - h->t))));
        begin = h->end;
    }
    const double left = el_max(0.0, x->plan.total - x->t);
    const double way = x->plan.v1 != 0.0 ? INFINITY : fastest * left;
    *low = at.s - way;
    *high = at.s + way;
}

bool axes_rests(const struct axes *a, int axis)
{
    const struct axes_axis *x = &a->axis[axis];
    return x->t >= x->plan.total && x->plan.v1 == 0.0;
}

bool axes_resting(const struct axes *a)
{
    for (int i = 0; i < AXES; i++) {
        if (!axes_rests(a, i)) {
            return false;
        }
    }
    return true;
}

bool axes_done(const struct axes *a, int axis)
{
    const struct axes_axis *x = &a->axis[axis];
    return axes_rests(a, axis) && x->order != AXES_RUN
           && (x->order == AXES_STAND || x->side * x->plan.s1 == x->goal);
}

int axes_last(const struct axes *a)
{
    int last = 0;
    for (int i = 1; i < AXES; i++) {
        const struct axes_axis *x = &a->axis[i], *y = &a->axis[last];
        last = x->plan.total - x->t > y->plan.total - y->t ? i : last;
    }
    return last;
}

double axes_left(const struct axes *a)
{
    const struct axes_axis *last = &a->axis[axes_last(a)];
    return el_max(0.0, last->plan.total - last->t);
}
