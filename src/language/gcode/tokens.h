/* tokens - cuts one line of a part program into words and settings of parameters.
 *
 * Comments in ( ) and behind ; are dropped. Case and blanks do not count, not even inside numbers.
 * A leading / or /1 to /9 (block delete) is noted.
 */
#ifndef TOKENS_H
#define TOKENS_H

#include "reading.h"

enum {
    TOKENS_WORDS_MAX = 40,
    TOKENS_CHAMFER = '[',
    TOKENS_ROUND = ']' /* letters of the words ,C and ,R */
};

/* A word: a letter and its value. */
struct token {
    char letter;        /* 'A'..'Z', '@', '^', TOKENS_CHAMFER, TOKENS_ROUND */
    bool whole;         /* a number without a decimal point */
    int32_t at, length; /* [characters] its place in the line */
    double value;
};

/* #1 = 5; it takes effect when the whole line has been read. The value may be vacant. */
struct setting {
    struct parameter which;
    double value;
    int32_t at, length;
};

/* What a line consists of. */
struct tokens {
    struct token word[TOKENS_WORDS_MAX];
    struct setting setting[TOKENS_WORDS_MAX];
    int count, settings;
    bool percent;       /* the line is a % */
    bool slash;         /* it begins with a /; noted before any fault behind it */
    bool flow;          /* reading has stopped at an O word, or at IF, GOTO, WHILE, DO, END */
    int32_t at, length; /* [characters] the line without blanks at its ends */
};

/* Cut what is left of a line. With a fault, s->r has the place of the first one, and *t all other
 * words that can be read. */
enum fault tokens_read(struct tokens *t, struct reading *s);

/* The offending text is a word; a word, and another one that it conflicts with; or the whole line.
 * They return f. */
enum fault tokens_at_word(struct fault_report *r, enum fault f, const struct token *w);
enum fault tokens_at_words(struct fault_report *r, enum fault f, const struct token *w,
                           const struct token *other);
enum fault tokens_at_line(struct fault_report *r, enum fault f, const struct tokens *t);

/* Add a note on a word. */
void tokens_note(struct fault_report *r, enum fault note, const struct token *w);

#endif
