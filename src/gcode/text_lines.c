#include "text_lines.h"

#include <string.h>

#include "flow.h"
#include "macro.h"

enum { BOM = 3 };       /* [byte] of the mark with which some editors begin UTF-8 */

static struct reading reading_of(const struct interpreter *in, const struct program *p,
                                 const struct source_line *line, struct fault_report *r)
{
    const bool marked = in->line == 1 && line->length >= BOM &&
                        !memcmp(line->text, "\xEF\xBB\xBF", BOM);

    return (struct reading){ .text = line->text, .at = marked ? BOM : 0, .end = line->length,
                             .in = in, .program = p, .r = r };
}

/* What the line sets takes effect now that all of it has been read. */
static enum fault set(struct interpreter *in, const struct program *p, const struct tokens *t,
                      struct fault_report *r)
{
    for (int i = 0; i < t->settings; i++) {
        const struct setting *s = &t->setting[i];
        const enum fault f = parameters_set(in, p, &s->which, s->value);
        if (f != FAULT_NONE) {
            return fault_at(r, f, s->at, s->length);
        }
    }
    return FAULT_NONE;
}

/* Words and settings of a line that is neither passed over nor an O word's. */
static enum fault words(struct interpreter *in, const struct program *p, struct tokens *t,
                        enum fault f, struct fault_report *r)
{
    struct fault_report ignored;
    const enum fault g = t->settings ? set(in, p, t, f == FAULT_NONE ? r : &ignored) : FAULT_NONE;

    f = f == FAULT_NONE ? g : f;
    in->flow.begun = in->flow.begun || t->count > 0 || t->settings > 0;
    if (f == FAULT_NONE && p->fanuc && macro_calls(t)) {
        f = macro_call(in, p, t, r);
        t->count = 0;
    }
    return f;
}

enum fault lines_next(struct interpreter *in, const struct program *p, struct tokens *t,
                      struct fault_report *r)
{
    const struct oword_place here = { in->offset, in->line };
    struct source_line line;
    enum fault f = source_read(p->source, &in->offset, &line, r);

    t->count = 0;
    if (f == FAULT_NONE && !line.text) {
        in->ended = true;
        return flow_end(in, p, r);
    }
    r->line = ++in->line;
    if (f != FAULT_NONE) {
        return f;
    }
    struct reading s = reading_of(in, p, &line, r);
    f = tokens_read(t, &s);
    if (t->slash && p->block_delete) {
        t->count = 0;           /* whatever stands behind it */
        return FAULT_NONE;
    }
    if (f == FAULT_NONE && t->percent) {
        in->ended = in->percent;    /* the second % closes the program */
        in->percent = true;
        return in->ended ? flow_end(in, p, r) : FAULT_NONE;
    }
    if (f == FAULT_NONE && t->flow) {
        t->count = 0;
        return flow_line(in, &s, here);
    }
    return words(in, p, t, f, r);
}
