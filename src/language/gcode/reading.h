/* reading - takes numbers, names and words from the characters of one line of a part program.
 *
 * Blanks do not count, not even inside numbers and names; nor does case.
 */
#ifndef READING_H
#define READING_H

#include "parameters.h"

/* A line, and how far it has been read. */
struct reading {
    const char *text;
    int32_t at, end;               /* index of the next character, and behind the last */
    int32_t depth;                 /* number of brackets, signs and # around it */
    const struct interpreter *in;  /* has the parameters; NULL: there are none */
    const struct program *program; /* that the line belongs to, or NULL */
    struct fault_report *r;        /* gets the place of a fault, and notes */
};

static inline bool reading_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

static inline bool reading_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* A letter in upper case, any other character as it is. */
static inline char reading_upper(char c)
{
    return c >= 'a' && c <= 'z' ? (char)(c - 'a' + 'A') : c;
}

static inline bool reading_letter(char c)
{
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

/* The next character that is no blank, in upper case; 0 at the end. It is not taken. */
static inline char reading_peek(struct reading *s)
{
    while (s->at < s->end && reading_blank(s->text[s->at])) {
        s->at++;
    }
    return s->at < s->end ? reading_upper(s->text[s->at]) : '\0';
}

/* Take the next character if it is this one, in upper case. */
static inline bool reading_take(struct reading *s, char c)
{
    const bool is = reading_peek(s) == c;
    s->at += is;
    return is;
}

/* Take these letters (in upper case), all or none. */
bool reading_word(struct reading *s, const char *letters);

/* The offending text is the line from a place to where it has been read; returns f. */
enum fault reading_fault(struct reading *s, enum fault f, int32_t from);

/* Take a comment, s at its (. FAULT_COMMENT: it has no ). */
enum fault reading_comment(struct reading *s);

/* Take a decimal number with or without a sign; *whole: it has no point. `from` is where its text
 * begins, with the letter in front of it. FAULT_NUMBER: no digit; FAULT_DIGITS: over 120. */
enum fault reading_number(struct reading *s, int32_t from, double *value, bool *whole);

/* Take a name and its >, s behind the <; in lower case, padded with bytes 0. FAULT_NAME. */
enum fault reading_name(struct reading *s, int32_t from, char name[PARAMETERS_NAME]);

/* The whole number below 10^9 within 0.0001 of a value; false: there is none. */
bool reading_integer(double value, int32_t *whole);

#endif
