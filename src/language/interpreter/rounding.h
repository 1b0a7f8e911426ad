/* rounding - ,C and ,R of Fanuc's controls: a chamfer or an arc between two motions in the plane.
 *
 * A motion that has one waits until the next one is known; then both are shortened and what lies
 * between them is made.
 */
#ifndef ROUNDING_H
#define ROUNDING_H

#include "gcode.h"
#include "modes.h"

/* Behind the motion of a block, in front of which it had made `before` commands: join it to one
 * that waits, and let it wait itself if it has ,C or ,R. */
enum fault rounding_block(struct interpreter *in, const struct program *p, const struct block *b,
                          int32_t before, struct fault_report *r);

/* Whether anything but a motion has come behind one that waits; the fault stands in its line. */
enum fault rounding_missed(const struct interpreter *in, struct fault_report *r);

#endif
