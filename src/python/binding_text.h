/* binding_text - a part program in memory, and the files that it calls as Python finds them. */
#ifndef BINDING_TEXT_H
#define BINDING_TEXT_H

#include "source.h"

/* Text of a file that a program calls, and its length; NULL: there is none. */
typedef const char *(*binding_file)(const char *name, int64_t *length);

struct binding_text {
    struct source_text text;
    binding_file file;         /* or NULL: it calls none */
    struct source_text called; /* the latest: */
    char name[FAULT_FILE];
};

/* The texts stay where they are while they are read. */
struct binding_text binding_text_of(const char *text, int64_t length, binding_file file);
struct source binding_source(struct binding_text *t);

#endif
