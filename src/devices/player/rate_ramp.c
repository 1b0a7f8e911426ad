#include "rate_ramp.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

double rate_ramp_slope_most(const struct rate_bounds *b, double rate)
{
    const double p = 1.0 - b->reserve, square = 1.0 - p * rate * rate,
                 cube = 1.0 - p * rate * rate * rate;
    double most = INFINITY;

    for (int i = 0; i < RATE_RAMP_AXES; i++) {
        if (b->speed[i] > 0.0) {
            most = el_min(most, square * b->acc[i] / b->speed[i]);
            if (b->jerk[i] > 0.0 && p * rate > 0.0) {
                most = el_min(most, cube * b->jerk[i] / (6.0 * rate * p * b->acc[i]));
            }
        }
    }
    return most;
}

double rate_ramp_bend_most(const struct rate_bounds *b, double rate)
{
    const double cube = 1.0 - (1.0 - b->reserve) * rate * rate * rate;
    double most = INFINITY;

    for (int i = 0; i < RATE_RAMP_AXES; i++) {
        if (b->speed[i] > 0.0 && b->jerk[i] > 0.0) {
            most = el_min(most, cube * b->jerk[i] / (2.0 * b->speed[i]));
        }
    }
    return most;
}

/* Largest change of r'^2 between the nodes k and k + 1, whose rates are known. */
static double change(const struct rate_ramp *r, const struct rate_bounds *b, int k)
{
    return 2.0 * rate_ramp_bend_most(b, el_max(r->rate[k], r->rate[k + 1]))
           * fabs(r->rate[k + 1] - r->rate[k]);
}

/* Set the nodes' times and the slopes' signs from the sizes of the slopes. Between two nodes r'^2
 * is linear in r, so the mean slope is the mean of the two. */
static void run_through(struct rate_ramp *r)
{
    const double sign = r->rate[r->pieces] < r->rate[0] ? -1.0 : 1.0;

    r->time[0] = 0.0;
    for (int k = 0; k < r->pieces; k++) {
        r->time[k + 1] =
            r->time[k] + 2.0 * fabs(r->rate[k + 1] - r->rate[k]) / (r->slope[k] + r->slope[k + 1]);
    }
    for (int k = 0; k <= r->pieces; k++) {
        r->slope[k] *= sign;
    }
}

void rate_ramp_make(struct rate_ramp *r, const struct rate_bounds *b, double from, double to)
{
    enum { N = RATE_RAMP_PIECES };
    double square[N + 1], most;

    memset(r, 0, sizeof *r);
    r->rate[0] = from;
    if (from == to || isinf(rate_ramp_slope_most(b, 1.0))) {
        r->rate[0] = to; /* no axis limits the rate: it changes at once */
        return;
    }
    r->pieces = N;
    for (int k = 0; k <= N; k++) {
        const double x = (double)k / N; /* finer at both ends, where r' changes most */
        r->rate[k] = k < N ? from + (to - from) * x * x * (3.0 - 2.0 * x) : to;
    }
    square[0] = 0.0;
    for (int k = 0; k < N; k++) {
        most = rate_ramp_slope_most(b, el_max(r->rate[k], r->rate[k + 1]));
        square[k] = el_min(square[k], most * most);
        square[k + 1] = el_min(square[k] + change(r, b, k), most * most);
    }
    square[N] = 0.0;
    for (int k = N - 1; k >= 0; k--) {
        square[k] = el_min(square[k], square[k + 1] + change(r, b, k));
    }
    for (int k = 0; k <= N; k++) {
        r->slope[k] = sqrt(square[k]);
    }
    run_through(r);
}

/* Index of the latest node at or before a time [s]. */
static int node(const struct rate_ramp *r, double time)
{
    int k = 0;

    while (k < r->pieces && time >= r->time[k + 1]) {
        k++;
    }
    return k;
}

double rate_ramp_at(const struct rate_ramp *r, double time, double *slope)
{
    const int k = node(r, time);
    const double t = time - r->time[k];

    if (k == r->pieces || t <= 0.0) {
        *slope = k == r->pieces ? 0.0 : r->slope[k];
        return r->rate[k];
    }
    const double bend = (r->slope[k + 1] - r->slope[k]) / (r->time[k + 1] - r->time[k]);
    *slope = r->slope[k] + bend * t;
    return r->rate[k] + t * (r->slope[k] + 0.5 * bend * t);
}

void rate_ramp_brake(struct rate_ramp *r, const struct rate_bounds *b, double time)
{
    const struct rate_ramp old = *r;
    double slope;

    memset(r, 0, sizeof *r);
    r->rate[0] = rate_ramp_at(&old, time, &slope);
    r->slope[0] = fabs(slope);
    for (int k = node(&old, time); k < old.pieces && r->slope[r->pieces] > 0.0; k++) {
        const int n = r->pieces;
        const double bend = rate_ramp_bend_most(b, el_max(old.rate[k], old.rate[k + 1])),
                     square = r->slope[n] * r->slope[n],
                     left = square - 2.0 * bend * fabs(old.rate[k + 1] - r->rate[n]);

        if (isinf(bend)) {
            r->slope[n] = 0.0;
        } else if (left <= 0.0 || k + 1 == old.pieces) {
            r->rate[n + 1] =
                left <= 0.0 ? r->rate[n] + copysign(square / (2.0 * bend), slope) : old.rate[k + 1];
            r->pieces++;
        } else {
            r->rate[n + 1] = old.rate[k + 1];
            r->slope[n + 1] = sqrt(left);
            r->pieces++;
        }
    }
    run_through(r);
}

double rate_ramp_length(const struct rate_ramp *r)
{
    return r->time[r->pieces];
}

double rate_ramp_way(const struct rate_ramp *r)
{
    double way = 0.0;

    for (int k = 0; k < r->pieces; k++) { /* Simpson's rule, exact for a parabola */
        double slope;
        const double t = r->time[k + 1] - r->time[k],
                     middle = rate_ramp_at(r, r->time[k] + 0.5 * t, &slope);
        way += t / 6.0 * (r->rate[k] + 4.0 * middle + r->rate[k + 1]);
    }
    return way;
}
