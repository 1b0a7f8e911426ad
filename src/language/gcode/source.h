/* source - gives the text of a part program, and of the files that it calls, line by line.
 *
 * A source is an argument of the calls that read, and none of them keeps it. The place of the next
 * line is an offset in the state. So a program of any length streams through a buffer of fixed
 * size, and a restored state goes on reading at its own place.
 */
#ifndef SOURCE_H
#define SOURCE_H

#include "fault.h"

enum {
    SOURCE_LINE_MAX = 256,               /* [characters] of a line without CR LF */
    SOURCE_WINDOW = SOURCE_LINE_MAX + 2, /* [byte] enough to see that a line is too long */
    SOURCE_NONE = -2                     /* look: there is no such file */
};

struct source {
    /* Point *text at the bytes from an offset on: of the program if `file` is empty, else of the
     * called file of this name (small letters, digits, - and _). They stay until the next call.
     * Returns their number: SOURCE_WINDOW or more, fewer only in front of the end of the text, 0 at
     * it; -1: the text cannot be read; SOURCE_NONE. */
    int64_t (*look)(void *context, const char *file, int64_t offset, const char **text);
    void *context;
};

struct source_line {
    const char *text; /* without LF or CR LF; NULL behind the last line */
    int32_t length;   /* [byte] */
};

/* Read the line at *offset of a file and move *offset behind its end. UTF-8's byte order mark in
 * front of the first line is skipped. FAULT_LINE_LENGTH: *offset is behind the line all the same;
 * FAULT_ZERO and FAULT_READ: it cannot be read on. */
enum fault source_read(const struct source *s, const char *file, int64_t *offset,
                       struct source_line *line, struct fault_report *r);

/* Whether a called file may have this name; and whether there is one that has it. */
bool source_name(const char *file);
bool source_has(const struct source *s, const char *file);

/* A program in memory that calls no files, and its source. */
struct source_text {
    const char *text;
    int64_t length; /* [byte] */
};

struct source source_of(struct source_text *t);

#endif
