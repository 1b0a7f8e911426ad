#include "gcode.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* A code, ten times its number, and its modal group. */
struct code {
    int code;
    enum gcode_group group;
};

static const struct code g_codes[] = {
    { 0, GCODE_MOTION },
    { 10, GCODE_MOTION },
    { 20, GCODE_MOTION },
    { 30, GCODE_MOTION },
    { 50, GCODE_MOTION },
    { 51, GCODE_MOTION },
    { GCODE_NO_MOTION, GCODE_MOTION },
    { 331, GCODE_MOTION },
    { 52, GCODE_MOTION },
    { 53, GCODE_MOTION },
    { 382, GCODE_MOTION },
    { 383, GCODE_MOTION },
    { 384, GCODE_MOTION },
    { 385, GCODE_MOTION },
    { 730, GCODE_MOTION },
    { 740, GCODE_MOTION },
    { 810, GCODE_MOTION },
    { 820, GCODE_MOTION },
    { 830, GCODE_MOTION },
    { 840, GCODE_MOTION },
    { 850, GCODE_MOTION },
    { 860, GCODE_MOTION },
    { 870, GCODE_MOTION },
    { 880, GCODE_MOTION },
    { 890, GCODE_MOTION },
    { 980, GCODE_RETRACT },
    { 990, GCODE_RETRACT },
    { 410, GCODE_CUTTER },
    { 420, GCODE_CUTTER },
    { 411, GCODE_CUTTER },
    { 421, GCODE_CUTTER },
    { 40, GCODE_NONMODAL },
    { 100, GCODE_NONMODAL },
    { 280, GCODE_NONMODAL },
    { 281, GCODE_NONMODAL },
    { 300, GCODE_NONMODAL },
    { 301, GCODE_NONMODAL },
    { 520, GCODE_NONMODAL },
    { 530, GCODE_NONMODAL },
    { 920, GCODE_NONMODAL },
    { 921, GCODE_NONMODAL },
    { 922, GCODE_NONMODAL },
    { 923, GCODE_NONMODAL },
    { 170, GCODE_PLANE },
    { 180, GCODE_PLANE },
    { 190, GCODE_PLANE },
    { 200, GCODE_UNITS },
    { 210, GCODE_UNITS },
    { 400, GCODE_CUTTER },
    { 490, GCODE_TOOL },
    { 430, GCODE_TOOL },
    { 431, GCODE_TOOL },
    { 432, GCODE_TOOL },
    { 960, GCODE_SURFACE },
    { 970, GCODE_SURFACE },
    { 540, GCODE_SYSTEM },
    { 550, GCODE_SYSTEM },
    { 560, GCODE_SYSTEM },
    { 570, GCODE_SYSTEM },
    { 580, GCODE_SYSTEM },
    { 590, GCODE_SYSTEM },
    { 591, GCODE_SYSTEM },
    { 592, GCODE_SYSTEM },
    { 593, GCODE_SYSTEM },
    { 610, GCODE_PATH },
    { 611, GCODE_PATH },
    { 640, GCODE_PATH },
    { 500, GCODE_SCALING },
    { 510, GCODE_SCALING },
    { 680, GCODE_ROTATION },
    { 690, GCODE_ROTATION },
    { 150, GCODE_POLAR },
    { 160, GCODE_POLAR },
    { 900, GCODE_DISTANCE },
    { 910, GCODE_DISTANCE },
    { 901, GCODE_CENTRE },
    { 911, GCODE_CENTRE },
    { 930, GCODE_FEED_MODE },
    { 940, GCODE_FEED_MODE },
    { 950, GCODE_FEED_MODE },
};

/* G codes that only Fanuc's controls have, and Haas'. */
static const struct code fanuc_codes[] = {
    { 90, GCODE_EXACT },
    { 670, GCODE_MODAL },
    { GCODE_MORE, GCODE_SYSTEM },
    { GCODE_MORE_HAAS, GCODE_SYSTEM },
};

