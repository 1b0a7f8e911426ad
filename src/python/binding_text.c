#include "binding_text.h"

#include <string.h>

struct binding_text binding_text_of(const char *text, int64_t length, binding_file file)
{
    return (struct binding_text){ .text = { text, length }, .file = file };
}

/* The function `look` of a struct source. */
static int64_t look(void *context, const char *file, int64_t offset, const char **text)
{
    struct binding_text *t = context;
    const struct source_text *of = file[0] ? &t->called : &t->text;

    if (file[0] && strcmp(file, t->name) != 0) {
        t->called.text = t->file ? t->file(file, &t->called.length) : NULL;
        memset(t->name, 0, sizeof t->name);
        if (!t->called.text) {
            return SOURCE_NONE;
        }
        memcpy(t->name, file, strlen(file));
    }
    *text = of->text + offset;
    return of->length - offset;
}

struct source binding_source(struct binding_text *t)
{
    return (struct source){ look, t };
}
