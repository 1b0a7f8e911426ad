/* Reads the part program of the mcc FMU. */
#ifndef PROGRAM_FILE_H
#define PROGRAM_FILE_H

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>

enum { PROGRAM_MAX = 64 << 20 };    /* [byte] some two million blocks */

/* Text of a part program. */
struct text {
    size_t length;
    char   byte[];
};

/* Read a whole file; *text stays NULL if it is empty. Returns an errno value, EFBIG if it is larger
 * than PROGRAM_MAX. The caller frees. */
static int text_read(const char *name, struct text **text)
{
    size_t room = 1 << 16;
    FILE *file = fopen(name, "rb");
    *text = NULL;
    if (!file) {
        return errno;
    }
    int error = 0;
    struct text *t = malloc(sizeof *t + room);
    if (t) {
        t->length = 0;
    } else {
        error = ENOMEM;
    }
    while (!error) {
        const size_t n = fread(t->byte + t->length, 1, room - t->length, file);
        t->length += n;
        if (t->length > PROGRAM_MAX) {
            error = EFBIG;
        } else if (t->length == room) {
            struct text *more = realloc(t, sizeof *t + (room *= 2));
            error = more ? 0 : ENOMEM;
            t = more ? more : t;
        } else {
            error = ferror(file) ? errno : 0;
            break;
        }
    }
    fclose(file);
    if (error || t->length == 0) {
        free(t);
    } else {
        *text = t;
    }
    return error;
}

#endif
