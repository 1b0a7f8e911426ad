/* nurbs - G5.2, G5.3: rational B-splines with even knots, clamped at both ends.
 *
 * A span is made as soon as the points are known that it depends on, so a curve has any number of
 * points. It becomes cubic curves with its place and direction at their ends.
 */
#ifndef NURBS_H
#define NURBS_H

#include "gcode.h"
#include "modes.h"

/* A line of G5.2, or G5.3. */
enum fault nurbs_block(struct interpreter *in, const struct program *p, const struct block *b,
                       struct fault_report *r);

/* What may not stand in a block between them: home, the program's end. */
enum fault nurbs_between(struct interpreter *in, const struct block *b, struct fault_report *r);

/* The text has ended: G5.3 must have. */
enum fault nurbs_end(struct interpreter *in, struct fault_report *r);

/* The next command of a curve that runs. */
enum fault nurbs_next(struct interpreter *in, const struct program *p, struct fault_report *r);

#endif
