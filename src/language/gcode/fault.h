/* fault - why a command or a line of a part program is refused. */
#ifndef FAULT_H
#define FAULT_H

#include <stdbool.h>
#include <stdint.h>

enum fault {
    FAULT_NONE,
    FAULT_CHARACTER,        /* neither letter, comment nor end of line */
    FAULT_NUMBER,           /* a letter without a number */
    FAULT_DIGITS,           /* a number of more digits than EL_DECIMAL_DIGITS */
    FAULT_ZERO,             /* a byte 0: no text */
    FAULT_LINE_LENGTH,      /* more than 256 characters */
    FAULT_WORD_COUNT,       /* more words than any line can need */
    FAULT_READ,             /* the text cannot be read */
    FAULT_COMMENT,          /* ( without ) */
    FAULT_BRACKET,          /* [ ] expected, or left open */
    FAULT_OPERATOR,         /* no operation that exists */
    FAULT_NAME,             /* a name without >, without or with too many characters */
    FAULT_ATAN,             /* ATAN without its / */
    FAULT_EXISTS,           /* EXISTS of anything but a name */
    FAULT_ASSIGNMENT,       /* # at the start of a word, no = behind it */
    FAULT_DEEP,             /* brackets too deep within one another */
    FAULT_DIVISION,         /* by zero */
    FAULT_ARGUMENT,         /* a function has no value there */
    FAULT_LARGE,            /* a value beyond all numbers */
    FAULT_PARAMETER,        /* a number that no parameter has */
    FAULT_UNSET,            /* a name read before it was set */
    FAULT_FOREIGN,          /* a name that other controllers give a value */
    FAULT_FIXED,            /* a parameter that a program cannot set */
    FAULT_NAMES,            /* too many names */
    FAULT_O_WORD,           /* no O word of the language, or in the middle of a line */
    FAULT_O_LABEL,          /* a label computed where it must be written */
    FAULT_O_BEHIND,         /* something behind the O word */
    FAULT_O_PLACE,          /* an O word whose beginning is not the innermost that is open */
    FAULT_O_OPEN,           /* the label of a loop or an if that is open already */
    FAULT_O_END,            /* what begins has no end */
    FAULT_O_NUMBER,         /* an O number that is not the program's */
    FAULT_O_DEEP,           /* too many loops and ifs within one another */
    FAULT_SEQUENCE,         /* no line has the N of a GOTO */
    FAULT_LOOP_END,         /* DO without END of its number */
    FAULT_THEN,             /* behind the condition of IF or WHILE stands something else */
    FAULT_ALARM,            /* #3000 = n (message) */
    FAULT_MODAL,            /* G66 or a canned cycle while G66 is in force */
    FAULT_NO_SUB,           /* the text does not have what is called */
    FAULT_USER,             /* M100 .. M199 without the subprogram that says what it does */
    FAULT_FILES,            /* too many files are called */
    FAULT_CALLS,            /* too many calls within calls */
    FAULT_M99,              /* M99 in an o sub */
    FAULT_ENDLESS,          /* too many lines read again without a command that takes time */
    FAULT_ANGLE,            /* A B C where the tool does not turn */
    FAULT_SIDE,             /* U V W where it does */
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
    FAULT_TURNING,          /* a code that only a lathe has */
    FAULT_NURBS,            /* another motion, plane or the end before G5.3 */
    FAULT_NURBS_END,        /* no G5.3 behind the points */
    FAULT_NURBS_NONE,       /* G5.3 without G5.2 */
    FAULT_NURBS_FEW,        /* fewer points than the order */
    FAULT_NURBS_POINT,      /* a point without one of its coordinates */
    FAULT_NURBS_FEED,       /* G5.2 with G93 */
    FAULT_SPLINE,           /* a spline without what its control points need */
    FAULT_SPLINE_PLANE,     /* not in the plane XY */
    FAULT_CUSP,             /* it turns on the spot */
    FAULT_PLAIN,            /* the machine drives none */
    FAULT_FRAME,            /* changes the zero while G51 or G68 is in force, or G51 within G68 */
    FAULT_NO_FACTOR,        /* G51 without P or I J K */
    FAULT_NO_ANGLE,         /* G68 without R */
    FAULT_OVAL,             /* arc in a plane with two factors, or not that of the rotation */
    FAULT_POLE,             /* polar words where the tool is at the pole */
    FAULT_NO_FEED,          /* no F in the line with G93, or since G94 or G95 */
    FAULT_REST,             /* G95 with the spindle at rest */
    FAULT_SURFACE,          /* G95 with G96 */
    FAULT_FEED,             /* above max_feed */
    FAULT_SPEED,            /* drives an axis above its safe motor speed */
    FAULT_RANGE,            /* a position that does not fit the pulse counter */
    FAULT_TRAVEL,           /* the path leaves the software limits of an axis */
    FAULT_MISSING,          /* a code without a word that it needs */
    FAULT_TOOL,             /* no such tool in the tool table */
    FAULT_NO_INPUTS,        /* M66 where no inputs can be asked */
    FAULT_NO_PROBE,         /* G38 without a probe */
    FAULT_PROBE_POINT,      /* G38 to where the tool stands */
    FAULT_NO_MODES,         /* M72 without M70 or M73 in this call */
    FAULT_RESTORE,          /* M72 or the end of a call with M73 beside a contour or G51, G68 */
    FAULT_NO_TOOL,          /* M6 with no T since the one before */
    FAULT_PLANE,            /* G17.1, G18.1, G19.1 */
    FAULT_CYCLE_R,          /* a cycle without R */
    FAULT_CYCLE_DEPTH,      /* a cycle without the word along the normal of the plane */
    FAULT_CYCLE_Q,          /* G73 or G83 without Q */
    FAULT_CYCLE_P,          /* G82, G86, G88 or G89 without P */
    FAULT_CYCLE_ASIDE,      /* G87 without the letters of I J K that it needs */
    FAULT_TAP_K,            /* G33.1 without K */
    FAULT_CYCLE_LOW,        /* R below the bottom of the hole */
    FAULT_CYCLE_PECKS,      /* more than 10,000 pecks */
    FAULT_CYCLE_FEED,       /* a cycle with G93 */
    FAULT_CYCLE_SPINDLE,    /* the spindle is off, or turns the wrong way round */
    FAULT_ROUND_NEXT,       /* behind ,C or ,R comes something else than a motion in the plane */
    FAULT_ROUND_SHORT,      /* ,C or ,R has no room between the motions */
    FAULT_CUTTER_ON,        /* G41 or G42 while one of them is in force */
    FAULT_CUTTER_PLANE,     /* G19, or another plane while compensation is on */
    FAULT_CUTTER_WORD,      /* what moves or measures the tool beside its contour */
    FAULT_CUTTER_ENTRY,     /* the first motion is too short, or cannot meet the second */
    FAULT_CUTTER_EXIT,      /* an arc right behind G40 */
    FAULT_CUTTER_ARC,       /* the tool does not fit into an arc */
    FAULT_CUTTER_CORNER,    /* nor into the corner in front of a motion */
    FAULT_CUTTER_SHORT,     /* a motion too short for the corners at its ends */
    FAULT_CUTTER_BACK,      /* the contour turns back on itself */
    FAULT_CUTTER_FULL,      /* more than 21 commands between two motions */
    FAULT_NOTE_COMMENT,     /* no fault but a note: (PRINT, ...) and the like do nothing here */
    FAULT_NOTE_ORIENT,      /* a note: M19 only stops the spindle */
    FAULT_NOTE_SPEED,       /* a note: M51, there is no override of the spindle */
    FAULT_NOTE_SPINDLE,     /* a note: there is none */
    FAULT_NOTE_COOLANT,     /* a note: there is none */
    FAULT_NOTE_OVERRIDE,    /* a note: M48 to M53 change nothing */
    FAULT_NOTE_FEED,        /* a note: F above the highest feed, or that of an axis */
    FAULT_NOTE_ANGLE,       /* a note: A0, B0 or C0 */
    FAULT_NOTE_SIDE,        /* a note: U0, V0 or W0 */
    FAULT_NOTE_MERGE,       /* a note: Q of G64, runs of lines stay lines */
    FAULT_NOTE_CHECKED,     /* a note: what comes behind has not been checked */
    FAULT_COUNT
};

