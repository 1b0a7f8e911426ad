#include "reach.h"

#include <math.h>
#include <string.h>

#include "bow.h"
#include "el_extremes.h"

/* The ramp at a time after now. */
struct instant {
    double t;           /* [s] */
    double joint[AXES]; /* [mm] */
    bool reached;
    struct scurve_start move[2]; /* along each move */
};

struct ramp_view {
    struct trajectory ramp; /* the ramp, whose clocks are at `at` */
    double at;              /* [s] */
    double dt;              /* [s] time from point to point */
    double acc[AXES];       /* [mm/s^2] highest acceleration of independent axes */
    double from[AXES];      /* [pulses] position of the latest point */
    double near[AXES];      /* [mm] joints there, if there are kinematics */
    const struct ring *ring;
    const struct mechanism *machine;
};

static int beyond(const struct ramp_view *v, const double low[AXES], const double high[AXES])
{
    int side;
    return mechanism_beyond(v->machine, v->from, low, high, &side);
}

static struct instant instant_at(struct ramp_view *v, double t, const double near[AXES])
{
    struct instant x = { .t = t };
    double place[AXES], velocity[AXES];

    trajectory_shift(&v->ramp, t - v->at);
    v->at = t;
    trajectory_place(&v->ramp, v->ring, place, velocity);
    memcpy(x.joint, near, sizeof x.joint);
    x.reached = trajectory_joints(&v->ramp, v->machine, place, x.joint);
    for (int i = 0; i < v->ramp.mix.count; i++) {
        x.move[i] = profile_state(&v->ramp.mix.move[i].profile);
    }
    return x;
}

/* Highest deviation of a move, along one axis, from the straight motion between two instants. A
 * speed between the two leaves the mean speed's way by no more than a fourth of their difference
 * times the time, a bent path its chord by no more than bend (ds)^2 / 8. An acceleration at the
 * first instant only becomes less. [mm] */
static double move_strays(const struct path *way, const struct scurve_start *a,
                          const struct scurve_start *b, double dt, int axis)
{
    const double top = el_max(a->v, b->v) + el_max(0.0, a->a) * dt, ds = b->s - a->s;
    const double uneven = 0.25 * (top - el_min(a->v, b->v)) * dt;
    return uneven * path_share(way, axis) + 0.125 * path_bend(way) * ds * ds;
}

/* Whether what lies between two instants is certainly within the bounds. Through kinematics a joint
 * goes no further than at its highest speed. */
static bool between(const struct ramp_view *v, const struct instant *a, const struct instant *b)
{
    const bool paths = v->ramp.motion == TRAJECTORY_MIX;
    const double dt = b->t - a->t;
    double low[AXES], high[AXES];

    for (int k = 0; k < AXES; k++) {
        double strays = 0.125 * v->acc[k] * dt * dt;
        for (int i = 0; i < v->ramp.mix.count && paths; i++) {
            strays +=
                move_strays(&v->ramp.mix.move[i].command.path, &a->move[i], &b->move[i], dt, k);
        }
        if (v->machine->kinematics && paths) {
            strays =
                0.5
                * el_max(0.0, v->machine->joint[k].speed * dt - fabs(b->joint[k] - a->joint[k]));
        }
        low[k] = el_min(a->joint[k], b->joint[k]) - strays;
        high[k] = el_max(a->joint[k], b->joint[k]) + strays;
    }
    return beyond(v, low, high) < 0;
}

/* First joint beyond its bounds at the points i + 1 .. j; those at i and j are known. */
static int search(struct ramp_view *v, int64_t i, const struct instant *a, int64_t j,
                  const struct instant *b)
{
    if (!b->reached) {
        return 0;
    }
    if (between(v, a, b)) {
        return -1;
    }
    if (j - i <= 1) {
        return beyond(v, b->joint, b->joint);
    }
    const int64_t half = i + (j - i) / 2;
    const struct instant mid = instant_at(v, (double)half * v->dt, a->joint);
    const int axis = search(v, i, a, half, &mid);
    return axis >= 0 ? axis : search(v, half, &mid, j, b);
}

static int beyond_in_time(struct ramp_view *v)
{
    const double time = trajectory_left(&v->ramp);
    const int64_t last = (int64_t)el_min(ceil(time / v->dt), 1e15) + 1;
    const struct instant first = instant_at(v, 0.0, v->near);
    const struct instant end = instant_at(v, (double)last * v->dt, first.joint);

    return search(v, 0, &first, last, &end);
}

/* Widen bounds by a path from one place on it to another. */
static void widen(const struct path *p, double from, double to, double margin, double low[AXES],
                  double high[AXES])
{
    double a, b;

    for (int k = 0; k < AXES && from <= to; k++) {
        path_extent(p, k, from, to, &a, &b);
        low[k] = el_min(low[k], a - margin);
        high[k] = el_max(high[k], b + margin);
    }
}

/* Way of a chain from the tool to its rest. */
struct way {
    const struct lookahead *t; /* the chain, brought to rest */
    const struct ring *ring;
    double from, to; /* [mm] on the chain */
};

static const struct path *path_of(const struct way *w, int32_t i)
{
    return &ring_peek(w->ring, i)->command.path;
}

/* Whether a command, its corner with it, begins before the rest. */
static bool begins(const struct way *w, int32_t i, double base)
{
    return base - lookahead_half(w->t, w->ring, i) <= w->to;
}

/* A corner takes both of its paths from half before the tool to half after it. Lines it leaves to
 * the inside, arcs by the tolerance at most. */
