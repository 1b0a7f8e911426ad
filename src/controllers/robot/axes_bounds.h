/* axes_bounds - how quickly joints can turn on a part of a path, for any arm that is known by its
 * axes, without its inverse kinematics.
 *
 * The joints q(s) obey J(q) q' = v(s), v the tip's velocity and turning. With A the inverse of J in
 * the middle of the part, of fewer than six joints a left inverse, at all its places
 *
 *     q'   = A (v + (J_m - J) q')                    q'' = A (v' - J' q' + (J_m - J) q'')
 *     q''' = A (v'' - 2 J' q'' - J'' q' + (J_m - J) q''')
 *
 * and J_m - J, J', J'' differ from what they are in the middle by half the part times bounds of the
 * next derivative, which follow from bounds of q', q'', q'''. So bounds that give themselves again,
 * but smaller, hold: at the place where the joints first left them they would still be within.
 */
#ifndef AXES_BOUNDS_H
#define AXES_BOUNDS_H

#include "bounds.h"

/* The tip in the middle of a part of a path; derivatives by its length. */
struct axes_motion {
    double half;     /* [mm] so far the part reaches to either side */
    double at[3];    /* [mm] */
    double slope[3]; /* first derivative, 1 */
    double bend[3];  /* second [1/mm] */
    double twist[3]; /* third [1/mm^2] */
    double swing;    /* [rad/mm] by which the slope turns, all over the part */
    double turn[3];  /* [rad/mm] by which the tool turns, all over the part */
};

/* Bounds for the joints that are joint[] in the middle. False: the part may be singular, or it is
 * too long to tell. */
bool axes_bounds_of(const struct manipulator *m, const double joint[OPW_JOINTS],
                    const struct axes_motion *motion, struct bounds *b);

#endif
