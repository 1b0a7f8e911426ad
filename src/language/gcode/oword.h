/* oword - the O word of a line, and where in the text the line stands that has a certain one. */
#ifndef OWORD_H
#define OWORD_H

#include <string.h>

#include "reading.h"
#include "source.h"

enum { OWORD_LABEL = PARAMETERS_NAME };

/* What an O word is; a bit each, so that one of several can be looked for. */
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

struct oword {
    char label[OWORD_LABEL]; /* name or digits without leading zeros, filled up with zeros */
    enum oword_is is;
    bool computed; /* o#1, o[#1 + 2] */
};

/* A place in the text. */
struct oword_place {
    int64_t offset; /* [byte] of a line */
    int32_t line;   /* lines in front of it */
    int32_t file;   /* 0 the program; of the files that it calls, from 1 */
};

/* Whether two labels are one. */
static inline bool oword_same(const char *a, const char *b)
{
    return memcmp(a, b, OWORD_LABEL) == 0;
}

/* Read O word and label, s at the O. */
enum fault oword_read(struct reading *s, struct oword *o);

/* The label that a number makes. */
void oword_label(char label[OWORD_LABEL], int32_t number);

/* Nothing but a comment may stand in what is left of the line. */
enum fault oword_alone(struct reading *s);

/* From a place on, in a file, the first line with this label and one of these words (bits); *place
 * becomes its own, and *is its word: 0 if there is none in front of one of `stop` with any
 * label. */
enum fault oword_seek(const struct program *p, const char *file, const char *label, int32_t words,
                      int32_t stop, struct oword_place *place, int32_t *is);

#endif
