/* tool_file - reads the tool table of the mcc FMU from a text file: one tool per line, in the form
 * of tool_table.h.
 *
 *     T1 P1 D6.0 Z+50.2 ;comment
 */
#ifndef TOOL_FILE_H
#define TOOL_FILE_H

#include "fmu_input.h"
#include "tool_table.h"

enum { TOOL_LINE = 256 };

struct tool_file {
    struct tool_table table;
    int line;                 /* number of the line */
    char said[2 * TOOL_LINE]; /* message about an error */
};

static int tool_bad(struct tool_file *f, const char *why, const char *text, int length)
{
    snprintf(f->said, sizeof f->said, "line %d: %s \"%.*s\"", f->line, why, length, text);
    return -1;
}

/* Read the next line into text[]. Returns its length, -1 at the end of the file, -2 if it is not
 * text or too long. */
static int tool_next(struct tool_file *f, FILE *file, char text[TOOL_LINE])
{
    int n = 0, c = getc(file);

    if (c == EOF) {
        return -1;
    }
    f->line++;
    for (; c != EOF && c != '\n'; c = getc(file)) {
        if (n == TOOL_LINE || c == '\0') {
            tool_bad(f, c ? "longer than 256 characters" : "byte 0, which no text has, behind",
                     text, c ? 20 : n);
            return -2;
        }
        text[n++] = (char)c;
    }
    return n > 0 && text[n - 1] == '\r' ? n - 1 : n;
}

/* Read a file into the table, which is closed to other tools then. Returns 0, or -1 with a message
 * in f->said. */
static int tool_read(struct tool_file *f, const char *name, bool angles)
{
    char text[TOOL_LINE];
    FILE *file;

    memset(f, 0, sizeof *f);
    f->table.closed = true;
    const char *why = file_open(name, &file);
    if (why) {
        snprintf(f->said, sizeof f->said, "cannot read: %s", why);
        return -1;
    }
    int length, bad = 0;
    errno = 0;
    while (!bad && (length = tool_next(f, file, text)) > -1) {
        struct tool_text at;
        const char *wrong = tool_table_line(&f->table, text, length, angles, &at);
        bad = wrong ? tool_bad(f, wrong, text + at.at, at.length) : 0;
    }
    bad = bad ? bad : length < -1 ? -1 : 0;
    if (!bad && ferror(file)) {
        snprintf(f->said, sizeof f->said, "cannot read: %s", strerror(errno ? errno : EIO));
        bad = -1;
    }
    fclose(file);
    return bad;
}

#endif
