/* source - where the text of a part program comes from; the core asks for it line by line.
 *
 * A source is an argument of the calls that read and is kept by none of them. The place of the next
 * line is an offset in the state, so a program of any length streams through a buffer of fixed
 * size, and a restored state goes on reading at its own place.
 */
#ifndef SOURCE_H
#define SOURCE_H

#include "fault.h"

enum {
    SOURCE_LINE_MAX = 256,                  /* [characters] of a line without CR LF */
    SOURCE_WINDOW = SOURCE_LINE_MAX + 2     /* [byte] enough to see whether a line is too long */
};

struct source {
    /* Point *text at the bytes from an offset of the program on; they stay until the next call.
     * Returns how many there are: SOURCE_WINDOW or more; fewer only in front of the end of the
     * program, 0 at it; -1 if the program cannot be read. */
    int64_t (*look)(void *context, int64_t offset, const char **text);
    void *context;
};

struct source_line {
    const char *text;       /* without its end; NULL behind the last line */
    int32_t length;         /* [byte] */
};

/* Read the line at *offset and move *offset behind its end. */
enum fault source_read(const struct source *s, int64_t *offset, struct source_line *line,
                       struct fault_report *r);

/* A program that stands in memory. */
struct source_text {
    const char *text;
    int64_t length;         /* [byte] */
};

struct source source_of(struct source_text *t);

#endif
