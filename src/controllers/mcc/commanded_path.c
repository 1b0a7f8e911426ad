#include "commanded_path.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

/* A circle that bends by less than this over a frame is a line: it leaves the chord by L/8 of it,
 * far below rounding of places in mm. [rad] */
static const double STRAIGHT = 1e-9;

/* Neighbours turn alike: their bends differ by less than this part. A part of a circle differs by
 * rounding only, a corner and the end of an arc by all of it. */
static const double ALIKE = 0.02;

/* Most that a circle turns in a frame; beyond it the points do not tell a circle. [rad] */
static const double TURN = 0.7;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double length(const double a[3])
{
    return sqrt(dot(a, a));
}

static void cross(const double a[3], const double b[3], double c[3])
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

static void minus(const double a[3], const double b[3], double c[3])
{
    for (int k = 0; k < 3; k++) {
        c[k] = a[k] - b[k];
    }
}

void commanded_path_start(struct commanded_path *t, const double place[3])
{
    memset(t, 0, sizeof *t);
    memcpy(t->point[0].place, place, sizeof t->point[0].place);
}

void commanded_path_push(struct commanded_path *t, const struct commanded_path_point *p)
{
    t->frames++;
    t->point[t->frames % COMMANDED_PATH_SIZE] = *p;
    if (t->frames - t->first >= COMMANDED_PATH_SIZE) {
        t->first++;
    }
    t->foot = t->foot > t->first ? t->foot : t->first;
}

const struct commanded_path_point *commanded_path_at(const struct commanded_path *t, int64_t frame)
{
    const int64_t there = frame < t->first ? t->first : frame > t->frames ? t->frames : frame;
    return &t->point[there % COMMANDED_PATH_SIZE];
}

static const double *place_at(const struct commanded_path *t, int64_t frame)
{
    return commanded_path_at(t, frame)->place;
}

/* Axis and size of the bend of the circle through three points: 2 a x b / (|a| |b| |a + b|)
 * [1/mm]; 0 if two of them are one. */
static void bend(const struct commanded_path *t, int64_t middle, double out[3])
{
    double a[3], b[3], ab[3];
    minus(place_at(t, middle), place_at(t, middle - 1), a);
    minus(place_at(t, middle + 1), place_at(t, middle), b);
    minus(place_at(t, middle + 1), place_at(t, middle - 1), ab);
    const double size = length(a) * length(b) * length(ab);
    cross(a, b, out);
    for (int k = 0; k < 3; k++) {
        out[k] = size > 0.0 ? 2.0 * out[k] / size : 0.0;
    }
}

/* The path from one point to the next, and the place on it that is nearest to the tool. */
struct commanded_path_segment {
    double from[3], chord[3], along[3]; /* [mm], [mm], unit */
    double size;                        /* [mm] of the chord */
    double foot[3];                     /* [mm] */
    double tangent[3];
    double square; /* [mm^2] distance to the foot */
};

/* Nearest place on the chord from point i to the next. */
static struct commanded_path_segment chord_of(const struct commanded_path *t, int64_t i,
                                              const double place[3])
{
    struct commanded_path_segment p = { 0 };
    double gap[3];

    memcpy(p.from, place_at(t, i), sizeof p.from);
    minus(place_at(t, i + 1), p.from, p.chord);
    p.size = length(p.chord);
    minus(place, p.from, gap);
    const double way = p.size > 0.0 ? dot(gap, p.chord) / p.size : 0.0;
    for (int k = 0; k < 3; k++) {
        p.along[k] = p.size > 0.0 ? p.chord[k] / p.size : 0.0;
        p.tangent[k] = p.along[k];
        p.foot[k] = p.from[k] + el_max(0.0, el_min(p.size, way)) * p.along[k];
        p.square += (place[k] - p.foot[k]) * (place[k] - p.foot[k]);
    }
    return p;
}

