#include "robot_job_scan.h"

#include <math.h>
#include <stddef.h>

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

int robot_job_scan_begin(struct robot_job_scan *s, const char *text, int64_t size,
                         struct robot_job_report *r)
{
    *r = (struct robot_job_report){ .fault = ROBOT_JOB_OK };
    *s = (struct robot_job_scan){ .text = text, .r = r };
    if (size > ROBOT_JOB_TEXT_MAX) {
        r->high = ROBOT_JOB_TEXT_MAX;
        r->fault = ROBOT_JOB_BAD_TEXT_LENGTH;
        return -1;
    }
    s->size = (int32_t)size;
    return 0;
}

int32_t robot_job_scan_column(const struct robot_job_scan *s, int32_t at)
{
    int32_t column = 1;
    while (column <= at && s->text[at - column] != '\n') {
        column++;
    }
    return column;
}

int robot_job_scan_fault(struct robot_job_scan *s, enum robot_job_fault f, struct robot_job_span p)
{
    s->r->fault = f;
    s->r->line = s->line;
    s->r->column = robot_job_scan_column(s, p.at);
    s->r->offset = p.at;
    s->r->length = p.length;
    return -1;
}

int robot_job_scan_fault_line(struct robot_job_scan *s, enum robot_job_fault f)
{
    return robot_job_scan_fault(s, f, (struct robot_job_span){ s->begin, s->end - s->begin });
}

int robot_job_scan_unexpected(struct robot_job_scan *s)
{
    struct robot_job_span p;
    if (robot_job_scan_over(s)) {
        return robot_job_scan_fault_line(s, ROBOT_JOB_BAD_MISSING);
    }
    p = (struct robot_job_span){ s->at, 0 };
    while (p.at + p.length < s->end && !blank(s->text[p.at + p.length])) {
        p.length++;
    }
    return robot_job_scan_fault(s, ROBOT_JOB_BAD_EXTRA, p);
}

/* Where a comment begins in text[at, end), or end; the // of a pendant's word is none. */
static int32_t comment(const struct robot_job_scan *s, int32_t at, int32_t end)
{
    while (at < end && s->text[at] != '\''
           && !(s->text[at] == '/' && at + 1 < end && s->text[at + 1] == '/')) {
        at++;
    }
    return at;
}

/* Number of / in front of a word of a pendant's file; 0: the line has none. */
static int32_t pendant_word(struct robot_job_scan *s)
{
    static const struct {
        char slashes;
        char word[9];
    } WORDS[] = { { 1, "JOB" },     { 2, "NAME" },  { 2, "POS" },  { 2, "INST" },
                  { 2, "ARGINFO" }, { 3, "TOOL" },  { 3, "USER" }, { 3, "POSTYPE" },
                  { 3, "RECTAN" },  { 3, "RCONF" }, { 3, "PULSE" } };
    int32_t found = 0;
    s->at = s->begin;
    while (s->at < s->end && s->text[s->at] == '/') {
        s->at++;
    }
    const int32_t slashes = s->at - s->begin;
    const struct robot_job_span w = robot_job_scan_word(s);
    for (size_t i = 0; i < sizeof WORDS / sizeof WORDS[0] && slashes > 0; i++) {
        if (slashes == WORDS[i].slashes && robot_job_scan_is(s, w, WORDS[i].word)
            && (i == 1 || w.at == s->begin + slashes)) { /* a blank is in comments, but for NAME */
            found = slashes;
        }
    }
    s->at = s->begin;
    return found;
}

int robot_job_scan_line(struct robot_job_scan *s)
{
    while (s->next < s->size) {
        const int32_t first = s->next;
        int32_t end = first;
        s->line++;
        while (end < s->size && s->text[end] != '\n') {
            if (s->text[end] == '\0') {
                return robot_job_scan_fault(s, ROBOT_JOB_BAD_BYTE,
                                            (struct robot_job_span){ first, end - first });
            }
            end++;
        }
        s->next = end + 1;
        end -= end > first && s->text[end - 1] == '\r';
        if (end - first > ROBOT_JOB_LINE_MAX) {
            s->r->high = ROBOT_JOB_LINE_MAX;
            return robot_job_scan_fault(s, ROBOT_JOB_BAD_LINE_LENGTH,
                                        (struct robot_job_span){ first, ROBOT_JOB_LINE_MAX });
        }
        s->begin = first;
        while (s->begin < end && blank(s->text[s->begin])) {
            s->begin++;
        }
        s->end = end;
        s->slashes = pendant_word(s);
        s->end = comment(s, s->begin + s->slashes, end);
        while (s->end > s->begin && blank(s->text[s->end - 1])) {
            s->end--;
        }
        if (s->end > s->begin) {
            return 1;
        }
    }
    return 0;
}

