/* reading - characters of one line of a part program, and the numbers, names and words they make.
 *
 * Blanks do not count, also inside numbers and names; neither does case.
 */
#ifndef READING_H
#define READING_H

#include "parameters.h"

struct reading {
    const char *text;
    int32_t at, end;               /* the next character, and behind the last */
    int32_t depth;                 /* brackets around it */
    const struct interpreter *in;  /* for the values of parameters; NULL: there are none */
    const struct program *program; /* as a part of a program; or NULL */
    struct fault_report *r;
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

/* The next character that counts, in upper case; 0 at the end. It is not taken. */
static inline char reading_peek(struct reading *s)
{
    while (s->at < s->end && reading_blank(s->text[s->at])) {
        s->at++;
    }
    return s->at < s->end ? reading_upper(s->text[s->at]) : '\0';
}

/* Take it if it is this one. */
static inline bool reading_take(struct reading *s, char c)
{
    const bool is = reading_peek(s) == c;
    s->at += is;
    return is;
}

/* Take these letters (in upper case), all or none. */
bool reading_word(struct reading *s, const char *letters);

/* The offending text: from a place of the line to where it is read; returns f. */
enum fault reading_fault(struct reading *s, enum fault f, int32_t from);

/* Past ( and what it closes with. */
enum fault reading_comment(struct reading *s);

/* A number in decimal; *whole: without a point. `from` is where its text begins, with the letter in
 * front of it. */
enum fault reading_number(struct reading *s, int32_t from, double *value, bool *whole);

/* A name in < > in lower case, s behind the <. */
enum fault reading_name(struct reading *s, int32_t from, char name[PARAMETERS_NAME]);

/* The whole number a value stands for if it lies within 0.0001 of it. */
bool reading_integer(double value, int32_t *whole);

#endif
