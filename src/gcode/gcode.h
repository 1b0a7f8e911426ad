/* gcode - one block of a part program: its words sorted by letter, its codes by modal group. */
#ifndef GCODE_H
#define GCODE_H

#include <stdbool.h>
#include <stdint.h>

#include "fault.h"
#include "tokens.h"

/* Modal groups of RS-274 that have members here. */
enum gcode_group {
    GCODE_NONMODAL,     /* G4 G10 G28 G52 G53 G92 G92.1 G92.2 G92.3 */
    GCODE_MOTION,       /* G0 G1 G2 G3 G80 */
    GCODE_PLANE,        /* G17 G18 G19 */
    GCODE_DISTANCE,     /* G90 G91 */
    GCODE_CENTRE,       /* G90.1 G91.1 */
    GCODE_FEED_MODE,    /* G94 */
    GCODE_UNITS,        /* G20 G21 */
    GCODE_CUTTER,       /* G40 */
    GCODE_TOOL,         /* G49 */
    GCODE_SYSTEM,       /* G54 .. G59 */
    GCODE_PATH,         /* G61 G64 */
    GCODE_STOP,         /* M0 M1 M2 M30 */
    GCODE_IO,           /* M62 M63 M64 M65 */
    GCODE_SPINDLE,      /* M3 M4 M5 */
    GCODE_COOLANT,      /* M7 M8 M9 */
    GCODE_GROUPS
};

enum { GCODE_ABSENT = -1, GCODE_M_MAX = 4 };    /* M words in a line */

struct gcode {
    const struct token *word[26];           /* by letter, except G, M; NULL if absent */
    const struct token *by[GCODE_GROUPS];   /* the word that gave the code */
    int code[GCODE_GROUPS];                 /* ten times the number of G or M, or GCODE_ABSENT */
};

/* The axis words in the order of the axes. */
#define BLOCK_AXES "XYZUVW"

/* One block on its way through the interpreter. */
struct block {
    struct tokens tokens;
    struct gcode g;
    double scale;       /* [mm] per unit of the program */
    bool angles;        /* U V W are A B C, which have no such unit */
};

/* Sort the words of a line; *r gets the place of a fault. With angles, A B C take the places of
 * U V W. */
enum fault gcode_sort(struct gcode *g, const struct tokens *t, bool angles,
                      struct fault_report *r);

/* The word of a letter, or NULL. */
const struct token *gcode_word(const struct gcode *g, char letter);

/* What an axis word says. [mm], [deg] */
double gcode_value(const struct block *b, int axis, const struct token *w);

/* The first of the letters that the block has, or NULL. */
const struct token *gcode_first(const struct gcode *g, const char *letters);

#endif
