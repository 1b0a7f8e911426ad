/* rounding - ,C and ,R of Fanuc's controls: a chamfer or an arc between two motions in the plane.
 *
 * A motion that has one waits until the next one is known. Then both are shortened, and the chamfer
 * or the arc comes between them.
 */
#ifndef ROUNDING_H
#define ROUNDING_H

#include "gcode.h"
#include "modes.h"

/* Called behind the motion of a block, in front of which the block had made `before` commands: join
 * the motion to one that waits, and let it wait itself if it has ,C or ,R. FAULT_ROUND_NEXT: one of
 * both is no line or arc in the plane; FAULT_ROUND_SHORT: there is no room. */
enum fault rounding_block(struct interpreter *in, const struct program *p, const struct block *b,
                          int32_t before, struct fault_report *r);

/* FAULT_ROUND_NEXT, in the line of the motion that waits: something other than a motion has come
 * behind it. */
enum fault rounding_missed(const struct interpreter *in, struct fault_report *r);

#endif
