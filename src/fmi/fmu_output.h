/* A file that an FMU writes takes the place of a regular file or of nothing, in full and at the
 * end. Functions return NULL, or words for what is wrong. */
#ifndef FMU_OUTPUT_H
#define FMU_OUTPUT_H

#include <stdbool.h>

#include "fmu_file.h"

/* A file that the same instance reads, "" if none, and what to say if it would be replaced. */
struct output_input {
    struct fmu_path path;
    const char *words;
};

/* A file on its way: it is written under the name `part`. */
struct output {
    char name[FMU_STRING_MAX + 16];
    char part[FMU_STRING_MAX + 48];
    bool shown;                    /* it has the name */
    char old[FMU_STRING_MAX + 48]; /* what had the name before is kept here, "" if nothing */
    FILE *file;
};

/* May a file take this name? A link is not replaced: it may be somebody's way to another file. */
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

/* Make the part, under a name that is nobody's yet. */
static const char *output_begin(struct output *o, const char *name)
{
    enum { TRIES = 100 }; /* parts that killed runs have left, at most */
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

/* The part is complete; `good`: so far without an error. */
static const char *output_end(struct output *o, bool good)
{
    int error = good && !ferror(o->file) ? 0 : errno ? errno : EIO;
    if (fclose(o->file) != 0 && !error) {
        error = errno;
    }
    o->file = NULL;
    return error ? strerror(error) : NULL;
}

/* Delete the parts that are still there, bring back what stood in the place of the others. */
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

/* Move what has the name out of the way. */
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

/* Give all parts their names. On an error *bad is the one, and output_drop brings back what was. */
static const char *output_show(struct output *o, int n, int *bad)
{
#ifdef _WIN32
    const int aside = n; /* rename does not replace there */
#else
    const int aside = n - 1; /* behind the last one nothing can fail any more */
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

/* Could a file be made under this name? Nothing is left behind. */
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

#endif
