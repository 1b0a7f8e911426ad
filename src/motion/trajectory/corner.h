/* corner - two neighbouring paths joined by a smooth curve that stays within a tolerance.
 *
 *        A              the last `half` of A and the first `half` of B are walked at the same time:
 *     ------.___
 *               \.      P(s) = A(L - half + s + half - y) + B(y) - (their common point)
 *                 \     y(s) = integral of h,  h = 3 x^2 - 2 x^3,  x = (s + half) / (2 half)
 *                  | B
 *
 * s is the way along the programmed path, -half .. half about the common point, so the length of a
 * chain is the sum of its commands. P'(s) = (1 - h) A' + h B' is no longer than 1 and P'' is
 * continuous: a constant speed along s needs a limited acceleration and a limited jerk.
 */
#ifndef CORNER_H
#define CORNER_H

#include "path.h"

struct corner {
    double half;  /* [mm] 0: the paths meet as they are */
    double bend;  /* [1/mm] bound of |P''| */
    double twist; /* [1/mm^2] bound of |P'''| */
};

/* Largest curve that stays within a tolerance [mm] of both paths and takes no more than `room`
 * [mm] of either. Of an arc it takes no more than half a radian, so that one that is small against
 * the tolerance is still driven. `round`: also join paths of different curvature that touch
 * smoothly. False, and no curve, if the paths meet at an angle and the tolerance allows none. */
bool corner_make(struct corner *k, const struct path *a, const struct path *b, double tolerance,
                 double room, bool round);

/* Point and d(point)/ds at s, -half .. half. */
void corner_at(const struct corner *k, const struct path *a, const struct path *b, double s,
               double point[AXES], double slope[AXES]);

#endif
