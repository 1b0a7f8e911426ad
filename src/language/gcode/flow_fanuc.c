#include "flow.h"

#include "expression.h"
#include "flow_step.h"
#include "modes.h"

enum { LOOPS = 3 };                             /* number of DO and END: 1 to 3 */
static const double SEQUENCE_MOST = 99999999.0; /* highest number N */

enum fanuc_word { FANUC_NONE, FANUC_GOTO, FANUC_IF, FANUC_WHILE, FANUC_DO, FANUC_END };

static enum fanuc_word word(struct reading *s)
{
    static const struct {
        char word[6];
        enum fanuc_word is;
    } words[] = {
        { "GOTO", FANUC_GOTO }, { "IF", FANUC_IF },   { "WHILE", FANUC_WHILE },
        { "DO", FANUC_DO },     { "END", FANUC_END },
    };

    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (reading_word(s, words[i].word)) {
            return words[i].is;
        }
    }
    return FANUC_NONE;
}

bool flow_fanuc_begins(struct reading s)
{
    return s.program && s.program->fanuc && word(&s) != FANUC_NONE;
}

/* What is searched: the line with a number N, or END with a number. */
struct sought {
    bool end;
    int32_t number;
};

/* Take digits as a number; -1: there are none. */
static double digits(struct reading *s)
{
    double value = reading_digit(reading_peek(s)) ? 0.0 : -1.0;

    for (char c = reading_peek(s); reading_digit(c); c = reading_peek(s)) {
        value = 10.0 * value + (c - '0');
        s->at++;
    }
    return value;
}

/* Whether a line is the one that is searched; *other: it begins another numbered program. */
static bool match(const struct source_line *line, const struct program *p, struct sought what,
                  bool *other)
{
    struct fault_report ignored;
    struct reading s = { .text = line->text, .end = line->length, .program = p, .r = &ignored };
    const bool slash = reading_take(&s, '/');

    *other = false;
    if (slash && p->block_delete) {
        return false;
    }
    if (slash && reading_peek(&s) >= '1' && reading_peek(&s) <= '9') {
        s.at++;
    }
    const double sequence = reading_take(&s, 'N') ? digits(&s) : -1.0;
    if (reading_take(&s, 'O') || reading_take(&s, ':')) {
        *other = digits(&s) >= 0.0 && oword_alone(&s) == FAULT_NONE;
        return false;
    }
    return what.end ? word(&s) == FANUC_END && digits(&s) == what.number : sequence == what.number;
}

/* Search from *place on, up to the offset `until` [byte]; if that is -1, up to the next numbered
 * program. *place becomes that of the line. */
static enum fault seek(const struct flow_step *l, struct sought what, int64_t until,
                       struct oword_place *place, bool *found)
{
    struct source_line line;
    struct fault_report r;
    bool other = false;

    *found = false;
    while (!*found && !other && (until < 0 || place->offset < until)) {
        int64_t next = place->offset;
        const enum fault f =
            source_read(l->s->program->source, flow_file(l->in, place->file), &next, &line, &r);
        if (f != FAULT_NONE && f != FAULT_LINE_LENGTH) {
            return f;
        }
        if (f == FAULT_NONE && !line.text) {
            return FAULT_NONE;
        }
        *found = f == FAULT_NONE && match(&line, l->s->program, what, &other);
        other = other && until < 0;
        if (!*found) {
            place->offset = next;
            place->line++;
        }
    }
    return FAULT_NONE;
}

/* Place of the next END of a number behind *place. The place of a fault has been set before: the
 * text of the line is gone when other lines are read. */
static enum fault seek_end(const struct flow_step *l, int32_t number, struct oword_place *place)
{
    bool found;
    const enum fault f = seek(l, (struct sought){ true, number }, -1, place, &found);
    return f != FAULT_NONE ? f : found ? FAULT_NONE : FAULT_LOOP_END;
}

/* Read a whole number from `least` to `most`, and the end of the line. */
static enum fault number(const struct flow_step *l, double least, double most, int32_t *value)
{
    const int32_t from = l->s->at;
    double given;
    bool whole;
    const enum fault f = expression_value(l->s, from, &given, &whole);

    if (f != FAULT_NONE) {
        return f;
    }
    if (!reading_integer(given, value) || *value < least || *value > most) {
        return reading_fault(l->s, FAULT_VALUE, from);
    }
    return oword_alone(l->s);
}

/* End the loops that a jump leaves. FAULT_O_PLACE: it stands in a condition or loop of O words. The
 * place of a fault has been set before. */
static enum fault leave(const struct flow_step *l, struct oword_place to)
{
    struct flow *f = &l->in->flow;
    const int32_t base = f->level > 0 ? f->call[f->level - 1].opens : 0;

