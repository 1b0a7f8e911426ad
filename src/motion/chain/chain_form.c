#include "chain_form.h"

#include <string.h>

#include "el_extremes.h"
#include "vector3.h"

/* Determinant below which lines are so nearly parallel that no place is nearest to all. */
static const double PARALLEL = 1e-6;

/* Sine of an angle between axes below which they may as well be in parallel. */
static const double SLANTED = 1e-2;

/* Where a held joint stands while the kind is sought: no special place. [rad], [m] */
static const double SOMEWHERE = 0.7;

void chain_lines_of(const struct chain *c, struct chain_lines *l)
{
    double at[3] = { 0.0, 0.0, 0.0 };

    memset(l, 0, sizeof *l);
    l->count = c->joints;
    for (int i = 0; i < c->joints; i++) {
        vector3_add(at, 1.0, c->joint[i].origin, at);
        memcpy(l->point[i], at, sizeof at);
        memcpy(l->axis[i], c->joint[i].axis, sizeof at);
        l->slides[i] = c->joint[i].slides;
    }
    l->home = c->flange;
    vector3_add(at, 1.0, c->flange.at, l->home.at);
}

/* What lies behind a joint as its motion leaves it. */
static void carry(const double axis[3], const double point[3], bool slides, double value,
                  double at[3])
{
    if (slides) {
        vector3_add(at, value, axis, at);
        return;
    }
    vector3_add(at, -1.0, point, at);
    vector3_turn(axis, el_sincos(value), at, at);
    vector3_add(at, 1.0, point, at);
}

void chain_lines_held(const struct chain *c, int32_t held, double value, struct chain_lines *l)
{
    struct chain_lines all;

    chain_lines_of(c, &all);
    *l = all;
    l->count--;
    const double *axis = all.axis[held], *point = all.point[held];
    const bool slides = all.slides[held];
    for (int i = held; i < l->count; i++) {
        memcpy(l->point[i], all.point[i + 1], sizeof l->point[i]);
        memcpy(l->axis[i], all.axis[i + 1], sizeof l->axis[i]);
        l->slides[i] = all.slides[i + 1];
        carry(axis, point, slides, value, l->point[i]);
        if (!slides) {
            vector3_turn(axis, el_sincos(value), l->axis[i], l->axis[i]);
        }
    }
    carry(axis, point, slides, value, l->home.at);
    if (!slides) {
        double own[3][3];
        vector3_matrix(axis, el_sincos(value), own);
        vector3_product((const double(*)[3])own, (const double(*)[3])all.home.turn, l->home.turn);
    }
}

void chain_lines_reverse(struct chain_lines *l)
{
    const struct chain_lines all = *l;

    for (int i = 0; i < l->count; i++) {
        const int k = l->count - 1 - i;
        memcpy(l->point[i], all.point[k], sizeof l->point[i]);
        l->slides[i] = all.slides[k];
        for (int n = 0; n < 3; n++) {
            l->axis[i][n] = -all.axis[k][n];
        }
    }
}

/* The place nearest to some lines; returns how far it is from the farthest of them [m], INFINITY
 * if they are in parallel. It is the solution of sum(1 - h h^T) (x - point) = 0. */
static double meet(const struct chain_lines *l, int first, int count, double x[3])
{
    double m[3][3] = { { 0.0 } }, b[3] = { 0.0 }, most = 0.0, inverse[3][3];

    for (int n = first; n < first + count; n++) {
        double across[3];
        vector3_across(l->axis[n], l->point[n], across);
        for (int i = 0; i < 3; i++) {
            b[i] += across[i];
            for (int k = 0; k < 3; k++) {
                m[i][k] += (i == k) - l->axis[n][i] * l->axis[n][k];
            }
        }
    }
    for (int i = 0; i < 3; i++) { /* of a symmetric matrix */
        vector3_cross(m[(i + 1) % 3], m[(i + 2) % 3], inverse[i]);
    }
    const double det = vector3_dot(m[0], inverse[0]);
    if (!(fabs(det) > PARALLEL)) {
        return INFINITY;
    }
    for (int i = 0; i < 3; i++) {
        x[i] = (inverse[0][i] * b[0] + inverse[1][i] * b[1] + inverse[2][i] * b[2]) / det;
    }
    for (int n = first; n < first + count; n++) {
        double off[3];
        vector3_add(x, -1.0, l->point[n], off);
        vector3_across(l->axis[n], off, off);
        most = el_max(most, vector3_length(off));
    }
    return most;
}

