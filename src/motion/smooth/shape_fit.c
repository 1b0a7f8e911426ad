#include "shape_fit.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

/* The blossom of the spline at both ends of the span, as Boehm has it (docs/theory). */
void shape_extract(const double t[7], double m[4][4])
{
    const double a = t[1], b = t[2], c = t[3], d = t[4], e = t[5], g = t[6];
    const double x1 = (e - c) / (e - b), x2 = (e - d) / (e - b), y = (d - c) / (d - b);
    const double z = (d - c) / (d - a), w = (d - c) / (e - c), q = (d - c) / (g - c);
    memset(m, 0, 16 * sizeof m[0][0]);
    m[1][1] = x1;
    m[1][2] = 1.0 - x1;
    m[2][1] = x2;
    m[2][2] = 1.0 - x2;
    m[0][0] = y * z;
    m[0][1] = y * (1.0 - z) + (1.0 - y) * x1;
    m[0][2] = (1.0 - y) * (1.0 - x1);
    m[3][1] = (1.0 - w) * x2;
    m[3][2] = (1.0 - w) * (1.0 - x2) + w * (1.0 - q);
    m[3][3] = w * q;
}

/* Equations of integral |r'''|^2. A clamped end without a state gets a heavy row for r'' = 0 there:
 * h1 (r'(between c1 and c2) - r'(between c0 and c1)) / 3 = 0. */
static void put_bend(struct shape_fit *f)
{
    const double *t = f->run->knot;
    memset(f->bend, 0, (size_t)(f->spans + 3) * sizeof f->bend[0]);
    double most = 0.0;

    for (int32_t k = 0; k < f->spans; k++) {
        double(*m)[4] = f->extract[k], row[4];
        const double h = t[k + 4] - t[k + 3];
        for (int i = 0; i < 4; i++) {
            row[i] = 6.0 / (h * h * h) * (m[3][i] - 3.0 * m[2][i] + 3.0 * m[1][i] - m[0][i]);
        }
        shape_solve_add(f->bend, k, row, h);
    }
    for (int32_t k = 0; k < f->spans; k++) {
        most = el_max(most, f->bend[k][0]);
    }
    const int32_t n = f->spans;
    if (!f->run->begun && !f->run->bound) {
        const double q = (t[4] - t[3]) / (t[5] - t[3]);
        shape_solve_add(f->bend, 0, (double[]){ 1.0, -1.0 - q, q, 0.0 }, 1e6 * most);
    }
    if (f->last && f->stop == NULL) {
        const double q = (t[n + 3] - t[n + 2]) / (t[n + 3] - t[n + 1]);
        shape_solve_add(f->bend, n - 1, (double[]){ 0.0, q, -1.0 - q, 1.0 }, 1e6 * most);
    }
}

/* The three control points of a state at a clamped end; h, h2: signed lengths of its spans. */
static void of_state(const struct shape_run *r, const struct segment_state *s, double h, double h2,
                     double *c0, double *c1, double *c2)
{
    for (int i = 0; i < AXES; i++) {
        c0[i] = s->point[i] - r->origin[i];
        c1[i] = c0[i] + s->slope[i] * h / 3.0;
        c2[i] = c1[i] + (h + h2) / 3.0 * (s->slope[i] + 0.5 * h * s->bend[i]);
    }
}

/* Set the control points that are known at both ends. */
static void put_known(struct shape_fit *f)
{
    struct shape_run *r = f->run;
    const int32_t n = f->spans + 3;
    const double *t = r->knot;

    if (!r->begun) {
        memcpy(r->origin, r->bound ? r->begin.point : r->vertex[0].point, sizeof r->origin);
    }
    f->known_right = 0;
    if (f->last && f->stop != NULL) {
        of_state(r, f->stop, t[n - 1] - t[n], t[n - 2] - t[n - 1], r->control[n - 1],
                 r->control[n - 2], r->control[n - 3]);
        f->known_right = 3;
    } else if (f->last) {
        for (int i = 0; i < AXES; i++) {
            r->control[n - 1][i] = r->vertex[f->end].point[i] - r->origin[i];
        }
        f->known_right = 1;
    }
    f->left = r->begun || r->bound ? 3 : 1;
    if (!r->begun && r->bound) {
        of_state(r, &r->begin, t[4] - t[3], t[5] - t[4], r->control[0], r->control[1],
                 r->control[2]);
    } else if (!r->begun) {
        memset(r->control[0], 0, sizeof r->control[0]);
    }
}

/* Axes in which a vertex or a known control point moves, and another one if their number is odd:
 * sums are made for two at a time. */
static void put_axes(struct shape_fit *f)
{
    const struct shape_run *r = f->run;
    const int32_t n = f->spans + 3;
    int still = 0;

    f->axes = 0;
    for (int i = 0; i < AXES; i++) {
        const double x = r->control[0][i];
        bool moves = false;
        for (int32_t k = 0; k <= f->end && !moves; k++) {
            moves = r->vertex[k].point[i] - r->origin[i] != x;
        }
        for (int32_t k = 0; k < n && !moves; k++) {
            moves = (k < f->left || k >= n - f->known_right) && r->control[k][i] != x;
        }
        if (moves) {
            f->axis[f->axes++] = i;
        } else {
            still = i;
        }
    }
    if (f->axes % 2 == 1) {
        f->axis[f->axes++] = still;
    }
}

/* An axis that does not move has the first coordinate at all control points. */
static void hold_axes(struct shape_fit *f)
{
    struct shape_run *r = f->run;

    for (int i = 0; i < AXES; i++) {
        bool moves = false;
        for (int x = 0; x < f->axes; x++) {
            moves = moves || f->axis[x] == i;
        }
        for (int32_t k = 1; k < f->spans + 3 && !moves; k++) {
            r->control[k][i] = r->control[0][i];
        }
    }
}

void shape_fit_prepare(struct shape_fit *f)
{
    const struct shape_vertex *v = f->run->vertex;

    for (int32_t k = 0; k < f->spans; k++) {
        shape_extract(f->run->knot + k, f->extract[k]);
    }
    put_bend(f);
    put_known(f);
    put_axes(f);
    hold_axes(f);
    for (int32_t i = 1; i <= f->end; i++) {
        const bool less = i < f->end && v[i + 1].tolerance < v[i].tolerance;
        const double most = SHAPE_USED * v[i + less].tolerance;
        f->per[i] = 1.0 / (most * most);
    }
}

void shape_fit_split(struct shape_fit *f, int32_t spans, const double knot[])
{
    double *old = f->run->knot;

    for (int32_t k = spans - 1, j = f->spans - 1; k >= 0; k--) { /* j: the old span */
        if (memcmp(knot + k + 1, old + j + 1, 6 * sizeof knot[0]) == 0) {
            memmove(f->extract[k], f->extract[j], sizeof f->extract[k]);
        } else {
            shape_extract(knot + k, f->extract[k]);
        }
        j -= knot[k + 3] <= old[j + 3];
    }
    memcpy(old, knot, (size_t)(spans + 7) * sizeof knot[0]);
    f->spans = f->run->spans = spans;
    put_bend(f);
    put_known(f);
    hold_axes(f);
}
