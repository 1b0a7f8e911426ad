/* source - where the text of a part program comes from, and that of files which it calls; the core
 * asks for it line by line.
 *
 * A source is an argument of the calls that read and is kept by none of them. The place of the next
 * line is an offset in the state, so a program of any length streams through a buffer of fixed
 * size, and a restored state goes on reading at its own place.
 */
#ifndef SOURCE_H
#define SOURCE_H

#include "fault.h"

enum {
    SOURCE_LINE_MAX = 256,               /* [characters] of a line without CR LF */
    SOURCE_WINDOW = SOURCE_LINE_MAX + 2, /* [byte] enough to see whether a line is too long */
    SOURCE_NONE = -2                     /* there is no such file */
};

struct source {
    /* Point *text at the bytes from an offset of the program on (file is empty), or of a file that
     * it calls by a name (file: small letters, digits, - and _); they stay until the next call.
     * Returns how many there are: SOURCE_WINDOW or more; fewer only in front of the end of the
     * text, 0 at it; -1 if it cannot be read; SOURCE_NONE. */
    int64_t (*look)(void *context, const char *file, int64_t offset, const char **text);
    void *context;
};

struct source_line {
    const char *text; /* without its end; NULL behind the last line */
    int32_t length;   /* [byte] */
};

/* Read the line at *offset of a file and move *offset behind its end. A mark of UTF-8 in front of
 * the first line is not of it. */
enum fault source_read(const struct source *s, const char *file, int64_t *offset,
                       struct source_line *line, struct fault_report *r);

/* Whether a name may be that of a file that is called; and there is one. */
bool source_name(const char *file);
bool source_has(const struct source *s, const char *file);

/* A program that stands in memory and calls no files. */
struct source_text {
    const char *text;
    int64_t length; /* [byte] */
};

struct source source_of(struct source_text *t);

#endif