    for (int32_t i = base; i < f->opens; i++) {
        if (f->open[i].label[0] != FLOW_FANUC) {
            return FAULT_O_PLACE;
        }
    }
    for (int32_t i = base; i < f->opens; i++) {
        struct oword_place end = f->open[i].behind;
        const enum fault g = seek_end(l, f->open[i].label[1] - '0', &end);
        if (g != FAULT_NONE) {
            return g;
        }
        if (to.offset <= f->open[i].here.offset || to.offset > end.offset) {
            f->opens = i;
        }
    }
    return FAULT_NONE;
}

/* GOTO n: go on at the next line with N n, within the numbered program; if none follows, at the
 * first one from the beginning of the program or subprogram that runs. */
static enum fault go_to(const struct flow_step *l)
{
    struct interpreter *in = l->in;
    const struct flow *flow = &in->flow;
    struct sought what = { .end = false };
    bool found = false;
    enum fault f = number(l, 1.0, SEQUENCE_MOST, &what.number);

    if (f != FAULT_NONE) {
        return f;
    }
    flow_refuse(l, FAULT_SEQUENCE); /* now: the line's text is gone when others are read */
    struct oword_place to = flow_behind(in);
    f = seek(l, what, -1, &to, &found);
    if (f == FAULT_NONE && !found) {
        to = flow->level > 0 ? flow->call[flow->level - 1].body
                             : (struct oword_place){ .file = in->file };
        f = seek(l, what, in->offset, &to, &found);
    }
    f = f == FAULT_NONE && !found ? FAULT_SEQUENCE : f;
    f = f == FAULT_NONE ? leave(l, to) : f;
    if (f != FAULT_NONE) {
        return f;
    }
    if (to.offset < in->offset) {
        return flow_again(in, to, l->s->r);
    }
    flow_go(in, to);
    return FAULT_NONE;
}

/* IF [ ] GOTO n, IF [ ] THEN #i = ... */
static enum fault condition(const struct flow_step *l, bool *then)
{
    double value;
    const enum fault f = expression_brackets(l->s, &value);

    if (f != FAULT_NONE) {
        return f;
    }
    if (reading_word(l->s, "GOTO")) {
        return value != 0.0 ? go_to(l) : FAULT_NONE;
    }
    if (!reading_word(l->s, "THEN")) {
        l->s->at += l->s->at < l->s->end;
        return flow_refuse(l, FAULT_THEN);
    }
    *then = value != 0.0;
    return FAULT_NONE;
}

/* WHILE [ ] DO m, DO m */
static enum fault loop(struct flow_step *l, bool conditional)
{
    double value = 1.0;
    int32_t m;
    enum fault f = conditional ? expression_brackets(l->s, &value) : FAULT_NONE;

    if (f == FAULT_NONE && conditional && !reading_word(l->s, "DO")) {
        l->s->at += l->s->at < l->s->end;
        f = flow_refuse(l, FAULT_THEN);
    }
    f = f == FAULT_NONE ? number(l, 1.0, LOOPS, &m) : f;
    if (f != FAULT_NONE) {
        return f;
    }
    l->o.label[0] = FLOW_FANUC;
    l->o.label[1] = (char)('0' + m);
    if (value != 0.0) {
        return flow_open(l, FLOW_WHILE, 0);
    }
    struct source_line line;
    struct fault_report r;
    struct oword_place end = flow_behind(l->in);
    flow_refuse(l, FAULT_LOOP_END);
    f = seek_end(l, m, &end);
    if (f == FAULT_NONE) {
        const char *const file = flow_file(l->in, end.file);
        f = source_read(l->s->program->source, file, &end.offset, &line, &r);
        end.line++;
        flow_go(l->in, end);
    }
    return f;
}

static enum fault end(struct flow_step *l)
{
    int32_t m;
    const enum fault f = number(l, 1.0, LOOPS, &m);

    if (f != FAULT_NONE) {
        return f;
    }
    l->o.label[0] = FLOW_FANUC;
    l->o.label[1] = (char)('0' + m);
    return flow_loop_end(l);
}

enum fault flow_fanuc(struct interpreter *in, struct reading *s, struct oword_place here,
                      bool *then)
{
    struct flow_step l = { .in = in, .s = s, .here = here, .at = s->at };

    *then = false;
    in->flow.begun = true;
    switch (word(s)) {
    case FANUC_GOTO:  return go_to(&l);
    case FANUC_IF:    return condition(&l, then);
    case FANUC_WHILE: return loop(&l, true);
    case FANUC_DO:    return loop(&l, false);
    default:          return end(&l);
    }
}
