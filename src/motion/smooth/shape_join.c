#include "shape_join.h"

#include <string.h>

#include "bernstein.h"

/* Part of the tolerance that is used: rounding may take the rest. */
static const double USED = 0.995;

/* Steps to the foot of a vertex on the curve; halvings of a part whose hull is too wide. */
enum { STEPS = 4, HALVINGS = 4 };

/* Squared distance of a point from a chord. [mm^2] */
static double off_chord(const double x[AXES], const double a[AXES], const double b[AXES])
{
    double ww = 0.0, wf = 0.0, sum = 0.0;

    for (int i = 0; i < AXES; i++) {
        ww += (b[i] - a[i]) * (b[i] - a[i]);
        wf += (b[i] - a[i]) * (x[i] - a[i]);
    }
    const double t = wf <= 0.0 ? 0.0 : wf >= ww ? 1.0 : wf / ww;
    for (int i = 0; i < AXES; i++) {
        const double d = x[i] - a[i] - t * (b[i] - a[i]);
        sum += d * d;
    }
    return sum;
}

/* True if the part t0 .. t1 of the curve is within a distance of a chord. */
static bool within(const struct segment *p, double t0, double t1, const double a[AXES],
                   const double b[AXES], double square, int halvings)
{
    double c[AXES][SEGMENT_POINTS];
    bool inside = true;

    for (int i = 0; i < AXES; i++) {
        for (int k = 0; k < SEGMENT_POINTS; k++) {
            c[i][k] = p->origin[i] + p->control[k][i];
        }
        bernstein_part(c[i], SEGMENT_POINTS - 1, t0, t1);
    }
    for (int k = 0; k < SEGMENT_POINTS; k++) {
        const double x[AXES] = { c[0][k], c[1][k], c[2][k], c[3][k], c[4][k], c[5][k] };
        const bool in = off_chord(x, a, b) <= square;
        if (!in && (k == 0 || k == SEGMENT_POINTS - 1)) {
            return false;
        }
        inside = inside && in;
    }
    if (inside || halvings == 0) {
        return inside;
    }
    const double middle = 0.5 * (t0 + t1);
    return within(p, t0, middle, a, b, square, halvings - 1)
           && within(p, middle, t1, a, b, square, halvings - 1);
}

/* *t becomes where the curve is nearest to a point, not before `least`. Squared distance. [mm^2] */
static double foot(const struct segment *p, const double x[AXES], double least, double *t)
{
    struct segment_state s;
    double square = 0.0;

    for (int step = 0; step <= STEPS; step++) {
        double along = 0.0, ss = 0.0;
        *t = *t < least ? least : *t > 1.0 ? 1.0 : *t;
        segment_at(p, *t * p->length, &s);
        square = 0.0;
        for (int i = 0; i < AXES; i++) {
            const double d = x[i] - s.point[i];
            square += d * d;
            along += d * s.slope[i];
            ss += s.slope[i] * s.slope[i];
        }
        if (step < STEPS && ss > 0.0) {
            *t += along / (ss * p->length);
        }
    }
    return square;
}

bool shape_join(struct segment *p, const struct segment_state *a, const struct segment_state *b,
                double length, const struct shape_way *way)
{
    double before = 0.0;

    segment_between(p, a, b, length);
    p->joint = true;
    for (int32_t k = 1; k < way->points; k++) {
        const double most = USED * way->tolerance[k], square = most * most;
        double t = 1.0;
        if (k < way->points - 1) {
            const double next = USED * way->tolerance[k + 1];
            t = way->u[k] / length;
            const double off = foot(p, way->point[k], before, &t);
            if (!(off <= square && off <= next * next)) {
                return false;
            }
        }
        if (t > before
            && !within(p, before, t, way->point[k - 1], way->point[k], square, HALVINGS)) {
            return false;
        }
        before = t;
    }
    return true;
}

void shape_cut(struct segment *p, double from, double to)
{
    if (p->kind == SEGMENT_LINE) {
        for (int i = 0; i < AXES; i++) {
            p->start[i] += p->slope[i] * from;
        }
    } else if (p->kind != SEGMENT_CURVE) {
        p->from += from;
    } else {
        for (int i = 0; i < AXES; i++) {
            double c[SEGMENT_POINTS];
            for (int k = 0; k < SEGMENT_POINTS; k++) {
                c[k] = p->control[k][i];
            }
            bernstein_part(c, SEGMENT_POINTS - 1, from / p->length, to / p->length);
            p->origin[i] += c[0];
            for (int k = 0; k < SEGMENT_POINTS; k++) {
                p->control[k][i] = c[k] - c[0];
            }
        }
    }
    p->length = to - from;
}