enum { FAULT_FILE = 32 };      /* [byte] of the name of a file that is called */

enum { FAULT_LIST = 20, FAULT_NOTES = FAULT_COUNT - FAULT_NOTE_COMMENT };

/* A note and where it stands, as below. */
struct fault_note {
    enum fault what;
    int32_t    line, at, length;
    int64_t    offset;
    char       file[FAULT_FILE];
};

/* Something wrong with a part program, or a note. */
struct fault_report {
    enum fault fault;
    int32_t    notes;       /* of what has been read, each kind once */
    struct fault_note note[FAULT_NOTES];
    int32_t    line;        /* source line, from 1 */
    int64_t    offset;      /* [byte] where that line begins in the program, */
    char       file[FAULT_FILE];    /* or in a file that it calls, by its name; empty: none */
    int32_t    at, length;  /* offending text in the line */
    int32_t    other_at, other_length;  /* of GROUP, SHARED: the word it does not agree with */
    int32_t    axis;            /* of TRAVEL, SPEED: the joint */
    double     value, limit;    /* ARC_END, ARC_CHORD, TRAVEL [mm], FEED [mm/min];
                                 * SPEED: of the joint's highest, and 1 */
    double     feed;            /* SPEED: the largest that is possible there [mm/min] */
};

/* All that is wrong with a part program, a line each, and the notes, once each. */
struct fault_list {
    int32_t count, notes;
    bool    more;           /* there are more faults than fit */
    struct fault_report of[FAULT_LIST];
    struct fault_report note[FAULT_NOTES];
};

/* Note where the offending text stands in its line; returns f. */
enum fault fault_at(struct fault_report *r, enum fault f, int32_t at, int32_t length);

/* Note something that is no fault, in the line of *r. */
void fault_note(struct fault_report *r, enum fault what, int32_t at, int32_t length);

/* What a fault means, in words; fits behind "line 12: ". */
const char *fault_text(enum fault f);

#endif
