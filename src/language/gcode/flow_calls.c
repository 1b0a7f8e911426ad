#include "flow.h"

#include <string.h>

#include "expression.h"
#include "flow_step.h"
#include "modes.h"

_Static_assert((int)OWORD_LABEL == (int)FAULT_FILE, "a label names a file");

/* P of M98: the number has four digits, the runs stand in front of them. */
enum { FANUC_RUNS = 10000 };

/* The file that has the name of a subprogram, among those called; 0: there is none. */
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

/* Where a subprogram begins: behind its line. It is in the text that calls it, in the program, or
 * in the file of its name. */
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
        if (g == FAULT_NONE && file[i] >= 0 && (i == 0 || file[i] > 0 || in->file > 0)) {
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

/* Bits of #1 .. #count in the first word of those that have been set. */
static uint64_t bits(int32_t count)
{
    return (UINT64_C(1) << count) - 1;
}

/* #1 .. of the call that runs, out of the parameters and into them. */
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

/* Call what begins at a place; r has the text of the call. */
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

/* The subprogram that runs has reached its end. */
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

enum fault flow_call_line(const struct flow_step *l)
{
    /* Those without a value are 0, as rs274 has it. */
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

enum fault flow_return_line(const struct flow_step *l)
{
    struct flow *flow = &l->in->flow;
    const struct flow_call *c = flow->level > 0 ? &flow->call[flow->level - 1] : NULL;
    const bool given = reading_peek(l->s) == '[';
    double value = 0.0;
    enum fault f = given ? flow_condition(l, &value) : oword_alone(l->s);

    if (f != FAULT_NONE) {
        return f;
    }
    /* return stands in ifs and loops, whose label it may have, as rs274 has it */
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

/* A numbered program that is to be called: where it is, and how often. */
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

enum fault flow_return(struct interpreter *in, struct fault_report *r)
{
    struct flow *f = &in->flow;

    if (f->level > 0) {
        return f->call[f->level - 1].caller == FLOW_SUB ? fault_at(r, FAULT_M99, r->at, r->length)
                                                        : leave(in, r);
    }
    f->opens = 0;
    f->begun = in->percent = false;
    return flow_again(in, (struct oword_place){ .file = 0 }, r);
}
