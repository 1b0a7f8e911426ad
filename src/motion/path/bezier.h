/* bezier - a cubic curve in X Y Z with its length as the parameter.
 *
 *     B(t) = (1-t)^3 start + 3 (1-t)^2 t inner 0 + 3 (1-t) t^2 inner 1 + t^3 end,   0 <= t <= 1
 *
 * Lengths are integrals of |B'| by Gauss and Legendre, halved until they agree; the t of a length
 * is found by Newton from the nearest of a few that are kept.
 */
#ifndef BEZIER_H
#define BEZIER_H

#include <stdbool.h>

enum { BEZIER_PARTS = 6 };

struct bezier {
    double inner[2][3];            /* [mm] */
    double upto[BEZIER_PARTS - 1]; /* [mm] length as far as t = 1/6, 2/6, .. */
    double bend;                   /* [1/mm] largest curvature, at most 0.1 % more */
    double twist;                  /* [1/mm^2] bound of |P'''|, P(s) by the length s */
};

/* Complete a curve whose inner points are set; its length [mm] into *length. False: it has a point
 * in which it turns on the spot, or nearly, a radius below 0.1 um. */
bool bezier_make(struct bezier *b, const double start[3], const double end[3], double *length);

/* Point and direction (of length 1) at a length s of all. */
void bezier_at(const struct bezier *b, const double start[3], const double end[3], double length,
               double s, double point[3], double slope[3]);

/* Point, direction and second derivative by the length [1/mm] at a length s of all. */
void bezier_frame(const struct bezier *b, const double start[3], const double end[3], double length,
                  double s, double point[3], double slope[3], double bend[3]);

/* Bounds of the curvature [1/mm] and of |P'''| [1/mm^2] between two lengths. */
void bezier_most(const struct bezier *b, const double start[3], const double end[3], double length,
                 double from, double to, double *bend, double *twist);

/* Largest part of the direction along an axis, at most 0.1 % more. */
double bezier_share(const struct bezier *b, const double start[3], const double end[3], int axis);

/* Widen bounds of a coordinate [mm] by the places between two lengths where it turns back. */
void bezier_extent(const struct bezier *b, const double start[3], const double end[3],
                   double length, int axis, double from, double to, double *low, double *high);

#endif
