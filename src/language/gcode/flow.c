#include "flow.h"

#include <string.h>

#include "expression.h"
#include "flow_step.h"
#include "modes.h"

_Static_assert((int)OWORD_LABEL == (int)FAULT_FILE, "a label names a file");

/* P of M98 on Fanuc's controls is runs * FANUC_RUNS + number of the program. */
enum { FANUC_RUNS = 10000 };

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

/* Place of the end of what this line begins or is in: the next line with the label and one of some
 * words (bits). With `past` it is the place behind that line. Ends are remembered. */
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
    flow_refuse(l, FAULT_O_END); /* now: the line's text is gone when others are read */
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

/* Go on at that end. */
static enum fault skip_to(const struct flow_step *l, const char *label, int32_t words, bool past)
{
    struct oword_place place;
    const enum fault f = seek_end(l, label, words, past, &place);

    if (f == FAULT_NONE) {
        flow_go(l->in, place);
    }
    return f;
}

/* The condition or loop that is open with a label in the call that runs, or NULL. */
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

/* That with the label of l, if it is open innermost and of this kind; or NULL. */
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

/* Read an expression in [ ] and the end of the line. */
static enum fault condition(const struct flow_step *l, double *value)
{
    const enum fault f = expression_brackets(l->s, value);
    return f == FAULT_NONE ? oword_alone(l->s) : f;
}

static const int32_t BRANCHES = OWORD_ELSEIF | OWORD_ELSE | OWORD_ENDIF;

/* if, elseif, else, endif */
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
    if (o && o->left) { /* a branch in front of it has run */
        return skip_to(l, l->o.label, OWORD_ENDIF, false);
    }
    enum fault f = l->o.is == OWORD_ELSE ? oword_alone(l->s) : condition(l, &value);
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

/* At the end of a loop: run it once more, or go on behind it. */
static enum fault loop_end(const struct flow_step *l, enum flow_kind kind, bool more)
{
    struct flow_open *o = innermost(l, kind);

    l->in->flow.opens -= !more || kind == FLOW_WHILE; /* the line of WHILE opens it again */
    reading_fault(l->s, FAULT_ENDLESS, l->at);
    return !more ? FAULT_NONE
                 : flow_again(l->in, kind == FLOW_WHILE ? o->here : o->behind, l->s->r);
}

enum fault flow_loop_end(const struct flow_step *l)
{
    return innermost(l, FLOW_WHILE) ? loop_end(l, FLOW_WHILE, true) : flow_refuse(l, FAULT_O_PLACE);
}

