/* pose - position and orientation of one frame in another. */
#ifndef POSE_H
#define POSE_H

#include "quaternion.h"

struct pose {
    double at[3];   /* [mm] */
    double turn[4]; /* quaternion */
};

/* The pose of a frame in itself: no shift, no turn. */
struct pose pose_none(void);

/* The pose that a program writes as X Y Z [mm], A B C [deg]. */
struct pose pose_of(const double xyz[3], const double abc[3]);

/* Pose in the base of a frame that has the pose b in frame a, which has the pose a in the base. */
struct pose pose_product(const struct pose *a, const struct pose *b);

/* Pose of the other frame in this one. */
struct pose pose_inverse(const struct pose *a);

/* Where a point [mm] of the frame lies in the other one. */
void pose_point(const struct pose *a, const double point[3], double out[3]);

/* A user's frame by its origin, a point on its x axis and one in its xy plane with y > 0. [mm]
 * Returns 0, or 1: the three are on one line. */
int pose_by_points(const double origin[3], const double x[3], const double xy[3],
                   struct pose *frame);

#endif
