#include "reading.h"

#include <math.h>
#include <string.h>

#include "el_decimal.h"

bool reading_word(struct reading *s, const char *letters)
{
    const int32_t from = s->at;

    for (; *letters; letters++) {
        if (!reading_take(s, *letters)) {
            s->at = from;
            return false;
        }
    }
    return true;
}

enum fault reading_fault(struct reading *s, enum fault f, int32_t from)
{
    int32_t end = s->at;

    while (from < end && reading_blank(s->text[from])) {
        from++;
    }
    while (end > from && reading_blank(s->text[end - 1])) {
        end--;
    }
    return fault_at(s->r, f, from, end - from);
}

enum fault reading_comment(struct reading *s)
{
    const int32_t from = s->at++;

    while (s->at < s->end && s->text[s->at] != ')') {
        s->at++;
    }
    if (s->at == s->end) {
        return reading_fault(s, FAULT_COMMENT, from);
    }
    s->at++;
    return FAULT_NONE;
}

enum fault reading_number(struct reading *s, int32_t from, double *value, bool *whole)
{
    const char *const text = s->text;
    const int32_t end = s->end;
    struct el_decimal d;
    int32_t i = s->at, last = from, digits = 0;
    bool point = false, negative = false, sign = false;

    el_decimal_begin(&d);
    for (; i < end; ++i) {
        const char c = text[i];
        if (reading_blank(c)) {
            continue;
        }
        if ((c == '+' || c == '-') && !sign && !digits && !point) {
            sign = true;
            negative = c == '-';
        } else if (c == '.' && !point) {
            point = true;
        } else if (reading_digit(c)) {
            digits++;
            if (!el_decimal_add(&d, c - '0', point)) {
                return fault_at(s->r, FAULT_DIGITS, from, i + 1 - from);
            }
        } else {
            break;
        }
        last = i;
    }
    s->at = last < end ? last + 1 : end; /* without digits: behind `from` */
    if (!digits) {
        return reading_fault(s, FAULT_NUMBER, from);
    }
    *value = el_decimal_value(&d);
    if (negative) {
        *value = -*value;
    }
    *whole = !point;
    return FAULT_NONE;
}

enum fault reading_name(struct reading *s, int32_t from, char name[PARAMETERS_NAME])
{
    int length = 0;

    memset(name, 0, PARAMETERS_NAME);
    for (char c = reading_peek(s); c != '>'; c = reading_peek(s)) {
        if (c == '\0' || length == PARAMETERS_NAME - 1) {
            return reading_fault(s, FAULT_NAME, from);
        }
        name[length++] = c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
        s->at++;
    }
    s->at++;
    return length > 0 ? FAULT_NONE : reading_fault(s, FAULT_NAME, from);
}

bool reading_integer(double value, int32_t *whole)
{
    const double nearest = round(value);

    if (!(fabs(value) < 1e9) || fabs(value - nearest) > 1e-4) {
        return false;
    }
    *whole = (int32_t)nearest;
    return true;
}
