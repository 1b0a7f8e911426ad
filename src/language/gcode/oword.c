#include "oword.h"

#include <string.h>

#include "expression.h"
#include "modes.h"

void oword_label(char label[OWORD_LABEL], int32_t number)
{
    char digits[12];
    int count = 0, i = 0;

    memset(label, 0, OWORD_LABEL);
    do {
        digits[count++] = (char)('0' + number % 10);
        number /= 10;
    } while (number > 0);
    while (count > 0) {
        label[i++] = digits[--count];
    }
}

/* Take digits as a label, without leading zeros. */
static enum fault digits(struct reading *s, int32_t from, char label[OWORD_LABEL])
{
    int length = 0;

    memset(label, 0, OWORD_LABEL);
    for (char c = reading_peek(s); reading_digit(c); c = reading_peek(s)) {
        if (length == OWORD_LABEL - 1) {
            return reading_fault(s, FAULT_NAME, from);
        }
        length -= length == 1 && label[0] == '0';
        label[length++] = c;
        s->at++;
    }
    return FAULT_NONE;
}

/* Take a value as a label. */
static enum fault computed(struct reading *s, int32_t from, char label[OWORD_LABEL])
{
    double value;
    int32_t number;
    bool whole;
    const enum fault f = expression_value(s, from, &value, &whole);

    if (f != FAULT_NONE) {
        return f;
    }
    if (!reading_integer(value, &number) || number < 0) {
        return reading_fault(s, FAULT_VALUE, from);
    }
    oword_label(label, number);
    return FAULT_NONE;
}

/* Take the word behind the label, as oword_is; 0: it is none of these. */
static int32_t kind(struct reading *s)
{
    static const struct {
        char word[10];
        int32_t is;
    } words[] = {
        { "SUB", OWORD_SUB },
        { "ENDSUB", OWORD_ENDSUB },
        { "CALL", OWORD_CALL },
        { "RETURN", OWORD_RETURN },
        { "IF", OWORD_IF },
        { "ELSEIF", OWORD_ELSEIF },
        { "ELSE", OWORD_ELSE },
        { "ENDIF", OWORD_ENDIF },
        { "WHILE", OWORD_WHILE },
        { "ENDWHILE", OWORD_ENDWHILE },
        { "DO", OWORD_DO },
        { "REPEAT", OWORD_REPEAT },
        { "ENDREPEAT", OWORD_ENDREPEAT },
        { "BREAK", OWORD_BREAK },
        { "CONTINUE", OWORD_CONTINUE },
    };
    const char c = reading_peek(s);

    if (c == '\0' || c == '(' || c == ';') {
        return OWORD_NUMBER;
    }
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (reading_word(s, words[i].word)) {
            return words[i].is;
        }
    }
    return 0;
}

/* Take the label, unless it is a value (o->computed), which stays. */
static enum fault label(struct reading *s, int32_t from, struct oword *o)
{
    const char c = reading_peek(s);

    o->computed = c != '<' && !reading_digit(c);
    if (c == '<') {
        s->at++;
        return reading_name(s, from, o->label);
    }
    return reading_digit(c) ? digits(s, from, o->label) : FAULT_NONE;
}

enum fault oword_read(struct reading *s, struct oword *o)
{
    const int32_t from = s->at++;
    enum fault f = label(s, from, o);

    if (f == FAULT_NONE && o->computed) {
        f = computed(s, from, o->label);
    }
    if (f != FAULT_NONE) {
        return f;
    }
    const int32_t is = kind(s);
    if (!is) {
        s->at += s->at < s->end;
        return reading_fault(s, FAULT_O_WORD, from);
    }
    o->is = (enum oword_is)is;
    return o->computed && o->is != OWORD_CALL ? reading_fault(s, FAULT_O_LABEL, from) : FAULT_NONE;
}

enum fault oword_alone(struct reading *s)
{
    while (reading_peek(s) == '(') {
        const enum fault f = reading_comment(s);
        if (f != FAULT_NONE) {
            return f;
        }
    }
    if (reading_peek(s) == '\0' || reading_peek(s) == ';') {
        return FAULT_NONE;
    }
    const int32_t from = s->at;
    s->at = s->end;
    return reading_fault(s, FAULT_O_BEHIND, from);
}

/* The word of a line that begins with O and this label, or with O, any label and sub or endsub;
 * else 0. */
static int32_t match(const struct source_line *line, const struct program *p, const char *name,
                     struct oword *o)
{
    struct fault_report ignored;
    struct reading s = { .text = line->text, .end = line->length, .r = &ignored };

    if (reading_take(&s, '/') && p->block_delete) {
        return 0;
    }
    while (reading_digit(reading_peek(&s))) {
        s.at++;
    }
    if (reading_take(&s, 'N')) {
        while (reading_digit(reading_peek(&s)) || reading_peek(&s) == '.') {
            s.at++;
        }
    }
    const bool begins = reading_take(&s, 'O') || (p->fanuc && reading_take(&s, ':'));
    if (!begins || label(&s, 0, o) != FAULT_NONE || o->computed) {
        return 0;
    }
    const int32_t is = kind(&s);
    return is & OWORD_EITHER_SUB || oword_same(o->label, name) ? is : 0;
}

enum fault oword_seek(const struct program *p, const char *file, const char *name, int32_t words,
                      int32_t stop, struct oword_place *place, int32_t *is)
{
    struct fault_report r;
    struct source_line line;

    for (;;) {
        int64_t next = place->offset;
        struct oword o;
        const enum fault f = source_read(p->source, file, &next, &line, &r);
        if (f != FAULT_NONE && f != FAULT_LINE_LENGTH) {
            return f;
        }
        *is = f == FAULT_NONE && line.text ? match(&line, p, name, &o) : 0;
        if ((*is & words) && oword_same(o.label, name)) {
            return FAULT_NONE;
        }
        if (!line.text || (*is & stop)) {
            *is = 0;
            return FAULT_NONE;
        }
        place->offset = next;
        place->line++;
    }
}
