/* Reads a part program of an FMU with the mcc core, through a window of fixed size. */
#ifndef PROGRAM_FILE_H
#define PROGRAM_FILE_H

#include <limits.h>
#include "fmu_input.h"
#include "source.h"

enum { PROGRAM_WINDOW = 1 << 16 }; /* [byte] some two thousand blocks */

/* An open part program, or a file that one calls; byte[0 .. count) stands at an offset of the file,
 * which is read up to offset + count. */
struct program_file {
    FILE *file;
    int64_t offset, count;
    int error;                 /* errno value of a read that failed */
    char *path;                /* of the program: files that it calls are beside it */
    struct program_file *next; /* of those that it has called */
    char name[FAULT_FILE];     /* of such a file */
    char byte[PROGRAM_WINDOW];
};

/* Go to an offset, also beyond 2 GiB. */
static int program_seek(FILE *file, int64_t offset)
{
#ifdef _WIN32
    return _fseeki64(file, offset, SEEK_SET);
#else
    return offset <= LONG_MAX ? fseek(file, (long)offset, SEEK_SET) : -1;
#endif
}

/* Fill the window from an offset on, keeping what it has of it. */
static int program_fill(struct program_file *p, int64_t offset)
{
    const int64_t skip = offset - p->offset;
    const int64_t keep = skip >= 0 && skip <= p->count ? p->count - skip : -1;

    p->count = keep > 0 ? keep : 0;
    p->offset = offset;
    if (keep > 0) {
        memmove(p->byte, p->byte + skip, (size_t)keep);
    }
    errno = 0;
    if (keep < 0 && program_seek(p->file, offset) != 0) {
        p->error = errno ? errno : EIO;
        return -1;
    }
    p->count += (int64_t)fread(p->byte + p->count, 1, (size_t)(PROGRAM_WINDOW - p->count), p->file);
    if (ferror(p->file)) {
        p->error = errno ? errno : EIO;
        return -1;
    }
    return 0;
}

/* Bytes of an open file from an offset on. */
static int64_t program_bytes(struct program_file *p, int64_t offset, const char **text)
{
    const int64_t behind = p->offset + p->count;

    if (offset < p->offset || offset > behind - SOURCE_WINDOW) {
        if (program_fill(p, offset)) {
            return -1;
        }
    }
    *text = p->byte + (offset - p->offset);
    return p->offset + p->count - offset;
}

/* Returns NULL or what is wrong; *program stays NULL if the file is empty. */
static const char *program_open(const char *name, struct program_file **program)
{
    FILE *file;
    *program = NULL;
    const char *why = file_open(name, &file);
    if (why) {
        return why;
    }
    struct program_file *p = malloc(sizeof *p);
    char *path = malloc(strlen(name) + 1);
    if (!p || !path) {
        fclose(file);
        free(p);
        free(path);
        return strerror(ENOMEM);
    }
    setvbuf(file, NULL, _IONBF, 0); /* the window is the buffer */
    p->file = file;
    p->path = strcpy(path, name);
    p->next = NULL;
    p->name[0] = '\0';
    p->offset = p->count = p->error = 0;
    if (program_fill(p, 0) || p->count == 0) {
        const int error = p->error;
        fclose(file);
        free(path);
        free(p);
        return error ? strerror(error) : NULL;
    }
    *program = p;
    return NULL;
}

static void program_close(struct program_file *p)
{
    while (p) {
        struct program_file *next = p->next;
        fclose(p->file);
        free(p->path);
        free(p);
        p = next;
    }
}

/* The file of a name beside a program, opened at its first use; NULL: there is none. */
static struct program_file *program_called(struct program_file *p, const char *name)
{
    char path[4096];
    int folder = 0;

    for (struct program_file *c = p->next; c; c = c->next) {
        if (strcmp(c->name, name) == 0) {
            return c;
        }
    }
    for (int i = 0; p->path[i]; i++) {
        folder = p->path[i] == '/' || p->path[i] == '\\' ? i + 1 : folder;
    }
    const int length = snprintf(path, sizeof path, "%.*s%s.ngc", folder, p->path, name);
    struct program_file *c = NULL;
    if (length < 0 || length >= (int)sizeof path || program_open(path, &c) || !c) {
        return NULL;
    }
    snprintf(c->name, sizeof c->name, "%s", name);
    c->next = p->next;
    p->next = c;
    return c;
}

/* struct source's look. */
static int64_t program_look(void *context, const char *file, int64_t offset, const char **text)
{
    struct program_file *p = context;
    struct program_file *of = file[0] ? program_called(p, file) : p;

    if (!of) {
        return SOURCE_NONE;
    }
    const int64_t there = program_bytes(of, offset, text);
    p->error = there < 0 ? of->error : p->error;
    return there;
}

#endif
