#include "inform_scan.h"

#include <math.h>

static bool blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

static bool digit(char c)
{
    return c >= '0' && c <= '9';
}

static bool letter(char c)
{
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

static char upper(char c)
{
    return c >= 'a' && c <= 'z' ? (char)(c - 'a' + 'A') : c;
}

int inform_scan_begin(struct inform_scan *s, const char *text, int64_t size,
                      struct inform_report *r)
{
    *r = (struct inform_report){ .fault = INFORM_OK };
    *s = (struct inform_scan){ .text = text, .r = r };
    if (size > INFORM_TEXT_MAX) {
        r->high = INFORM_TEXT_MAX;
        r->fault = INFORM_BAD_TEXT_LENGTH;
        return -1;
    }
    s->size = (int32_t)size;
    return 0;
}

int inform_scan_fault(struct inform_scan *s, enum inform_fault f, struct inform_piece p)
{
    s->r->fault = f;
    s->r->line = s->line;
    s->r->column = 1;
    while (s->r->column <= p.at && s->text[p.at - s->r->column] != '\n') {
        s->r->column++;
    }
    s->r->offset = p.at;
    s->r->length = p.length;
    return -1;
}

int inform_scan_fault_line(struct inform_scan *s, enum inform_fault f)
{
    return inform_scan_fault(s, f, (struct inform_piece){ s->begin, s->end - s->begin });
}

int inform_scan_unexpected(struct inform_scan *s)
{
    struct inform_piece p;
    if (inform_scan_over(s)) {
        return inform_scan_fault_line(s, INFORM_BAD_MISSING);
    }
    p = (struct inform_piece){ s->at, 0 };
    while (p.at + p.length < s->end && !blank(s->text[p.at + p.length])) {
        p.length++;
    }
    return inform_scan_fault(s, INFORM_BAD_EXTRA, p);
}

/* Where a comment begins in text[at, end), or end; the // of //NAME is none. */
static int32_t comment(const struct inform_scan *s, int32_t at, int32_t end)
{
    while (at < end && s->text[at] != '\''
           && !(s->text[at] == '/' && at + 1 < end && s->text[at + 1] == '/')) {
        at++;
    }
    return at;
}

int inform_scan_line(struct inform_scan *s)
{
    while (s->next < s->size) {
        const int32_t first = s->next;
        int32_t end = first;
        s->line++;
        while (end < s->size && s->text[end] != '\n') {
            if (s->text[end] == '\0') {
                return inform_scan_fault(s, INFORM_BAD_BYTE,
                                         (struct inform_piece){ first, end - first });
            }
            end++;
        }
        s->next = end + 1;
        end -= end > first && s->text[end - 1] == '\r';
        if (end - first > INFORM_LINE_MAX) {
            s->r->high = INFORM_LINE_MAX;
            return inform_scan_fault(s, INFORM_BAD_LINE_LENGTH,
                                     (struct inform_piece){ first, INFORM_LINE_MAX });
        }
        s->begin = first;
        while (s->begin < end && blank(s->text[s->begin])) {
            s->begin++;
        }
        s->at = s->begin + 2;
        s->end = end;
        s->name = comment(s, s->begin, end) == s->begin && s->at < end
                  && inform_scan_is(s, inform_scan_word(s), "NAME");
        s->at = s->name ? s->at : s->begin;
        s->end = comment(s, s->at, end);
        while (s->end > s->at && blank(s->text[s->end - 1])) {
            s->end--;
        }
        if (s->end > s->begin) {
            return 1;
        }
    }
    return 0;
}

bool inform_scan_over(struct inform_scan *s)
{
    while (s->at < s->end && blank(s->text[s->at])) {
        s->at++;
    }
    return s->at >= s->end;
}

bool inform_scan_take(struct inform_scan *s, char c)
{
    if (inform_scan_over(s) || s->text[s->at] != c) {
        return false;
    }
    s->at++;
    return true;
}

struct inform_piece inform_scan_word(struct inform_scan *s)
{
    struct inform_piece p = { s->at, 0 };
    if (inform_scan_over(s) || !letter(s->text[s->at])) {
        return p;
    }
    p.at = s->at;
    while (s->at < s->end
           && (letter(s->text[s->at]) || digit(s->text[s->at]) || s->text[s->at] == '_')) {
        s->at++;
    }
    p.length = s->at - p.at;
    return p;
}

int inform_scan_name(struct inform_scan *s, int32_t most, struct inform_piece *name)
{
    if (inform_scan_over(s)) {
        return inform_scan_unexpected(s);
    }
    name->at = s->at;
    while (s->at < s->end
           && (letter(s->text[s->at]) || digit(s->text[s->at]) || s->text[s->at] == '_'
               || s->text[s->at] == '-')) {
        s->at++;
    }
    name->length = s->at - name->at;
    if (name->length == 0) {
        return inform_scan_unexpected(s);
    }
    s->r->high = most;
    return name->length <= most ? 0 : inform_scan_fault(s, INFORM_BAD_NAME, *name);
}

bool inform_scan_is(const struct inform_scan *s, struct inform_piece p, const char *word)
{
    int32_t i = 0;
    while (i < p.length && word[i] != '\0' && upper(s->text[p.at + i]) == word[i]) {
        i++;
    }
    return i == p.length && word[i] == '\0';
}

bool inform_scan_same(const char *text, struct inform_piece a, struct inform_piece b)
{
    int32_t i = 0;
    while (i < a.length && i < b.length && text[a.at + i] == text[b.at + i]) {
        i++;
    }
    return i == a.length && i == b.length;
}

int32_t inform_scan_digits(const struct inform_scan *s, struct inform_piece p)
{
    int32_t n = 0;
    for (int32_t i = 1; i < p.length; i++) {
        if (!digit(s->text[p.at + i]) || n > 99999) {
            return -1;
        }
        n = 10 * n + (s->text[p.at + i] - '0');
    }
    return p.length > 1 ? n : -1;
}

/* A number of at most 15 digits: the mantissa is exact, powers of ten to 10^22 are, so the one
 * division gives the nearest double. */
static int number(struct inform_scan *s, struct inform_piece *p, double *value)
{
    int64_t mantissa = 0;
    double scale = 1.0;
    int32_t digits = 0;
    bool point = false, negative;

    if (inform_scan_over(s)) {
        return inform_scan_unexpected(s);
    }
    p->at = s->at;
    negative = s->text[s->at] == '-';
    s->at += negative || s->text[s->at] == '+';
    while (s->at < s->end && (digit(s->text[s->at]) || (s->text[s->at] == '.' && !point))) {
        if (s->text[s->at] == '.') {
            point = true;
        } else if (++digits <= 15) {
            mantissa = 10 * mantissa + (s->text[s->at] - '0');
            scale *= point ? 10.0 : 1.0;
        }
        s->at++;
    }
    if (digits == 0) {
        s->at = p->at;
        return inform_scan_unexpected(s);
    }
    p->length = s->at - p->at;
    *value = negative ? -((double)mantissa / scale) : (double)mantissa / scale;
    return digits <= 15 ? 0 : inform_scan_fault(s, INFORM_BAD_NUMBER, *p);
}

static int within(struct inform_scan *s, struct inform_piece p, double low, double high,
                  double value)
{
    if (value >= low && value <= high) {
        return 0;
    }
    s->r->low = low;
    s->r->high = high;
    return inform_scan_fault(s, INFORM_BAD_VALUE, p);
}

int inform_scan_number(struct inform_scan *s, double low, double high, double *value)
{
    struct inform_piece p;
    return number(s, &p, value) || within(s, p, low, high, *value) ? -1 : 0;
}

int inform_scan_whole(struct inform_scan *s, int32_t low, int32_t high, int32_t *value)
{
    struct inform_piece p;
    double x;
    if (number(s, &p, &x)) {
        return -1;
    }
    if (x != floor(x)) {
        return inform_scan_fault(s, INFORM_BAD_WHOLE, p);
    }
    if (within(s, p, low, high, x)) {
        return -1;
    }
    *value = (int32_t)x;
    return 0;
}
