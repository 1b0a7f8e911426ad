/* block - the motion of one block: end point, arc centre, path, dwell. */
#ifndef BLOCK_H
#define BLOCK_H

#include "gcode.h"
#include "modes.h"

#define BLOCK_DWELL_MAX 86400.0     /* [s] a day */

/* The next command of the block, cleared but for its line; it counts once in->count is raised. */
struct command *block_command(struct interpreter *in);

/* Make the command of a block that moves, with the modes in force. A block that leads to the
 * point where the axes already are makes none. */
enum fault block_motion(struct interpreter *in, const struct program *p, const struct block *b,
                        struct fault_report *r);

/* A way straight to a point, with a feed [mm/s] or, 0, as a rapid; it rests at its end. Where it
 * stands in the text is left to the caller. */
enum fault block_straight(struct interpreter *in, const struct program *p, const double end[AXES],
                          double feed, struct fault_report *r);

/* The fault of a command that is refused, with what is known of it. */
enum fault block_refusal(enum command_status s, const struct command_refusal *why,
                         struct fault_report *r);

/* G28, G30: rapid to the point of the block, then to the point kept (G28.1, G30.1; at first machine
 * zero) of the axes it names; without an axis word at once to that of all. */
enum fault block_home(struct interpreter *in, const struct program *p, const struct block *b,
                      struct fault_report *r);

/* G4. */
enum fault block_dwell(struct interpreter *in, const struct program *p, const struct block *b,
                       struct fault_report *r);

#endif
