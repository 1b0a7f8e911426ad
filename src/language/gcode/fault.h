/* fault - why a block of a part program is refused, with the place and the values that a message
 * needs; and notes, which tell of what is accepted but does nothing or something else here. */
#ifndef FAULT_H
#define FAULT_H

#include <stdbool.h>
#include <stdint.h>

/* Each fault with its text, which fits behind "line 12: ". FAULT_NOTE_COMMENT begins the notes. */
#define FAULT_TEXTS(X) \
    X(FAULT_NONE, "no fault") \
    X(FAULT_CHARACTER, "unexpected character") /* neither letter, comment nor end of line */ \
    X(FAULT_NUMBER, "number expected after") \
    X(FAULT_DIGITS, "number of more than 120 digits") \
    X(FAULT_ZERO, "byte 0, which no text has, behind") \
    X(FAULT_LINE_LENGTH, "line longer than 256 characters") \
    X(FAULT_WORD_COUNT, "too many words in the line") \
    X(FAULT_READ, "the program cannot be read") \
    X(FAULT_COMMENT, "comment without )") \
    X(FAULT_BRACKET, "[ ] expected")             /* [ ] expected, or left open */ \
    X(FAULT_OPERATOR, "operation or ] expected") /* no operation that exists */ \
    X(FAULT_NAME, "a name has 1 to 31 characters between < and >") \
    X(FAULT_ATAN, "ATAN needs [ ]/[ ]") \
    X(FAULT_EXISTS, "EXISTS needs [#<name>]") \
    X(FAULT_ASSIGNMENT, "= expected behind") /* # at the start of a word, no = behind it */ \
    X(FAULT_DEEP, "more than 30 brackets within one another") \
    X(FAULT_DIVISION, "division by zero") \
    X(FAULT_ARGUMENT, "no value for this argument") /* a function has no value there */ \
    X(FAULT_LARGE, "value too large") \
    X(FAULT_PARAMETER, "no such parameter")      /* a number that no parameter has */ \
    X(FAULT_UNSET, "parameter has not been set") /* a name read before it was set */ \
    /* a name that other controllers give a value */ \
    X(FAULT_FOREIGN, "this machine has no value for") \
    X(FAULT_FIXED, "parameter cannot be set") \
    X(FAULT_NAMES, "more than 100 named parameters") \
    X(FAULT_O_WORD, "unknown O word") /* no O word of the language, or in the middle of a line */ \
    /* a label computed where it must be written */ \
    X(FAULT_O_LABEL, "only a call may compute its O number") \
    X(FAULT_O_BEHIND, "O words allow no other word in their line") \
    /* an O word whose beginning is not the innermost that is open */ \
    X(FAULT_O_PLACE, "O word without its beginning") \
    /* the label of a loop or an if that is open already */ \
    X(FAULT_O_OPEN, "O number is open already") \
    X(FAULT_O_END, "O word without its end") \
    /* an O number that is not the program's */ \
    X(FAULT_O_NUMBER, "second O number without M2, M30 or M99 in front of it") \
    X(FAULT_O_DEEP, "more than 64 loops and conditions within one another") \
    X(FAULT_SEQUENCE, "no line of this program has this N") \
    X(FAULT_LOOP_END, "DO without the END of its number") \
    X(FAULT_THEN, "IF [ ] goes on with GOTO or THEN, WHILE [ ] with DO") \
    X(FAULT_ALARM, "alarm of the program") /* #3000 = n (message) */ \
    /* G66 or a canned cycle while G66 is in force */ \
    X(FAULT_MODAL, "not while G66 is in force (G67 ends it)") \
    X(FAULT_NO_SUB, "no such subprogram") /* the text does not have what is called */ \
    X(FAULT_USER, "no subprogram of its name (o<m100> sub) says what it does:") \
    X(FAULT_FILES, "more than 32 files are called") \
    X(FAULT_CALLS, "more than 10 calls within one another") \
    X(FAULT_M99, "M99 in a subprogram that ends with endsub") /* M99 in an o sub */ \
    X(FAULT_ENDLESS, "1,000,000 lines read again without anything that takes time") \
    /* A B C where the tool does not turn */ \
    X(FAULT_ANGLE, "this machine has no rotary axes (--angles: A B C in place of U V W)") \
    X(FAULT_SIDE, "this machine has A B C in place of the axes U V W") /* U V W where it does */ \
    X(FAULT_WORD, "unknown word")      /* letter or G, M number not in the language */ \
    X(FAULT_TWICE, "word given twice") /* a letter other than G and M twice */ \
    X(FAULT_GROUP, "second word of one modal group") \
    X(FAULT_M_COUNT, "more than four M words in the line") \
    /* two codes that take the same words: axes, or P */ \
    X(FAULT_SHARED, "two codes take the same words") \
    X(FAULT_UNUSED, "word has no use in this line") \
    X(FAULT_VALUE, "value out of range") \
    X(FAULT_NO_MOTION, "axis word without G0, G1, G2 or G3") \
    X(FAULT_NO_DWELL, "G4 without P") \
    X(FAULT_NO_AXES, "no axis word") /* G10, G52, G53 or G92 without an axis */ \
    X(FAULT_NO_SYSTEM, "G10 needs L2 or L20 and P0 to P9") /* G10 without L2 or P */ \
    X(FAULT_NO_OUTPUT, "output without P0 to P31")         /* M62 .. M65 without P */ \
    X(FAULT_G53, "G53 needs G0 or G1") \
    X(FAULT_AXIS, "axis is not active") \
    /* arc with neither centre nor radius, or half a centre */ \
    X(FAULT_NO_CENTRE, "arc without centre or radius") \
    X(FAULT_CENTRE_AND_R, "arc with both centre and radius") \
    X(FAULT_ARC_RADIUS, "arc of radius zero") \
    /* start and end have different distances from the centre */ \
    X(FAULT_ARC_END, "arc end does not lie on the circle through its start") \
    X(FAULT_ARC_CHORD, "arc radius is smaller than half the distance to the end") \
    /* R form with end = start, or three points on one line */ \
    X(FAULT_ARC_CLOSED, "arc is not determined by its points") \
    X(FAULT_TURNING, "for turning; this is no lathe") \
    X(FAULT_NURBS, "G5.2 is not ended by G5.3 before") /* another motion or plane before G5.3 */ \
    X(FAULT_NURBS_END, "G5.2 is not ended by G5.3 behind") \
    X(FAULT_NURBS_NONE, "no G5.2 before") \
    X(FAULT_NURBS_FEW, "fewer points since G5.2 than its order L, or 3, before") \
    X(FAULT_NURBS_POINT, "point of a NURBS without both axes of the plane") \
    X(FAULT_NURBS_FEED, "NURBS with G93, in which a feed is that of one motion") \
    X(FAULT_SPLINE, "spline without control points (G5 I J P Q, G5.1 I J)") \
    X(FAULT_SPLINE_PLANE, "splines are in the plane of G17") /* not in the plane XY */ \
    X(FAULT_CUSP, "spline turns on the spot") \
    X(FAULT_PLAIN, "this machine drives no splines") \
    /* changes the zero while G51 or G68 is in force, or G51 within G68 */ \
    X(FAULT_FRAME, "not while G51 or G68 is in force") \
    X(FAULT_NO_FACTOR, "G51 without P or I J K") \
    X(FAULT_NO_ANGLE, "G68 without R") \
    /* arc in a plane with two factors, or not that of the rotation */ \
    X(FAULT_OVAL, "arc in a plane that G51 or a rotation does not keep round") \
    X(FAULT_POLE, "polar word without an angle: the tool is at the pole") \
    X(FAULT_NO_FEED, "no F since G93, G94 or G95; with G93 each line needs one") \
    X(FAULT_REST, "G95 with the spindle at rest") \
    /* G95 with G96 */ \
    X(FAULT_SURFACE, "G95 needs G97: the spindle's speed would change on the way") \
    X(FAULT_FEED, "feed above max_feed [mm/min]") \
    /* drives an axis above its safe motor speed */ \
    X(FAULT_SPEED, "feed drives an axis above max_rpm [rpm]") \
    X(FAULT_RANGE, "position does not fit the 32-bit pulse counter") \
    X(FAULT_TRAVEL, "path leaves the software limits") \
    /* a code without a word that it needs */ \
    X(FAULT_MISSING, "a word is missing that goes with") \
    X(FAULT_TOOL, "no such tool in the tool table") \
    X(FAULT_NO_INPUTS, "this machine has no inputs for") /* M66 where no inputs can be asked */ \
    X(FAULT_NO_PROBE, "this machine has no probe for")   /* G38 without a probe */ \
    X(FAULT_PROBE_POINT, "probing leads nowhere")        /* G38 to where the tool stands */ \
    /* M72 without M70 or M73 in this call */ \
    X(FAULT_NO_MODES, "no M70 or M73 in this call before") \
    /* M72 or the end of a call with M73 beside a contour or G51, G68 */ \
    X(FAULT_RESTORE, "cutter compensation, G51 or G68 allow no change that this restores") \
    X(FAULT_NO_TOOL, "no T since the tool change before") /* M6 with no T since the one before */ \
    /* G17.1, G18.1, G19.1 */ \
    X(FAULT_PLANE, "plane of U V W, in which this machine has no arcs or cycles") \
    X(FAULT_CYCLE_R, "canned cycle without R") \
    /* a cycle without the word along the normal of the plane */ \
    X(FAULT_CYCLE_DEPTH, "canned cycle without its depth") \
    X(FAULT_CYCLE_Q, "canned cycle without Q") /* G73 or G83 without Q */ \
    X(FAULT_CYCLE_P, "canned cycle without P") /* G82, G86, G88 or G89 without P */ \
    /* G87 without the letters of I J K that it needs */ \
    X(FAULT_CYCLE_ASIDE, "G87 without I, J and K") \
    X(FAULT_TAP_K, "G33.1 without K, the way of a turn") \
    X(FAULT_CYCLE_LOW, "R is below the bottom of the hole") \
    X(FAULT_CYCLE_PECKS, "more than 10,000 pecks in one hole") \
    X(FAULT_CYCLE_FEED, "canned cycle with G93, in which a feed is that of one motion") \
    /* the spindle is off, or turns the wrong way round */ \
    X(FAULT_CYCLE_SPINDLE, "the spindle does not turn as this cycle needs") \
    X(FAULT_ROUND_NEXT, \
      ",C and ,R are between two lines or arcs in the plane that follow each other") \
    X(FAULT_ROUND_SHORT, "no room for ,C or ,R between the motions") \
    /* G41 or G42 while one of them is in force */ \
    X(FAULT_CUTTER_ON, "cutter compensation is on already") \
    /* G19, or another plane while compensation is on */ \
    X(FAULT_CUTTER_PLANE, "cutter compensation does not work in this plane") \
    /* what moves or measures the tool beside its contour */ \
    X(FAULT_CUTTER_WORD, "not while cutter compensation is on") \
    /* the first motion is too short, or cannot meet the second */ \
    X(FAULT_CUTTER_ENTRY, "first motion of cutter compensation cannot reach the contour") \
    X(FAULT_CUTTER_EXIT, "motion behind G40 has to be straight") /* an arc right behind G40 */ \
    X(FAULT_CUTTER_ARC, "tool does not fit into the arc") \
    X(FAULT_CUTTER_CORNER, "tool does not fit into the corner in front of") \
    X(FAULT_CUTTER_SHORT, "motion too short for the tool to fit into its corners") \
    X(FAULT_CUTTER_BACK, "contour turns back on itself at the start of") \
    /* more than 21 commands between two motions */ \
    X(FAULT_CUTTER_FULL, "too much between two motions of cutter compensation") \
    /* O words but a call, IF, GOTO, WHILE, M99 in a line by hand */ \
    X(FAULT_ALONE, "it needs other lines, and a line by hand has none") \
    /* a line by hand that comes while something else has the machine */ \
    X(FAULT_WHILE_PROGRAM, "no line by hand is taken while a program runs") \
    X(FAULT_WHILE_HAND, "no line by hand is taken while axes are jogged or homed") \
    X(FAULT_WHILE_ERROR, "no line by hand is taken until the run-time error is cleared") \
    /* a program is to begin at such a line */ \
    X(FAULT_FROM_LINE, "the program does not come to line") \
    X(FAULT_FROM_HELD, "a motion before waits for this line: begin where it is whole") \
    /* a note, no fault: (PRINT, ...) and the like */ \
    X(FAULT_NOTE_COMMENT, "a comment that does nothing here") \
    /* a note: M19 only stops the spindle */ \
    X(FAULT_NOTE_ORIENT, "the spindle stops, it has no angle") \
    /* a note: M51, there is no override of the spindle */ \
    X(FAULT_NOTE_SPEED, "the spindle has no override") \
    X(FAULT_NOTE_SPINDLE, "this machine has no spindle for") \
    X(FAULT_NOTE_COOLANT, "this machine has no coolant for") \
    /* a note: M48 to M53 change nothing */ \
    X(FAULT_NOTE_OVERRIDE, "overrides act here whatever a program says") \
    /* a note: F above the highest feed, or that of an axis */ \
    X(FAULT_NOTE_FEED, "feed above the highest one of the machine, which it gets") \
    /* a note: A0, B0 or C0 */ \
    X(FAULT_NOTE_ANGLE, "this machine has no rotary axes (--angles: A B C in place of U V W) for") \
    /* a note: U0, V0 or W0 */ \
    X(FAULT_NOTE_SIDE, "this machine has A B C in place of the axes U V W, so it has none for") \
    /* a note: Q of G64, runs of lines stay lines */ \
    X(FAULT_NOTE_MERGE, "runs of short lines stay lines here") \
    /* a note: what comes behind has not been checked */ \
    X(FAULT_NOTE_CHECKED, "lines that repeat are checked up to here")

