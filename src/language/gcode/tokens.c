#include "tokens.h"

#include <string.h>

#include "expression.h"
#include "modes.h"

/* Take a setting #1 = value, s at its #. */
static enum fault setting(struct tokens *t, struct reading *s)
{
    const int32_t from = s->at++;
    struct setting *to = &t->setting[t->settings];
    bool whole;

    if (t->settings == TOKENS_WORDS_MAX) {
        return fault_at(s->r, FAULT_WORD_COUNT, t->at, t->length);
    }
    enum fault f = expression_parameter(s, &to->which);
    if (f != FAULT_NONE) {
        return f;
    }
    if (!reading_take(s, '=')) {
        return reading_fault(s, FAULT_ASSIGNMENT, from);
    }
    f = s->program && s->program->fanuc ? expression_bare(s, &to->value)
                                        : expression_value(s, from, &to->value, &whole);
    if (f == FAULT_NONE) {
        to->at = from;
        to->length = s->at - from;
        t->settings++;
    }
    return f;
}

/* Take a word, s at its letter (of ,C and ,R behind the comma). Coordinates without a point are
 * multiples of the program's least_increment, if that is set. */
static enum fault word(struct tokens *t, struct reading *s, char letter)
{
    if (t->count == TOKENS_WORDS_MAX) {
        return fault_at(s->r, FAULT_WORD_COUNT, t->at, t->length);
    }
    struct token *w = &t->word[t->count];
    w->letter = letter;
    w->at = s->at++;
    const enum fault f = expression_or_vacant(s, w->at, &w->value, &w->whole);
    w->length = s->at - w->at;
    if (f == FAULT_NONE && w->whole && s->program && s->program->least_increment > 0.0
        && strchr("XYZUVWABCIJKRQ[]", letter)) {
        w->value *= s->program->least_increment;
    }
    t->count += f == FAULT_NONE && !parameters_vacant(w->value); /* a vacant word is none */
    return f;
}

/* Whether a comment is one on which other controls act. */
static bool acts(struct reading s)
{
    static const char words[][12] = { "PRINT,",     "DEBUG,",   "LOG,",      "LOGOPEN,",
                                      "LOGAPPEND,", "LOGCLOSE", "PROBEOPEN", "PROBECLOSE" };
    size_t i = 0;

    while (i < sizeof words / sizeof *words && !reading_word(&s, words[i])) {
        i++;
    }
    if (i == 1 && s.in && s.in->parameters.debug <= 0.0) {
        return false;
    }
    return i < sizeof words / sizeof *words;
}

/* Take a comment, s at its (. */
static enum fault comment(struct reading *s)
{
    const int32_t from = s->at;
    const enum fault f = reading_comment(s);
    struct reading inside = *s;

    inside.at = from + 1;
    if (f == FAULT_NONE && acts(inside)) {
        fault_note(s->r, FAULT_NOTE_COMMENT, from, s->at - from);
    }
    return f;
}

/* Whether only line numbers stand in front. */
static bool first(const struct tokens *t)
{
    for (int i = 0; i < t->count; i++) {
        if (t->word[i].letter != 'N') {
            return false;
        }
    }
    return t->settings == 0;
}

/* Take a / and its number in front of a line. */
static void block_delete(struct tokens *t, struct reading *s)
{
    t->slash = reading_take(s, '/');
    if (t->slash && reading_peek(s) >= '1' && reading_peek(s) <= '9') {
        s->at++;
    }
}

/* Take ,C or ,R of Fanuc's controls, s at the comma. */
static enum fault corner_word(struct tokens *t, struct reading *s)
{
    const int32_t from = s->at++;
    const char c = reading_peek(s);
    const int count = t->count;

    if (c != 'C' && c != 'R') {
        s->at += s->at < s->end;
        return reading_fault(s, FAULT_WORD, from);
    }
    const enum fault f = word(t, s, c == 'C' ? TOKENS_CHAMFER : TOKENS_ROUND);
    if (t->count > count) {
        t->word[count].length += t->word[count].at - from;
        t->word[count].at = from;
    }
    return f;
}

/* Take the next word, setting or comment, which begins with c. */
static enum fault item(struct tokens *t, struct reading *s, char c)
{
    if ((c >= '@' && c <= 'Z') || c == '^') {
        return word(t, s, c);
    }
    if (c == '(') {
        return comment(s);
    }
    if (c == '#') {
        return setting(t, s);
    }
    if (c == ',' && s->program && s->program->fanuc) {
        return corner_word(t, s);
    }
    return fault_at(s->r, FAULT_CHARACTER, s->at++, 1);
}

/* Behind a fault: go on to the next letter or comment outside brackets. */
static void skip(struct reading *s, int32_t from)
{
    int depth = 0;

    for (int32_t i = from; i < s->end; i++) {
        const char c = s->text[i];
        depth += c == '[' ? 1 : c == ']' ? -1 : 0;
        if (i >= s->at && i > from && depth <= 0 && (reading_letter(c) || c == '(' || c == ';')) {
            s->at = i;
            return;
        }
    }
    s->at = s->end;
}

enum fault tokens_read(struct tokens *t, struct reading *s)
{
    struct fault_report ignored, *const r = s->r;
    const bool fanuc = s->program && s->program->fanuc;
    enum fault f = FAULT_NONE;
    int32_t end = s->end;

    reading_peek(s);
    while (end > s->at && reading_blank(s->text[end - 1])) {
        end--;
    }
    s->end = end;
    ignored.notes = 0;
    t->count = t->settings = 0;
    t->slash = t->flow = false;
    t->at = s->at;
    t->length = end - s->at;
    t->percent = t->length == 1 && s->text[s->at] == '%';
    if (t->percent) {
        return FAULT_NONE;
    }
    block_delete(t, s);
    for (char c = reading_peek(s); c != '\0' && c != ';'; c = reading_peek(s)) {
        const int32_t from = s->at;
        const bool other = fanuc && (c == ':' || flow_fanuc_begins(*s)); /* : is O in ISO code */
        if ((c == 'O' || other) && first(t)) {
            t->flow = true;
            break;
        }
        const enum fault one = item(t, s, c);
        if (one != FAULT_NONE) {
            f = f == FAULT_NONE ? one : f;
            s->r = &ignored; /* faults behind the first are not told */
            skip(s, from);
        }
    }
    s->r = r;
    return f;
}

enum fault tokens_at_word(struct fault_report *r, enum fault f, const struct token *w)
{
    return fault_at(r, f, w->at, w->length);
}

enum fault tokens_at_words(struct fault_report *r, enum fault f, const struct token *w,
                           const struct token *other)
{
    fault_at(r, f, w->at, w->length);
    r->other_at = other->at;
    r->other_length = other->length;
    return f;
}

enum fault tokens_at_line(struct fault_report *r, enum fault f, const struct tokens *t)
{
    return fault_at(r, f, t->at, t->length);
}

void tokens_note(struct fault_report *r, enum fault note, const struct token *w)
{
    fault_note(r, note, w->at, w->length);
}
