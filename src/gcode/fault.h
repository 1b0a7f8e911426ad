/* fault - why a command or a line of a part program is refused. */
#ifndef FAULT_H
#define FAULT_H

#include <stdint.h>

enum fault {
    FAULT_NONE,
    FAULT_CHARACTER,        /* neither letter, comment nor end of line */
    FAULT_NUMBER,           /* a letter without a number */
    FAULT_DIGITS,           /* a number with too many digits */
    FAULT_ZERO,             /* a byte 0: no text */
    FAULT_LINE_LENGTH,      /* more than 256 characters */
    FAULT_WORD_COUNT,       /* more words than any line can need */
    FAULT_READ,             /* the text cannot be read */
    FAULT_COMMENT,          /* ( without ) */
    FAULT_WORD,             /* letter or G, M number not in the language */
    FAULT_TWICE,            /* a letter other than G and M twice */
    FAULT_GROUP,            /* two codes of one modal group */
    FAULT_M_COUNT,          /* more than four M words */
    FAULT_SHARED,           /* two codes that take the same words: axes, or P */
    FAULT_UNUSED,           /* a known word that has no use in this line */
    FAULT_VALUE,            /* a value outside its range */
    FAULT_NO_MOTION,        /* axis words with no motion code in force */
    FAULT_NO_DWELL,         /* G4 without P */
    FAULT_NO_AXES,          /* G10, G52, G53 or G92 without an axis */
    FAULT_NO_SYSTEM,        /* G10 without L2 or P */
    FAULT_NO_OUTPUT,        /* M62 .. M65 without P */
    FAULT_G53,              /* G53 without G0 or G1 */
    FAULT_AXIS,             /* the axis is not used */
    FAULT_NO_CENTRE,        /* arc with neither centre nor radius, or half a centre */
    FAULT_CENTRE_AND_R,     /* arc with both */
    FAULT_ARC_RADIUS,       /* radius zero */
    FAULT_ARC_END,          /* start and end have different distances from the centre */
    FAULT_ARC_CHORD,        /* radius smaller than half the distance start - end */
    FAULT_ARC_CLOSED,       /* R form with end = start, or three points on one line */
    FAULT_FEED,             /* above max_feed */
    FAULT_SPEED,            /* drives an axis above its safe motor speed */
    FAULT_RANGE,            /* a position that does not fit the pulse counter */
    FAULT_TRAVEL,           /* the path leaves the software limits of an axis */
    FAULT_COUNT
};

/* The first thing wrong with a part program. */
struct fault_report {
    enum fault fault;
    int32_t    line;        /* source line, from 1 */
    int64_t    offset;      /* [byte] where that line begins in the program */
    int32_t    at, length;  /* offending text in the line */
    int32_t    other_at, other_length;  /* of GROUP, SHARED: the word it does not agree with */
    int32_t    axis;            /* of TRAVEL, SPEED: the joint */
    double     value, limit;    /* ARC_END, ARC_CHORD, TRAVEL [mm], FEED [mm/min];
                                 * SPEED: of the joint's highest, and 1 */
};

/* Note where the offending text stands in its line; returns f. */
enum fault fault_at(struct fault_report *r, enum fault f, int32_t at, int32_t length);

/* What a fault means, in words; fits behind "line 12: ". */
const char *fault_text(enum fault f);

#endif
