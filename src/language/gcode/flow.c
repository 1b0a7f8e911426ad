#include "flow.h"

#include <string.h>

#include "expression.h"
#include "flow_step.h"
#include "modes.h"

enum fault flow_refuse(const struct flow_step *l, enum fault f)
{
    return reading_fault(l->s, f, l->at);
}

void flow_go(struct interpreter *in, struct oword_place to)
{
    in->offset = to.offset;
    in->line = to.line;
    in->file = to.file;
}

const char *flow_file(const struct interpreter *in, int32_t file)
{
    static const char PROGRAM[OWORD_LABEL] = "";
    return file > 0 ? in->flow.file[file - 1] : PROGRAM;
}

int32_t flow_line_shown(const struct interpreter *in)
{
    int32_t line = in->line;

    for (int32_t i = in->flow.level - 1, file = in->file; i >= 0 && file > 0; i--) {
        file = in->flow.call[i].here.file;
        line = in->flow.call[i].here.line + 1;
    }
    return line;
}

enum fault flow_again(struct interpreter *in, struct oword_place to, struct fault_report *r)
{
    struct flow *f = &in->flow;
    const int32_t lines = in->file == to.file ? in->line - to.line : 1;

    f->again += lines > 0 ? lines : 1;
    flow_go(in, to);
    return f->again - f->idle <= FLOW_IDLE ? FAULT_NONE
                                           : fault_at(r, FAULT_ENDLESS, r->at, r->length);
}

struct oword_place flow_behind(const struct interpreter *in)
{
    return (struct oword_place){ in->offset, in->line, in->file };
}

/* The end of what this line begins or is in: one of some words with a label. With `past` the place
 * is the one behind it. Found ends are remembered. */
static enum fault seek_end(const struct flow_step *l, const char *label, int32_t words, bool past,
                           struct oword_place *place)
{
    struct flow *f = &l->in->flow;
    const int64_t from = l->in->offset;
    const int32_t stop = words & OWORD_ENDSUB ? 0 : OWORD_EITHER_SUB;
    const int32_t kind = past ? -words : words;
    int32_t is;

    for (int i = 0; i < FLOW_KNOWN; i++) {
        const struct flow_known_end *e = &f->end[i];
        if (e->from == from && e->file == l->in->file && e->words == kind) {
            *place = f->end[i].place;
            return FAULT_NONE;
        }
    }
    *place = flow_behind(l->in);
    flow_refuse(l, FAULT_O_END); /* of this line, whose text goes when others are read */
    const char *const file = flow_file(l->in, place->file);
    enum fault g = oword_seek(l->s->program, file, label, words, stop, place, &is);
    if (g == FAULT_NONE && !is) {
        g = FAULT_O_END;
    }
    if (g == FAULT_NONE && past) {
        struct source_line line;
        struct fault_report r;
        g = source_read(l->s->program->source, file, &place->offset, &line, &r);
        place->line++;
    }
    if (g == FAULT_NONE) {
        f->end[f->ends].from = from;
        f->end[f->ends].file = place->file;
        f->end[f->ends].words = kind;
        f->end[f->ends].place = *place;
        f->ends = (f->ends + 1) % FLOW_KNOWN;
    }
    return g;
}

static enum fault skip_to(const struct flow_step *l, const char *label, int32_t words, bool past)
{
    struct oword_place place;
    const enum fault f = seek_end(l, label, words, past, &place);

    if (f == FAULT_NONE) {
        flow_go(l->in, place);
    }
    return f;
}

/* What is open with a label in the call that runs, or NULL. */
static struct flow_open *opened(struct interpreter *in, const char *label)
{
    struct flow *f = &in->flow;
    const int32_t base = f->level > 0 ? f->call[f->level - 1].opens : 0;

    for (int32_t i = f->opens - 1; i >= base; i--) {
        if (oword_same(f->open[i].label, label)) {
            return &f->open[i];
        }
    }
    return NULL;
}

