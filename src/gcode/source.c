#include "source.h"

#include <stddef.h>

/* Leave a line behind that is too long. */
static enum fault leave(const struct source *s, int64_t *offset, struct fault_report *r)
{
    const char *text;

    for (;;) {
        const int64_t there = s->look(s->context, *offset, &text);
        if (there < 0) {
            return fault_at(r, FAULT_READ, 0, 0);
        }
        for (int64_t i = 0; i < there; i++) {
            if (text[i] == '\n') {
                *offset += i + 1;
                return fault_at(r, FAULT_LINE_LENGTH, 0, SOURCE_LINE_MAX);
            }
        }
        *offset += there;
        if (there == 0) {
            return fault_at(r, FAULT_LINE_LENGTH, 0, SOURCE_LINE_MAX);
        }
    }
}

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
    if (line->length <= SOURCE_LINE_MAX) {
        return FAULT_NONE;
    }
    return n < window ? fault_at(r, FAULT_LINE_LENGTH, 0, SOURCE_LINE_MAX)
                      : leave(s, offset, r);
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
