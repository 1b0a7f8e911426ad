/* cutter - cutter compensation: G40, G41, G42, G41.1, G42.1.
 *
 * The commands of the program are those of its contour. While compensation is on they pass through
 * here, and become those of the tool's centre. A motion in the plane waits for the next one, for
 * the corner between them says where the centre ends it. Commands between the two wait behind it.
 */
#ifndef CUTTER_H
#define CUTTER_H

#include "gcode.h"
#include "modes.h"

/* Execute G40 to G42.1 and D of a block. FAULT_CUTTER_WORD, FAULT_CUTTER_PLANE: what may not be in
 * a block while compensation is on; FAULT_CUTTER_ON, FAULT_CUTTER_EXIT, FAULT_TOOL, FAULT_VALUE. */
enum fault cutter_block(struct interpreter *in, const struct program *p, const struct block *b,
                        struct fault_report *r);

/* Whether compensation has an offset, so that commands of the program go to cutter_follow. */
static inline bool cutter_on(const struct interpreter *in)
{
    return in->cutter.edge != 0.0;
}

/* Take the next command of the program; none may be ready. A fault has its place in the text. */
enum fault cutter_follow(struct interpreter *in, const struct program *p, const struct command *c,
                         struct fault_report *r);

/* Compensation ends: the motion held ends beside the end of its contour, all that is held becomes
 * ready, and in->point is where the tool's centre is. */
enum fault cutter_end(struct interpreter *in, const struct program *p, struct fault_report *r);

/* Hand out the oldest command if one is ready. */
bool cutter_take(struct interpreter *in, struct command *c);

/* Compensation is off, and what is held is forgotten. */
void cutter_drop(struct interpreter *in);

#endif
