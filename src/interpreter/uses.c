#include "uses.h"

#include <stddef.h>
#include <string.h>

#define P GCODE_BIT('P')
#define L GCODE_BIT('L')
#define R GCODE_BIT('R')
#define Q GCODE_BIT('Q')
#define H GCODE_BIT('H')
#define D GCODE_BIT('D')
#define E GCODE_BIT('E')
#define I GCODE_BIT('I')
#define J GCODE_BIT('J')
#define K GCODE_BIT('K')
#define POLAR (GCODE_BIT('@') | GCODE_BIT('^'))
#define AXIS_WORDS ((uint32_t)1 << GCODE_LETTERS)

/* The codes beside those of motion that take words: group, code, letters. */
#define CODES(X)                                                                                 \
    X(NONMODAL, 40, P)      X(NONMODAL, 100, P | L | R | AXIS_WORDS)                             \
    X(NONMODAL, 280, AXIS_WORDS)        X(NONMODAL, 300, AXIS_WORDS)                             \
    X(NONMODAL, 520, AXIS_WORDS)        X(NONMODAL, 920, AXIS_WORDS)                             \
    X(SCALING, 510, P | I | J | K | AXIS_WORDS)     X(ROTATION, 680, R | AXIS_WORDS)             \
    X(STOP, 980, P | L)                                                                          \
    X(IO, 620, P)           X(IO, 630, P)           X(IO, 640, P)           X(IO, 650, P)        \
    X(IO, 660, P | L | E | Q)           X(IO, 670, E | Q)       X(IO, 680, E | Q)                \
    X(TOOL, 430, H)         X(TOOL, 431, AXIS_WORDS)            X(TOOL, 432, H | AXIS_WORDS)     \
    X(CHANGE, 610, Q)       X(SPINDLE, 190, R | P | Q)          X(SURFACE, 960, D)               \
    X(OVERRIDE, 500, P)     X(OVERRIDE, 510, P)     X(OVERRIDE, 520, P)     X(OVERRIDE, 530, P)  \
    X(PATH, 640, P | Q)                                                                          \
    X(CUTTER, 410, D)       X(CUTTER, 420, D)       X(CUTTER, 411, D)       X(CUTTER, 421, D)

/* What the codes of motion take beside axis words, while no other code takes those. */
#define MOVES(X)                                                                                 \
    X(MOTION, 0, POLAR)     X(MOTION, 10, POLAR)                                                 \
    X(MOTION, 20, POLAR | I | J | K | R | P)        X(MOTION, 30, POLAR | I | J | K | R | P)     \
    X(MOTION, 50, I | J | P | Q)        X(MOTION, 51, I | J)                                     \
    X(MOTION, 730, POLAR | R | L | Q)   X(MOTION, 740, POLAR | R | L | P)                        \
    X(MOTION, 810, POLAR | R | L)       X(MOTION, 820, POLAR | R | L | P)                        \
    X(MOTION, 830, POLAR | R | L | Q)   X(MOTION, 840, POLAR | R | L | P)                        \
    X(MOTION, 850, POLAR | R | L)       X(MOTION, 860, POLAR | R | L | P)                        \
    X(MOTION, 870, POLAR | R | L | I | J | K)                                                    \
    X(MOTION, 880, POLAR | R | L | P)   X(MOTION, 890, POLAR | R | L | P)

#define ROW(group, code, takes) { GCODE_##group, code, takes },
#define GROUP(group, code, takes) | (uint32_t)1 << GCODE_##group
#define LETTERS(group, code, takes) | (takes)
static const struct row { enum gcode_group group; int code; uint32_t takes; }
    rows[] = { CODES(ROW) }, moves[] = { MOVES(ROW) };
static const uint32_t OWNERS = 0 CODES(GROUP);      /* groups that have rows */
static const uint32_t OWNED = (0 CODES(LETTERS) MOVES(LETTERS)) & ~AXIS_WORDS;

/* Which word a code gave that takes each letter, the axis words at the end. */
struct owners {
    const struct token *of[GCODE_LETTERS + 1];
};

static bool takes(const struct gcode *g, size_t row)
{
    return g->code[rows[row].group] == rows[row].code;
}

const struct token *uses_of(const struct gcode *g, char letter)
{
    const uint32_t bit = letter == '+' ? AXIS_WORDS : GCODE_BIT(letter);

    if (!(g->groups & OWNERS)) {
        return NULL;
    }
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (takes(g, i) && rows[i].takes & bit) {
            return g->by[rows[i].group];
        }
    }
    return NULL;
}

/* Owners of the letters of a block; two of one letter that is there, or of axes, are a fault. */
static enum fault share(const struct gcode *g, struct owners *o, struct fault_report *r)
{
    memset(o, 0, sizeof *o);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        uint32_t left = takes(g, i) ? rows[i].takes : 0;
        for (int k = 0; left; k++, left >>= 1) {
            const struct token **owner = &o->of[k];
            if (left & 1 && *owner && (k == GCODE_LETTERS || g->word[k])) {
                return tokens_at_words(r, FAULT_SHARED, g->by[rows[i].group], *owner);
            }
            *owner = left & 1 && !*owner ? g->by[rows[i].group] : *owner;
        }
    }
    return FAULT_NONE;
}

/* Letters that the code of motion in force takes. */
static uint32_t moves_with(const struct interpreter *in)
{
    size_t i = 0;

    while (i < sizeof moves / sizeof *moves && moves[i].code != in->motion) {
        i++;
    }
    return i < sizeof moves / sizeof *moves ? moves[i].takes : 0;
}

/* The block moves: by its code of motion, its axis words, or what else only a motion has. */
static bool moves_by(const struct gcode *g, const struct owners *o)
{
    const int code = g->code[GCODE_MOTION];
    bool any = gcode_first(g, BLOCK_AXES "@^") || (code != GCODE_ABSENT && code != GCODE_NO_MOTION);

    for (const char *c = "IJKR"; *c; c++) {
        any = any || (gcode_word(g, *c) && !o->of[*c - '@']);
    }
    return any;
}

enum fault uses_check(const struct interpreter *in, const struct block *b, struct fault_report *r)
{
    const struct gcode *g = &b->g;
    const struct token *motion = g->by[GCODE_MOTION];
    struct owners o;

    if (!(g->groups & OWNERS) && !(g->letters & OWNED)) {
        return FAULT_NONE;      /* as most lines are */
    }
    const enum fault f = share(g, &o, r);
    const struct token *axes = o.of[GCODE_LETTERS];
    const uint32_t moved = !axes && moves_by(g, &o) ? moves_with(in) : 0;

    if (f != FAULT_NONE) {
        return f;
    }
    if (axes && motion && g->code[GCODE_MOTION] != GCODE_NO_MOTION) {
        return tokens_at_words(r, FAULT_SHARED, motion, axes);
    }
    uint32_t left = g->letters & OWNED;
    for (int k = 0; left >> k; k++) {
        const struct token *word = left >> k & 1 ? g->word[k] : NULL, *owner = o.of[k];
        if (word && owner && moved >> k & 1) {
            return tokens_at_words(r, FAULT_SHARED, word, owner);
        }
        if (word && !owner && !(moved >> k & 1)) {
            return tokens_at_word(r, FAULT_UNUSED, word);
        }
    }
    return FAULT_NONE;
}
