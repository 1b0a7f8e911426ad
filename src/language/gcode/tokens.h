/* tokens - cuts one line of a part program into words and settings of parameters.
 *
 * Comments in ( ) and behind ; are dropped, case and blanks do not count (also inside numbers),
 * a leading / or /1 to /9 (block delete) is noted.
 */
#ifndef TOKENS_H
#define TOKENS_H

#include "reading.h"

enum {
    TOKENS_WORDS_MAX = 40,
    TOKENS_CHAMFER = '[',
    TOKENS_ROUND = ']' /* letters of the words ,C and ,R */
};

struct token {
    char letter;        /* 'A'..'Z', '@', '^', TOKENS_CHAMFER, TOKENS_ROUND */
    bool whole;         /* a number without a decimal point */
    int32_t at, length; /* where it stands in the line */
    double value;
};

/* #1 = 5: takes effect when the whole line has been read. The value may be vacant. */
struct setting {
    struct parameter which;
    double value;
    int32_t at, length;
};

struct tokens {
    struct token word[TOKENS_WORDS_MAX];
    struct setting setting[TOKENS_WORDS_MAX];
    int count, settings;
    bool percent;       /* the line is a % */
    bool slash;         /* it begins with a /; noted before any fault behind it */
    bool flow;          /* where the reading stopped stands an O word, or GOTO .. END */
    int32_t at, length; /* the line without blanks at its ends */
};

/* Cut what is left of a line. s->r gets the place of the first fault; the words around it are there
 * as far as they can be read. */
enum fault tokens_read(struct tokens *t, struct reading *s);

/* Note a word, a word and the one it does not agree with, or the whole line as the offending text;
 * returns f. */
enum fault tokens_at_word(struct fault_report *r, enum fault f, const struct token *w);
enum fault tokens_at_words(struct fault_report *r, enum fault f, const struct token *w,
                           const struct token *other);
enum fault tokens_at_line(struct fault_report *r, enum fault f, const struct tokens *t);

/* What a word has to say that is no fault. */
void tokens_note(struct fault_report *r, enum fault note, const struct token *w);

#endif
