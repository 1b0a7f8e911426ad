#include "reach.h"

#include <math.h>
#include <string.h>

#include "guard.h"

/* An extent of a corner may be told by so much too wide: far below a pulse. [mm] */
static const double NEAR = 1e-6;

/* The ramp at a time after now. */
struct instant {
    double t;                               /* [s] */
    double place[AXES];                     /* [mm] */
    struct scurve_start move[2];            /* along each move */
};

struct ramp_view {
    struct ipo ramp;                        /* its clocks at `at` */
    double at;                              /* [s] */
    double acc[AXES];                       /* [mm/s^2] highest of independent axes */
    const struct ipo *now;
    const struct ring *ring;
    const struct machine *machine;
};

/* Bounds of each move, the sum of them. Exact if there is one. */
static void box_of_moves(const struct ipo *ramp, double low[AXES], double high[AXES])
{
    memcpy(low, ramp->rest, AXES * sizeof *low);
    memcpy(high, ramp->rest, AXES * sizeof *high);
    for (int i = 0; i < ramp->count; i++) {
        const struct path *way = &ramp->move[i].command.path;
        struct profile left = ramp->move[i].profile;
        const double s = profile_state(&left).s;
        left.t = left.total;
        const double end = profile_state(&left).s;
        for (int k = 0; k < AXES; k++) {
            double a, b;
            path_extent(way, k, s, end, &a, &b);
            low[k] = i == 0 ? a : low[k] + (a - way->start[k]);
            high[k] = i == 0 ? b : high[k] + (b - way->start[k]);
        }
    }
}

static struct instant instant_at(struct ramp_view *v, double t)
{
    struct instant x = { .t = t };
    double velocity[AXES];

    ipo_shift(&v->ramp, t - v->at);
    v->at = t;
    ipo_place(&v->ramp, v->ring, x.place, velocity);
    for (int i = 0; i < v->ramp.count; i++) {
        x.move[i] = profile_state(&v->ramp.move[i].profile);
    }
    return x;
}

/* Highest deviation of a move, along one axis, from the straight motion between two instants: a
 * speed between the two leaves the mean speed's way by no more than a fourth of their difference
 * times the time, a bent path its chord by no more than bend (ds)^2 / 8. An acceleration at the
 * first instant only becomes less. [mm] */
static double move_strays(const struct path *way, const struct scurve_start *a,
                          const struct scurve_start *b, double dt, int axis)
{
    const double top = fmax(a->v, b->v) + fmax(0.0, a->a) * dt, ds = b->s - a->s;
    const double uneven = 0.25 * (top - fmin(a->v, b->v)) * dt;
    return uneven * path_share(way, axis) + 0.125 * path_bend(way) * ds * ds;
}

/* Whether what lies between two instants is certainly within the limits. */
static bool between(const struct ramp_view *v, const struct instant *a, const struct instant *b)
{
    const double dt = b->t - a->t;
    double low[AXES], high[AXES];

    for (int k = 0; k < AXES; k++) {
        double strays = 0.125 * v->acc[k] * dt * dt;
        for (int i = 0; i < v->ramp.count && ipo_follows_paths(&v->ramp); i++) {
            strays += move_strays(&v->ramp.move[i].command.path, &a->move[i], &b->move[i], dt, k);
        }
        low[k] = fmin(a->place[k], b->place[k]) - strays;
        high[k] = fmax(a->place[k], b->place[k]) + strays;
    }
    return guard_reach(v->machine, v->now->pulses, low, high) < 0;
}

/* First axis beyond at the DDA boundaries i + 1 .. j, whose first and last places are known. */
static int search(struct ramp_view *v, int64_t i, const struct instant *a, int64_t j,
                  const struct instant *b)
{
    if (between(v, a, b)) {
        return -1;
    }
    if (j - i <= 1) {
        return guard_reach(v->machine, v->now->pulses, b->place, b->place);
    }
    const int64_t half = i + (j - i) / 2;
    const struct instant mid = instant_at(v, (double)half * machine_dda_time(v->machine));
    const int axis = search(v, i, a, half, &mid);
    return axis >= 0 ? axis : search(v, half, &mid, j, b);
}

static int beyond_in_time(struct ramp_view *v)
{
    const double time = ipo_left(&v->ramp), dda = machine_dda_time(v->machine);
    const int64_t last = (int64_t)fmin(ceil(time / dda), 1e15) + 1;
    const struct instant first = instant_at(v, 0.0);
    const struct instant end = instant_at(v, (double)last * dda);

    return search(v, 0, &first, last, &end);
}

/* Widen bounds by a path from one place on it to another. */
static void widen(const struct path *p, double from, double to, double margin, double low[AXES],
                  double high[AXES])
{
    double a, b;

    for (int k = 0; k < AXES && from <= to; k++) {
        path_extent(p, k, from, to, &a, &b);
        low[k] = fmin(low[k], a - margin);
        high[k] = fmax(high[k], b + margin);
    }
}

/* Way of a chain from the tool to its rest. */
struct way {
    const struct track *t;      /* at rest */
    const struct ring *ring;
    double from, to;            /* [mm] on the chain */
};

static const struct path *path_of(const struct way *w, int32_t i)
{
    return &ring_peek(w->ring, i)->command.path;
}

