/* text_lines - reads the next line of a part program, and executes what decides which lines are
 * read (O words, jumps, calls) and what sets parameters. */
#ifndef TEXT_LINES_H
#define TEXT_LINES_H

#include "modes.h"
#include "tokens.h"

/* Read one line; *t has the words that are left to be executed. It has none for an empty line, one
 * passed over by block delete, an O word, a call or the end of the program. With a fault it has the
 * words that could be read. */
enum fault lines_next(struct interpreter *in, const struct program *p, struct tokens *t,
                      struct fault_report *r);

#endif
