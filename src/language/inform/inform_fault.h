/* inform_fault - why a line of a program or points file is refused, or a program stops. */
#ifndef INFORM_FAULT_H
#define INFORM_FAULT_H

#include <stdint.h>

enum inform_fault {
    INFORM_OK,
    /* any text */
    INFORM_BAD_BYTE,          /* a byte 0: no text */
    INFORM_BAD_TEXT_LENGTH,   /* more than INFORM_TEXT_MAX bytes */
    INFORM_BAD_LINE_LENGTH,   /* more than INFORM_LINE_MAX characters */
    INFORM_BAD_WORD,          /* not in the language */
    INFORM_BAD_MISSING,       /* the line ends before it is complete */
    INFORM_BAD_EXTRA,         /* something else is expected here, or nothing more */
    INFORM_BAD_TWICE,         /* a tag given twice, or two that exclude each other */
    INFORM_BAD_NUMBER,        /* no number, or one with more than 15 digits */
    INFORM_BAD_WHOLE,         /* no whole number */
    INFORM_BAD_VALUE,         /* outside low .. high of the report */
    /* points file */
    INFORM_BAD_POINT_TWICE,   /* a point, tool or user frame has been defined; other: its line */
    INFORM_BAD_COORDINATES,   /* a coordinate or joint is missing */
    INFORM_BAD_MIXED,         /* joints beside coordinates, or beside a configuration */
    INFORM_BAD_POINT_FRAME,   /* a point names a frame that is not defined above it */
    /* program */
    INFORM_BAD_POINT,         /* no such point */
    INFORM_BAD_FRAME,         /* no such tool or user frame */
    INFORM_BAD_JOB,           /* no such job */
    INFORM_BAD_LABEL,         /* no such label in the job */
    INFORM_BAD_JOB_TWICE,     /* other: line of the first */
    INFORM_BAD_LABEL_TWICE,   /* other: line of the first */
    INFORM_BAD_INTO_LOOP,     /* a jump into a LOOP from outside; other: line of the LOOP */
    INFORM_BAD_NOT_OPEN,      /* ELSE, ELSEIF, ENDIF, ENDLOOP, ENDWHILE without its beginning, or
                               * inside another block that is still open */
    INFORM_BAD_OPEN,          /* IF, LOOP, WHILE without end; other: line where the job ends */
    INFORM_BAD_AFTER_ELSE,    /* ELSE or ELSEIF behind ELSE; other: line of the ELSE */
    INFORM_BAD_AFTER_END,     /* an instruction behind END; other: line of the END */
    INFORM_BAD_NAME,          /* no name, or one with more than INFORM_NAME_MAX characters */
    INFORM_BAD_ARC_POINTS,    /* MOVC with one point each not in threes */
    INFORM_BAD_ARC_SPEED,     /* the two speeds of an arc differ; other: line of the first */
    INFORM_BAD_ARC_FRAMES,    /* points of an arc with another tool or user frame */
    INFORM_BAD_KIND,          /* an operand of another kind than the instruction takes */
    INFORM_BAD_COMPARE,       /* a signal compared with <, > or with what is neither ON nor OFF */
    INFORM_BAD_EMPTY,         /* a program without an instruction */
    INFORM_BAD_TOO_MANY,      /* instructions, jobs, labels, blocks; high: how many may be */
    /* while it runs */
    INFORM_BAD_STACK,         /* CALL deeper than INFORM_CALLS */
    INFORM_BAD_ZERO_DIVISION, /* DIV by 0 */
    INFORM_BAD_RANGE,         /* a result outside the range of its variable or output */
    INFORM_BAD_ENDLESS,       /* INFORM_IDLE_MAX instructions that nobody sees */
    INFORM_FAULT_COUNT
};

/* The first thing wrong with a text. */
struct inform_report {
    enum inform_fault fault;
    int32_t line;           /* from 1 */
    int32_t column;         /* from 1 */
    int32_t offset, length; /* [byte] the offending text in the whole text */
    int32_t other;          /* another line that belongs to it, or 0 */
    double  low, high;      /* of BAD_VALUE; high of BAD_TOO_MANY, too */
};

/* What a fault means, in words. */
const char *inform_fault_text(enum inform_fault f);

enum { INFORM_MESSAGE_MAX = 420 };

/* The whole message: line 3, column 13: value out of range "PL=9" (0 to 8). `text` is the text that
 * was read. */
void inform_message(const struct inform_report *r, const char *text,
                    char message[INFORM_MESSAGE_MAX]);

#endif