/* Whether a command, its corner with it, begins before the rest. */
static bool begins(const struct way *w, int32_t i, double base)
{
    return base - track_half(w->t, w->ring, i) <= w->to;
}

/* A corner takes both of its paths from half before the tool to half after it. Lines it leaves to
 * the inside, arcs by the tolerance at most. */
static void box_of_chain(const struct way *w, double low[AXES], double high[AXES])
{
    const int32_t first = w->t->out > 0 ? w->t->out - 1 : 0;
    double base = w->t->out_base - (first < w->t->out ? path_of(w, first)->length : 0.0);

    for (int32_t i = first; i < w->t->joined && begins(w, i, base); i++) {
        const struct path *p = path_of(w, i);
        const double half = track_half(w->t, w->ring, i), next = track_half(w->t, w->ring, i + 1);
        const bool bent = p->arc || (half > 0.0 && path_of(w, i - 1)->arc) ||
                          (next > 0.0 && path_of(w, i + 1)->arc);
        widen(p, fmax(0.0, w->from - base - next), fmin(p->length, w->to - base + half),
              bent ? ring_peek(w->ring, i)->command.tolerance : 0.0, low, high);
        base += p->length;
    }
}

struct bow {
    const struct corner *corner;
    const struct path *a, *b;
    double *low, *high;         /* of places on it */
};

/* Part of a corner: in halves until nothing in it leaves the places known by more than NEAR. */
static void widen_by_bow(const struct bow *w, double s0, const double p0[AXES], double s1,
                         const double p1[AXES])
{
    const double strays = 0.125 * w->corner->bend * (s1 - s0) * (s1 - s0);
    bool inside = true;

    for (int k = 0; k < AXES; k++) {
        w->low[k] = fmin(w->low[k], fmin(p0[k], p1[k]));
        w->high[k] = fmax(w->high[k], fmax(p0[k], p1[k]));
        inside = inside && fmin(p0[k], p1[k]) - strays >= w->low[k] - NEAR &&
                 fmax(p0[k], p1[k]) + strays <= w->high[k] + NEAR;
    }
    if (!inside && s1 - s0 > NEAR) {
        const double s = 0.5 * (s0 + s1);
        double p[AXES], slope[AXES];
        corner_at(w->corner, w->a, w->b, s, p, slope);
        widen_by_bow(w, s0, p0, s, p);
        widen_by_bow(w, s, p, s1, p1);
    }
}

static void widen_by_corner(const struct way *w, int32_t i, double from, double to,
                            double low[AXES], double high[AXES])
{
    const struct bow bow = { &ring_peek(w->ring, i)->corner, path_of(w, i - 1), path_of(w, i),
                             low, high };
    double first[AXES], last[AXES], slope[AXES];

    corner_at(bow.corner, bow.a, bow.b, from, first, slope);
    corner_at(bow.corner, bow.a, bow.b, to, last, slope);
    widen_by_bow(&bow, from, first, to, last);
}

static void extent_of_chain(const struct way *w, double low[AXES], double high[AXES])
{
    double base = w->t->out_base;

    for (int32_t i = w->t->out; i < w->t->joined && begins(w, i, base); i++) {
        const struct path *p = path_of(w, i);
        const double half = track_half(w->t, w->ring, i), from = w->from - base, to = w->to - base;
        if (half > 0.0 && from < half && to > -half) {
            widen_by_corner(w, i, fmax(-half, from), fmin(half, to), low, high);
        }
        widen(p, fmax(half, from), fmin(p->length - track_half(w->t, w->ring, i + 1), to), 0.0,
              low, high);
        base += p->length;
    }
    for (int k = 0; k < AXES; k++) {
        low[k] -= NEAR;
        high[k] += NEAR;
    }
}

static int beyond_in_chain(const struct ipo *p, struct ring *r, const struct machine *m)
{
    struct track rest = p->track;
    const double from = rest.out_base + rest.out_s;
    double place[AXES], low[AXES], high[AXES], velocity[AXES];

    track_to_rest(&rest, r);
    const struct way w = { &rest, r, from, rest.base + rest.s };
    track_place(&p->track, r, place, velocity);
    memcpy(low, place, sizeof low);
    memcpy(high, place, sizeof high);
    box_of_chain(&w, low, high);
    if (guard_reach(m, p->pulses, low, high) < 0) {
        return -1;
    }
    memcpy(low, place, sizeof low);
    memcpy(high, place, sizeof high);
    extent_of_chain(&w, low, high);
    return guard_reach(m, p->pulses, low, high);
}

int reach_beyond(const struct ipo *p, struct ring *r, const struct machine *m)
{
    if (p->track.active) {
        return beyond_in_chain(p, r, m);
    }
    struct ramp_view v = { .now = p, .ring = r, .machine = m };
    ipo_ramp(p, &v.ramp);
    double low[AXES], high[AXES];
    const bool paths = ipo_follows_paths(&v.ramp);
    if (paths) {
        box_of_moves(&v.ramp, low, high);
    } else {
        for (int i = 0; i < AXES; i++) {
            axes_reach(&v.ramp.axes, i, &low[i], &high[i], &v.acc[i]);
        }
    }
    const int axis = guard_reach(m, p->pulses, low, high);
    return axis < 0 || (paths && p->count < 2) ? axis : beyond_in_time(&v);
}
