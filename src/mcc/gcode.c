#include "gcode.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

static const struct { int code; enum gcode_group group; } codes[] = {
    { 0, GCODE_MOTION },    { 10, GCODE_MOTION },   { 20, GCODE_MOTION },   { 30, GCODE_MOTION },
    { 800, GCODE_MOTION },  { 40, GCODE_NONMODAL }, { 530, GCODE_NONMODAL },
    { 170, GCODE_PLANE },   { 180, GCODE_PLANE },   { 190, GCODE_PLANE },
    { 200, GCODE_UNITS },   { 210, GCODE_UNITS },   { 400, GCODE_CUTTER },  { 490, GCODE_TOOL },
    { 540, GCODE_SYSTEM },  { 550, GCODE_SYSTEM },  { 560, GCODE_SYSTEM },  { 570, GCODE_SYSTEM },
    { 580, GCODE_SYSTEM },  { 590, GCODE_SYSTEM },  { 610, GCODE_PATH },    { 640, GCODE_PATH },
    { 900, GCODE_DISTANCE }, { 910, GCODE_DISTANCE }, { 901, GCODE_CENTRE }, { 911, GCODE_CENTRE },
    { 940, GCODE_FEED_MODE },
};

/* Ten times a code; E1 of the facts takes a number within 0.0001 as meant. -1 if it is none. */
static int tenfold(double value)
{
    const double ten = round(value * 10.0);
    return value >= 0.0 && value < 1000.0 && fabs(value * 10.0 - ten) <= 1e-3 ? (int)ten : -1;
}

static enum fault sort_g(struct gcode *g, const struct token *w)
{
    const int code = tenfold(w->value);
    for (size_t i = 0; i < sizeof codes / sizeof *codes; i++) {
        if (codes[i].code == code) {
            if (g->code[codes[i].group] != GCODE_ABSENT) {
                return FAULT_GROUP;
            }
            g->code[codes[i].group] = code;
            return FAULT_NONE;
        }
    }
    return FAULT_WORD;
}

static enum fault sort_m(struct gcode *g, const struct token *w)
{
    const int code = tenfold(w->value);
    if (code != 20 && code != 300) {
        return FAULT_WORD;
    }
    if (g->end) {
        return FAULT_GROUP;
    }
    g->end = true;
    return FAULT_NONE;
}

static enum fault sort_letter(struct gcode *g, const struct token *w)
{
    bool known = false;
    for (const char *l = "NFXYZUVWIJKRP"; *l; l++) {
        known = known || *l == w->letter;
    }
    if (!known) {
        return FAULT_WORD;
    }
    if (g->word[w->letter - 'A']) {
        return FAULT_TWICE;
    }
    if (w->letter == 'N' && (w->value < 0.0 || w->value != round(w->value))) {
        return FAULT_VALUE;
    }
    g->word[w->letter - 'A'] = w;
    return FAULT_NONE;
}

enum fault gcode_sort(struct gcode *g, const struct tokens *t, struct fault_report *r)
{
    memset(g->word, 0, sizeof g->word);
    g->end = false;
    for (int i = 0; i < GCODE_GROUPS; i++) {
        g->code[i] = GCODE_ABSENT;
    }
    for (int i = 0; i < t->count; i++) {
        const struct token *w = &t->word[i];
        const enum fault f = w->letter == 'G' ? sort_g(g, w) :
                             w->letter == 'M' ? sort_m(g, w) : sort_letter(g, w);
        if (f != FAULT_NONE) {
            return tokens_at_word(r, f, w);
        }
    }
    return FAULT_NONE;
}

const struct token *gcode_word(const struct gcode *g, char letter)
{
    return g->word[letter - 'A'];
}
