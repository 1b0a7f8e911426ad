/* text_lines - the next line of a program. */
#ifndef TEXT_LINES_H
#define TEXT_LINES_H

#include "modes.h"
#include "tokens.h"

/* Read one line. What has no words to execute leaves none in *t: an empty line, one passed over, an
 * O word, the end of the program. With a fault *t holds the words that could be read. */
enum fault lines_next(struct interpreter *in, const struct program *p, struct tokens *t,
                      struct fault_report *r);

#endif
