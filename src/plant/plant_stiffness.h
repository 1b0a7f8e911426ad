/* plant_stiffness - how stiff a plant is: bound of the largest |eigenvalue| of its equations at a
 * point, over all branches (contact or gap, and so on). plant_model.c chooses its sub-steps by
 * it. */
#ifndef PLANT_STIFFNESS_H
#define PLANT_STIFFNESS_H

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "elementary.h"
#include "plant.h"

/* Bound of the largest |eigenvalue| of an n x n matrix, [i][j] at [i * n + j]: |lambda| <=
 * norm(a^m)^(1/m) for every m; with m = 2^squarings, of 2^10 at most some per cent too large. */
enum { PLANT_ROUGH = 4, PLANT_FINE = 10 };
static double plant_spectral_radius(const double *matrix, int squarings)
{
    enum { n = PLANT_STATES };
    double a[n * n], square[n * n], logarithm = 0.0, share = 1.0;
    memcpy(a, matrix, sizeof a);
    for (int k = 0;; k++, share *= 0.5) {
        double norm = 0.0;
        for (int i = 0; i < n; i++) {
            double sum = 0.0;
            for (int j = 0; j < n; j++) {
                sum += fabs(a[i * n + j]);
            }
            norm = sum > norm || isnan(sum) ? sum : norm;
        }
        if (norm == 0.0 || !isfinite(norm)) {
            return norm;
        }
        logarithm += share * el_log(norm);
        if (k == squarings) {
            return el_exp(logarithm);
        }
        for (int i = 0; i < n * n; i++) {
            a[i] /= norm;
        }
        memset(square, 0, sizeof square);
        for (int i = 0; i < n; i++) {
            for (int q = 0; q < n; q++) {
                const double factor = a[i * n + q], *row = &a[q * n];
                double *sum = &square[i * n];
                for (int j = 0; j < n && factor != 0.0; j++) {
                    sum[j] += factor * row[j];
                }
            }
        }
        memcpy(a, square, sizeof square);
    }
}

/* Bound of |lambda| [1/s] at a point with these branches; NaN is possible where branches exclude
 * each other and give 0/0. */
static double plant_radius(const double *x, const double *u, const double *p, unsigned branches,
                           int squarings)
{
    double a[PLANT_STATES * PLANT_STATES];
    plant_jacobian(x, u, p, branches, a);
    return plant_spectral_radius(a, squarings);
}

/* Whether a value, which may be NaN, is larger than the largest so far (NaN before the first). */
static bool plant_larger(double radius, double largest)
{
    return !isnan(radius) && !(largest >= radius);
}

/* Bound of |lambda| [1/s] at a point over all branches; NaN if no combination has one. If there are
 * many branches not every combination is tried: starting from none and from all of them, each
 * branch in turn is switched if that makes the bound larger. */
static double plant_stiffness(const double *x, const double *u, const double *p)
{
    const int every = 8;
    unsigned all = 0u;
    for (int bit = 0; bit < PLANT_BRANCHES; bit++) {
        all |= 1u << bit;
    }
    double largest = NAN;
    if (PLANT_BRANCHES <= every) {
        for (unsigned branches = 0; branches <= all; branches++) {
            const double radius = plant_radius(x, u, p, branches, PLANT_FINE);
            largest = plant_larger(radius, largest) ? radius : largest;
        }
        return largest;
    }
    for (int begin = 0; begin < 2; begin++) {
        unsigned branches = begin ? all : 0u;
        double a[PLANT_STATES * PLANT_STATES], changed[PLANT_STATES * PLANT_STATES];
        plant_jacobian(x, u, p, branches, a);
        double here = plant_spectral_radius(a, PLANT_ROUGH);
        for (int bit = 0; bit < PLANT_BRANCHES; bit++) {
            plant_jacobian(x, u, p, branches ^ 1u << bit, changed);
            if (memcmp(a, changed, sizeof a) == 0) { /* the branch does not matter at this point */
                continue;
            }
            const double radius = plant_spectral_radius(changed, PLANT_ROUGH);
            if (plant_larger(radius, here)) {
                branches ^= 1u << bit;
                here = radius;
                memcpy(a, changed, sizeof a);
            }
        }
        here = plant_radius(x, u, p, branches, PLANT_FINE);
        largest = plant_larger(here, largest) ? here : largest;
    }
    return largest;
}

#endif