static const struct code m_codes[] = {
    { 0, GCODE_STOP },       { 10, GCODE_STOP },      { 20, GCODE_STOP },
    { 300, GCODE_STOP },     { 980, GCODE_STOP },     { 990, GCODE_STOP },
    { 30, GCODE_SPINDLE },   { 40, GCODE_SPINDLE },   { 50, GCODE_SPINDLE },
    { 70, GCODE_COOLANT },   { 80, GCODE_COOLANT },   { 90, GCODE_COOLANT },
    { 600, GCODE_STOP },     { 190, GCODE_SPINDLE },  { 60, GCODE_CHANGE },
    { 610, GCODE_CHANGE },   { 480, GCODE_OVERRIDE }, { 490, GCODE_OVERRIDE },
    { 500, GCODE_OVERRIDE }, { 510, GCODE_OVERRIDE }, { 520, GCODE_OVERRIDE },
    { 530, GCODE_OVERRIDE }, { 700, GCODE_SAVING },   { 710, GCODE_SAVING },
    { 720, GCODE_SAVING },   { 730, GCODE_SAVING },   { 660, GCODE_IO },
    { 670, GCODE_IO },       { 680, GCODE_IO },       { 620, GCODE_IO },
    { 630, GCODE_IO },       { 640, GCODE_IO },       { 650, GCODE_IO },
};

/* G codes of the language that are always refused, each with its own fault. */
static const struct refusal {
    int code;
    enum fault why;
} g_refused[] = {
    { 171, FAULT_PLANE },   { 181, FAULT_PLANE },   { 191, FAULT_PLANE },   { 70, FAULT_TURNING },
    { 80, FAULT_TURNING },  { 330, FAULT_TURNING }, { 700, FAULT_TURNING }, { 710, FAULT_TURNING },
    { 711, FAULT_TURNING }, { 712, FAULT_TURNING }, { 720, FAULT_TURNING }, { 721, FAULT_TURNING },
    { 722, FAULT_TURNING }, { 760, FAULT_TURNING },
};

int gcode_code(const struct token *w)
{
    const double tenfold = w->value * 10.0, ten = round(tenfold);
    return ten >= 0.0 && ten < 10000.0 && fabs(tenfold - ten) <= 1e-3 ? (int)ten : -1;
}

bool gcode_user(const struct token *w)
{
    const int code = gcode_code(w);
    return w->letter == 'M' && code >= GCODE_USER_FIRST && code <= GCODE_USER_LAST
           && code % 10 == 0;
}

/* Enter a G or M word by its group. */
static enum fault sort_code(struct gcode *g, const struct token *w, const struct code *codes,
                            size_t count, struct fault_report *r)
{
    const int code = gcode_code(w);
    if (gcode_user(w)) {
        if (g->by[GCODE_USER]) {
            return tokens_at_words(r, FAULT_GROUP, w, g->by[GCODE_USER]);
        }
        g->by[GCODE_USER] = w;
        g->groups |= (uint32_t)1 << GCODE_USER;
        g->code[GCODE_USER] = GCODE_USER_FIRST; /* for all of them, as they take the same words */
        return FAULT_NONE;
    }
    for (size_t i = 0; i < count; i++) {
        if (codes[i].code == code) {
            const enum gcode_group group = codes[i].group;
            if (group == GCODE_MOTION && g->by[group] && code != g->code[group]
                && (code == GCODE_NO_MOTION || g->code[group] == GCODE_NO_MOTION)) {
                if (code == GCODE_NO_MOTION) {
                    return FAULT_NONE; /* G80 gives way to the motion word beside it */
                }
            } else if (g->by[group]) {
                return tokens_at_words(r, FAULT_GROUP, w, g->by[group]);
            }
            g->by[group] = w;
            g->groups |= (uint32_t)1 << group;
            g->code[group] = code;
            return FAULT_NONE;
        }
    }
    for (size_t i = 0; codes == g_codes && i < sizeof g_refused / sizeof *g_refused; i++) {
        if (g_refused[i].code == code) {
            return tokens_at_word(r, g_refused[i].why, w);
        }
    }
    return tokens_at_word(r, FAULT_WORD, w);
}

