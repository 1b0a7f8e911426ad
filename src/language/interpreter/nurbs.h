/* nurbs - G5.2, G5.3: rational B-splines with uniform knots, clamped at both ends.
 *
 * A span is made as soon as all control points are known on which it depends, so a curve may have
 * any number of them. It becomes cubic curves that have its place and direction at their ends.
 */
#ifndef NURBS_H
#define NURBS_H

#include "gcode.h"
#include "modes.h"

/* Execute a line of G5.2, which begins a curve or adds a control point, or G5.3, which ends it. */
enum fault nurbs_block(struct interpreter *in, const struct program *p, const struct block *b,
                       struct fault_report *r);

/* FAULT_NURBS if a block has what may not stand between them: G28, G30, or the program's end. */
enum fault nurbs_between(struct interpreter *in, const struct block *b, struct fault_report *r);

/* The text has ended. FAULT_NURBS_END, in the line of the latest point: G5.3 is missing. */
enum fault nurbs_end(struct interpreter *in, struct fault_report *r);

/* Make none of the spans that wait to be made: a fault has come before them. */
void nurbs_skip(struct interpreter *in);

/* Make the next command of a curve whose spans are being made. */
enum fault nurbs_next(struct interpreter *in, const struct program *p, struct fault_report *r);

#endif
