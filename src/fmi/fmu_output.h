/* fmu_output - writing a file so that it appears complete at the end or not at all: it is written
 * as NAME.part and renamed. It replaces only a regular file. Functions return NULL, or a text for
 * what is wrong. */
#ifndef FMU_OUTPUT_H
#define FMU_OUTPUT_H

#include <stdbool.h>

#include "fmu_file.h"

/* A file that the same instance reads ("" if none), and the text if an output would replace it. */
struct output_input {
    struct fmu_path path;
    const char *words;
};

/* A file being written, under the name `part`. */
struct output {
    char name[FMU_STRING_MAX + 16];
    char part[FMU_STRING_MAX + 48];
    bool shown;                    /* it has been renamed to `name` */
    char old[FMU_STRING_MAX + 48]; /* name under which the replaced file is kept; "" if none */
    FILE *file;
};

/* Check that a file may be written under this name. A link is not replaced, because it may lead to
 * another file. */
static const char *output_check(const char *name, const struct output_input *input, int inputs)
{
    file_stat s;
    if (file_look_at_link(name, &s) != 0) {
        return errno == ENOENT ? NULL : strerror(errno);
    }
    const char *why = file_regular(&s);
    for (int i = 0; i < inputs && !why; i++) {
        why = file_same(name, input[i].path.text) ? input[i].words : NULL;
    }
    return why;
}

/* Create the part, under a name that does not exist yet. */
static const char *output_begin(struct output *o, const char *name)
{
    enum { TRIES = 100 }; /* most parts that killed runs may have left behind */
    memset(o, 0, sizeof *o);
    snprintf(o->name, sizeof o->name, "%s", name);
    for (int i = 1; i <= TRIES; i++) {
        snprintf(o->part, sizeof o->part, i == 1 ? "%s.part" : "%s.part%d", name, i);
        o->file = file_create(o->part);
        if (o->file || errno != EEXIST) {
            break;
        }
    }
    if (!o->file) {
        o->part[0] = '\0';
        return strerror(errno);
    }
    return NULL;
}

/* Close the part, which is complete; `good`: no error so far. */
static const char *output_end(struct output *o, bool good)
{
    int error = good && !ferror(o->file) ? 0 : errno ? errno : EIO;
    if (fclose(o->file) != 0 && !error) {
        error = errno;
    }
    o->file = NULL;
    return error ? strerror(error) : NULL;
}

/* Give up n outputs: delete parts and files that were renamed, bring back the replaced files. */
static void output_drop(struct output *o, int n)
{
    for (int k = 0; k < n; k++) {
        if (o[k].file) {
            fclose(o[k].file);
        }
        file_remove(o[k].shown ? o[k].name : o[k].part);
        if (o[k].old[0]) {
            file_rename(o[k].old, o[k].name);
        }
    }
}

/* Rename the file that has the name, if there is one, to `old`. */
static const char *output_set_aside(struct output *o)
{
    file_stat s;
    if (file_look_at_link(o->name, &s) != 0) {
        return NULL;
    }
    for (int i = 1;; i++) {
        snprintf(o->old, sizeof o->old, "%.*s.old%d", (int)sizeof o->name - 1, o->name, i);
        if (file_look_at_link(o->old, &s) != 0) {
            break;
        }
    }
    if (file_rename(o->name, o->old) == 0) {
        return NULL;
    }
    o->old[0] = '\0';
    return strerror(errno);
}

/* Rename all parts to their names. On an error *bad is the index of the output, and output_drop
 * restores the state before. */
static const char *output_show(struct output *o, int n, int *bad)
{
#ifdef _WIN32
    const int aside = n; /* rename does not replace there */
#else
    const int aside = n - 1; /* after the last rename nothing can fail any more */
#endif
    for (int k = 0; k < n; k++) {
        *bad = k;
        const char *why = k < aside ? output_set_aside(&o[k]) : NULL;
        if (!why && file_rename(o[k].part, o[k].name) != 0) {
            why = strerror(errno);
        }
        if (why) {
            return why;
        }
        o[k].shown = true;
    }
    for (int k = 0; k < n; k++) {
        if (o[k].old[0]) {
            file_remove(o[k].old);
        }
    }
    return NULL;
}

/* Check that a file can be written under this name; leaves nothing behind. */
static const char *output_try(const char *name, const struct output_input *input, int inputs)
{
    struct output o;
    const char *why = output_check(name, input, inputs);
    why = why ? why : output_begin(&o, name);
    if (!why) {
        output_drop(&o, 1);
    }
    return why;
}

/* Puts the content of a file; NULL, or why there is none. */
typedef const char *output_fill(const void *from, FILE *file);

/* Write one file in full. NULL, or what is wrong; then there is no new file and an old one is
 * untouched. */
static inline const char *output_write(const char *name, const struct output_input *input,
                                       int inputs, output_fill *fill, const void *from)
{
    struct output o;
    int bad;
    const char *why = output_check(name, input, inputs);
    why = why ? why : output_begin(&o, name);
    if (why) {
        return why;
    }
    errno = 0;
    const char *told = fill(from, o.file);
    why = output_end(&o, true);
    why = why ? why : told ? told : output_show(&o, 1, &bad);
    if (why) {
        output_drop(&o, 1);
    }
    return why;
}

#endif
