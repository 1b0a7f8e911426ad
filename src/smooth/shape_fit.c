#include "shape_fit.h"

#include <math.h>
#include <string.h>

/* Boehm: the blossom at each knot four times. */
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

/* Adds weight * row row^T to the equations of control points k .. k + 3. */
static void add(double band[][SHAPE_BAND], int32_t k, const double row[4], double weight)
{
    for (int i = 0; i < 4; i++) {
        const double x = weight * row[i];
        for (int j = i; j < 4; j++) {
            band[k + i][j - i] += x * row[j];
        }
    }
}

/* Row of h1 (r'(between c1 and c2) - r'(between c0 and c1)) / 3 at a clamped end: 0 if r'' is. */
static void put_bend(struct shape_fit *f)
{
    const double *t = f->run->knot;
    memset(f->bend, 0, sizeof f->bend);
    double most = 0.0;

    for (int32_t k = 0; k < f->spans; k++) {
        double (*m)[4] = f->extract[k], row[4];
        const double h = t[k + 4] - t[k + 3];
        for (int i = 0; i < 4; i++) {
            row[i] = 6.0 / (h * h * h) * (m[3][i] - 3.0 * m[2][i] + 3.0 * m[1][i] - m[0][i]);
        }
        add(f->bend, k, row, h);
    }
    for (int32_t k = 0; k < f->spans; k++) {
        most = fmax(most, f->bend[k][0]);
    }
    const int32_t n = f->spans;
    if (!f->run->begun && !f->run->bound) {
        const double q = (t[4] - t[3]) / (t[5] - t[3]);
        add(f->bend, 0, (double[]){ 1.0, -1.0 - q, q, 0.0 }, 1e6 * most);
    }
    if (f->last && f->stop == NULL) {
        const double q = (t[n + 3] - t[n + 2]) / (t[n + 3] - t[n + 1]);
        add(f->bend, n - 1, (double[]){ 0.0, q, -1.0 - q, 1.0 }, 1e6 * most);
    }
}

/* The three control points of a state at a clamped end; h, h2: signed lengths of its spans. */
static void of_state(const struct piece_state *s, double h, double h2, double *c0, double *c1,
                     double *c2)
{
    for (int i = 0; i < AXES; i++) {
        c0[i] = s->point[i];
        c1[i] = s->point[i] + s->slope[i] * h / 3.0;
        c2[i] = c1[i] + (h + h2) / 3.0 * (s->slope[i] + 0.5 * h * s->bend[i]);
    }
}

/* Known control points. Returns how many at the left; *right: at the right. */
static int32_t put_known(struct shape_fit *f, int32_t *right)
{
    struct shape_run *r = f->run;
    const int32_t n = f->spans + 3;
    const double *t = r->knot;

    *right = 0;
    if (f->last && f->stop != NULL) {
        of_state(f->stop, t[n - 1] - t[n], t[n - 2] - t[n - 1], r->control[n - 1],
                 r->control[n - 2], r->control[n - 3]);
        *right = 3;
    } else if (f->last) {
        memcpy(r->control[n - 1], r->vertex[f->end].point, sizeof r->control[0]);
        *right = 1;
    }
    if (r->begun) {
        return 3;
    }
    if (r->bound) {
        of_state(&r->begin, t[4] - t[3], t[5] - t[4], r->control[0], r->control[1],
                 r->control[2]);
        return 3;
    }
    memcpy(r->control[0], r->vertex[0].point, sizeof r->control[0]);
    return 1;
}

/* Axes in which neither a vertex nor a known control point moves stay where they are. */
static void put_axes(struct shape_fit *f, int32_t left, int32_t right)
{
    struct shape_run *r = f->run;
    const int32_t n = f->spans + 3;

    f->axes = 0;
    for (int i = 0; i < AXES; i++) {
        const double x = r->control[0][i];
        bool moves = false;
        for (int32_t k = 0; k <= f->end && !moves; k++) {
            moves = r->vertex[k].point[i] != x;
        }
        for (int32_t k = 0; k < n && !moves; k++) {
            moves = (k < left || k >= n - right) && r->control[k][i] != x;
        }
        if (moves) {
            f->axis[f->axes++] = i;
        } else {
            for (int32_t k = 0; k < n; k++) {
                r->control[k][i] = x;
            }
        }
    }
}

static void bernstein3(double t, double b[4])
{
    const double s = 1.0 - t;
    b[0] = s * s * s;
    b[1] = 3.0 * s * s * t;
    b[2] = 3.0 * s * t * t;
    b[3] = t * t * t;
}

