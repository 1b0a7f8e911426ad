/* gcode - one block of a part program: its words sorted by letter, its codes by modal group. */
#ifndef GCODE_H
#define GCODE_H

#include <stdbool.h>
#include <stdint.h>

#include "fault.h"
#include "tokens.h"

/* Modal groups of RS-274 that have members here. */
enum gcode_group {
    GCODE_NONMODAL,     /* G4 G53 */
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
    GCODE_GROUPS
};

enum { GCODE_ABSENT = -1 };

struct gcode {
    const struct token *word[26];   /* by letter, except G, M; NULL if absent */
    int  code[GCODE_GROUPS];        /* ten times the G number, or GCODE_ABSENT */
    bool end;                       /* M2 or M30 */
};

/* Sort the words of a line; *r gets the place of a fault. */
enum fault gcode_sort(struct gcode *g, const struct tokens *t, struct fault_report *r);

/* The word of a letter, or NULL. */
const struct token *gcode_word(const struct gcode *g, char letter);

#endif
