/* Candidate integrators for a plant, over a trajectory of held inputs: what the table in
 * fmus/hydraulic_axis/README.md was measured with. bench_run advances x by `steps` micro steps of
 * h [s] and writes x after each; the tolerance counts for adaptive methods, n for fixed steps.
 */
#include <math.h>
#include <string.h>

#include "plant.h"

enum { N = PLANT_STATES };

static double scale[N]; /* what 1 is for each state in the error norm */
static double h_next;   /* [s] step that the error control asks for */

long bench_rhs_calls, bench_jacobian_calls;

void plant_slope(const double *x, const double *u, const double *p, double *jacobian);

static void rhs(const double *x, const double *u, const double *c, double *dx)
{
    bench_rhs_calls++;
    plant_rhs_1(x, u, c, dx);
}

/* Explicit method of s stages: y += h sum b k, error h sum e k. */
struct explicit_method {
    int stages, order;
    double a[7][7], b[7], e[7];
};

static const struct explicit_method rk4 = {
    4, 4, { { 0 }, { 0.5 }, { 0, 0.5 }, { 0, 0, 1 } }, { 1 / 6.0, 1 / 3.0, 1 / 3.0, 1 / 6.0 }, { 0 }
};

static const struct explicit_method bogacki_shampine = {
    4,
    3,
    { { 0 }, { 0.5 }, { 0, 0.75 }, { 2 / 9.0, 1 / 3.0, 4 / 9.0 } },
    { 2 / 9.0, 1 / 3.0, 4 / 9.0, 0 },
    { 2 / 9.0 - 7 / 24.0, 1 / 3.0 - 0.25, 4 / 9.0 - 1 / 3.0, -0.125 }
};

static const struct explicit_method dormand_prince = {
    7,
    5,
    { { 0 },
      { 0.2 },
      { 3 / 40.0, 9 / 40.0 },
      { 44 / 45.0, -56 / 15.0, 32 / 9.0 },
      { 19372 / 6561.0, -25360 / 2187.0, 64448 / 6561.0, -212 / 729.0 },
      { 9017 / 3168.0, -355 / 33.0, 46732 / 5247.0, 49 / 176.0, -5103 / 18656.0 },
      { 35 / 384.0, 0, 500 / 1113.0, 125 / 192.0, -2187 / 6784.0, 11 / 84.0 } },
    { 35 / 384.0, 0, 500 / 1113.0, 125 / 192.0, -2187 / 6784.0, 11 / 84.0, 0 },
    { 71 / 57600.0, 0, -71 / 16695.0, 71 / 1920.0, -17253 / 339200.0, 22 / 525.0, -1 / 40.0 }
};

static double norm(const double *error, const double *x)
{
    double worst = 0.0;
    for (int i = 0; i < N; i++) {
        (void)x;
        const double e = fabs(error[i]) / scale[i];
        worst = e > worst || isnan(e) ? e : worst;
    }
    return worst;
}

static double explicit_step(const struct explicit_method *m, const double *x, const double *u,
                            const double *c, double h, double *y)
{
    double k[7][N], error[N] = { 0 };
    memcpy(y, x, N * sizeof *x);
    for (int s = 0; s < m->stages; s++) {
        double at[N];
        for (int i = 0; i < N; i++) {
            double sum = 0.0;
            for (int q = 0; q < s; q++) {
                sum += m->a[s][q] * k[q][i];
            }
            at[i] = x[i] + h * sum;
        }
        rhs(at, u, c, k[s]);
        for (int i = 0; i < N; i++) {
            y[i] += h * m->b[s] * k[s][i];
            error[i] += h * m->e[s] * k[s][i];
        }
    }
    return norm(error, x);
}

/* LU decomposition with partial pivoting of a, N x N. */
static void decompose(double *a, int *pivot)
{
    for (int k = 0; k < N; k++) {
        int best = k;
        for (int i = k + 1; i < N; i++) {
            best = fabs(a[i * N + k]) > fabs(a[best * N + k]) ? i : best;
        }
        pivot[k] = best;
        for (int j = 0; best != k && j < N; j++) {
            const double t = a[k * N + j];
            a[k * N + j] = a[best * N + j];
            a[best * N + j] = t;
        }
        for (int i = k + 1; i < N; i++) {
            const double f = a[i * N + k] / a[k * N + k];
            a[i * N + k] = f;
            for (int j = k + 1; f != 0.0 && j < N; j++) {
                a[i * N + j] -= f * a[k * N + j];
            }
        }
    }
}

