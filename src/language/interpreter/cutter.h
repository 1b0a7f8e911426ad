/* cutter - compensation of the tool's radius: G40, G41, G42, G41.1, G42.1.
 *
 * The commands of the program are those of its contour. While compensation is on they pass through
 * here: a motion in the plane waits until the next one is known, for only then is it known where
 * the centre of the tool has to end it; what comes between them waits behind it.
 */
#ifndef CUTTER_H
#define CUTTER_H

#include "gcode.h"
#include "modes.h"

/* G40 to G42.1 and D of a block, and what may not stand in it while compensation is on. */
enum fault cutter_block(struct interpreter *in, const struct program *p, const struct block *b,
                        struct fault_report *r);

/* Compensation is on: commands of the program go to cutter_follow. */
static inline bool cutter_on(const struct interpreter *in)
{
    return in->cutter.edge != 0.0;
}

/* Take a command of the program; none may be ready. */
enum fault cutter_follow(struct interpreter *in, const struct program *p, const struct command *c,
                         struct fault_report *r);

/* No motion follows: what is held becomes ready, in->point is where the tool's centre is. */
enum fault cutter_end(struct interpreter *in, const struct program *p, struct fault_report *r);

/* Hand out a command if one is ready. */
bool cutter_take(struct interpreter *in, struct command *c);

/* Forget what is held; compensation is off. */
void cutter_drop(struct interpreter *in);

#endif
