/* comp_file - reads the compensation tables (pitch error, backlash) of the mcc FMU from a text
 * file: two kinds of rows, each under its own header.
 *
 *     axis,interval,home              (interval in pulses; home: index of the point at position 0)
 *     1,8000,10
 *     axis,index,forward,backward     (corrections in pulses; indices of an axis without a gap)
 *     1,8,-3,-13
 *
 * Before the first index of an axis and after its last the table is filled with their values. Empty
 * lines and lines that begin with # are skipped.
 */
#ifndef COMP_FILE_H
#define COMP_FILE_H

#include <limits.h>

#include "mcc.h"
#include "fmu_input.h"

enum { COMP_CELLS = 4, COMP_LINE = 256 };

struct comp_file {
    struct comp_table table[AXES];
    int32_t last[AXES];         /* index read last for each axis, -1: none yet */
    int cells;                  /* number of cells in a row under the latest header; 0: no header */
    int line;                   /* number of the line */
    char said[COMP_LINE + 160]; /* message about an error */
};

static const char *const comp_head[] = { "axis,interval,home", "axis,index,forward,backward" };

/* Write the message about a wrong value; returns -1. */
static int comp_bad(struct comp_file *f, const char *what, long value, const char *why)
{
    snprintf(f->said, sizeof f->said, "line %d: %s %ld %s", f->line, what, value, why);
    return -1;
}

/* Read the integers of a row into cell[]. Returns 0, or -1 if there are not f->cells of them. */
static int comp_row(struct comp_file *f, const char *text, long cell[COMP_CELLS])
{
    for (int n = 0;; n++) {
        char *end;
        errno = 0;
        cell[n] = strtol(text, &end, 10);
        end += strspn(end, " ");
        if (end == text || (*end && *end != ',') || errno || n + 1 > f->cells) {
            break;
        }
        if (!*end && n + 1 == f->cells) {
            return 0;
        }
        if (!*end || n + 1 == COMP_CELLS) {
            break;
        }
        text = end + 1;
    }
    snprintf(f->said, sizeof f->said, "line %d: not %d whole numbers: \"%.*s\"", f->line, f->cells,
             COMP_LINE, text);
    return -1;
}

/* Take a row axis,interval,home. */
static int comp_axis(struct comp_file *f, const long c[COMP_CELLS])
{
    struct comp_table *t = &f->table[c[0] - 1];

    if (t->interval) {
        return comp_bad(f, "axis", c[0], "has an interval already");
    }
    if (c[1] < 1 || c[1] > INT32_MAX) {
        return comp_bad(f, "interval", c[1], "is not a number of pulses from 1");
    }
    if (c[2] < 0 || c[2] >= COMP_POINTS) {
        return comp_bad(f, "home", c[2], "is not an index, 0 to 255");
    }
    t->interval = (int32_t)c[1];
    t->home = (int32_t)c[2];
    return 0;
}

/* Take a row axis,index,forward,backward. */
static int comp_point(struct comp_file *f, const long c[COMP_CELLS])
{
    struct comp_table *t = &f->table[c[0] - 1];
    int32_t *last = &f->last[c[0] - 1];

    if (!t->interval) {
        return comp_bad(f, "axis", c[0], "has no interval yet");
    }
    if (c[1] < 0 || c[1] >= COMP_POINTS) {
        return comp_bad(f, "index", c[1], "is not within 0 to 255");
    }
    if (*last >= 0 && c[1] != *last + 1) {
        return comp_bad(f, "index", c[1], "does not follow the one before");
    }
    for (int i = 2; i < 4; i++) {
        if (c[i] < -COMP_LARGEST || c[i] > COMP_LARGEST) { /* labs of the least long is none */
            return comp_bad(f, i == 2 ? "forward" : "backward", c[i], "is beyond +-32767");
        }
    }
    for (int i = *last < 0 ? 0 : (int)c[1]; i < COMP_POINTS; i++) {
        t->forward[i] = (int32_t)c[2];
        t->backward[i] = (int32_t)c[3];
    }
    *last = (int32_t)c[1];
    return 0;
}

/* Take a line, without its line end. */
static int comp_line(struct comp_file *f, const char *text)
{
    long cell[COMP_CELLS];

    if (!*text || *text == '#') {
        return 0;
    }
    for (int i = 0; i < 2; i++) {
        if (strcmp(text, comp_head[i]) == 0) {
            f->cells = 3 + i;
            return 0;
        }
    }
    if (!f->cells) {
        snprintf(f->said, sizeof f->said, "line %d: not the header \"%s\": \"%.*s\"", f->line,
                 comp_head[0], COMP_LINE, text);
        return -1;
    }
    if (comp_row(f, text, cell)) {
        return -1;
    }
    if (cell[0] < 1 || cell[0] > AXES) {
        return comp_bad(f, "axis", cell[0], "is not within 1 to 6");
    }
    return f->cells == 3 ? comp_axis(f, cell) : comp_point(f, cell);
}

/* Read a line without its line end. Returns 1, 0 at the end of the file, or -1 if it is not text or
 * too long. */
static int comp_next(struct comp_file *f, FILE *file, char text[COMP_LINE])
{
    int n = 0, c = getc(file);

    if (c == EOF) {
        return 0;
    }
    f->line++;
    for (; c != EOF && c != '\n'; c = getc(file)) {
        if (c == '\0') {
            snprintf(f->said, sizeof f->said, "line %d: a byte 0: this is no text", f->line);
            return -1;
        }
        if (n == COMP_LINE - 2) {
            return comp_bad(f, "more than", COMP_LINE - 2, "characters");
        }
        text[n++] = (char)c;
    }
    text[n - (n > 0 && text[n - 1] == '\r')] = '\0';
    return 1;
}

/* Read a file into the tables. Returns 0, or -1 with a message in f->said. */
static int comp_read(struct comp_file *f, const char *name)
{
    char text[COMP_LINE];
    FILE *file;

    memset(f, 0, sizeof *f);
    memset(f->last, -1, sizeof f->last);
    const char *why = file_open(name, &file);
    if (why) {
        snprintf(f->said, sizeof f->said, "cannot read: %s", why);
        return -1;
    }
    int bad = 0, got = 0;
    errno = 0;
    while (!bad && (got = comp_next(f, file, text)) > 0) {
        bad = comp_line(f, text);
    }
    bad = bad ? bad : got;
    if (!bad && ferror(file)) {
        snprintf(f->said, sizeof f->said, "cannot read: %s", strerror(errno ? errno : EIO));
        bad = -1;
    }
    fclose(file);
    for (int i = 0; i < AXES && !bad; i++) {
        if (f->table[i].interval && f->last[i] < 0) {
            snprintf(f->said, sizeof f->said, "axis %d has an interval and no points", i + 1);
            bad = -1;
        }
    }
    return bad;
}

#endif
