/* pose - a place with an attitude: of a frame in another one. */
#ifndef POSE_H
#define POSE_H

#include "quaternion.h"

struct pose {
    double at[3];   /* [mm] */
    double turn[4]; /* quaternion */
};

/* A frame that is the other one. */
struct pose pose_none(void);

/* Of a program: X Y Z [mm], A B C [deg]. */
struct pose pose_of(const double xyz[3], const double abc[3]);

/* Frame b in frame a in a third: there it is the product. */
struct pose pose_product(const struct pose *a, const struct pose *b);

/* The other frame in this one. */
struct pose pose_inverse(const struct pose *a);

/* A point [mm] of the frame, in the other one. */
void pose_point(const struct pose *a, const double point[3], double out[3]);

/* A user's frame by its origin, a point on its x axis and one in its xy plane with y > 0. [mm]
 * Returns 0, or 1: the three are on one line. */
int pose_by_points(const double origin[3], const double x[3], const double xy[3],
                   struct pose *frame);

#endif