static void box_of_chain(const struct way *w, double low[AXES], double high[AXES])
{
    const int32_t first = w->t->out > 0 ? w->t->out - 1 : 0;
    double base = w->t->out_base - (first < w->t->out ? path_of(w, first)->length : 0.0);

    for (int32_t i = first; i < w->t->joined && begins(w, i, base); i++) {
        const struct path *p = path_of(w, i);
        const double half = lookahead_half(w->t, w->ring, i),
                     next = lookahead_half(w->t, w->ring, i + 1);
        const bool bent = path_bend(p) > 0.0 || (half > 0.0 && path_bend(path_of(w, i - 1)) > 0.0)
                          || (next > 0.0 && path_bend(path_of(w, i + 1)) > 0.0);
        widen(p, el_max(0.0, w->from - base - next), el_min(p->length, w->to - base + half),
              bent ? ring_peek(w->ring, i)->command.tolerance : 0.0, low, high);
        base += p->length;
    }
}

/* A corner and both of its paths. */
struct turn {
    const struct corner *corner;
    const struct path *a, *b;
};

static void place_in_turn(const void *turn, double s, double place[AXES])
{
    const struct turn *t = turn;
    double slope[AXES];

    corner_at(t->corner, t->a, t->b, s, place, slope);
}

static void widen_by_corner(const struct way *w, int32_t i, double from, double to,
                            double low[AXES], double high[AXES])
{
    const struct turn turn = { &ring_peek(w->ring, i)->corner, path_of(w, i - 1), path_of(w, i) };
    const struct bow bow = { place_in_turn, &turn, turn.corner->bend };

    bow_widen(&bow, from, to, low, high);
}

static void extent_of_chain(const struct way *w, double low[AXES], double high[AXES])
{
    double base = w->t->out_base;

    for (int32_t i = w->t->out; i < w->t->joined && begins(w, i, base); i++) {
        const struct path *p = path_of(w, i);
        const double half = lookahead_half(w->t, w->ring, i), from = w->from - base,
                     to = w->to - base;
        if (half > 0.0 && from < half && to > -half) {
            widen_by_corner(w, i, el_max(-half, from), el_min(half, to), low, high);
        }
        widen(p, el_max(half, from), el_min(p->length - lookahead_half(w->t, w->ring, i + 1), to),
              0.0, low, high);
        base += p->length;
    }
    for (int k = 0; k < AXES; k++) {
        low[k] -= BOW_NEAR;
        high[k] += BOW_NEAR;
    }
}

/* First joint beyond its bounds at places of a chain, as far apart as the tool goes in dt. */
static int beyond_on_way(const struct way *w, const struct ramp_view *v)
{
    struct lookahead tool = *w->t;
    double joint[AXES], place[AXES], velocity[AXES], step = INFINITY;

    for (int32_t i = w->t->out; i < w->t->joined; i++) {
        step = el_min(step, ring_peek(w->ring, i)->command.cap * v->dt);
    }
    memcpy(joint, v->near, sizeof joint);
    for (double at = w->from; at < w->to;) {
        at = el_min(at + step, w->to);
        lookahead_go(&tool, w->ring, at);
        lookahead_place(&tool, w->ring, place, velocity);
        const bool reached = mechanism_joints(v->machine, place, joint);
        const int axis = reached ? beyond(v, joint, joint) : 0;
        if (axis >= 0) {
            return axis;
        }
    }
    return -1;
}

static int beyond_in_chain(const struct trajectory *p, struct ring *r, const struct ramp_view *v)
{
    struct lookahead rest = p->lookahead;
    const double from = rest.out_base + rest.out_s;
    double place[AXES], low[AXES], high[AXES], velocity[AXES];

    lookahead_to_rest(&rest, r);
    const struct way w = { &rest, r, from, rest.base + rest.s };
    if (v->machine->kinematics) {
        return beyond_on_way(&w, v);
    }
    lookahead_place(&p->lookahead, r, place, velocity);
    memcpy(low, place, sizeof low);
    memcpy(high, place, sizeof high);
    box_of_chain(&w, low, high);
    if (beyond(v, low, high) < 0) {
        return -1;
    }
    memcpy(low, place, sizeof low);
    memcpy(high, place, sizeof high);
    extent_of_chain(&w, low, high);
    return beyond(v, low, high);
}

int reach_beyond(const struct trajectory *p, const struct trajectory_beside *b,
                 const struct mechanism *m, double dt)
{
    struct ring *r = b->ring;
    struct ramp_view v = { .dt = dt, .ring = r, .machine = m };
    double low[AXES], high[AXES];

    for (int i = 0; i < AXES; i++) {
        v.from[i] = p->pulses[i];
    }
    mechanism_near(m, p->pulses, v.near);
    if (p->motion == TRAJECTORY_CHAIN) {
        return beyond_in_chain(p, r, &v);
    }
    if (p->motion == TRAJECTORY_CURVE) {
        curve_stop_extent(&p->curve, b->curve, low, high);
        return beyond(&v, low, high);
    }
    trajectory_ramp(p, &v.ramp);
    const bool paths = p->motion == TRAJECTORY_MIX;
    if (paths && m->kinematics) {
        return beyond_in_time(&v);
    }
    if (paths) {
        mix_extent(&v.ramp.mix, v.ramp.rest, low, high);
    } else {
        for (int i = 0; i < AXES; i++) {
            axes_reach(&v.ramp.axes, i, &low[i], &high[i], &v.acc[i]);
        }
    }
    const int axis = beyond(&v, low, high);
    return axis < 0 || (paths && p->mix.count < 2) ? axis : beyond_in_time(&v);
}
