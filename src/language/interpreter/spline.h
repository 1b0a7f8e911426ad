/* spline - G5 and G5.1: curves of Bezier in the plane XY. */
#ifndef SPLINE_H
#define SPLINE_H

#include "gcode.h"
#include "modes.h"

/* Path of the block to a point in machine coordinates. I J lead from the start to the first control
 * point, P Q from the end to the second; without I J a G5 goes on as the G5 before it ended. I J of
 * G5.1 lead to the one point of a parabola. */
enum fault spline_path(struct interpreter *in, const struct program *p, const struct block *b,
                       const double end[AXES], struct path *path, struct fault_report *r);

#endif
