/* tokens - cuts one line of a part program into words.
 *
 * Comments in ( ) and behind ; are dropped, case and blanks do not count (also inside numbers),
 * a leading / (block delete) is noted.
 */
#ifndef TOKENS_H
#define TOKENS_H

#include <stdbool.h>
#include <stdint.h>

#include "fault.h"

enum { TOKENS_WORDS_MAX = 40 };

struct token {
    char    letter;         /* 'A'..'Z' */
    double  value;
    int32_t at, length;     /* where it stands in the line */
};

struct tokens {
    struct token word[TOKENS_WORDS_MAX];
    int     count;
    bool    percent;        /* the line is a % */
    bool    slash;          /* it begins with a /; noted before any fault behind it */
    int32_t at, length;     /* the line without blanks at its ends */
};

/* Cut a line. *r gets the place of a fault. */
enum fault tokens_read(struct tokens *t, const char *line, int32_t length,
                       struct fault_report *r);

/* Note a word, a word and the one it does not agree with, or the whole line as the offending text;
 * returns f. */
enum fault tokens_at_word(struct fault_report *r, enum fault f, const struct token *w);
enum fault tokens_at_words(struct fault_report *r, enum fault f, const struct token *w,
                           const struct token *other);
enum fault tokens_at_line(struct fault_report *r, enum fault f, const struct tokens *t);

#endif
