#include "source.h"

#include <stddef.h>

enum fault source_read(const struct source *s, int64_t *offset, struct source_line *line,
                       struct fault_report *r)
{
    const char *text = NULL;
    const int64_t there = s->look(s->context, *offset, &text);
    const int64_t window = there < SOURCE_WINDOW ? there : SOURCE_WINDOW;
    int32_t n = 0;

    r->offset = *offset;
    if (there < 0) {
        return fault_at(r, FAULT_READ, 0, 0);
    }
    line->text = there > 0 ? text : NULL;
    while (n < window && text[n] != '\n') {
        if (text[n] == '\0') {
            return fault_at(r, FAULT_ZERO, 0, n);
        }
        n++;
    }
    *offset += n + (n < window);
    line->length = n > 0 && text[n - 1] == '\r' ? n - 1 : n;
    return line->length <= SOURCE_LINE_MAX ? FAULT_NONE
                                           : fault_at(r, FAULT_LINE_LENGTH, 0, SOURCE_LINE_MAX);
}

static int64_t look(void *context, int64_t offset, const char **text)
{
    const struct source_text *t = context;
    *text = t->text + offset;
    return t->length - offset;
}

struct source source_of(struct source_text *t)
{
    return (struct source){ look, t };
}
