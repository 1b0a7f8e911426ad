#include "text_lines.h"

#include "flow.h"
#include "macro.h"

/* Set the parameters of a line, all of which has been read. */
static enum fault set(struct interpreter *in, const struct program *p, const struct tokens *t,
                      struct fault_report *r)
{
    for (int i = 0; i < t->settings; i++) {
        const struct setting *s = &t->setting[i];
        if (p->fanuc && s->which.number == PARAMETERS_ALARM) { /* told with its message */
            return fault_at(r, FAULT_ALARM, s->at, t->at + t->length - s->at);
        }
        const enum fault f = parameters_set(in, p, &s->which, s->value);
        if (f != FAULT_NONE) {
            return fault_at(r, f, s->at, s->length);
        }
    }
    return FAULT_NONE;
}

/* Settings and calls of a line that is neither passed over nor begins with an O word; f is a fault
 * of its text. */
static enum fault words(struct interpreter *in, const struct program *p, struct tokens *t,
                        struct oword_place here, enum fault f, struct fault_report *r)
{
    struct fault_report ignored;
    const bool called = in->flow.rest;

    in->flow.rest = false;
    if (f == FAULT_NONE && !called && macro_user(t)) {
        in->flow.begun = true;
        f = macro_call_user(in, p, t, here, r);
        t->count = 0;
        return f;
    }
    const enum fault g = t->settings ? set(in, p, t, f == FAULT_NONE ? r : &ignored) : FAULT_NONE;

    f = f == FAULT_NONE ? g : f;
    in->flow.begun = in->flow.begun || t->count > 0 || t->settings > 0;
    if (f == FAULT_NONE && p->fanuc && macro_calls(t)) {
        f = macro_call(in, p, t, r);
        t->count = 0;
    }
    return f;
}

/* A line with IF, GOTO, WHILE, DO or END. Behind THEN it may only set parameters. */
static enum fault fanuc(struct interpreter *in, const struct program *p, struct tokens *t,
                        struct reading *s, struct oword_place here)
{
    bool then;
    enum fault f = flow_fanuc(in, s, here, &then);

    if (f != FAULT_NONE || !then) {
        return f;
    }
    f = tokens_read(t, s);
    if (f == FAULT_NONE && (t->count > 0 || t->settings == 0 || t->flow)) {
        f = tokens_at_line(s->r, FAULT_O_BEHIND, t);
    }
    t->count = 0;
    return f == FAULT_NONE ? set(in, p, t, s->r) : f;
}

/* A line with an O word, or with IF, GOTO, WHILE, DO or END, which a line by hand has not. */
static enum fault flow(struct interpreter *in, const struct program *p, struct tokens *t,
                       struct reading *s, struct oword_place here)
{
    t->count = 0;
    if (!flow_fanuc_begins(*s)) {
        return flow_line(in, s, here);
    }
    return p->by_hand && in->file == 0 ? tokens_at_line(s->r, FAULT_ALONE, t)
                                       : fanuc(in, p, t, s, here);
}

/* The second % closes the program; in lines by hand it means nothing, as senders have it at both
 * ends. */
static enum fault percent(struct interpreter *in, const struct program *p, struct fault_report *r)
{
    if (p->by_hand) {
        return FAULT_NONE;
    }
    in->ended = in->percent;
    in->percent = true;
    return in->ended ? flow_end(in, p, r) : FAULT_NONE;
}

enum fault lines_next(struct interpreter *in, const struct program *p, struct tokens *t,
                      struct fault_report *r)
{
    const struct oword_place here = { in->offset, in->line, in->file };
    struct source_line line;
    enum fault f = source_read(p->source, flow_file(in, in->file), &in->offset, &line, r);

    t->count = 0;
    if (f == FAULT_NONE && !line.text) {
        in->ended = true; /* of a file, too: a subprogram there lacks its end */
        return flow_end(in, p, r);
    }
    r->line = ++in->line;
    if (f != FAULT_NONE) {
        return f;
    }
    struct reading s = { .text = line.text, .end = line.length, .in = in, .program = p, .r = r };
    f = tokens_read(t, &s);
    if (t->slash && p->block_delete) {
        t->count = 0; /* whatever stands behind it */
        return FAULT_NONE;
    }
    if (f == FAULT_NONE && t->percent) {
        return percent(in, p, r);
    }
    if (f == FAULT_NONE && t->flow) {
        return flow(in, p, t, &s, here);
    }
    return words(in, p, t, here, f, r);
}
