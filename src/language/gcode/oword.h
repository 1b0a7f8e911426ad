/* oword - reads the O word of a line, and searches a text for the line that has a certain one. */
#ifndef OWORD_H
#define OWORD_H

#include <string.h>

#include "reading.h"
#include "source.h"

enum { OWORD_LABEL = PARAMETERS_NAME };

/* The word behind the label; a bit each, so that a search can be for one of several. */
enum oword_is {
    OWORD_NUMBER = 1 << 0, /* nothing behind the label: the number of a program */
    OWORD_SUB = 1 << 1,
    OWORD_ENDSUB = 1 << 2,
    OWORD_CALL = 1 << 3,
    OWORD_RETURN = 1 << 4,
    OWORD_IF = 1 << 5,
    OWORD_ELSEIF = 1 << 6,
    OWORD_ELSE = 1 << 7,
    OWORD_ENDIF = 1 << 8,
    OWORD_WHILE = 1 << 9,
    OWORD_ENDWHILE = 1 << 10,
    OWORD_DO = 1 << 11,
    OWORD_REPEAT = 1 << 12,
    OWORD_ENDREPEAT = 1 << 13,
    OWORD_BREAK = 1 << 14,
    OWORD_CONTINUE = 1 << 15,
    OWORD_EITHER_SUB = OWORD_SUB | OWORD_ENDSUB
};

/* O, label and word: o100 call, o<name> sub. */
struct oword {
    char label[OWORD_LABEL]; /* name, or digits without leading zeros; padded with bytes 0 */
    enum oword_is is;
    bool computed; /* the label is a value: o#1, o[#1 + 2] */
};

/* Place of a line. */
struct oword_place {
    int64_t offset; /* [byte] of the line in its text */
    int32_t line;   /* number of lines in front of it */
    int32_t file;   /* its text: 0 the program, from 1 on called files */
};

/* Whether two labels are the same. */
static inline bool oword_same(const char *a, const char *b)
{
    return memcmp(a, b, OWORD_LABEL) == 0;
}

/* Read O, label and word, s at the O. FAULT_O_WORD: no such word; FAULT_O_LABEL: a computed label
 * without `call`; FAULT_VALUE: a computed label that is no whole number from 0. */
enum fault oword_read(struct reading *s, struct oword *o);

/* The label that stands for a number >= 0. */
void oword_label(char label[OWORD_LABEL], int32_t number);

/* FAULT_O_BEHIND unless what is left of the line is only comments. */
enum fault oword_alone(struct reading *s);

/* Search a file from *place on for the first line with this label and one of `words` (bits).
 * It sets *place to that line and *is to its word. Without one in front of the end, or of a line
 * with a word of `stop` (sub, endsub, with any label), *is becomes 0. */
enum fault oword_seek(const struct program *p, const char *file, const char *label, int32_t words,
                      int32_t stop, struct oword_place *place, int32_t *is);

#endif