/* The same if it is the innermost, of this kind. */
static struct flow_open *innermost(const struct flow_step *l, enum flow_kind kind)
{
    struct flow *f = &l->in->flow;
    struct flow_open *o = opened(l->in, l->o.label);

    return o && o == &f->open[f->opens - 1] && o->kind == kind ? o : NULL;
}

enum fault flow_open(const struct flow_step *l, enum flow_kind kind, int32_t left)
{
    struct flow *f = &l->in->flow;

    if (opened(l->in, l->o.label)) {
        return flow_refuse(l, FAULT_O_OPEN);
    }
    if (f->opens == FLOW_OPEN) {
        return flow_refuse(l, FAULT_O_DEEP);
    }
    struct flow_open *o = &f->open[f->opens++];
    memset(o, 0, sizeof *o);
    memcpy(o->label, l->o.label, OWORD_LABEL);
    o->kind = kind;
    o->left = left;
    o->here = l->here;
    o->behind = flow_behind(l->in);
    return FAULT_NONE;
}

enum fault flow_condition(const struct flow_step *l, double *value)
{
    const enum fault f = expression_brackets(l->s, value);
    return f == FAULT_NONE ? oword_alone(l->s) : f;
}

static const int32_t BRANCHES = OWORD_ELSEIF | OWORD_ELSE | OWORD_ENDIF;

static enum fault if_line(const struct flow_step *l)
{
    struct flow_open *o = l->o.is == OWORD_IF ? NULL : innermost(l, FLOW_IF);
    double value = 1.0;

    if (l->o.is != OWORD_IF && !o) {
        return flow_refuse(l, FAULT_O_PLACE);
    }
    if (l->o.is == OWORD_ENDIF) {
        l->in->flow.opens--;
        return oword_alone(l->s);
    }
    if (o && o->left) { /* a branch before it has run */
        return skip_to(l, l->o.label, OWORD_ENDIF, false);
    }
    enum fault f = l->o.is == OWORD_ELSE ? oword_alone(l->s) : flow_condition(l, &value);
    if (f == FAULT_NONE && !o) {
        f = flow_open(l, FLOW_IF, 0);
        o = &l->in->flow.open[l->in->flow.opens - 1];
    }
    if (f != FAULT_NONE) {
        return f;
    }
    o->left = value != 0.0;
    f = value != 0.0 ? FAULT_NONE : skip_to(l, l->o.label, BRANCHES, false);
    l->in->flow.opens -= f != FAULT_NONE && l->o.is == OWORD_IF;
    return f;
}

/* The end of a loop: once more, or out of it. */
static enum fault loop_end(const struct flow_step *l, enum flow_kind kind, bool more)
{
    struct flow_open *o = innermost(l, kind);

    l->in->flow.opens -= !more || kind == FLOW_WHILE; /* its line opens it again */
    reading_fault(l->s, FAULT_ENDLESS, l->at);
    return !more ? FAULT_NONE
                 : flow_again(l->in, kind == FLOW_WHILE ? o->here : o->behind, l->s->r);
}

enum fault flow_loop_end(const struct flow_step *l)
{
    return innermost(l, FLOW_WHILE) ? loop_end(l, FLOW_WHILE, true) : flow_refuse(l, FAULT_O_PLACE);
}

/* while begins a loop, or ends one that began with do. */
static enum fault while_line(const struct flow_step *l)
{
    const bool ends = innermost(l, FLOW_DO) != NULL;
    double value;
    enum fault f = flow_condition(l, &value);

    if (f != FAULT_NONE) {
        return f;
    }
    if (ends) {
        return loop_end(l, FLOW_DO, value != 0.0);
    }
    return value != 0.0 ? flow_open(l, FLOW_WHILE, 0)
                        : skip_to(l, l->o.label, OWORD_ENDWHILE, true);
}

