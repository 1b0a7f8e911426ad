/* gcode - one block of a part program: its words sorted by letter, its G and M codes by modal
 * group, so that what executes the block finds each by a look-up. */
#ifndef GCODE_H
#define GCODE_H

#include <stdbool.h>
#include <stdint.h>

#include "fault.h"
#include "tokens.h"

/* Modal groups of RS-274 that have members here. */
enum gcode_group {
    GCODE_NONMODAL,  /* G4 G10 G28 G28.1 G30 G30.1 G52 G53 G92 to G92.3 */
    GCODE_MOTION,    /* G0 to G3 G5 to G5.3 G33.1 G38.2 to G38.5 G73 G74 G80 to G89 */
    GCODE_PLANE,     /* G17 G18 G19 */
    GCODE_DISTANCE,  /* G90 G91 */
    GCODE_CENTRE,    /* G90.1 G91.1 */
    GCODE_FEED_MODE, /* G93 G94 G95 */
    GCODE_UNITS,     /* G20 G21 */
    GCODE_CUTTER,    /* G40 G41 G42 G41.1 G42.1 */
    GCODE_TOOL,      /* G43 G43.1 G43.2 G49 */
    GCODE_SYSTEM,    /* G54 .. G59.3, G54.1, G154 */
    GCODE_PATH,      /* G61 G61.1 G64 */
    GCODE_SCALING,   /* G50 G51 */
    GCODE_ROTATION,  /* G68 G69 */
    GCODE_POLAR,     /* G15 G16 */
    GCODE_RETRACT,   /* G98 G99 */
    GCODE_STOP,      /* M0 M1 M2 M30 M60 M98 M99 */
    GCODE_IO,        /* M62 .. M68 */
    GCODE_CHANGE,    /* M6 M61 */
    GCODE_SPINDLE,   /* M3 M4 M5 M19 */
    GCODE_SURFACE,   /* G96 G97 */
    GCODE_OVERRIDE,  /* M48 .. M53 */
    GCODE_COOLANT,   /* M7 M8 M9 */
    GCODE_SAVING,    /* M70 .. M73 */
    GCODE_EXACT,     /* G9, of Fanuc's controls */
    GCODE_MODAL,     /* G67, of Fanuc's controls; G65 and G66 make a call (macro.h) */
    GCODE_USER,      /* M100 .. M199 */
    GCODE_GROUPS
};

enum {
    GCODE_ABSENT = -1,      /* the block has no code of a group */
    GCODE_NO_MOTION = 800,  /* G80 */
    GCODE_MORE = 541,       /* G54.1: further coordinate systems */
    GCODE_MORE_HAAS = 1540, /* G154, the same on Haas' controls */
    GCODE_USER_FIRST = 1000,
    GCODE_USER_LAST = 1990, /* M100, M199 */
    GCODE_M_MAX = 4,        /* most M words in a block */
    GCODE_LETTERS = '^' - '@' + 1
};

struct gcode {
    const struct token *word[GCODE_LETTERS]; /* by letter, @ to ^, except G, M; or NULL */
    const struct token *by[GCODE_GROUPS];    /* the word that gave the code, or NULL */
    int code[GCODE_GROUPS];                  /* ten times the number of G or M, or GCODE_ABSENT */
    uint32_t letters;                        /* bits (GCODE_BIT) of letters that have a word */
    uint32_t idle;   /* bits of words with 0 for axes that the machine lacks */
    uint32_t groups; /* bit n: group n has a code */
};

/* The bit of a letter. */
#define GCODE_BIT(letter) ((uint32_t)1 << ((letter) - '@'))

/* G2 or G3. */
static inline bool gcode_arc(int code)
{
    return code == 20 || code == 30;
}

/* G5 or G5.1. */
static inline bool gcode_spline(int code)
{
    return code == 50 || code == 51;
}

/* The axis words in the order of the axes. */
#define BLOCK_AXES "XYZUVW"

/* One block while it is executed. */
struct block {
    struct tokens tokens;
    struct gcode g;
    double scale; /* [mm] per unit of the program */
    bool angles;  /* U V W are A B C, which have no such unit */
    bool fanuc;   /* the program is written for one of Fanuc's controls */
};

/* Code of a G or M word, ten times its number (G38.2: 382), if the number lies within 0.0001 of a
 * tenth between 0 and 999.9; else -1. */
int gcode_code(const struct token *w);

/* Whether a word is M100 to M199. */
bool gcode_user(const struct token *w);

/* Sort the words of b->tokens into b->g; b->angles and b->fanuc are set. With angles, A B C take
 * the places of U V W. FAULT_WORD: unknown; FAULT_TWICE, FAULT_GROUP, FAULT_M_COUNT: too many;
 * FAULT_ANGLE, FAULT_SIDE: an axis that the machine lacks, not 0; FAULT_VALUE: N below 0. */
enum fault gcode_sort(struct block *b, struct fault_report *r);

/* The word of a letter, or NULL. */
static inline const struct token *gcode_word(const struct gcode *g, char letter)
{
    return g->word[letter - '@'];
}

/* Value of the word of an axis, in mm whatever the units of the program; an angle in degrees. */
double gcode_value(const struct block *b, int axis, const struct token *w);

/* The word of the first of these letters that has one, or NULL. */
const struct token *gcode_first(const struct gcode *g, const char *letters);

#endif
