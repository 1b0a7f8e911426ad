/* tokens - cuts one line of a part program into words.
 *
 * Comments in ( ) and behind ; are dropped, case and blanks do not count (also inside numbers),
 * a leading / (block delete, its switch off) is passed over.
 */
#ifndef TOKENS_H
#define TOKENS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "fault.h"

enum { TOKENS_LINE_MAX = 256, TOKENS_WORDS_MAX = 40 };

struct token {
    char    letter;         /* 'A'..'Z' */
    double  value;
    int64_t at, length;     /* where it stands in the program */
};

struct tokens {
    struct token word[TOKENS_WORDS_MAX];
    int     count;
    bool    percent;        /* the line is a % */
    int64_t at, length;     /* the line without blanks at its ends */
};

/* Read the line that begins at *offset and move *offset behind its end. *r has the place of a fault
 * but no line number. */
enum fault tokens_read(struct tokens *t, const char *text, size_t length, int64_t *offset,
                       struct fault_report *r);

/* Note a word or the whole line as the offending text; returns f. */
enum fault tokens_at_word(struct fault_report *r, enum fault f, const struct token *w);
enum fault tokens_at_line(struct fault_report *r, enum fault f, const struct tokens *t);

#endif
