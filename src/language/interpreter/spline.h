/* spline - G5 and G5.1: cubic and quadratic Bezier curves in the plane XY. */
#ifndef SPLINE_H
#define SPLINE_H

#include "gcode.h"
#include "modes.h"

/* Path of the block to a point in machine coordinates [mm]. G5: I J lead from the start to the
 * first control point, P Q from the end to the second; without I J the first one is set so that the
 * curve goes on as the G5 in front ended. G5.1: I J lead from the start to the one control point of
 * a parabola. FAULT_SPLINE: words are missing; FAULT_SPLINE_PLANE, FAULT_PLAIN, FAULT_CUSP. */
enum fault spline_path(struct interpreter *in, const struct program *p, const struct block *b,
                       const double end[AXES], struct path *path, struct fault_report *r);

#endif
