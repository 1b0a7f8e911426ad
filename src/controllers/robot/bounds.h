/* bounds - how quickly the joints can turn anywhere on a part of a path.
 *
 * The inverse kinematics of opw is gone through with jets instead of numbers: every length and
 * every direction with its derivatives and the ranges that these have all over the part. Arms that
 * are known by their axes go the other way round (axes_bounds).
 */
#ifndef BOUNDS_H
#define BOUNDS_H

#include "arm_moves.h"

/* Absolute values of the joints' derivatives along the path. */
struct bounds_pair {
    double slope[OPW_JOINTS]; /* [rad/mm] |dq/ds| */
    double bend[OPW_JOINTS];  /* [rad/mm^2] |d2q/ds2| */
};

struct bounds {
    struct bounds_pair most;   /* nowhere on the part are they larger */
    struct bounds_pair middle; /* in the middle of the part */
};

/* Bounds on the part `from` .. `to` (0..1) of the path of the arm's latest move; joint[] holds the
 * joints in the middle of the part. False: a place of it may be singular, so nothing is known. */
bool bounds_of(const struct arm_geometry *g, const struct path *path, double from, double to,
               const double joint[OPW_JOINTS], struct bounds *b);

#endif