static enum fault repeat_line(const struct flow_step *l)
{
    const int32_t from = l->s->at;
    double value;
    int32_t runs;
    enum fault f = flow_condition(l, &value);

    if (f == FAULT_NONE && !reading_integer(value, &runs)) {
        f = reading_fault(l->s, FAULT_VALUE, from);
    }
    if (f != FAULT_NONE) {
        return f;
    }
    return runs > 0 ? flow_open(l, FLOW_REPEAT, runs)
                    : skip_to(l, l->o.label, OWORD_ENDREPEAT, true);
}

/* endwhile, endrepeat */
static enum fault end_line(const struct flow_step *l)
{
    const enum flow_kind kind = l->o.is == OWORD_ENDWHILE ? FLOW_WHILE : FLOW_REPEAT;
    struct flow_open *o = innermost(l, kind);
    const enum fault f = oword_alone(l->s);

    if (f != FAULT_NONE || !o) {
        return f != FAULT_NONE ? f : flow_refuse(l, FAULT_O_PLACE);
    }
    return loop_end(l, kind, kind == FLOW_WHILE || --o->left > 0);
}

/* break, continue */
static enum fault leave_line(const struct flow_step *l)
{
    struct flow *flow = &l->in->flow;
    struct flow_open *o = opened(l->in, l->o.label);
    const enum fault f = oword_alone(l->s);

    if (f != FAULT_NONE || !o || o->kind == FLOW_IF) {
        return f != FAULT_NONE ? f : flow_refuse(l, FAULT_O_PLACE);
    }
    const int32_t end = o->kind == FLOW_WHILE ? OWORD_ENDWHILE
                        : o->kind == FLOW_DO  ? OWORD_WHILE
                                              : OWORD_ENDREPEAT;
    const bool out = l->o.is == OWORD_BREAK;
    flow->opens = (int32_t)(o - flow->open) + !out;
    return skip_to(l, l->o.label, end, out);
}

/* o.. do, until its while. */
static enum fault do_line(const struct flow_step *l)
{
    const enum fault f = oword_alone(l->s);
    return f == FAULT_NONE ? flow_open(l, FLOW_DO, 0) : f;
}

enum fault flow_line(struct interpreter *in, struct reading *s, struct oword_place here)
{
    struct flow_step l = { .in = in, .s = s, .here = here, .at = s->at };
    enum fault f = oword_read(s, &l.o);

    if (f != FAULT_NONE) {
        return f;
    }
    switch (l.o.is) {
    case OWORD_NUMBER: return in->flow.begun ? flow_refuse(&l, FAULT_O_NUMBER) : oword_alone(s);
    case OWORD_SUB:
        f = oword_alone(s);
        return f == FAULT_NONE ? skip_to(&l, l.o.label, OWORD_ENDSUB, true) : f;
    case OWORD_CALL:      return flow_call_line(&l);
    case OWORD_RETURN:
    case OWORD_ENDSUB:    return flow_return_line(&l);
    case OWORD_WHILE:     return while_line(&l);
    case OWORD_DO:        return do_line(&l);
    case OWORD_REPEAT:    return repeat_line(&l);
    case OWORD_ENDWHILE:
    case OWORD_ENDREPEAT: return end_line(&l);
    case OWORD_BREAK:
    case OWORD_CONTINUE:  return leave_line(&l);
    default:              return if_line(&l);
    }
}

enum fault flow_end(const struct interpreter *in, const struct program *p, struct fault_report *r)
{
    const struct flow *f = &in->flow;
    struct oword_place at;
    struct source_line line;

    if (f->opens > 0) {
        at = f->open[f->opens - 1].here;
    } else if (f->level > 0) {
        at = f->call[f->level - 1].here;
    } else {
        return FAULT_NONE;
    }
    r->line = at.line + 1;
    const enum fault g = source_read(p->source, flow_file(in, at.file), &at.offset, &line, r);
    return g != FAULT_NONE ? g : fault_at(r, FAULT_O_END, 0, line.length);
}
