/* binding_text - a part program in memory as a struct source for the interpreter, with the files
 * that it calls, which a callback of Python finds. */
#ifndef BINDING_TEXT_H
#define BINDING_TEXT_H

#include "source.h"

/* Callback: text and length of a file that a program calls; NULL if there is none. */
typedef const char *(*binding_file)(const char *name, int64_t *length);

struct binding_text {
    struct source_text text;
    binding_file file;         /* NULL: no files can be called */
    struct source_text called; /* text of the file called last, */
    char name[FAULT_FILE];     /* and its name */
};

/* Make a text; make a source of it. The texts must stay in memory while they are read. */
struct binding_text binding_text_of(const char *text, int64_t length, binding_file file);
struct source binding_source(struct binding_text *t);

#endif