/* Axis and radius of the circle from point i to the next; false where the path is straight. */
static bool arc_of(const struct commanded_path *t, int64_t i, double size, double axis[3],
                   double *radius)
{
    double before[3], after[3], gap[3];

    if (i <= t->first || i + 2 > t->frames) {
        return false;
    }
    bend(t, i, before);
    bend(t, i + 1, after);
    minus(after, before, gap);
    for (int k = 0; k < 3; k++) {
        axis[k] = 0.5 * (before[k] + after[k]);
    }
    const double k = length(axis);
    if (length(gap) > ALIKE * k || k * size < STRAIGHT || k * size > TURN) {
        return false;
    }
    *radius = 1.0 / k;
    for (int j = 0; j < 3; j++) {
        axis[j] *= *radius;
    }
    return true;
}

/* Move the foot to an end of the piece: there the chord may be nearer to the tool than the path
 * is. */
static void at_end(struct commanded_path_segment *p, bool far, const double place[3])
{
    p->square = 0.0;
    for (int k = 0; k < 3; k++) {
        p->foot[k] = p->from[k] + (far ? p->chord[k] : 0.0);
        p->square += (place[k] - p->foot[k]) * (place[k] - p->foot[k]);
    }
}

/* Nearest place on the path from point i to the next: on its circle if it has one, else on the
 * chord. */
static struct commanded_path_segment refined(const struct commanded_path *t, int64_t i,
                                             const double place[3])
{
    struct commanded_path_segment p = chord_of(t, i, place);
    double axis[3], inward[3], centre[3], spoke[3], radius;

    if (p.size == 0.0 || !arc_of(t, i, p.size, axis, &radius)) {
        return p;
    }
    cross(axis, p.along, inward);
    const double deep = sqrt(radius * radius - 0.25 * p.size * p.size);
    for (int k = 0; k < 3; k++) {
        centre[k] = p.from[k] + 0.5 * p.chord[k] + deep * inward[k];
    }
    minus(place, centre, spoke);
    const double off = dot(spoke, axis);
    for (int k = 0; k < 3; k++) {
        spoke[k] -= off * axis[k];
    }
    const double reach = length(spoke);
    if (reach == 0.0) {
        return p; /* at the centre every point is as near */
    }
    double foot[3], way[3], square = 0.0;
    for (int k = 0; k < 3; k++) {
        foot[k] = centre[k] + radius / reach * spoke[k];
        way[k] = foot[k] - p.from[k];
        square += (place[k] - foot[k]) * (place[k] - foot[k]);
    }
    const double s = dot(way, p.along);
    if (s < 0.0 || s > p.size || dot(spoke, inward) > 0.0) {
        at_end(&p, s > 0.5 * p.size, place);
        return p;
    }
    memcpy(p.foot, foot, sizeof p.foot);
    p.square = square;
    cross(axis, spoke, p.tangent);
    for (int k = 0; k < 3; k++) {
        p.tangent[k] /= reach;
    }
    return p;
}

/* Places that stand still have no piece of their own. */
static void pass_rest(struct commanded_path *t, int64_t last)
{
    while (t->foot + 1 < last
           && memcmp(place_at(t, t->foot), place_at(t, t->foot + 1), 3 * sizeof(double)) == 0) {
        t->foot++;
    }
}

struct commanded_path_foot commanded_path_nearest(struct commanded_path *t, const double place[3],
                                                  int64_t frame)
{
    struct commanded_path_foot out = { { 0.0 }, { 0.0 } };
    const int64_t last =
        frame + COMMANDED_PATH_AHEAD < t->frames ? frame + COMMANDED_PATH_AHEAD : t->frames;
    int64_t best = t->foot;
    double least = INFINITY;

    pass_rest(t, last);
    for (int64_t i = t->foot; i < last; i++) {
        const double square = chord_of(t, i, place).square;
        if (square < least) {
            least = square;
            best = i;
        }
    }
    if (least == INFINITY) {
        return out;
    }
    struct commanded_path_segment p = refined(t, best, place);
    for (int64_t i = best - 1; i <= best + 1; i += 2) {
        const struct commanded_path_segment other = refined(t, i, place);
        if (i >= t->foot && i < last && other.square < p.square) {
            p = other;
        }
    }
    t->foot = best;
    minus(p.foot, place, out.error);
    const double along = dot(out.error, p.tangent);
    for (int k = 0; k < 3; k++) {
        out.tangent[k] = p.tangent[k];
        out.error[k] -= along * p.tangent[k];
    }
    return out;
}
