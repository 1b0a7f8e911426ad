#include "bernstein.h"

/* De Casteljau: means of neighbours until one is left. */
void bernstein_cut(double c[], int n, double t, double before[])
{
    for (int k = n; k > 0; k--) {
        before[n - k] = c[0];
        for (int i = 0; i < k; i++) {
            c[i] = (1.0 - t) * c[i] + t * c[i + 1];
        }
    }
    before[n] = c[0];
}

/* The polynomial is cut at t1, then at t0. */
void bernstein_part(double c[], int n, double t0, double t1)
{
    for (int k = n; k > 0 && t1 < 1.0; k--) {
        for (int i = n; i > n - k; i--) {
            c[i] = (1.0 - t1) * c[i - 1] + t1 * c[i];
        }
    }
    const double t = t0 / t1;
    for (int k = n; k > 0 && t0 > 0.0; k--) {
        for (int i = 0; i < k; i++) {
            c[i] = (1.0 - t) * c[i] + t * c[i + 1];
        }
    }
}