static void assemble(struct shape_fit *f)
{
    const struct shape_run *r = f->run;
    const double *t = r->knot;
    int32_t k = 0;

    memcpy(f->band, f->bend, sizeof f->band);
    memset(f->right, 0, sizeof f->right);
    for (int32_t i = 1; i <= f->end; i++) {
        const struct shape_vertex *v = &r->vertex[i];
        double b[4], row[4];
        while (k < f->spans - 1 && v->u > t[k + 4]) {
            k++;
        }
        const double (*m)[4] = (const double (*)[4])f->extract[k];
        bernstein3((v->u - t[k + 3]) / (t[k + 4] - t[k + 3]), b);
        row[0] = b[0] * m[0][0];
        row[1] = b[0] * m[0][1] + b[1] * m[1][1] + b[2] * m[2][1] + b[3] * m[3][1];
        row[2] = b[0] * m[0][2] + b[1] * m[1][2] + b[2] * m[2][2] + b[3] * m[3][2];
        row[3] = b[3] * m[3][3];
        add(f->band, k, row, v->weight);
        for (int j = 0; j < 4; j++) {
            const double x = v->weight * row[j];
            for (int a = 0; a < f->axes; a++) {
                f->right[k + j][a] += x * v->point[f->axis[a]];
            }
        }
    }
}

/* Cholesky without roots, L D L^T in a band; known control points leave their columns. */
static void solve(struct shape_fit *f)
{
    struct shape_run *r = f->run;
    const int32_t n = f->spans + 3, first = f->left, last = n - f->known_right;
    double (*a)[SHAPE_BAND] = f->band;

    for (int32_t i = 0; i < n; i++) {
        for (int j = 1; j < SHAPE_BAND && i + j < n; j++) {
            const int32_t k = i + j;
            const bool known_i = i < first || i >= last, known_k = k < first || k >= last;
            for (int x = 0; x < f->axes && known_i != known_k; x++) {
                if (known_i) {
                    f->right[k][x] -= a[i][j] * r->control[i][f->axis[x]];
                } else {
                    f->right[i][x] -= a[i][j] * r->control[k][f->axis[x]];
                }
            }
        }
    }
    for (int32_t i = first; i < last; i++) {
        const double inverse = 1.0 / a[i][0];
        for (int j = 1; j < SHAPE_BAND && i + j < last; j++) {
            const double l = a[i][j] * inverse;
            for (int m = j; m < SHAPE_BAND && i + m < last; m++) {
                a[i + j][m - j] -= l * a[i][m];
            }
            for (int x = 0; x < f->axes; x++) {
                f->right[i + j][x] -= l * f->right[i][x];
            }
        }
        for (int x = 0; x < f->axes; x++) {
            f->right[i][x] *= inverse;
        }
        for (int j = 1; j < SHAPE_BAND; j++) {
            a[i][j] *= inverse;
        }
    }
    for (int32_t i = last - 1; i >= first; i--) {
        for (int x = 0; x < f->axes; x++) {
            double c = f->right[i][x];
            for (int j = 1; j < SHAPE_BAND && i + j < last; j++) {
                c -= a[i][j] * f->right[i + j][x];
            }
            f->right[i][x] = c;
            r->control[i][f->axis[x]] = c;
        }
    }
    /* r'' = 0 exactly where it was asked for by weight */
    const double *t = r->knot;
    for (int x = 0; x < f->axes; x++) {
        const int i = f->axis[x];
        if (!r->begun && !r->bound) {
            const double q = (t[5] - t[3]) / (t[4] - t[3]);
            r->control[2][i] = r->control[1][i] + q * (r->control[1][i] - r->control[0][i]);
        }
        if (f->last && f->stop == NULL) {
            const double q = (t[n] - t[n - 2]) / (t[n] - t[n - 1]);
            r->control[n - 3][i] = r->control[n - 2][i]
                + q * (r->control[n - 2][i] - r->control[n - 1][i]);
        }
    }
}

void shape_fit_prepare(struct shape_fit *f)
{
    for (int32_t k = 0; k < f->spans; k++) {
        shape_extract(f->run->knot + k, f->extract[k]);
    }
    put_bend(f);
    f->left = put_known(f, &f->known_right);
    put_axes(f, f->left, f->known_right);
}

void shape_fit_solve(struct shape_fit *f)
{
    assemble(f);
    solve(f);
}
