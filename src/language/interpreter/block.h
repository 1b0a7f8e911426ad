/* block - the motion of one block: end point, arc centre, path, dwell. */
#ifndef BLOCK_H
#define BLOCK_H

#include "gcode.h"
#include "modes.h"

#define BLOCK_DWELL_MAX 86400.0 /* [s] a day */

/* The next command of the block, cleared but for its line; it counts once in->count is raised. */
struct command *block_command(struct interpreter *in);

/* The line of a block, of which r tells; and a fault (or FAULT_NONE) of a line that was kept. */
struct kept_line block_line(const struct interpreter *in, const struct block *b,
                            const struct fault_report *r);
enum fault block_at_line(const struct interpreter *in, const struct kept_line *l, enum fault f,
                         struct fault_report *r);

/* Make the command of a block that moves, with the modes in force. A block that leads to the
 * point where the axes already are makes none. */
enum fault block_motion(struct interpreter *in, const struct program *p, const struct block *b,
                        struct fault_report *r);

/* Complete a command with a feed [mm/s], or what its axes allow along its path if that is less and
 * not refused: the text of r has a note then. */
enum command_status block_move(struct command *c, const struct program *p, enum command_type type,
                               double feed, struct command_refusal *why, struct fault_report *r);

/* Complete a line, an arc or a rapid whose path has changed. */
enum fault block_complete(struct command *c, const struct program *p, struct fault_report *r);

/* A way straight to a point, with a feed [mm/s], which may have to be `exact`, or, 0, as a rapid;
 * it rests at its end. Where it stands in the text is left to the caller. */
enum fault block_straight(struct interpreter *in, const struct program *p, const double end[AXES],
                          double feed, bool exact, struct fault_report *r);

/* A cubic curve with two inner points, or a line without (NULL), which joins its neighbours within
 * a tolerance [mm] at least, with a feed [mm/s]; likewise. */
enum fault block_curve(struct interpreter *in, const struct program *p, const double end[AXES],
                       const double inner[2][3], double feed, double joined,
                       struct fault_report *r);

/* The fault of a command that is refused, with what is known of it. */
enum fault block_refusal(enum command_status s, const struct command_refusal *why,
                         struct fault_report *r);

/* G28, G30: rapid to the point of the block, then to the point kept (G28.1, G30.1; at first machine
 * zero) of the axes it names; without an axis word at once to that of all. */
enum fault block_home(struct interpreter *in, const struct program *p, const struct block *b,
                      struct fault_report *r);

/* Whether the block asks for a motion: by its code or by axis words. */
bool block_moves(const struct block *b);

/* [s] of P, or of X and U of G4; Fanuc's controls count ms without a point. */
double block_seconds(const struct program *p, const struct token *w);

/* G4; a motion of the same block is left to the caller. */
enum fault block_dwell(struct interpreter *in, const struct program *p, const struct block *b,
                       struct fault_report *r);

#endif
