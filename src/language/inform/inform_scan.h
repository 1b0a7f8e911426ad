/* inform_scan - what stands in a line, word by word, and where; both files are read with it.
 *
 * Functions that return -1 have written the report.
 */
#ifndef INFORM_SCAN_H
#define INFORM_SCAN_H

#include "inform_points.h"

struct inform_scan {
    const char *text;
    int32_t size;       /* [byte] */
    int32_t next;       /* where the next line begins */
    int32_t line;       /* number of this line, from 1 */
    int32_t begin, end; /* this line without blanks around it, comment and line end */
    int32_t at;         /* what has not been read yet */
    bool name;          /* the line begins with //NAME, which is read */
    struct inform_report *r;
};

/* Some text of the line. */
struct inform_piece {
    int32_t at, length;
};

/* Begin; -1: too long. */
int inform_scan_begin(struct inform_scan *s, const char *text, int64_t size,
                      struct inform_report *r);

/* Go to the next line that is not empty: 1, 0 behind the last one, or -1. */
int inform_scan_line(struct inform_scan *s);

/* Write a report about a piece, or about the whole line; -1. */
int inform_scan_fault(struct inform_scan *s, enum inform_fault f, struct inform_piece at);
int inform_scan_fault_line(struct inform_scan *s, enum inform_fault f);

/* What was expected is not here: incomplete at the end of the line, unexpected before; -1. */
int inform_scan_unexpected(struct inform_scan *s);

/* Whether nothing more stands in the line. */
bool inform_scan_over(struct inform_scan *s);

/* Take a character if it is the next one. */
bool inform_scan_take(struct inform_scan *s, char c);

/* Take a letter and the letters, digits and _ that follow; length 0 and nothing taken if there is
 * no letter. */
struct inform_piece inform_scan_word(struct inform_scan *s);

/* Take what names are of: letters, digits, _ and -. Longer than INFORM_NAME_MAX or nothing: -1. */
int inform_scan_name(struct inform_scan *s, int32_t most, struct inform_piece *name);

/* Whether a piece is a word, in capitals or not. */
bool inform_scan_is(const struct inform_scan *s, struct inform_piece p, const char *word);

/* Whether two pieces of the text are the same bytes. */
bool inform_scan_same(const char *text, struct inform_piece a, struct inform_piece b);

/* The number of a word such as B012 behind its letter, -1 if it is none. */
int32_t inform_scan_digits(const struct inform_scan *s, struct inform_piece p);

/* Take a number within low .. high; -1. */
int inform_scan_number(struct inform_scan *s, double low, double high, double *value);

/* The same for a whole number. */
int inform_scan_whole(struct inform_scan *s, int32_t low, int32_t high, int32_t *value);

#endif