/* Sine of the angle between two axes. */
static double between(const struct chain_lines *l, int i, int k)
{
    double c[3];

    vector3_cross(l->axis[i], l->axis[k], c);
    return vector3_length(c);
}

static bool all_turn(const struct chain_lines *l, int first, int count)
{
    bool good = true;

    for (int i = first; i < first + count; i++) {
        good = good && !l->slides[i];
    }
    return good;
}

/* The centre of the wrist behind joint 3: where its axes meet. Of one axis it is the joint's
 * origin, on the pivot of a linkage; of none the flange. */
static double wrist_of(const struct chain_lines *l, double centre[3])
{
    if (l->count < 3 || l->count > 6 || !all_turn(l, 0, l->count)) {
        return INFINITY;
    }
    if (l->count < 5) {
        memcpy(centre, l->count == 4 ? l->point[3] : l->home.at, 3 * sizeof *centre);
        return 0.0;
    }
    return meet(l, 3, l->count - 3, centre);
}

/* The same, and where two axes from `first` on meet. */
static double meetings_of(const struct chain_lines *l, int first, struct chain_points *p)
{
    return el_max(wrist_of(l, p->centre), meet(l, first, 2, p->meeting));
}

/* The axes of an arm of four joints, one of which slides, in parallel. */
static double scara_of(const struct chain_lines *l)
{
    int slides = 0;
    double most = 0.0;

    for (int i = 0; i < l->count; i++) {
        slides += l->slides[i];
        most = el_max(most, between(l, 0, i));
    }
    return l->count == 4 && slides == 1 ? most : INFINITY;
}

static double gantry_of(const struct chain_lines *l)
{
    const bool slide = l->count >= 3 && l->count <= 6 && l->slides[0] && l->slides[1]
                       && l->slides[2] && all_turn(l, 3, l->count - 3);
    return slide && fabs(vector3_triple(l->axis[0], l->axis[1], l->axis[2])) > PARALLEL ? 0.0
                                                                                        : INFINITY;
}

/* How far axes i and k are from parallel, where axis j is not so, too. */
static double only(const struct chain_lines *l, int i, int k, int j)
{
    return between(l, i, j) > SLANTED ? between(l, i, k) : INFINITY;
}

double chain_points_of(enum chain_kind kind, const struct chain_lines *l, double size,
                       struct chain_points *p)
{
    p->lines = *l;
    switch (kind) {
    case CHAIN_WRIST_PARALLEL: return el_max(wrist_of(l, p->centre) / size, only(l, 1, 2, 0));
    case CHAIN_WRIST_SHOULDER: return meetings_of(l, 0, p) / size;
    case CHAIN_WRIST_ELBOW:    return meetings_of(l, 1, p) / size;
    case CHAIN_WRIST_COLUMN:   return el_max(wrist_of(l, p->centre) / size, only(l, 0, 1, 2));
    case CHAIN_THREE_PARALLEL:
        return l->count != 6 || !all_turn(l, 0, 6)
                   ? INFINITY
                   : el_max(meet(l, 4, 2, p->centre) / size,
                            el_max(only(l, 1, 2, 0), only(l, 1, 3, 4)));
    case CHAIN_SCARA:  return scara_of(l);
    case CHAIN_GANTRY: return gantry_of(l);
    case CHAIN_SHOULDER_WRIST:
        return l->count != 7 || !all_turn(l, 0, 7)
                   ? INFINITY
                   : el_max(meet(l, 0, 3, p->meeting), meet(l, 4, 3, p->centre)) / size;
    default: return INFINITY;
    }
}

