/* block - the motion of one block: end point, arc centre, path, dwell. */
#ifndef BLOCK_H
#define BLOCK_H

#include "gcode.h"
#include "modes.h"

/* The next command of the block, cleared but for its line; it counts once in->count is raised. */
struct command *block_command(struct interpreter *in);

/* Make the command of a block that moves, with the modes in force. A block that leads to the
 * point where the axes already are makes none. */
enum fault block_motion(struct interpreter *in, const struct program *p, const struct block *b,
                        struct fault_report *r);

/* G28: rapid to the point of the block, then to the machine zero of the axes it names; without an
 * axis word at once to that of all. */
enum fault block_home(struct interpreter *in, const struct program *p, const struct block *b,
                      struct fault_report *r);

/* G4. */
enum fault block_dwell(struct interpreter *in, const struct block *b, struct fault_report *r);

#endif