/* A while begins a loop, or ends one that began with do. */
static enum fault while_line(const struct flow_step *l)
{
    const bool ends = innermost(l, FLOW_DO) != NULL;
    double value;
    enum fault f = condition(l, &value);

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
    enum fault f = condition(l, &value);

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

/* do, whose loop ends with a while of its label. */
static enum fault do_line(const struct flow_step *l)
{
    const enum fault f = oword_alone(l->s);
    return f == FAULT_NONE ? flow_open(l, FLOW_DO, 0) : f;
}

/* Number of the called file that has the name of a subprogram, which is added if it is new; 0:
 * there is no such file. */
static enum fault find_file(struct interpreter *in, const struct program *p, const char *label,
                            int32_t *file)
{
    struct flow *f = &in->flow;

    for (*file = f->files; *file > 0; --*file) {
        if (oword_same(f->file[*file - 1], label)) {
            return FAULT_NONE;
        }
    }
    if (!source_has(p->source, label)) {
        return FAULT_NONE;
    }
    if (f->files == FLOW_FILES) {
        return FAULT_FILES;
    }
    memcpy(f->file[f->files++], label, OWORD_LABEL);
    *file = f->files;
    return FAULT_NONE;
}

/* Whether a text is searched for a subprogram: first the one that calls; lines by hand have
 * none. */
static bool searched(const struct interpreter *in, const struct program *p, int32_t file,
                     bool first)
{
    return file > 0 || (file == 0 && (first || in->file > 0) && !p->by_hand);
}

/* Place where a subprogram begins, behind its O word. It is in the text that calls it, in the
 * program, or in the file of its name.
 * CCN 16: three places are searched in turn, and each step only goes on behind one without a
 * fault. */
static enum fault find_sub(struct interpreter *in, const struct program *p, const char *label,
                           int32_t words, struct oword_place *place)
{
    struct flow *f = &in->flow;
    struct source_line line;
    struct fault_report r;
    int32_t file[3] = { in->file, 0, -1 }, is = 0;
    enum fault g = FAULT_NONE;

    for (int i = 0; i < FLOW_KNOWN; i++) {
        const struct flow_known_sub *k = &f->sub[i];
        if (k->words == words && k->file == in->file && oword_same(k->label, label)) {
            *place = k->place;
            return FAULT_NONE;
        }
    }
    for (int i = 0; i < 3 && g == FAULT_NONE && !is; i++) {
        if (i == 2 && words == OWORD_SUB) {
            g = find_file(in, p, label, &file[i]);
        }
        if (g == FAULT_NONE && searched(in, p, file[i], i == 0)) {
            *place = (struct oword_place){ .file = file[i] };
            g = oword_seek(p, flow_file(in, file[i]), label, words, 0, place, &is);
        }
    }
    g = g == FAULT_NONE && !is ? FAULT_NO_SUB : g;
    if (g == FAULT_NONE) {
        g = source_read(p->source, flow_file(in, place->file), &place->offset, &line, &r);
        place->line++;
    }
    if (g == FAULT_NONE) {
        memcpy(f->sub[f->subs].label, label, OWORD_LABEL);
        f->sub[f->subs].words = words;
        f->sub[f->subs].file = in->file;
        f->sub[f->subs].place = *place;
        f->subs = (f->subs + 1) % FLOW_KNOWN;
    }
    return g;
}

/* Bits of #1 .. #count in parameters.given[0]. */
static uint64_t bits(int32_t count)
{
    return (UINT64_C(1) << count) - 1;
}

/* Copy the local parameters #1 .. #count out of the parameters, and back into them. */
static void take_locals(const struct parameters *all, int32_t count, struct flow_local *local)
{
    local->set = all->given[0] & bits(count);
    for (int32_t i = 0; i < count; i++) {
        local->value[i] = local->set >> i & 1 ? all->value[i] : 0.0;
    }
}

static void put_locals(struct parameters *all, int32_t count, const struct flow_local *local)
{
    memcpy(all->value, local->value, (size_t)count * sizeof *local->value);
    all->given[0] = (all->given[0] & ~bits(count)) | (local->set & bits(count));
}

/* Call the subprogram that begins at a place; r has the place of the call in the text. */
static enum fault call(struct interpreter *in, const struct program *p, const char *label,
                       enum flow_caller caller, int32_t runs, struct oword_place body,
                       const struct flow_local *local, struct fault_report *r)
{
    struct flow *f = &in->flow;

    if (f->level == FLOW_CALLS) {
        return fault_at(r, FAULT_CALLS, r->at, r->length);
    }
    struct flow_call *c = &f->call[f->level++];
    memset(c, 0, sizeof *c);
    in->saved[f->level].kept = in->saved[f->level].returns = false;
    memcpy(c->label, label, OWORD_LABEL);
    c->caller = caller;
    c->left = runs;
    c->opens = f->opens;
    c->body = body;
    c->here = (struct oword_place){ r->offset, r->line - 1, in->file };
    c->back = flow_behind(in);
    if (local) {
        c->locals = p->fanuc ? PARAMETERS_LOCAL_FANUC : PARAMETERS_LOCAL;
        c->given = *local;
        take_locals(&in->parameters, c->locals, &c->before);
        put_locals(&in->parameters, c->locals, &c->given);
    }
    f->value = 0.0;
    f->returned = false;
    return flow_again(in, body, r);
}

/* The subprogram that runs has reached its end: run it again, or go back to its caller. */
static enum fault leave(struct interpreter *in, struct fault_report *r)
{
    struct flow *f = &in->flow;
    struct flow_call *c = &f->call[f->level - 1];

