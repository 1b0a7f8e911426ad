/* block - the motion of one block as commands: its end point, the centre of an arc, the path and
 * the feed along it; dwells, and the points of G28 and G30. */
#ifndef BLOCK_H
#define BLOCK_H

#include "gcode.h"
#include "modes.h"

#define BLOCK_DWELL_MAX 86400.0 /* [s] longest dwell, a day */

/* Room for the block's next command, cleared but for its line; raising in->count counts it. */
struct command *block_command(struct interpreter *in);

/* The line of a block, with the place that r has; and f as a fault (or FAULT_NONE) of a line that
 * was kept: its place goes into *r. */
struct kept_line block_line(const struct interpreter *in, const struct block *b,
                            const struct fault_report *r);
enum fault block_at_line(const struct interpreter *in, const struct kept_line *l, enum fault f,
                         struct fault_report *r);

/* Make the command of a block that moves by G0 to G3, G5 or G5.1, with the modes in force. A block
 * that leads to where the axes stand makes none. */
enum fault block_motion(struct interpreter *in, const struct program *p, const struct block *b,
                        struct fault_report *r);

/* Complete a command, whose path is set, with a feed [mm/s]. If that drives a joint too fast, and
 * p->strict_feed is not set, it gets the highest feed that the joints allow, and *r a note. */
enum command_status block_move(struct command *c, const struct program *p, enum command_type type,
                               double feed, struct command_refusal *why, struct fault_report *r);

/* Complete a line, an arc or a rapid anew, with its feed, behind a change of its path. */
enum fault block_complete(struct command *c, const struct program *p, struct fault_report *r);

/* Make a straight motion to a point in machine coordinates, at rest at its end: with a feed [mm/s],
 * which is never cut down if it is `exact`; or, with 0, as a rapid. The caller sets the place of a
 * fault in the text. */
enum fault block_straight(struct interpreter *in, const struct program *p, const double end[AXES],
                          double feed, bool exact, struct fault_report *r);

/* Make a cubic curve with two inner control points [mm], or without them (NULL) a line, with a feed
 * [mm/s]. The tolerance to its neighbours is `joined` [mm], or that of G64 if it is larger. The
 * caller sets the place of a fault. FAULT_CUSP: the curve turns on the spot. */
enum fault block_curve(struct interpreter *in, const struct program *p, const double end[AXES],
                       const double inner[2][3], double feed, double joined,
                       struct fault_report *r);

/* The fault of a command that is refused; *r gets joint, values and highest feed, but no place. */
enum fault block_refusal(enum command_status s, const struct command_refusal *why,
                         struct fault_report *r);

/* G28, G30: rapid to the end point of the block; then the axes that it names go on by a rapid to
 * the point that G28.1, G30.1 kept, at first machine zero. Without an axis word all axes go
 * there at once. */
enum fault block_home(struct interpreter *in, const struct program *p, const struct block *b,
                      struct fault_report *r);

/* Whether the block asks for a motion: by a code other than G80, or by axis words. */
bool block_moves(const struct block *b);

/* Time [s] of a word P, or X and U of G4; on Fanuc's controls a number without a point is in ms. */
double block_seconds(const struct program *p, const struct token *w);

/* G4: make its dwell; a motion of the same block is left to the caller. FAULT_NO_DWELL: no time;
 * FAULT_VALUE: not 0 to BLOCK_DWELL_MAX; FAULT_UNUSED. */
enum fault block_dwell(struct interpreter *in, const struct program *p, const struct block *b,
                       struct fault_report *r);

#endif