static void solve(const double *a, const int *pivot, double *b)
{
    for (int k = 0; k < N; k++) {
        const double t = b[k];
        b[k] = b[pivot[k]];
        b[pivot[k]] = t;
    }
    for (int i = 0; i < N; i++) {
        for (int j = 0; j < i; j++) {
            b[i] -= a[i * N + j] * b[j];
        }
    }
    for (int i = N - 1; i >= 0; i--) {
        for (int j = i + 1; j < N; j++) {
            b[i] -= a[i * N + j] * b[j];
        }
        b[i] /= a[i * N + i];
    }
}

/* RODAS of Hairer and Wanner: six stages, order 4(3), L-stable, for autonomous equations. */
static double rodas_step(const double *x, const double *u, const double *p, const double *c,
                         double h, double *y)
{
    static const double a[6][5] = {
        { 0 },
        { 1.544 },
        { 0.9466785280815826, 0.2557011698983284 },
        { 3.314825187068521, 2.896124015972201, 0.9986419139977817 },
        { 1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950 },
        { 1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950, 1.0 }
    };
    static const double g[6][5] = { { 0 },
                                    { -5.6688 },
                                    { -2.430093356833875, -0.2063599157091915 },
                                    { -0.1073529058151375, -9.594562251023355, -20.47028614809616 },
                                    { 7.496443313967647, -10.24680431464352, -33.99990352819905,
                                      11.70890893206160 },
                                    { 8.083246795921522, -7.981132988064893, -31.52159432874371,
                                      16.31930543123136, -6.058818238834054 } };
    double k[6][N], w[N * N];
    int pivot[N];
    bench_jacobian_calls++;
    plant_slope(x, u, p, w);
    for (int i = 0; i < N * N; i++) {
        w[i] = -w[i];
    }
    for (int i = 0; i < N; i++) {
        w[i * N + i] += 1.0 / (0.25 * h);
    }
    decompose(w, pivot);
    for (int s = 0; s < 6; s++) {
        double f[N];
        memcpy(y, x, N * sizeof *x);
        for (int q = 0; q < s; q++) {
            for (int i = 0; i < N; i++) {
                y[i] += a[s][q] * k[q][i];
            }
        }
        rhs(y, u, c, f);
        for (int i = 0; i < N; i++) {
            for (int q = 0; q < s; q++) {
                f[i] += g[s][q] / h * k[q][i];
            }
        }
        solve(w, pivot, f);
        memcpy(k[s], f, sizeof f);
    }
    for (int i = 0; i < N; i++) {
        y[i] += k[5][i];
    }
    return norm(k[5], x);
}

static double any_step(int method, const double *x, const double *u, const double *p,
                       const double *c, double h, double *y)
{
    switch (method) {
    case 0:  return explicit_step(&rk4, x, u, c, h, y);
    case 1:  return explicit_step(&bogacki_shampine, x, u, c, h, y);
    case 2:  return explicit_step(&dormand_prince, x, u, c, h, y);
    default: return rodas_step(x, u, p, c, h, y);
    }
}

void bench_begin(const double *scales)
{
    memcpy(scale, scales, sizeof scale);
    h_next = 1.0;
    bench_rhs_calls = bench_jacobian_calls = 0;
}

/* n > 0: n equal steps per micro step; n = 0: steps by the error. */
void bench_run(int method, int n, double tolerance, double h, long steps, const double *u,
               const double *p, double *x, double *shown)
{
    static const double order[] = { 4, 3, 5, 4 };
    double c[PLANT_CONSTANTS], y[N];
    plant_constants(p, c);
    for (long k = 0; k < steps; k++) {
        for (int q = 0; q < n; q++) {
            any_step(method, x, u, p, c, h / n, y);
            memcpy(x, y, sizeof y);
        }
        for (double left = h; n == 0 && left > 0.0;) {
            const double share = ceil(left / h_next * (1.0 - 1e-9));
            const double trial = share <= 1.0 ? left : share <= 2.0 ? 0.5 * left : h_next;
            const double error = any_step(method, x, u, p, c, trial, y) / tolerance;
            double factor = error > 0.0 ? 0.9 * pow(error, -1.0 / order[method]) : 5.0;
            factor = factor > 5.0 ? 5.0 : factor < 0.2 || isnan(factor) ? 0.2 : factor;
            if (error <= 1.0) {
                memcpy(x, y, sizeof y);
                left = trial < left ? left - trial : 0.0;
                h_next = trial * factor > h_next || factor < 1.0 ? trial * factor : h_next;
            } else {
                h_next = trial * (factor < 0.9 ? factor : 0.9);
            }
        }
        if (shown) {
            memcpy(&shown[k * N], x, N * sizeof *x);
        }
    }
}