#define FAULT_ENTRY(name, text) name,
enum fault { FAULT_TEXTS(FAULT_ENTRY) FAULT_COUNT };

enum { FAULT_FILE = 32 }; /* [byte] length of the name of a file that is called, with its 0 */

enum { FAULT_LIST = 20, FAULT_NOTES = FAULT_COUNT - FAULT_NOTE_COMMENT };

/* A note and its place; the members are those of struct fault_report. */
struct fault_note {
    enum fault what;
    int32_t line, at, length;
    int64_t offset;
    char file[FAULT_FILE];
    double value, limit; /* NOTE_FEED [mm/min]: asked and driven; 0 of others */
};

/* A fault of a part program with its place and values, and the notes of what has just been read. */
struct fault_report {
    enum fault fault;
    int32_t notes; /* number of notes, each kind once */
    struct fault_note note[FAULT_NOTES];
    int32_t line;                   /* number of the line in its text, from 1 */
    int64_t offset;                 /* [byte] where that line begins in its text */
    char file[FAULT_FILE];          /* the called file that has the line; empty: the program */
    int32_t at, length;             /* [characters] place of the offending text in the line */
    int32_t other_at, other_length; /* GROUP, SHARED: place of the word it conflicts with */
    int32_t axis;                   /* TRAVEL, SPEED: index of the joint */
    double value, limit;            /* FEED, NOTE_FEED [mm/min]; SPEED: share of the joint's
                                     * highest speed, and 1; lengths of all others [mm] */
    double feed;                    /* [mm/min] SPEED: highest feed that the joint allows */
};

/* The faults of a part program, one a line at most, and its notes, each kind once. */
struct fault_list {
    int32_t count, notes;
    bool more; /* there are more faults than fit */
    struct fault_report of[FAULT_LIST];
    struct fault_report note[FAULT_NOTES];
};

/* Set the place of the offending text in its line, without a second word; returns f. */
enum fault fault_at(struct fault_report *r, enum fault f, int32_t at, int32_t length);

/* Add a note on a text in the line of *r, unless *r has one of its kind already. */
void fault_note(struct fault_report *r, enum fault what, int32_t at, int32_t length);

/* The same with the value that is asked and the limit that is driven instead. */
void fault_note_limit(struct fault_report *r, enum fault what, int32_t at, int32_t length,
                      double value, double limit);

/* The text of a fault; empty if f is none of them. */
const char *fault_text(enum fault f);

#endif
