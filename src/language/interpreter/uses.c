#include "uses.h"

#include <stddef.h>
#include <string.h>

#define P          GCODE_BIT('P')
#define L          GCODE_BIT('L')
#define R          GCODE_BIT('R')
#define Q          GCODE_BIT('Q')
#define H          GCODE_BIT('H')
#define D          GCODE_BIT('D')
#define E          GCODE_BIT('E')
#define I          GCODE_BIT('I')
#define J          GCODE_BIT('J')
#define K          GCODE_BIT('K')
#define POLAR      (GCODE_BIT('@') | GCODE_BIT('^'))
#define CORNER     (GCODE_BIT(TOKENS_CHAMFER) | GCODE_BIT(TOKENS_ROUND))
#define AXIS_WORDS ((uint32_t)1 << GCODE_LETTERS)

/* Codes other than those of motion that take words: group, code, letters. */
#define CODES(X) \
    X(NONMODAL, 40, P) \
    X(NONMODAL, 100, P | L | R | AXIS_WORDS) \
    X(NONMODAL, 280, AXIS_WORDS) \
    X(NONMODAL, 300, AXIS_WORDS) \
    X(NONMODAL, 520, AXIS_WORDS) \
    X(NONMODAL, 920, AXIS_WORDS) \
    X(SCALING, 510, P | I | J | K | AXIS_WORDS) \
    X(ROTATION, 680, R | AXIS_WORDS) \
    X(STOP, 980, P | L) \
    X(USER, GCODE_USER_FIRST, P | Q) \
    X(IO, 620, P) \
    X(IO, 630, P) \
    X(IO, 640, P) \
    X(IO, 650, P) \
    X(IO, 660, P | L | E | Q) \
    X(IO, 670, E | Q) \
    X(IO, 680, E | Q) \
    X(TOOL, 430, H) \
    X(TOOL, 431, AXIS_WORDS) \
    X(TOOL, 432, H | AXIS_WORDS) \
    X(CHANGE, 610, Q) \
    X(SPINDLE, 190, R | P | Q) \
    X(SURFACE, 960, D) \
    X(OVERRIDE, 500, P) \
    X(OVERRIDE, 510, P) \
    X(OVERRIDE, 520, P) \
    X(OVERRIDE, 530, P) \
    X(SYSTEM, GCODE_MORE, P) \
    X(SYSTEM, GCODE_MORE_HAAS, P) \
    X(PATH, 640, P | Q) \
    X(CUTTER, 410, D) \
    X(CUTTER, 420, D) \
    X(CUTTER, 411, D) \
    X(CUTTER, 421, D)

/* What codes of motion take beside axis words, if no other code takes these. */
#define MOVES(X) \
    X(MOTION, 0, POLAR) \
    X(MOTION, 10, POLAR) \
    X(MOTION, 20, POLAR | I | J | K | R | P) \
    X(MOTION, 30, POLAR | I | J | K | R | P) \
    X(MOTION, 52, P | L) \
    X(MOTION, 53, 0) \
    X(MOTION, 331, POLAR | I | K) \
    X(MOTION, 50, I | J | P | Q) \
    X(MOTION, 51, I | J) \
    X(MOTION, 730, POLAR | R | L | Q) \
    X(MOTION, 740, POLAR | R | L | P) \
    X(MOTION, 810, POLAR | R | L) \
    X(MOTION, 820, POLAR | R | L | P) \
    X(MOTION, 830, POLAR | R | L | Q) \
    X(MOTION, 840, POLAR | R | L | P) \
    X(MOTION, 850, POLAR | R | L) \
    X(MOTION, 860, POLAR | R | L | P) \
    X(MOTION, 870, POLAR | R | L | I | J | K) \
    X(MOTION, 880, POLAR | R | L | P) \
    X(MOTION, 890, POLAR | R | L | P)

/* What some of these take in addition on Fanuc's controls. */
#define FANUC(X) \
    X(MOTION, 730, P) \
    X(MOTION, 830, P) \
    X(MOTION, 10, CORNER) \
    X(MOTION, 20, CORNER) \
    X(MOTION, 30, CORNER)

#define ROW(group, code, takes)     { GCODE_##group, code, takes },
#define GROUP(group, code, takes)   | (uint32_t)1 << GCODE_##group
#define LETTERS(group, code, takes) | (takes)
static const struct row {
    enum gcode_group group;
    int code;
    uint32_t takes;
} rows[] = { CODES(ROW) }, moves[] = { MOVES(ROW) }, fanuc[] = { FANUC(ROW) };
static const uint32_t OWNERS = 0 CODES(GROUP); /* bits of groups with rows */
static const uint32_t OWNED = (0 CODES(LETTERS) MOVES(LETTERS) FANUC(LETTERS)) & ~AXIS_WORDS;

/* The word of the code that takes each letter, or NULL; last for the axis words. */
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

/* Find the owners. FAULT_SHARED: two codes take a letter that the block has, or axis words. */
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

/* Bits of the letters that the code of motion in force takes. */
static uint32_t moves_with(const struct interpreter *in, const struct block *b)
{
    size_t i = 0;
    uint32_t more = 0;

    for (size_t k = 0; b->fanuc && k < sizeof fanuc / sizeof *fanuc; k++) {
        more |= fanuc[k].code == in->motion ? fanuc[k].takes : 0;
    }
    while (i < sizeof moves / sizeof *moves && moves[i].code != in->motion) {
        i++;
    }
    return i < sizeof moves / sizeof *moves ? moves[i].takes | more : 0;
}

/* Whether the block moves: it has a code of motion, axis words, or I J K R that no code takes. */
static bool moves_by(const struct gcode *g, const struct owners *o)
{
    const int code = g->code[GCODE_MOTION];
    bool any = gcode_first(g, BLOCK_AXES "@^") || (code != GCODE_ABSENT && code != GCODE_NO_MOTION);

    for (const char *c = "IJKR"; *c; c++) {
        any = any || (gcode_word(g, *c) && !o->of[*c - '@']);
    }
    return any;
}

/* Whether G0 or G1 stands beside G28 or G30, as postprocessors write it: it holds from the next
 * line on. */
static bool homes_beside(const struct gcode *g)
{
    const int other = g->code[GCODE_NONMODAL], motion = g->code[GCODE_MOTION];

    return (other == 280 || other == 300) && (motion == 0 || motion == 10);
}

/* CCN 18: each word of a block has an owner, two or none, and most blocks none that matter. */
enum fault uses_check(const struct interpreter *in, const struct block *b, struct fault_report *r)
{
    const struct gcode *g = &b->g;
    const struct token *motion = g->by[GCODE_MOTION];
    struct owners o;

    if (!(g->groups & OWNERS) && !(g->letters & OWNED)) {
        return FAULT_NONE; /* as most lines are */
    }
    const enum fault f = share(g, &o, r);
    const struct token *axes = o.of[GCODE_LETTERS];
    const uint32_t moved = !axes && moves_by(g, &o) ? moves_with(in, b) : 0;

    if (f != FAULT_NONE) {
        return f;
    }
    if (axes && motion && g->code[GCODE_MOTION] != GCODE_NO_MOTION && !homes_beside(g)) {
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
