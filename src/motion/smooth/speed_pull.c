#include "speed_pull.h"

#include <math.h>

#include "el_extremes.h"

/* The least |r'| counts as at least this share of the most: it is less where a path turns back. */
static const double LEAST = 1e-9;

struct range {
    double low, high;
};

static struct range of(const struct segment_bounds *b, int n, int axis)
{
    return (struct range){ b->low[n - 1][axis], b->high[n - 1][axis] };
}

static struct range times(struct range a, struct range b)
{
    const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
    return (struct range){ el_min(el_min(p, q), el_min(r, s)), el_max(el_max(p, q), el_max(r, s)) };
}

static struct range square(struct range a)
{
    const double p = a.low * a.low, q = a.high * a.high;
    return (struct range){ a.low <= 0.0 && a.high >= 0.0 ? 0.0 : el_min(p, q), el_max(p, q) };
}

static void add(struct range *sum, struct range a)
{
    sum->low += a.low;
    sum->high += a.high;
}

static double spread(struct range a)
{
    return a.high - a.low;
}

static double size(struct range a)
{
    return el_max(fabs(a.low), fabs(a.high));
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void speed_pull_axis(struct speed_pull *l, int axis, double length, const struct segment_bounds *b)
{
    for (int e = 0; e < 2; e++) {
        l->p[e] = b->slope[e][axis];
        l->q[e] = b->bend[e][axis];
    }
    for (int n = 1; n <= 3; n++) {
        l->most[n - 1] = size(of(b, n, axis));
    }
    l->sag = 0.125 * length * length * l->most[2];
    l->stray = 0.25 * length * spread(of(b, 3, axis));
}

/* s = (r'' r'' + r' r''' - q^2) / p along a curve, from the axes `first` and two more. */
static struct range twist(const struct segment_bounds *b, int first)
{
    struct range slope = { 0.0, 0.0 }, both = slope, turn = slope;

    for (int i = first; i < first + 3; i++) {
        add(&slope, square(of(b, 1, i)));
        add(&both, times(of(b, 1, i), of(b, 2, i)));
        add(&turn, square(of(b, 2, i)));
        add(&turn, times(of(b, 1, i), of(b, 3, i)));
    }
    const struct range per = { 1.0 / b->most[0],
                               1.0 / el_max(sqrt(slope.low), LEAST * b->most[0]) };
    const struct range along = square(times(both, per));
    add(&turn, (struct range){ -el_min(along.high, b->most[1] * b->most[1]), -along.low });
    return times(turn, per);
}

/* The pull along the path, whose axes are `first` and two more. */
static void look_along(struct speed_pull *l, const struct segment *p, double length,
                       const struct segment_bounds *b, int first)
{
    struct range s = { 0.0, 0.0 };

    for (int e = 0; e < 2; e++) {
        const double *r1 = b->slope[e] + first;
        l->p[e] = el_max(sqrt(dot(r1, r1)), LEAST * b->most[0]);
        l->q[e] = dot(r1, b->bend[e] + first) / l->p[e];
    }
    if (p->kind == SEGMENT_CURVE) {
        s = twist(b, first);
    } else if (p->kind == SEGMENT_ARC && p->path.plane != PATH_TILTED) { /* of a spiral */
        const double turns = p->path.growth * p->path.sweep / (p->path.length * p->path.length);
        s.high = turns * turns / el_min(l->p[0], l->p[1]);
        s.low = -s.high;
    }
    l->sag = el_min(0.125 * length * length * size(s), b->most[0]);
    l->stray = el_min(0.25 * length * spread(s), 2.0 * b->most[1]);
    l->most[0] = b->most[0];
    l->most[1] = el_min(b->most[1], el_max(fabs(l->q[0]), fabs(l->q[1])) + l->stray);
    l->most[2] = size(s);
}

/* The most n: it is at most |r'' - k r'| for any k. With a k that is right at both ends and
 * straight in between, that vector leaves its chord as the spread of its derivative allows. */
static double most_across(const struct speed_pull *along, double length,
                          const struct segment_bounds *b, int first)
{
    const double k[2] = { along->q[0] / along->p[0], along->q[1] / along->p[1] };
    const double grows = fabs(k[1] - k[0]), most = el_max(fabs(k[0]), fabs(k[1]));
    double end[2][3], strays[3];

    for (int i = 0; i < 3; i++) {
        const struct range r2 = of(b, 2, first + i);
        for (int e = 0; e < 2; e++) {
            end[e][i] = b->bend[e][first + i] - k[e] * b->slope[e][first + i];
        }
        strays[i] = 0.25
                    * (length * (spread(of(b, 3, first + i)) + most * spread(r2))
                       + grows * (length * size(r2) + spread(of(b, 1, first + i))));
    }
    return el_min(b->most[1], sqrt(el_max(dot(end[0], end[0]), dot(end[1], end[1])))
                                  + sqrt(dot(strays, strays)));
}

double speed_pull_path(struct speed_pull *along, const struct segment *p, double length,
                       const struct segment_bounds *b)
{
    const int first = b->axes > 0 && b->axis[0] >= 3 ? 3 : 0;

    look_along(along, p, length, b, first);
    return most_across(along, length, b, first);
}
