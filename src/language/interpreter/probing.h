/* probing - G38.2 to G38.5: a line at the feed that ends where a probe touches, or leaves. */
#ifndef PROBING_H
#define PROBING_H

#include "gcode.h"
#include "modes.h"

/* Whether that is what the block's code of motion says. */
bool probing_asked(const struct block *b);

/* The line, which reading waits for. Behind it axis words need a code of motion again. */
enum fault probing_block(struct interpreter *in, const struct program *p, const struct block *b,
                         struct fault_report *r);

#endif
