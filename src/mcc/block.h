/* block - the motion of one block: end point, arc centre, path. */
#ifndef BLOCK_H
#define BLOCK_H

#include "gcode.h"
#include "interpreter.h"

/* One block on its way through the interpreter. */
struct block {
    struct tokens tokens;
    struct gcode g;
    double scale;       /* [mm] per unit of the program */
};

/* The first of the letters that the block has, or NULL. */
const struct token *block_first(const struct block *b, const char *letters);

/* Make the command of a block that moves, with the modes in force. A block that leads to the
 * point where the axes already are gives a path of length 0 and no command. */
enum fault block_motion(struct interpreter *in, const struct program *p, const struct block *b,
                        struct command *c, struct fault_report *r);

#endif
