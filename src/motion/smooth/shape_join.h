/* shape_join - two segments of a path joined by a quintic that stays within a tolerance.
 *
 * It has the place, r' and r'' of both where it leaves them. Between two lines it is the curve with
 * r'' ~ x (1 - x). It is 0.1875 of its half length times the change of direction off the corner. A
 * corner with more room has two, the first from a line to the middle, the second from there.
 * The bound is proved as in shape_run.h, for the polyline it replaces.
 */
#ifndef SHAPE_JOIN_H
#define SHAPE_JOIN_H

#include <stdint.h>

#include "segment.h"

enum { SHAPE_WAY = 48 };

/* The polyline: from a point at or before the join's start to one at or behind its end. */
struct shape_way {
    int32_t points;
    double point[SHAPE_WAY][AXES]; /* [mm] */
    double u[SHAPE_WAY];           /* [mm] about where it lies, from the join's start */
    double tolerance[SHAPE_WAY];   /* [mm] of the chord that ends here */
};

/* Join two states by a quintic: sets kind, length, origin, control. False: it is not within the
 * tolerance, or cannot be seen to be. */
bool shape_join(struct segment *p, const struct segment_state *a, const struct segment_state *b,
                double length, const struct shape_way *way);

/* Leaves the part from .. to of a segment. */
void shape_cut(struct segment *p, double from, double to);

#endif
