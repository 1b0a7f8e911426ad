/* mcc_chain - for the tests of look-ahead: paths, and the distance, speed and acceleration of the
 * tool, checked at every interpolation point. */
#ifndef MCC_CHAIN_H
#define MCC_CHAIN_H

#include "mcc_record.h"

static const double DT = 1.024e-3; /* [s] of mcc_machine */

static inline double norm3(const double a[3])
{
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

/* Distance of a point from a path [mm], by sampling and bisection. */
static inline double distance(const struct path *p, const double at[AXES])
{
    enum { SAMPLES = 60 };
    double best = INFINITY, where = 0.0, x[AXES], slope[AXES];
    for (double step = p->length / SAMPLES; step > 1e-9 * p->length; step *= 0.5) {
        const int wide = best == INFINITY ? SAMPLES : 2;
        const double from = best == INFINITY ? 0.0 : where - step;
        for (int i = 0; i <= wide; i++) {
            const double s = fmin(p->length, fmax(0.0, from + i * step));
            path_at(p, s, x, slope);
            const double d = norm3((double[3]){ x[0] - at[0], x[1] - at[1], x[2] - at[2] });
            where = d < best ? s : where;
            best = fmin(best, d);
        }
    }
    return best;
}

enum { SIDES = 20 };

/* Send a zigzag: twenty lines of 5 mm, in X and Y in turn. */
static inline void send_zigzag(struct path side[SIDES])
{
    double at[AXES] = { 0 };

    for (int i = 0; i < SIDES; i++) {
        double end[AXES];
        memcpy(end, at, sizeof end);
        end[i % 2] += 5.0;
        path_line(&side[i], at, end);
        memcpy(at, end, sizeof at);
        CHECK(MCC_line(&m, at) > 0);
    }
}

/* Distance of the latest point from the zigzag [mm]. */
static inline double off_zigzag(const struct path side[SIDES], const struct record *r)
{
    double d = INFINITY;

    for (int i = 0; i < SIDES; i++) {
        d = fmin(d, distance(&side[i], r->last.place));
    }
    return d;
}

/* Drive a line of 100 mm in a thousand commands. Returns the lowest speed between two times
 * [mm/s]. */
static inline double drive_pieces(struct record *r, double from, double to)
{
    double slowest = INFINITY;

    for (int sent = 0;;) {
        while (sent < 1000 && !ring_full(&m.ring)) {
            sent++;
            CHECK(MCC_line(&m, (double[AXES]){ 0.06 * sent, 0.08 * sent }) > 0);
        }
        if (!point(r)) {
            return slowest;
        }
        const double t = r->n * DT;
        slowest = t > from && t < to ? fmin(slowest, r->last.feed) : slowest;
    }
}

static inline void smooth_ramps(bool on)
{
    MCC_set_acc_type(&m, on ? 'S' : 'T');
    MCC_set_dec_type(&m, on ? 'S' : 'T');
}

static inline double way_of_tool(void)
{
    return m.trajectory.lookahead.out_base + m.trajectory.lookahead.out_s;
}

/* A number that is different for each chain: the index of its first command. */
static inline int chain_number(void)
{
    return m.trajectory.lookahead.started;
}

struct limits {
    double speed, acc, jerk;
};

/* Positions of the tool along its path and their differences: speed and acceleration. */
struct stream {
    double s[4];
    int n;
};

static inline void look(struct stream *x, double way, const struct limits *l)
{
    memmove(x->s + 1, x->s, 3 * sizeof *x->s);
    x->s[0] = way;
    x->n++;
    const double v = x->s[0] - x->s[1], a = v - (x->s[1] - x->s[2]);
    const double j = a - (x->s[1] - 2.0 * x->s[2] + x->s[3]);
    const double noise = 1e-12;
    CHECK(x->n < 2 || (v >= 0.0 && v <= l->speed * DT * (1.0 + 1e-6) + noise));
    CHECK(x->n < 3 || fabs(a) <= l->acc * DT * DT * (1.0 + 1e-6) + noise);
    CHECK(x->n < 4 || l->jerk <= 0.0 || fabs(j) <= l->jerk * DT * DT * DT * (1.0 + 1e-6) + noise);
}

static inline struct limits limits_at(double feed, bool smooth)
{
    /* 0.1 s from rest to the feed; S with share 0.5: acc/0.75, jerk acc/0.025 */
    const double acc = smooth ? feed / 0.075 : feed / 0.1;
    return (struct limits){ 2.0 * feed, acc, smooth ? acc / 0.025 : 0.0 };
}

#endif