/* Letters of the language beside G and M. */
#define ANGLES  (GCODE_BIT('A') | GCODE_BIT('B') | GCODE_BIT('C'))
#define LENGTHS (GCODE_BIT('U') | GCODE_BIT('V') | GCODE_BIT('W'))
#define LETTERS \
    (GCODE_BIT('N') | GCODE_BIT('F') | GCODE_BIT('S') | GCODE_BIT('T') | GCODE_BIT('X') \
     | GCODE_BIT('Y') | GCODE_BIT('Z') | GCODE_BIT('I') | GCODE_BIT('J') | GCODE_BIT('K') \
     | GCODE_BIT('R') | GCODE_BIT('P') | GCODE_BIT('L') | GCODE_BIT('Q') | GCODE_BIT('H') \
     | GCODE_BIT('D') | GCODE_BIT('E') | GCODE_BIT('@') | GCODE_BIT('^') \
     | GCODE_BIT(TOKENS_CHAMFER) | GCODE_BIT(TOKENS_ROUND))

/* The word of an axis that the machine does not have. Postprocessors write A0 for all machines, so
 * 0 is only a note. */
static enum fault idle(struct gcode *g, const struct token *w, bool angles, struct fault_report *r)
{
    if (w->value != 0.0) {
        return tokens_at_word(r, angles ? FAULT_SIDE : FAULT_ANGLE, w);
    }
    if (g->idle & GCODE_BIT(w->letter)) {
        return tokens_at_word(r, FAULT_TWICE, w);
    }
    g->idle |= GCODE_BIT(w->letter);
    tokens_note(r, angles ? FAULT_NOTE_SIDE : FAULT_NOTE_ANGLE, w);
    return FAULT_NONE;
}

static enum fault sort_letter(struct gcode *g, const struct token *w, bool angles,
                              struct fault_report *r)
{
    const int turns = w->letter - 'A'; /* 0..2 for A B C, which stand where U V W would */
    const bool angle = angles && turns >= 0 && turns < 3;
    const char letter = (char)(w->letter + (angle ? 'U' - 'A' : 0));
    const struct token **place = &g->word[letter - '@'];

    if (GCODE_BIT(w->letter) & (angles ? LENGTHS : ANGLES)) {
        return idle(g, w, angles, r);
    }
    if (!(GCODE_BIT(w->letter) & (LETTERS | (angles ? ANGLES : LENGTHS)))) {
        return tokens_at_word(r, FAULT_WORD, w);
    }
    if (*place) {
        return tokens_at_word(r, FAULT_TWICE, w);
    }
    if (w->letter == 'N' && w->value < 0.0) {
        return tokens_at_word(r, FAULT_VALUE, w);
    }
    *place = w;
    g->letters |= GCODE_BIT(letter);
    return FAULT_NONE;
}

static bool fanuc_code(const struct token *w)
{
    const int code = gcode_code(w);
    size_t i = 0;

    while (i < sizeof fanuc_codes / sizeof *fanuc_codes && fanuc_codes[i].code != code) {
        i++;
    }
    return i < sizeof fanuc_codes / sizeof *fanuc_codes;
}

static enum fault sort(struct block *b, const struct token *w, int *m_words, struct fault_report *r)
{
    struct gcode *g = &b->g;

    if (w->letter == 'G' && b->fanuc && fanuc_code(w)) {
        return sort_code(g, w, fanuc_codes, sizeof fanuc_codes / sizeof *fanuc_codes, r);
    }
    if (w->letter == 'G') {
        return sort_code(g, w, g_codes, sizeof g_codes / sizeof *g_codes, r);
    }
    if (w->letter == 'M' && ++*m_words > GCODE_M_MAX) {
        return tokens_at_word(r, FAULT_M_COUNT, w);
    }
    if (w->letter == 'M') {
        return sort_code(g, w, m_codes, sizeof m_codes / sizeof *m_codes, r);
    }
    return sort_letter(g, w, b->angles, r);
}

enum fault gcode_sort(struct block *b, struct fault_report *r)
{
    const struct tokens *t = &b->tokens;
    struct gcode *g = &b->g;
    enum fault f = FAULT_NONE;
    int m_words = 0;

    memset(g->word, 0, sizeof g->word);
    memset(g->by, 0, sizeof g->by);
    g->letters = g->idle = g->groups = 0;
    for (int i = 0; i < GCODE_GROUPS; i++) {
        g->code[i] = GCODE_ABSENT;
    }
    for (int i = 0; i < t->count && f == FAULT_NONE; i++) {
        f = sort(b, &t->word[i], &m_words, r);
    }
    return f;
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
