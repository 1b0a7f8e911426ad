#include "gcode.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

struct code { int code; enum gcode_group group; };

static const struct code g_codes[] = {
    { 0, GCODE_MOTION },    { 10, GCODE_MOTION },   { 20, GCODE_MOTION },   { 30, GCODE_MOTION },
    { 800, GCODE_MOTION },  { 40, GCODE_NONMODAL }, { 100, GCODE_NONMODAL },
    { 280, GCODE_NONMODAL }, { 520, GCODE_NONMODAL }, { 530, GCODE_NONMODAL },
    { 920, GCODE_NONMODAL }, { 921, GCODE_NONMODAL }, { 922, GCODE_NONMODAL },
    { 923, GCODE_NONMODAL }, { 170, GCODE_PLANE },  { 180, GCODE_PLANE },   { 190, GCODE_PLANE },
    { 200, GCODE_UNITS },   { 210, GCODE_UNITS },   { 400, GCODE_CUTTER },  { 490, GCODE_TOOL },
    { 540, GCODE_SYSTEM },  { 550, GCODE_SYSTEM },  { 560, GCODE_SYSTEM },  { 570, GCODE_SYSTEM },
    { 580, GCODE_SYSTEM },  { 590, GCODE_SYSTEM },  { 610, GCODE_PATH },    { 640, GCODE_PATH },
    { 900, GCODE_DISTANCE }, { 910, GCODE_DISTANCE }, { 901, GCODE_CENTRE }, { 911, GCODE_CENTRE },
    { 940, GCODE_FEED_MODE },
};

static const struct code m_codes[] = {
    { 0, GCODE_STOP },      { 10, GCODE_STOP },     { 20, GCODE_STOP },     { 300, GCODE_STOP },
    { 30, GCODE_SPINDLE },  { 40, GCODE_SPINDLE },  { 50, GCODE_SPINDLE },
    { 70, GCODE_COOLANT },  { 80, GCODE_COOLANT },  { 90, GCODE_COOLANT },
    { 620, GCODE_IO },      { 630, GCODE_IO },      { 640, GCODE_IO },      { 650, GCODE_IO },
};

/* Ten times a code; E1 of the facts takes a number within 0.0001 as meant. -1 if it is none. */
static int tenfold(double value)
{
    const double ten = round(value * 10.0);
    return value >= 0.0 && value < 1000.0 && fabs(value * 10.0 - ten) <= 1e-3 ? (int)ten : -1;
}

static enum fault sort_code(struct gcode *g, const struct token *w, const struct code *codes,
                            size_t count, struct fault_report *r)
{
    const int code = tenfold(w->value);
    for (size_t i = 0; i < count; i++) {
        if (codes[i].code == code) {
            const enum gcode_group group = codes[i].group;
            if (g->by[group]) {
                return tokens_at_words(r, FAULT_GROUP, w, g->by[group]);
            }
            g->by[group] = w;
            g->code[group] = code;
            return FAULT_NONE;
        }
    }
    return tokens_at_word(r, FAULT_WORD, w);
}

static enum fault sort_letter(struct gcode *g, const struct token *w, bool angles,
                              struct fault_report *r)
{
    const char *letters = angles ? "NFSXYZABCIJKRPL" : "NFSXYZUVWIJKRPL";
    const int turns = w->letter - 'A';    /* 0..2 for A B C, which stand where U V W would */
    const struct token **place = &g->word[angles && turns < 3 ? turns + ('U' - 'A') : turns];

    while (*letters && *letters != w->letter) {
        letters++;
    }
    if (!*letters) {
        return tokens_at_word(r, FAULT_WORD, w);
    }
    if (*place) {
        return tokens_at_word(r, FAULT_TWICE, w);
    }
    if (w->letter == 'N' && (w->value < 0.0 || w->value != round(w->value))) {
        return tokens_at_word(r, FAULT_VALUE, w);
    }
    *place = w;
    return FAULT_NONE;
}

static enum fault sort(struct gcode *g, const struct token *w, bool angles, int *m_words,
                       struct fault_report *r)
{
    if (w->letter == 'G') {
        return sort_code(g, w, g_codes, sizeof g_codes / sizeof *g_codes, r);
    }
    if (w->letter == 'M' && ++*m_words > GCODE_M_MAX) {
        return tokens_at_word(r, FAULT_M_COUNT, w);
    }
    if (w->letter == 'M') {
        return sort_code(g, w, m_codes, sizeof m_codes / sizeof *m_codes, r);
    }
    return sort_letter(g, w, angles, r);
}

enum fault gcode_sort(struct gcode *g, const struct tokens *t, bool angles,
                      struct fault_report *r)
{
    enum fault f = FAULT_NONE;
    int m_words = 0;

    memset(g->word, 0, sizeof g->word);
    memset(g->by, 0, sizeof g->by);
    for (int i = 0; i < GCODE_GROUPS; i++) {
        g->code[i] = GCODE_ABSENT;
    }
    for (int i = 0; i < t->count && f == FAULT_NONE; i++) {
        f = sort(g, &t->word[i], angles, &m_words, r);
    }
    return f;
}

const struct token *gcode_word(const struct gcode *g, char letter)
{
    return g->word[letter - 'A'];
}

double gcode_value(const struct block *b, int axis, const struct token *w)
{
    return w->value * (b->angles && axis >= 3 ? 1.0 : b->scale);
}

const struct token *gcode_first(const struct gcode *g, const char *letters)
{
    for (; *letters; letters++) {
        if (gcode_word(g, *letters)) {
            return gcode_word(g, *letters);
        }
    }
    return NULL;
}
