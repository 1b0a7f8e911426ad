#include "shape_fit.h"

#include <string.h>

void shape_solve_add(double band[][SHAPE_BAND], int32_t k, const double row[4], double weight)
{
    const double x = weight * row[0], y = weight * row[1], z = weight * row[2];

    band[k][0] += x * row[0];
    band[k][1] += x * row[1];
    band[k][2] += x * row[2];
    band[k][3] += x * row[3];
    band[k + 1][0] += y * row[1];
    band[k + 1][1] += y * row[2];
    band[k + 1][2] += y * row[3];
    band[k + 2][0] += z * row[2];
    band[k + 2][1] += z * row[3];
    band[k + 3][0] += weight * row[3] * row[3];
}

/* Shares of the four control points of a span in its place at t = 0 .. 1. */
static inline void put_row(const struct shape_fit *f, int32_t span, double t, double row[4])
{
    const double(*m)[4] = (const double(*)[4])f->extract[span];
    const double s = 1.0 - t, both = 3.0 * s * t;
    const double b0 = s * s * s, b1 = both * s, b2 = both * t, b3 = t * t * t;

    row[0] = b0 * m[0][0];
    row[1] = b0 * m[0][1] + b1 * m[1][1] + b2 * m[2][1] + b3 * m[3][1];
    row[2] = b0 * m[0][2] + b1 * m[1][2] + b2 * m[2][2] + b3 * m[3][2];
    row[3] = b3 * m[3][3];
}

/* Adds weight |r(u) - vertex|^2 to the equations. */
static void add_vertex(struct shape_fit *f, int32_t vertex, int32_t span, double weight)
{
    const double *row = f->row[vertex], *point = f->run->vertex[vertex].point;
    const double x[4] = { weight * row[0], weight * row[1], weight * row[2], weight * row[3] };

    shape_solve_add(f->band, span, row, weight);
    for (int a = 0; a < f->axes; a++) {
        const double p = point[f->axis[a]] - f->run->origin[f->axis[a]];
        f->right[span][a] += x[0] * p;
        f->right[span + 1][a] += x[1] * p;
        f->right[span + 2][a] += x[2] * p;
        f->right[span + 3][a] += x[3] * p;
    }
}

/* Adds all vertices of a span to the equations, sum by sum. */
static void add_span(struct shape_fit *f, int32_t span)
{
    const int32_t from = f->first[span], to = f->first[span + 1];
    const struct shape_vertex *v = f->run->vertex;
    double(*b)[SHAPE_BAND] = f->band + span;
    double b00 = 0.0, b01 = 0.0, b02 = 0.0, b03 = 0.0, b11 = 0.0, b12 = 0.0, b13 = 0.0;
    double b22 = 0.0, b23 = 0.0, b33 = 0.0;

    for (int32_t i = from; i < to; i++) {
        const double *row = f->row[i], r1 = row[1], r2 = row[2], r3 = row[3];
        const double x = v[i].weight * row[0], y = v[i].weight * r1, z = v[i].weight * r2;
        b00 += x * row[0];
        b01 += x * r1;
        b02 += x * r2;
        b03 += x * r3;
        b11 += y * r1;
        b12 += y * r2;
        b13 += y * r3;
        b22 += z * r2;
        b23 += z * r3;
        b33 += v[i].weight * r3 * r3;
    }
    b[0][0] += b00;
    b[0][1] += b01;
    b[0][2] += b02;
    b[0][3] += b03;
    b[1][0] += b11;
    b[1][1] += b12;
    b[1][2] += b13;
    b[2][0] += b22;
    b[2][1] += b23;
    b[3][0] += b33;
    for (int x = 0; x < f->axes; x += 2) {
        const int a = f->axis[x], c = f->axis[x + 1];
        const double *origin = f->run->origin;
        double p[4] = { 0.0 }, q[4] = { 0.0 };
        for (int32_t i = from; i < to; i++) {
            const double *row = f->row[i], w = v[i].weight;
            const double y = w * (v[i].point[a] - origin[a]), z = w * (v[i].point[c] - origin[c]);
            p[0] += y * row[0];
            p[1] += y * row[1];
            p[2] += y * row[2];
            p[3] += y * row[3];
            q[0] += z * row[0];
            q[1] += z * row[1];
            q[2] += z * row[2];
            q[3] += z * row[3];
        }
        for (int k = 0; k < 4; k++) {
            f->right[span + k][x] += p[k];
            f->right[span + k][x + 1] += q[k];
        }
    }
}

void shape_solve_assemble(struct shape_fit *f)
{
    const struct shape_vertex *v = f->run->vertex;
    const double *t = f->run->knot;
    int32_t i = 1;

    memcpy(f->band, f->bend, (size_t)(f->spans + 3) * sizeof f->band[0]);
    memset(f->right, 0, (size_t)(f->spans + 3) * sizeof f->right[0]);
    for (int32_t k = 0; k < f->spans; k++) {
        const double per = 1.0 / (t[k + 4] - t[k + 3]);
        f->first[k] = i;
        for (; i <= f->end && (v[i].u <= t[k + 4] || k == f->spans - 1); i++) {
            put_row(f, k, (v[i].u - t[k + 3]) * per, f->row[i]);
        }
        f->first[k + 1] = i;
        add_span(f, k);
    }
}

