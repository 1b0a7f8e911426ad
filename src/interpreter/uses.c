#include "uses.h"

#include <stddef.h>
#include <string.h>

/* A row for each code beside those of motion that takes words: '+' are the axis words. */
static const struct { enum gcode_group group; int code; char takes[8]; } rows[] = {
    { GCODE_NONMODAL, 40, "P" },   { GCODE_NONMODAL, 100, "PLR+" }, { GCODE_NONMODAL, 280, "+" },
    { GCODE_NONMODAL, 300, "+" },  { GCODE_NONMODAL, 520, "+" },    { GCODE_NONMODAL, 920, "+" },
    { GCODE_SCALING, 510, "PIJK+" }, { GCODE_ROTATION, 680, "R+" }, { GCODE_STOP, 980, "PL" },
    { GCODE_IO, 620, "P" },        { GCODE_IO, 630, "P" },          { GCODE_IO, 640, "P" },
    { GCODE_IO, 650, "P" },        { GCODE_IO, 660, "PLEQ" },       { GCODE_IO, 670, "EQ" },
    { GCODE_IO, 680, "EQ" },
    { GCODE_TOOL, 430, "H" },      { GCODE_TOOL, 431, "+" },        { GCODE_TOOL, 432, "H+" },
    { GCODE_CHANGE, 610, "Q" },    { GCODE_SPINDLE, 190, "RPQ" },
    { GCODE_OVERRIDE, 500, "P" },  { GCODE_OVERRIDE, 510, "P" },    { GCODE_OVERRIDE, 520, "P" },
    { GCODE_OVERRIDE, 530, "P" },  { GCODE_PATH, 640, "PQ" },
    { GCODE_CUTTER, 410, "D" },    { GCODE_CUTTER, 420, "D" },      { GCODE_CUTTER, 411, "D" },
    { GCODE_CUTTER, 421, "D" },
};

/* What the codes of motion take, while no other code takes the axis words. */
static const struct { int code; char takes[12]; } moves[] = {
    { 0, "+@^" }, { 10, "+@^" }, { 20, "+@^IJKRP" }, { 30, "+@^IJKRP" }, { 50, "+IJPQ" },
    { 51, "+IJ" },
    { 730, "+@^RLQ" }, { 740, "+@^RLP" }, { 810, "+@^RL" }, { 820, "+@^RLP" }, { 830, "+@^RLQ" },
    { 840, "+@^RLP" }, { 850, "+@^RL" }, { 860, "+@^RLP" }, { 880, "+@^RLP" }, { 890, "+@^RLP" },
};

/* Which word a code gave that takes each letter, '+' at the end. */
struct owners {
    const struct token *of[GCODE_LETTERS + 1];
};

static int place(char letter)
{
    return letter == '+' ? GCODE_LETTERS : letter - '@';
}

static bool takes(const struct gcode *g, size_t row)
{
    return g->code[rows[row].group] == rows[row].code;
}

/* Groups that have rows, and the letters that rows and moves take beside those of axes. */
#define OWNERS                                                                                   \
    (1u << GCODE_NONMODAL | 1u << GCODE_SCALING | 1u << GCODE_ROTATION | 1u << GCODE_STOP |      \
     1u << GCODE_IO | 1u << GCODE_TOOL | 1u << GCODE_CHANGE | 1u << GCODE_SPINDLE |              \
     1u << GCODE_OVERRIDE | 1u << GCODE_PATH | 1u << GCODE_CUTTER)
#define OWNED                                                                                    \
    (GCODE_BIT('P') | GCODE_BIT('L') | GCODE_BIT('R') | GCODE_BIT('Q') | GCODE_BIT('H') |        \
     GCODE_BIT('D') | GCODE_BIT('E') | GCODE_BIT('I') | GCODE_BIT('J') | GCODE_BIT('K') |        \
     GCODE_BIT('@') | GCODE_BIT('^'))

const struct token *uses_of(const struct gcode *g, char letter)
{
    if (!(g->groups & OWNERS)) {
        return NULL;
    }
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (takes(g, i) && strchr(rows[i].takes, letter)) {
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
        for (const char *c = rows[i].takes; takes(g, i) && *c; c++) {
            const struct token **owner = &o->of[place(*c)];
            if (*owner && (*c == '+' || gcode_word(g, *c))) {
                return tokens_at_words(r, FAULT_SHARED, g->by[rows[i].group], *owner);
            }
            *owner = *owner ? *owner : g->by[rows[i].group];
        }
    }
    return FAULT_NONE;
}

/* The code of motion in force takes it. */
static bool moves_with(const struct interpreter *in, char letter)
{
    for (size_t i = 0; i < sizeof moves / sizeof *moves; i++) {
        if (moves[i].code == in->motion) {
            return strchr(moves[i].takes, letter) != NULL;
        }
    }
    return false;
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
    const struct token *axes = o.of[place('+')];
    const bool moves = !axes && gcode_first(g, BLOCK_AXES "@^IJKR");

    if (f != FAULT_NONE) {
        return f;
    }
    if (axes && motion && g->code[GCODE_MOTION] != GCODE_NO_MOTION) {
        return tokens_at_words(r, FAULT_SHARED, motion, axes);
    }
    for (const char *c = "PLRQHDEIJK@^"; *c; c++) {
        const struct token *word = gcode_word(g, *c), *owner = o.of[place(*c)];
        if (word && owner && moves && moves_with(in, *c)) {
            return tokens_at_words(r, FAULT_SHARED, word, owner);
        }
        if (word && !owner && !(moves && moves_with(in, *c))) {
            return tokens_at_word(r, FAULT_UNUSED, word);
        }
    }
    return FAULT_NONE;
}