/* Flags of a kind; a wrist of less than three axes has one solution. */
static uint32_t flags_of(enum chain_kind kind, int count)
{
    switch (kind) {
    case CHAIN_ITERATED: return 0;
    case CHAIN_SCARA:    return CHAIN_ELBOW;
    case CHAIN_GANTRY:   return count == 6 ? CHAIN_FLIP : 0;
    default:             return CHAIN_BACK | CHAIN_ELBOW | (count >= 6 ? CHAIN_FLIP : 0);
    }
}

/* A linkage is known to palletizers: four joints, the last one level, and the forearm too where it
 * is driven from the base. */
static bool level_fits(const struct chain *c, enum chain_kind kind, bool reversed)
{
    bool plain = true;

    for (int i = 0; i < c->joints; i++) {
        plain = plain && c->joint[i].level == 0;
    }
    const bool four = c->joints == 4 && c->joint[3].level == 2 && c->joint[2].level <= 1
                      && c->joint[1].level == 0;
    return plain || (four && kind == CHAIN_WRIST_PARALLEL && !reversed);
}

/* Order in which kinds are tried. */
static const enum chain_kind KINDS[] = { CHAIN_WRIST_PARALLEL, CHAIN_WRIST_SHOULDER,
                                         CHAIN_WRIST_ELBOW,    CHAIN_WRIST_COLUMN,
                                         CHAIN_THREE_PARALLEL, CHAIN_SCARA,
                                         CHAIN_GANTRY,         CHAIN_SHOULDER_WRIST };

/* Take the kind that lines miss least, if by less than the form so far. */
static void take_best(const struct chain_lines *lines, bool reversed, struct chain_form *f)
{
    struct chain_points points;

    for (int n = 0; n < (int)(sizeof KINDS / sizeof KINDS[0]); n++) {
        const double off = chain_points_of(KINDS[n], lines, f->size, &points);
        const bool better = f->deviation > CHAIN_EXACT && off < 0.5 * f->deviation;
        if (off <= CHAIN_LOOSE && better && level_fits(&f->chain, KINDS[n], reversed)) {
            f->kind = KINDS[n];
            f->deviation = off;
            f->reversed = reversed;
            f->flags = flags_of(f->kind, lines->count);
        }
    }
}

void chain_form_of(const struct chain *c, int32_t held, struct chain_form *f)
{
    struct chain_lines lines;
    double size = vector3_length(c->flange.at);

    for (int i = 0; i < c->joints; i++) {
        size += vector3_length(c->joint[i].origin);
    }
    memset(f, 0, sizeof *f);
    f->chain = *c;
    f->held = held;
    f->size = size > 0.0 ? size : 1.0;
    f->deviation = INFINITY;
    if (c->joints < CHAIN_JOINTS) {
        f->held = CHAIN_NONE;
    } else if (held == CHAIN_NONE) {
        f->held = 2;
    }
    if (f->held >= 0) {
        chain_lines_held(c, f->held, SOMEWHERE, &lines);
    } else {
        chain_lines_of(c, &lines);
    }
    take_best(&lines, false, f);
    if (lines.count == 6) {
        chain_lines_reverse(&lines);
        take_best(&lines, true, f);
    }
    if (f->held == CHAIN_ARM_ANGLE && f->kind != CHAIN_SHOULDER_WRIST) {
        chain_form_of(c, 2, f);
    }
}

int chain_form_open(const struct chain_form *f)
{
    const int count = f->chain.joints - (f->held >= 0);
    const int open = f->kind == CHAIN_THREE_PARALLEL ? 5 : f->kind == CHAIN_SHOULDER_WRIST ? 4 : 3;

    if (!(f->flags & CHAIN_FLIP)) {
        return -1;
    }
    const int among = f->reversed ? count - 1 - open : open;
    return among + (f->held >= 0 && among >= f->held);
}
