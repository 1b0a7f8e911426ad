/* program_file - the part program of an FMU and the files that it calls, read through a window of
 * fixed size, as a struct source for the interpreter. */
#ifndef PROGRAM_FILE_H
#define PROGRAM_FILE_H

#include <limits.h>
#include "fmu_input.h"
#include "source.h"

enum { PROGRAM_WINDOW = 1 << 16 }; /* [byte] some two thousand blocks */

/* An open part program, or a file that one calls. */
struct program_file {
    FILE *file;
    int64_t offset, count;     /* [byte] place of the window in the file; its filling */
    int error;                 /* errno of a read that failed */
    char *path;                /* path of the program; files that it calls are in its folder */
    struct program_file *next; /* list of the files that it has called */
    char name[FAULT_FILE];     /* name by which this file is called; "" for the program */
    char byte[PROGRAM_WINDOW]; /* the window */
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

/* Fill the window from an offset on, keeping the bytes that it has already. */
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

/* Bytes of an open file from an offset on: *text points to them. Returns their number, -1 on an
 * error. */
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

/* Open a part program. Returns NULL, or what is wrong; *program stays NULL if the file is empty. */
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

/* The file `name`.ngc in the folder of a program, opened at its first use; NULL if there is
 * none. */
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

/* The function `look` of a struct source; without a program (NULL) there is no file. */
static int64_t program_look(void *context, const char *file, int64_t offset, const char **text)
{
    struct program_file *p = context;
    struct program_file *of = p && file[0] ? program_called(p, file) : p;

    if (!of) {
        return SOURCE_NONE;
    }
    const int64_t there = program_bytes(of, offset, text);
    p->error = there < 0 ? of->error : p->error;
    return there;
}

#endif