    f->opens = c->opens;
    if (--c->left > 0) {
        put_locals(&in->parameters, c->locals, &c->given);
        return flow_again(in, c->body, r);
    }
    put_locals(&in->parameters, c->locals, &c->before);
    parameters_leave(&in->parameters, f->level);
    f->rest = c->rest;
    f->left = in->saved[f->level].returns ? f->level : 0;
    f->level--;
    f->modal.level = f->modal.level > f->level ? f->level : f->modal.level;
    f->again += in->line > c->body.line ? in->line - c->body.line : 1;
    flow_go(in, c->back);
    return FAULT_NONE;
}

/* call, with up to 30 values in [ ] */
static enum fault call_line(const struct flow_step *l)
{
    /* Local parameters without a value are 0, as in rs274. */
    struct flow_local local = { .set = bits(PARAMETERS_LOCAL) };
    struct oword_place body;
    enum fault f = FAULT_NONE;
    int count = 0;

    for (char c = reading_peek(l->s); f == FAULT_NONE && (c == '[' || c == '(');
         c = reading_peek(l->s)) {
        if (c == '[' && count == PARAMETERS_LOCAL) {
            return flow_refuse(l, FAULT_O_BEHIND);
        }
        f = c == '(' ? reading_comment(l->s) : expression_brackets(l->s, &local.value[count++]);
    }
    f = f == FAULT_NONE ? oword_alone(l->s) : f;
    if (f != FAULT_NONE) {
        return f;
    }
    flow_refuse(l, FAULT_NO_SUB);
    f = find_sub(l->in, l->s->program, l->o.label, OWORD_SUB, &body);
    return f == FAULT_NONE
               ? call(l->in, l->s->program, l->o.label, FLOW_SUB, 1, body, &local, l->s->r)
               : f;
}

/* return, endsub, with or without a value in [ ] */
static enum fault return_line(const struct flow_step *l)
{
    struct flow *flow = &l->in->flow;
    const struct flow_call *c = flow->level > 0 ? &flow->call[flow->level - 1] : NULL;
    const bool given = reading_peek(l->s) == '[';
    double value = 0.0;
    enum fault f = given ? condition(l, &value) : oword_alone(l->s);

    if (f != FAULT_NONE) {
        return f;
    }
    /* A return may have the label of a condition or loop around it, as in rs274. */
    if (!c || c->caller != FLOW_SUB
        || (l->o.is == OWORD_ENDSUB && !oword_same(c->label, l->o.label))) {
        return flow_refuse(l, FAULT_O_PLACE);
    }
    if (l->o.is == OWORD_ENDSUB && flow->opens > c->opens) {
        return flow_refuse(l, FAULT_O_END);
    }
    flow->value = value;
    flow->returned = given;
    flow_refuse(l, FAULT_ENDLESS);
    return leave(l->in, l->s->r);
}

/* Read the O word of a line; of lines by hand it may only be a call. */
static enum fault word_of(struct flow_step *l)
{
    const enum fault f = oword_read(l->s, &l->o);

    return f == FAULT_NONE && l->s->program->by_hand && l->in->file == 0 && l->o.is != OWORD_CALL
               ? flow_refuse(l, FAULT_ALONE)
               : f;
}

/* CCN 16: a case for each O word. */
enum fault flow_line(struct interpreter *in, struct reading *s, struct oword_place here)
{
    struct flow_step l = { .in = in, .s = s, .here = here, .at = s->at };
    enum fault f = word_of(&l);

