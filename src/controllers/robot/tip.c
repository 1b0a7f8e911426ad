#include "tip.h"

#include <math.h>
#include <string.h>

/* A pivot below this share of the largest one counts as 0: the orientations in which the tip was
 * touched do not differ enough. */
static const double PIVOT = 1e-9;

/* Normal equations of the tip alone: with the mean over all touches taken off, R_i t + p_i loses
 * the point.
 * CCN 20: most of it are loops over the three axes, as the equations have sums. */
int tip_solve(const struct pose *flange, int count, double tip[3], double *rms)
{
    double r[TIP_POSES][3][3], mean[3][3] = { { 0 } }, at[3] = { 0 }, a[3][4] = { { 0 } };

    if (count < 3 || count > TIP_POSES) {
        return 1;
    }
    for (int n = 0; n < count; n++) {
        quaternion_matrix(flange[n].turn, r[n]);
        for (int i = 0; i < 3; i++) {
            at[i] += flange[n].at[i] / count;
            for (int k = 0; k < 3; k++) {
                mean[i][k] += r[n][i][k] / count;
            }
        }
    }
    for (int n = 0; n < count; n++) {
        for (int row = 0; row < 3; row++) {
            double c[3];
            for (int k = 0; k < 3; k++) {
                c[k] = r[n][row][k] - mean[row][k];
            }
            for (int i = 0; i < 3; i++) {
                for (int k = 0; k < 3; k++) {
                    a[i][k] += c[i] * c[k];
                }
                a[i][3] -= c[i] * (flange[n].at[row] - at[row]);
            }
        }
    }
    for (int n = 0; n < 3; n++) { /* symmetric and positive: pivots in order */
        if (!(a[n][n] > PIVOT)) {
            return 1;
        }
        for (int i = n + 1; i < 3; i++) {
            const double f = a[i][n] / a[n][n];
            for (int k = n; k < 4; k++) {
                a[i][k] -= f * a[n][k];
            }
        }
    }
    for (int n = 2; n >= 0; n--) {
        tip[n] = a[n][3];
        for (int k = n + 1; k < 3; k++) {
            tip[n] -= a[n][k] * tip[k];
        }
        tip[n] /= a[n][n];
    }
    double sum = 0.0;
    for (int n = 0; n < count; n++) {
        for (int i = 0; i < 3; i++) {
            double off = flange[n].at[i] - at[i];
            for (int k = 0; k < 3; k++) {
                off += (r[n][i][k] - mean[i][k]) * tip[k];
            }
            sum += off * off / count;
        }
    }
    *rms = sqrt(sum);
    return 0;
}