bool robot_job_scan_over(struct robot_job_scan *s)
{
    while (s->at < s->end && blank(s->text[s->at])) {
        s->at++;
    }
    return s->at >= s->end;
}

bool robot_job_scan_take(struct robot_job_scan *s, char c)
{
    if (robot_job_scan_over(s) || s->text[s->at] != c) {
        return false;
    }
    s->at++;
    return true;
}

struct robot_job_span robot_job_scan_word(struct robot_job_scan *s)
{
    struct robot_job_span p = { s->at, 0 };
    if (robot_job_scan_over(s) || !letter(s->text[s->at])) {
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

int robot_job_scan_name(struct robot_job_scan *s, int32_t most, struct robot_job_span *name)
{
    if (robot_job_scan_over(s)) {
        return robot_job_scan_unexpected(s);
    }
    name->at = s->at;
    while (s->at < s->end
           && (letter(s->text[s->at]) || digit(s->text[s->at]) || s->text[s->at] == '_'
               || s->text[s->at] == '-')) {
        s->at++;
    }
    name->length = s->at - name->at;
    if (name->length == 0) {
        return robot_job_scan_unexpected(s);
    }
    s->r->high = most;
    return name->length <= most ? 0 : robot_job_scan_fault(s, ROBOT_JOB_BAD_NAME, *name);
}

bool robot_job_scan_is(const struct robot_job_scan *s, struct robot_job_span p, const char *word)
{
    int32_t i = 0;
    while (i < p.length && word[i] != '\0' && upper(s->text[p.at + i]) == word[i]) {
        i++;
    }
    return i == p.length && word[i] == '\0';
}

bool robot_job_scan_same(const char *text, struct robot_job_span a, struct robot_job_span b)
{
    int32_t i = 0;
    while (i < a.length && i < b.length && text[a.at + i] == text[b.at + i]) {
        i++;
    }
    return i == a.length && i == b.length;
}

int32_t robot_job_scan_digits(const struct robot_job_scan *s, struct robot_job_span p)
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
static int number(struct robot_job_scan *s, struct robot_job_span *p, double *value)
{
    int64_t mantissa = 0;
    double scale = 1.0;
    int32_t digits = 0;
    bool point = false, negative;

    if (robot_job_scan_over(s)) {
        return robot_job_scan_unexpected(s);
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
        return robot_job_scan_unexpected(s);
    }
    p->length = s->at - p->at;
    *value = negative ? -((double)mantissa / scale) : (double)mantissa / scale;
    return digits <= 15 ? 0 : robot_job_scan_fault(s, ROBOT_JOB_BAD_NUMBER, *p);
}

static int within(struct robot_job_scan *s, struct robot_job_span p, double low, double high,
                  double value)
{
    if (value >= low && value <= high) {
        return 0;
    }
    s->r->low = low;
    s->r->high = high;
    return robot_job_scan_fault(s, ROBOT_JOB_BAD_VALUE, p);
}

int robot_job_scan_number(struct robot_job_scan *s, double low, double high, double *value)
{
    struct robot_job_span p;
    return number(s, &p, value) || within(s, p, low, high, *value) ? -1 : 0;
}

int robot_job_scan_whole(struct robot_job_scan *s, int32_t low, int32_t high, int32_t *value)
{
    struct robot_job_span p;
    double x;
    if (number(s, &p, &x)) {
        return -1;
    }
    if (x != floor(x)) {
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_WHOLE, p);
    }
    if (within(s, p, low, high, x)) {
        return -1;
    }
    *value = (int32_t)x;
    return 0;
}