    if (f != FAULT_NONE) {
        return f;
    }
    switch (l.o.is) {
    case OWORD_NUMBER: return in->flow.begun ? flow_refuse(&l, FAULT_O_NUMBER) : oword_alone(s);
    case OWORD_SUB:
        f = oword_alone(s);
        return f == FAULT_NONE ? skip_to(&l, l.o.label, OWORD_ENDSUB, true) : f;
    case OWORD_CALL:      return call_line(&l);
    case OWORD_RETURN:
    case OWORD_ENDSUB:    return return_line(&l);
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

void flow_drop(struct interpreter *in)
{
    struct flow *f = &in->flow;

    for (; f->level > 0; f->level--) {
        const struct flow_call *c = &f->call[f->level - 1];
        put_locals(&in->parameters, c->locals, &c->before);
        parameters_leave(&in->parameters, f->level);
    }
    memset(f, 0, sizeof *f);
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

/* A numbered program that is to be called, and how many times. */
struct numbered {
    char name[OWORD_LABEL];
    int32_t times;
    struct oword_place body;
};

static enum fault find_numbered(struct interpreter *in, const struct program *p, double number,
                                const double *runs, struct numbered *n, struct fault_report *r)
{
    int32_t label;

    n->times = 1;
    if (!reading_integer(number, &label) || label < 0
        || (runs && (!reading_integer(*runs, &n->times) || n->times < 0))) {
        return fault_at(r, FAULT_VALUE, r->at, r->length);
    }
    if (p->fanuc && !runs && label >= FANUC_RUNS) {
        n->times = label / FANUC_RUNS;
        label %= FANUC_RUNS;
    }
    oword_label(n->name, label);
    return fault_at(r, find_sub(in, p, n->name, OWORD_NUMBER, &n->body), r->at, r->length);
}

enum fault flow_subprogram(struct interpreter *in, const struct program *p, double number,
                           const double *runs, const struct flow_local *local,
                           struct fault_report *r)
{
    struct numbered n;
    const enum fault f = find_numbered(in, p, number, runs, &n, r);

    if (f != FAULT_NONE || n.times == 0) {
        return f;
    }
    return call(in, p, n.name, local ? FLOW_G65 : FLOW_M98, n.times, n.body, local, r);
}

enum fault flow_modal_begin(struct interpreter *in, const struct program *p, double number,
                            const double *runs, const struct flow_local *local,
                            struct fault_report *r)
{
    struct flow_modal *m = &in->flow.modal;
    struct numbered n;

    if (m->on) {
        return fault_at(r, FAULT_MODAL, r->at, r->length);
    }
    const enum fault f = find_numbered(in, p, number, runs, &n, r);
    if (f == FAULT_NONE) {
        m->on = true;
        m->level = in->flow.level;
        memcpy(m->label, n.name, OWORD_LABEL);
        m->runs = n.times;
        m->body = n.body;
        m->given = *local;
    }
    return f;
}

bool flow_modal_acts(const struct flow *f)
{
    return f->modal.on && f->modal.level == f->level;
}

enum fault flow_modal_call(struct interpreter *in, const struct program *p, struct fault_report *r)
{
    const struct flow_modal *m = &in->flow.modal;

    return m->runs == 0 ? FAULT_NONE
                        : call(in, p, m->label, FLOW_G65, m->runs, m->body, &m->given, r);
}

enum fault flow_user(struct interpreter *in, const struct program *p, int32_t number,
                     const double given[2], struct oword_place here, struct fault_report *r)
{
    const struct flow_local local = { { given[0], given[1] }, bits(PARAMETERS_LOCAL) };
    char name[OWORD_LABEL];
    struct oword_place body;

    oword_label(name, number);
    memmove(name + 1, name, OWORD_LABEL - 2);
    name[0] = 'm';
    enum fault f = find_sub(in, p, name, OWORD_SUB, &body);
    f = f == FAULT_NO_SUB ? FAULT_USER : f;
    if (f != FAULT_NONE) {
        return fault_at(r, f, r->at, r->length);
    }
    f = call(in, p, name, FLOW_SUB, 1, body, &local, r);
    if (f == FAULT_NONE) {
        in->flow.call[in->flow.level - 1].back = here;
        in->flow.call[in->flow.level - 1].rest = true;
    }
    return f;
}

enum fault flow_return(struct interpreter *in, const struct program *p, struct fault_report *r)
{
    struct flow *f = &in->flow;

    if (f->level > 0) {
        return f->call[f->level - 1].caller == FLOW_SUB ? fault_at(r, FAULT_M99, r->at, r->length)
                                                        : leave(in, r);
    }
    if (p->by_hand) {
        return fault_at(r, FAULT_ALONE, r->at, r->length);
    }
    f->opens = 0;
    f->begun = in->percent = false;
    return flow_again(in, (struct oword_place){ .file = 0 }, r);
}