void shape_solve_change(struct shape_fit *f, int32_t vertex, int32_t span, double weight, double u)
{
    struct shape_vertex *v = &f->run->vertex[vertex];
    const double *t = f->run->knot + span;

    add_vertex(f, vertex, span, -v->weight);
    v->weight = weight;
    v->u = u;
    put_row(f, span, (u - t[3]) / (t[4] - t[3]), f->row[vertex]);
    add_vertex(f, vertex, span, weight);
}

/* Takes known control points to the right side. */
static void take_known(const struct shape_fit *f, int32_t first, int32_t last, double right[][AXES])
{
    const struct shape_run *r = f->run;

    for (int j = 1; j < SHAPE_BAND; j++) {
        for (int x = 0; x < f->axes; x++) {
            for (int32_t k = first; k < first + j && k < last; k++) {
                if (k - j >= 0) {
                    right[k][x] -= f->band[k - j][j] * r->control[k - j][f->axis[x]];
                }
            }
            for (int32_t k = last - 1; k >= last - j && k >= first; k--) {
                if (k + j < f->spans + 3) {
                    right[k][x] -= f->band[k][j] * r->control[k + j][f->axis[x]];
                }
            }
        }
    }
}

/* Cholesky without roots, L D L^T in a band; known control points leave their columns. */
void shape_solve(struct shape_fit *f)
{
    struct shape_run *r = f->run;
    const int32_t n = f->spans + 3, first = f->left, last = n - f->known_right;
    double a[SHAPE_CONTROLS + 3][SHAPE_BAND], right[SHAPE_CONTROLS + 3][AXES];

    memcpy(a, f->band, (size_t)n * sizeof a[0]);
    memcpy(right, f->right, (size_t)n * sizeof right[0]);
    take_known(f, first, last, right);
    memset(a + last, 0, 3 * sizeof a[0]); /* nothing behind the last */
    memset(right + last, 0, 3 * sizeof right[0]);
    for (int32_t i = first; i < last; i++) {
        const double inverse = 1.0 / a[i][0], a1 = a[i][1], a2 = a[i][2], a3 = a[i][3];
        const double l1 = a1 * inverse, l2 = a2 * inverse, l3 = a3 * inverse;
        a[i + 1][0] -= l1 * a1;
        a[i + 1][1] -= l1 * a2;
        a[i + 1][2] -= l1 * a3;
        a[i + 2][0] -= l2 * a2;
        a[i + 2][1] -= l2 * a3;
        a[i + 3][0] -= l3 * a3;
        a[i][1] = l1;
        a[i][2] = l2;
        a[i][3] = l3;
        for (int x = 0; x < f->axes; x += 2) {
            const double b = right[i][x], c = right[i][x + 1];
            right[i + 1][x] -= l1 * b;
            right[i + 1][x + 1] -= l1 * c;
            right[i + 2][x] -= l2 * b;
            right[i + 2][x + 1] -= l2 * c;
            right[i + 3][x] -= l3 * b;
            right[i + 3][x + 1] -= l3 * c;
            right[i][x] = b * inverse;
            right[i][x + 1] = c * inverse;
        }
    }
    memset(right + last, 0, 3 * sizeof right[0]);
    for (int32_t i = last - 1; i >= first; i--) {
        const double a1 = a[i][1], a2 = a[i][2], a3 = a[i][3];
        for (int x = 0; x < f->axes; x += 2) {
            const double b =
                right[i][x] - a1 * right[i + 1][x] - a2 * right[i + 2][x] - a3 * right[i + 3][x];
            const double c = right[i][x + 1] - a1 * right[i + 1][x + 1] - a2 * right[i + 2][x + 1]
                             - a3 * right[i + 3][x + 1];
            r->control[i][f->axis[x]] = right[i][x] = b;
            r->control[i][f->axis[x + 1]] = right[i][x + 1] = c;
        }
    }
    /* r'' is exactly 0 where a heavy row has made it nearly so */
    const double *t = r->knot;
    for (int x = 0; x < f->axes; x++) {
        const int i = f->axis[x];
        if (!r->begun && !r->bound) {
            const double q = (t[5] - t[3]) / (t[4] - t[3]);
            r->control[2][i] = r->control[1][i] + q * (r->control[1][i] - r->control[0][i]);
        }
        if (f->last && f->stop == NULL) {
            const double q = (t[n] - t[n - 2]) / (t[n] - t[n - 1]);
            r->control[n - 3][i] =
                r->control[n - 2][i] + q * (r->control[n - 2][i] - r->control[n - 1][i]);
        }
    }
}
