#include "source.h"

#include <stddef.h>
#include <string.h>

enum { BOM = 3 }; /* [byte] length of the byte order mark that some editors write */

/* Move *offset behind a line that is too long. FAULT_LINE_LENGTH, FAULT_READ. */
static enum fault leave(const struct source *s, const char *file, int64_t *offset,
                        struct fault_report *r)
{
    const char *text;

    for (;;) {
        const int64_t there = s->look(s->context, file, *offset, &text);
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

enum fault source_read(const struct source *s, const char *file, int64_t *offset,
                       struct source_line *line, struct fault_report *r)
{
    const char *text = NULL;
    const int64_t there = s->look(s->context, file, *offset, &text);
    const int64_t window = there < SOURCE_WINDOW ? there : SOURCE_WINDOW;
    int32_t n = 0;

    if (*offset == 0 && there >= BOM && memcmp(text, "\xEF\xBB\xBF", BOM) == 0) {
        *offset = BOM;
        return source_read(s, file, offset, line, r);
    }
    r->offset = *offset;
    memcpy(r->file, file, FAULT_FILE);
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
                      : leave(s, file, offset, r);
}

bool source_name(const char *file)
{
    bool may = file[0] != '\0';

    for (const char *c = file; *c; c++) {
        may =
            may && ((*c >= 'a' && *c <= 'z') || (*c >= '0' && *c <= '9') || *c == '-' || *c == '_');
    }
    return may;
}

bool source_has(const struct source *s, const char *file)
{
    const char *text;
    return source_name(file) && s->look(s->context, file, 0, &text) != SOURCE_NONE;
}

static int64_t look(void *context, const char *file, int64_t offset, const char **text)
{
    const struct source_text *t = context;
    if (file[0]) {
        return SOURCE_NONE;
    }
    *text = t->text + offset;
    return t->length - offset;
}

struct source source_of(struct source_text *t)
{
    return (struct source){ look, t };
}
