#include "shape_fit.h"

#include <math.h>

/* Part of the tolerance that is used: rounding may take the rest. */
static const double USED = 0.995;

/* Slowest and fastest r' of a curve, and what a distance counts as where it is not between. */
static const double SLOW = 0.5, FAST = 1.6, ASTRAY = 2.0;

/* Place and slope of the curve, one event on the way. */
struct place {
    double u, point[AXES], slope[AXES];
};

static void note(struct shape_fit *f, int32_t vertex, double square)
{
    struct shape_vertex *v = &f->run->vertex[vertex];
    const double off = sqrt(square) / (USED * v->tolerance);
    v->off = !(off <= v->off) ? off : v->off;
    if (!(off <= f->worst)) {     /* what is no number, too */
        f->worst = off;
        f->worst_vertex = vertex;
    }
}

/* The part of the curve between two events belongs to the chord that ends at a vertex: how far its
 * control points but the first are from there. */
static void prove(struct shape_fit *f, int32_t vertex, const struct place *a, const struct place *b)
{
    const struct shape_vertex *v = &f->run->vertex[vertex];
    const double third = (b->u - a->u) / 3.0;
    double ww = 0.0, wf[3] = { 0.0 }, ff[3] = { 0.0 }, most = 0.0;

    for (int k = 0; k < f->axes; k++) {
        const double start = v[-1].point[f->axis[k]], way = v->point[f->axis[k]] - start;
        const double from[3] = { a->point[k] + third * a->slope[k] - start,
                                 b->point[k] - third * b->slope[k] - start, b->point[k] - start };
        ww += way * way;
        for (int i = 0; i < 3; i++) {
            wf[i] += way * from[i];
            ff[i] += from[i] * from[i];
        }
    }
    const double per = ww > 0.0 ? 1.0 / ww : 0.0;
    for (int i = 0; i < 3; i++) {       /* from the foot, the start or the end of the chord */
        const double square = wf[i] <= 0.0 ? ff[i] : wf[i] < ww ? ff[i] - wf[i] * wf[i] * per
                            : ff[i] - 2.0 * wf[i] + ww;
        most = square <= most ? most : square;
    }
    note(f, vertex, most);
}

void shape_fit_look(struct shape_fit *f)
{
    struct shape_run *r = f->run;
    const double *t = r->knot;
    struct place now = { .u = t[3] }, next;
    int32_t i = 1;

    f->worst = 0.0;
    f->worst_vertex = f->end;
    for (int32_t k = 0; k <= f->end; k++) {
        r->vertex[k].off = 0.0;
    }
    for (int32_t k = 0; k < f->spans; k++) {
        const double (*m)[4] = (const double (*)[4])f->extract[k];
        const double h = t[k + 4] - t[k + 3], per = 3.0 / h;
        double b[4][AXES];
        for (int x = 0; x < f->axes; x++) {
            const int a = f->axis[x];
            const double c[4] = { r->control[k][a], r->control[k + 1][a], r->control[k + 2][a],
                                  r->control[k + 3][a] };
            b[0][x] = m[0][0] * c[0] + m[0][1] * c[1] + m[0][2] * c[2];
            b[1][x] = m[1][1] * c[1] + m[1][2] * c[2];
            b[2][x] = m[2][1] * c[1] + m[2][2] * c[2];
            b[3][x] = m[3][1] * c[1] + m[3][2] * c[2] + m[3][3] * c[3];
            if (k == 0) {
                now.point[x] = b[0][x];
                now.slope[x] = per * (b[1][x] - b[0][x]);
            }
        }
        bool more = true;
        while (more) {
            struct shape_vertex *v = &r->vertex[i];
            const bool at_vertex = i <= f->end && (v->u <= t[k + 4] || k == f->spans - 1);
            next.u = at_vertex ? v->u : t[k + 4];
            const double z = (next.u - t[k + 3]) / h, s = 1.0 - z;
            for (int x = 0; x < f->axes; x++) {
                const double p = s * b[0][x] + z * b[1][x], q = s * b[1][x] + z * b[2][x];
                const double w = s * b[2][x] + z * b[3][x];
                const double pq = s * p + z * q, qw = s * q + z * w;
                next.point[x] = s * pq + z * qw;
                next.slope[x] = per * (qw - pq);
            }
            if (i <= f->end) {
                prove(f, i, &now, &next);
            }
            if (at_vertex) {
                double sum = 0.0, along = 0.0, ss = 0.0, speed = 0.0;
                for (int x = 0; x < f->axes; x++) {
                    const double d = v->point[f->axis[x]] - next.point[x];
                    sum += d * d;
                    along += d * next.slope[x];
                    ss += next.slope[x] * next.slope[x];
                    const bool counts = f->axis[x] < 3 || f->axis[0] >= 3;     /* path.h's length */
                    speed += counts ? next.slope[x] * next.slope[x] : 0.0;
                }
                if (!(speed > SLOW * SLOW && speed < FAST * FAST)) {
                    f->worst = ASTRAY;
                    f->worst_vertex = i;
                }
                const bool tighter = i < f->end && v[1].tolerance < v->tolerance;
                const double ratio = tighter ? v->tolerance / v[1].tolerance : 1.0;
                note(f, i, sum * ratio * ratio);
                v->shift = ss > 0.0 ? along / ss : 0.0;
                i++;
                more = i <= f->end;
            } else {
                more = false;
            }
            now = next;
        }
    }
}
