/* robot_job_scan - reads a line word by word and knows where each word stands. Programs and points
 * files are both read with it.
 *
 * A function that returns -1 has written the report.
 */
#ifndef ROBOT_JOB_SCAN_H
#define ROBOT_JOB_SCAN_H

#include "robot_job_points.h"

struct robot_job_scan {
    const char *text;
    int32_t size;       /* [byte] */
    int32_t next;       /* where the next line begins */
    int32_t line;       /* number of this line, from 1 */
    int32_t begin, end; /* [byte] this line without the blanks around it, comment and line end */
    int32_t at;         /* [byte] where the part begins that has not been read yet */
    int32_t slashes;    /* number of / in front of a word that pendants write so, or 0 */
    struct robot_job_report *r;
};

/* Where some text of the line lies. */
struct robot_job_span {
    int32_t at, length;
};

/* Begin with a text; -1: it is too long. */
int robot_job_scan_begin(struct robot_job_scan *s, const char *text, int64_t size,
                         struct robot_job_report *r);

/* Go to the next line that is not empty: 1, 0 behind the last one, or -1. */
int robot_job_scan_line(struct robot_job_scan *s);

/* Column of a byte in its line, from 1; blanks in front count. */
int32_t robot_job_scan_column(const struct robot_job_scan *s, int32_t at);

/* Report a fault of a span, or of the whole line; always -1. */
int robot_job_scan_fault(struct robot_job_scan *s, enum robot_job_fault f,
                         struct robot_job_span at);
int robot_job_scan_fault_line(struct robot_job_scan *s, enum robot_job_fault f);

/* Report that what was expected is missing: BAD_MISSING at the end of the line, BAD_EXTRA before
 * it; always -1. */
int robot_job_scan_unexpected(struct robot_job_scan *s);

/* Whether the line has been read to its end. */
bool robot_job_scan_over(struct robot_job_scan *s);

/* Take a character if it is the next one. */
bool robot_job_scan_take(struct robot_job_scan *s, char c);

/* Take a letter and the letters, digits and _ that follow; length 0 and nothing taken if there is
 * no letter. */
struct robot_job_span robot_job_scan_word(struct robot_job_scan *s);

/* Take a name: letters, digits, _ and -. -1: there is none, or it is longer than
 * ROBOT_JOB_NAME_MAX. */
int robot_job_scan_name(struct robot_job_scan *s, int32_t most, struct robot_job_span *name);

/* Whether a span is this word, in capitals or not. */
bool robot_job_scan_is(const struct robot_job_scan *s, struct robot_job_span p, const char *word);

/* Whether two spans have the same bytes. */
bool robot_job_scan_same(const char *text, struct robot_job_span a, struct robot_job_span b);

/* The number of a word such as B012 behind its letter, -1 if it is none. */
int32_t robot_job_scan_digits(const struct robot_job_scan *s, struct robot_job_span p);

/* Take a number, which must lie within low .. high. */
int robot_job_scan_number(struct robot_job_scan *s, double low, double high, double *value);

/* Take a whole number, likewise. */
int robot_job_scan_whole(struct robot_job_scan *s, int32_t low, int32_t high, int32_t *value);

#endif
