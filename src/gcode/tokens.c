#include "tokens.h"

static bool blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

static bool digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Letter in upper case, or 0. */
static char letter(char c)
{
    return c >= 'A' && c <= 'Z' ? c : c >= 'a' && c <= 'z' ? (char)(c - 'a' + 'A') : 0;
}

/* First c in text[at, end), or end. */
static int32_t find(const char *text, int32_t at, int32_t end, char c)
{
    while (at < end && text[at] != c) {
        at++;
    }
    return at;
}

/* A number from text[*i] on, blanks between its characters allowed. Digits make an integer below
 * 2^53, and powers of ten to 10^22 are exact, so the one division gives the nearest double. */
static enum fault number(const char *text, int32_t end, int32_t *i, struct token *w,
                         struct fault_report *r)
{
    int64_t mantissa = 0;
    double scale = 1.0;
    int32_t last = w->at, digits = 0;
    bool point = false, negative = false, sign = false;

    for (; *i < end; ++*i) {
        const char c = text[*i];
        if (blank(c)) {
            continue;
        }
        if ((c == '+' || c == '-') && !sign && !digits && !point) {
            sign = true;
            negative = c == '-';
        } else if (c == '.' && !point) {
            point = true;
        } else if (digit(c)) {
            digits++;
            if (mantissa > (((int64_t)1 << 53) - 9) / 10 || scale > 1e21) {
                return fault_at(r, FAULT_DIGITS, w->at, *i + 1 - w->at);
            }
            mantissa = mantissa * 10 + (c - '0');
            scale *= point ? 10.0 : 1.0;
        } else {
            break;
        }
        last = *i;
    }
    w->length = last + 1 - w->at;
    if (!digits) {
        return fault_at(r, FAULT_NUMBER, w->at, w->length);
    }
    w->value = (double)mantissa / scale;
    if (negative) {
        w->value = -w->value;
    }
    return FAULT_NONE;
}

static enum fault words(struct tokens *t, const char *text, int32_t i, int32_t end,
                        struct fault_report *r)
{
    bool first = true;      /* a / is allowed before anything else */

    while (i < end) {
        const char c = text[i];
        if (blank(c)) {
            i++;
            continue;
        }
        if (c == ';') {
            return FAULT_NONE;
        }
        if (c == '(') {
            const int32_t close = find(text, i, end, ')');
            if (close == end) {
                return fault_at(r, FAULT_COMMENT, i, end - i);
            }
            i = close + 1;
            continue;
        }
        if (c == '/' && first) {
            first = false;
            t->slash = true;
            i++;
            continue;
        }
        first = false;
        if (!letter(c)) {
            return fault_at(r, FAULT_CHARACTER, i, 1);
        }
        if (t->count == TOKENS_WORDS_MAX) {
            return fault_at(r, FAULT_WORD_COUNT, t->at, t->length);
        }
        struct token *w = &t->word[t->count++];
        w->letter = letter(c);
        w->at = i++;
        const enum fault f = number(text, end, &i, w, r);
        if (f != FAULT_NONE) {
            return f;
        }
    }
    return FAULT_NONE;
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

enum fault tokens_read(struct tokens *t, const char *line, int32_t length,
                       struct fault_report *r)
{
    int32_t at = 0, end = length;

    while (at < end && blank(line[at])) {
        at++;
    }
    while (end > at && blank(line[end - 1])) {
        end--;
    }
    t->count = 0;
    t->slash = false;
    t->at = at;
    t->length = end - at;
    t->percent = end - at == 1 && line[at] == '%';
    return t->percent ? FAULT_NONE : words(t, line, at, end, r);
}
