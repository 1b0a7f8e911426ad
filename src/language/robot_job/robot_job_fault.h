/* robot_job_fault - why a line of a program or points file is refused, or a program stops. */
#ifndef ROBOT_JOB_FAULT_H
#define ROBOT_JOB_FAULT_H

#include <stdint.h>

/* Each fault with its text. `low`, `high` and `other` are members of the report. */
#define ROBOT_JOB_FAULT_TEXTS(X) \
    X(ROBOT_JOB_OK, "no fault") \
    /* any text */ \
    X(ROBOT_JOB_BAD_BYTE, "byte 0, which no text has, behind") \
    X(ROBOT_JOB_BAD_TEXT_LENGTH, "text too long") /* more than ROBOT_JOB_TEXT_MAX bytes */ \
    X(ROBOT_JOB_BAD_LINE_LENGTH, "line too long") /* more than ROBOT_JOB_LINE_MAX characters */ \
    X(ROBOT_JOB_BAD_WORD, "unknown word") \
    X(ROBOT_JOB_BAD_MISSING, "incomplete") /* the line ends before it is complete */ \
    X(ROBOT_JOB_BAD_EXTRA, "unexpected")   /* something else is expected here, or nothing more */ \
    X(ROBOT_JOB_BAD_TWICE, "given twice")  /* a tag given twice, or two that exclude each other */ \
    X(ROBOT_JOB_BAD_NUMBER, "number with more than 15 digits") \
    X(ROBOT_JOB_BAD_WHOLE, "no whole number") \
    X(ROBOT_JOB_BAD_VALUE, "value out of range") /* outside low .. high of the report */ \
    /* points file */ \
    /* a point, tool or user frame has been defined; other: its line */ \
    X(ROBOT_JOB_BAD_POINT_TWICE, "defined twice") \
    X(ROBOT_JOB_BAD_COORDINATES, "needs X Y Z A B C or J1 to J6") \
    X(ROBOT_JOB_BAD_MIXED, "joints beside coordinates or configuration") \
    X(ROBOT_JOB_BAD_POINT_FRAME, "tool or user frame not defined above") \
    /* program */ \
    X(ROBOT_JOB_BAD_POINT, "point not in the points file") \
    X(ROBOT_JOB_BAD_FRAME, "tool or user frame not in the points file") \
    X(ROBOT_JOB_BAD_JOB, "no such job") \
    X(ROBOT_JOB_BAD_LABEL, "no such label in this job") \
    X(ROBOT_JOB_BAD_JOB_TWICE, "second job of this name") /* other: line of the first */ \
    /* other: line of the first */ \
    X(ROBOT_JOB_BAD_LABEL_TWICE, "second label of this name in the job") \
    /* a jump into a LOOP from outside; other: line of the LOOP */ \
    X(ROBOT_JOB_BAD_INTO_LOOP, "jump into a LOOP") \
    /* ELSE, ELSEIF, ENDIF, ENDLOOP, ENDWHILE without its beginning, or within another block */ \
    X(ROBOT_JOB_BAD_NOT_OPEN, "does not end what is open") \
    /* IF, LOOP, WHILE without end; other: line where the job ends */ \
    X(ROBOT_JOB_BAD_OPEN, "has no end") \
    /* ELSE or ELSEIF behind ELSE; other: line of the ELSE */ \
    X(ROBOT_JOB_BAD_AFTER_ELSE, "behind ELSE") \
    X(ROBOT_JOB_BAD_AFTER_END, \
      "behind END") /* an instruction behind END; other: line of the END */ \
    /* no name, or one with more than ROBOT_JOB_NAME_MAX characters */ \
    X(ROBOT_JOB_BAD_NAME, "name too long") \
    X(ROBOT_JOB_BAD_ARC_POINTS, "MOVC of one point: three in a row, start, via, end") \
    /* the two speeds, ACC or DEC of an arc differ; other: line of the first */ \
    X(ROBOT_JOB_BAD_ARC_SPEED, "via and end with different speeds") \
    /* points of an arc with another tool or user frame */ \
    X(ROBOT_JOB_BAD_ARC_FRAMES, "via and end with different tools or user frames") \
    /* an operand of another kind than the instruction takes */ \
    X(ROBOT_JOB_BAD_KIND, "operand of the wrong kind") \
    /* a signal compared with <, > or with what is neither ON nor OFF */ \
    X(ROBOT_JOB_BAD_COMPARE, "IN# and OT# compare by = or <> with ON or OFF") \
    X(ROBOT_JOB_BAD_EMPTY, "no instruction") \
    /* AND and OR in one condition */ \
    X(ROBOT_JOB_BAD_MIXTURE, "AND beside OR in one condition") \
    X(ROBOT_JOB_BAD_BEFORE_CASE, "before the first CASE") \
    /* CASE or DEFAULT behind DEFAULT; other: line of the DEFAULT */ \
    X(ROBOT_JOB_BAD_AFTER_DEFAULT, "behind DEFAULT") \
    X(ROBOT_JOB_BAD_NEXT, "NEXT of another variable") /* other: line of the FOR */ \
    X(ROBOT_JOB_BAD_SHIFT, "a shift is a pose without a turn") \
    /* INFORM's, but not of this controller */ \
    X(ROBOT_JOB_BAD_LACKING, "INFORM that this controller lacks") \
    X(ROBOT_JOB_BAD_ARC_UNTIL, "via and end with different UNTIL") \
    X(ROBOT_JOB_BAD_AXES, "six values wanted, as many as the arm has axes") \
    X(ROBOT_JOB_BAD_OTHER_AXES, "base or station axes, which the arm has not") \
    X(ROBOT_JOB_BAD_ARC_OUTSIDE, "via and end with different base or station axes") \
    X(ROBOT_JOB_BAD_OTHER_ROBOT, "a move of another robot, and there is one") \
    X(ROBOT_JOB_BAD_POSITION, "position not in this job") \
    X(ROBOT_JOB_BAD_CONFIGURATION, "///RCONF wants six numbers or more") \
    /* instructions, jobs, labels, blocks; high: how many may be */ \
    X(ROBOT_JOB_BAD_TOO_MANY, "too many") \
    /* while it runs */ \
    X(ROBOT_JOB_BAD_STACK, "CALL inside too many others") /* CALL deeper than ROBOT_JOB_CALLS */ \
    X(ROBOT_JOB_BAD_ARGUMENT, "an argument it was not called with") \
    /* an element of B[..] P[..] that is none */ \
    X(ROBOT_JOB_BAD_ELEMENT, "no such variable") \
    X(ROBOT_JOB_BAD_UNSET, "a position that has no value yet") \
    /* pulses or joints beside X Y Z */ \
    X(ROBOT_JOB_BAD_PLACES, "positions of two kinds") \
    /* SFTON, IMOV */ \
    X(ROBOT_JOB_BAD_STEP, "a shift or increment of the wrong kind") \
    /* more than ROBOT_JOB_CHANGED */ \
    X(ROBOT_JOB_BAD_CHANGED, "more than 128 positions are changed") \
    X(ROBOT_JOB_BAD_ZERO_DIVISION, "division by zero") \
    /* a result outside the range of its variable or output */ \
    X(ROBOT_JOB_BAD_RANGE, "result out of range") \
    /* ROBOT_JOB_IDLE_MAX instructions that nobody sees */ \
    X(ROBOT_JOB_BAD_ENDLESS, "endless without motion, input, output or wait")

#define ROBOT_JOB_FAULT_ENTRY(name, text) name,
enum robot_job_fault { ROBOT_JOB_FAULT_TEXTS(ROBOT_JOB_FAULT_ENTRY) ROBOT_JOB_FAULT_COUNT };

/* The first thing wrong with a text. */
struct robot_job_report {
    enum robot_job_fault fault;
    int32_t line;           /* from 1 */
    int32_t column;         /* from 1 */
    int32_t offset, length; /* [byte] where the text at fault lies in the whole text */
    int32_t other;          /* another line that belongs to the fault, or 0 */
    int32_t text;           /* number of the text it lies in, from 0 */
    double low, high;       /* the range that BAD_VALUE left; BAD_TOO_MANY has `high` alone */
};

const char *robot_job_fault_text(enum robot_job_fault f);

enum { ROBOT_JOB_MESSAGE_MAX = 420 };

/* The whole message about the text that was read: line 3, column 13: value out of range "PL=9" (0
 * to 8). */
void robot_job_message(const struct robot_job_report *r, const char *text,
                       char message[ROBOT_JOB_MESSAGE_MAX]);

#endif
