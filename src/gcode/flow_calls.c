#include "flow.h"

#include <string.h>

#include "expression.h"
#include "flow_step.h"
#include "modes.h"

/* P of M98: the number has four digits, the runs stand in front of them. */
enum { FANUC_RUNS = 10000 };

/* Where a subprogram begins: behind its line. */
static enum fault find_sub(struct interpreter *in, const struct program *p, const char *label,
                           int32_t words, struct oword_place *place)
{
    struct flow *f = &in->flow;
    struct source_line line;
    struct fault_report r;
    int32_t is;

    for (int i = 0; i < FLOW_KNOWN; i++) {
        if (f->sub[i].words == words && oword_same(f->sub[i].label, label)) {
            *place = f->sub[i].place;
            return FAULT_NONE;
        }
    }
    *place = (struct oword_place){ 0, 0 };
    enum fault g = oword_seek(p, label, words, 0, place, &is);
    g = g == FAULT_NONE && !is ? FAULT_NO_SUB : g;
    if (g == FAULT_NONE) {
        g = source_read(p->source, &place->offset, &line, &r);
        place->line++;
    }
    if (g == FAULT_NONE) {
        memcpy(f->sub[f->subs].label, label, OWORD_LABEL);
        f->sub[f->subs].words = words;
        f->sub[f->subs].place = *place;
        f->subs = (f->subs + 1) % FLOW_KNOWN;
    }
    return g;
}

/* Call what begins at a place; r has the text of the call. */
static enum fault call(struct interpreter *in, const char *label, enum flow_caller caller,
                       int32_t runs, struct oword_place body, const double *local,
                       struct fault_report *r)
{
    struct flow *f = &in->flow;

    if (f->level == FLOW_CALLS) {
        return fault_at(r, FAULT_CALLS, r->at, r->length);
    }
    struct flow_call *c = &f->call[f->level++];
    memset(c, 0, sizeof *c);
    memcpy(c->label, label, OWORD_LABEL);
    c->caller = caller;
    c->left = runs;
    c->opens = f->opens;
    c->body = body;
    c->here = (struct oword_place){ r->offset, r->line - 1 };
    c->back = flow_behind(in);
    memcpy(c->local, in->parameters.value, sizeof c->local);
    if (local) {
        memcpy(c->given, local, sizeof c->given);
        memcpy(in->parameters.value, local, sizeof c->given);
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
        if (c->caller != FLOW_M98) {
            memcpy(in->parameters.value, c->given, sizeof c->given);
        }
        return flow_again(in, c->body, r);
    }
    if (c->caller != FLOW_M98) {
        memcpy(in->parameters.value, c->local, sizeof c->local);
    }
    parameters_leave(&in->parameters, f->level);
    f->level--;
    f->again += in->line > c->body.line ? in->line - c->body.line : 1;
    flow_go(in, c->back);
    return FAULT_NONE;
}

enum fault flow_call_line(const struct flow_step *l)
{
    double local[PARAMETERS_LOCAL] = { 0.0 };   /* without a value 0, as rs274 has it */
    struct oword_place body;
    enum fault f = FAULT_NONE;
    int count = 0;

    while (f == FAULT_NONE && reading_peek(l->s) == '[') {
        if (count == PARAMETERS_LOCAL) {
            return flow_refuse(l, FAULT_O_BEHIND);
        }
        f = expression_brackets(l->s, &local[count++]);
    }
    f = f == FAULT_NONE ? oword_alone(l->s) : f;
    if (f != FAULT_NONE) {
        return f;
    }
    flow_refuse(l, FAULT_NO_SUB);
    f = find_sub(l->in, l->s->program, l->o.label, OWORD_SUB, &body);
    return f == FAULT_NONE ? call(l->in, l->o.label, FLOW_SUB, 1, body, local, l->s->r) : f;
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
    if (!c || c->caller != FLOW_SUB || !oword_same(c->label, l->o.label)) {
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

enum fault flow_subprogram(struct interpreter *in, const struct program *p, double number,
                           const double *runs, const double *local, struct fault_report *r)
{
    int32_t label, times = 1;
    char name[OWORD_LABEL];
    struct oword_place body;

    if (!reading_integer(number, &label) || label < 0 ||
        (runs && (!reading_integer(*runs, &times) || times < 0))) {
        return fault_at(r, FAULT_VALUE, r->at, r->length);
    }
    if (p->fanuc && !runs && label >= FANUC_RUNS) {
        times = label / FANUC_RUNS;
        label %= FANUC_RUNS;
    }
    oword_label(name, label);
    const enum fault f = find_sub(in, p, name, OWORD_NUMBER, &body);
    if (f != FAULT_NONE) {
        return fault_at(r, f, r->at, r->length);
    }
    return times == 0 ? FAULT_NONE
                      : call(in, name, local ? FLOW_G65 : FLOW_M98, times, body, local, r);
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
    return flow_again(in, (struct oword_place){ 0, 0 }, r);
}
