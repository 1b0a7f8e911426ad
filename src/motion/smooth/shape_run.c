#include "shape_run.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"
#include "shape_fit.h"

/* In tolerances: closest spacing of knots; way over which the direction of a raster is taken. */
static const double SPACING = 12.0, SMOOTHED = 12.0;

/* Wave length of the first weights' smoothing, in spacings of knots. */
static const double WAVE = 18.0;

/* Knots of so many last spans of a window are placed anew by the next one. */
enum { UNSETTLED = 2 };

/* Weights grow so often; vertices go to their feet FOLLOWS times, then only those whose weight
 * grows. Every SPLIT rounds spans of more than so many closest spacings are halved where a distance
 * is too large, after LATE rounds shorter ones, too. */
enum { ROUNDS = 24, FOLLOWS = 2, SPLIT = 2, LATE = 5 };
static const double LONGER = 1.5, LONGER_LATE = 0.7;

/* Most squared distance, in tolerance^2, of vertices that are not made into segments yet: in the
 * next half of them, and in the rest. */
static const double NEARLY = 1.2, FAR = 4.0;

double shape_spacing(double tolerance)
{
    return SPACING * tolerance;
}

double shape_distance(const double a[AXES], const double b[AXES])
{
    double sum = 0.0;
    for (int i = 0; i < AXES; i++) {
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    }
    return sqrt(sum);
}

/* A staircase is longer than the curve through it: u grows by the chord of the steps around. */
static void place(struct shape_run *r, int32_t end)
{
    struct shape_vertex *v = r->vertex;
    int32_t a = 0, b = 0;

    for (int32_t i = r->placed > 0 ? r->placed : 1; i <= end; i++) {
        const double reach = SMOOTHED * v[i].tolerance, middle = 0.5 * (v[i - 1].s + v[i].s);
        while (a < i - 1 && v[a + 1].s <= middle - reach) {
            a++;
        }
        b = b > i ? b : i;
        while (b < end && v[b].s < middle + reach) {
            b++;
        }
        const double way = v[b].s - v[a].s, chord = shape_distance(v[a].point, v[b].point);
        const double ratio = way > 0.0 ? el_max(0.5, chord / way) : 1.0;
        v[i].u = v[i - 1].u + (v[i].s - v[i - 1].s) * ratio;
    }
    r->placed = end + 1 > r->placed ? end + 1 : r->placed;
}

static void put_weights(struct shape_fit *f)
{
    struct shape_run *r = f->run;

    for (int32_t i = 1; i <= f->end; i++) {
        struct shape_vertex *v = &r->vertex[i];
        const double next = i < f->end ? v[1].s : v->s;
        const double x = 6.283 / (WAVE * shape_spacing(v->tolerance));
        if (v->weight == 0.0) {
            v->weight = 0.5 * (next - v[-1].s) * x * x * x * x * x * x;
        }
    }
}

/* How many spans become segments once a fit is good: the rest depends on what comes. */
static int32_t sure(const struct shape_fit *f)
{
    const int32_t rest = f->spans / 6 > 2 ? f->spans / 6 : 2;
    return f->last ? f->spans : f->spans - rest;
}

/* Whether the vertices of those spans, and the next one, are near the curve, and others nearly. */
static bool near(const struct shape_fit *f)
{
    const int32_t first = f->first[sure(f)], middle = (first + f->end) / 2;

    for (int32_t i = 1; i <= f->end; i++) {
        const double most = i <= first ? 1.0 : i < middle ? NEARLY : FAR;
        if (!(f->run->vertex[i].off <= most)) {
            return false;
        }
    }
    return true;
}

void shape_run_afresh(struct shape_run *r)
{
    const double held = r->begun ? r->knot[5] : r->vertex[0].u;
    int32_t kept = 1;

    while (kept < r->placed && r->vertex[kept].u <= held) {
        kept++;
    }
    r->placed = kept < r->placed ? kept : r->placed;
    for (int32_t k = 1; k < r->vertices; k++) {
        r->vertex[k].weight = 0.0;
    }
}

int32_t shape_run_fit(struct shape_run *r, int32_t end, bool last, const struct segment_state *stop)
{
    struct shape_fit f; /* large: each part is set where it is made */

    f.run = r;
    f.end = end;
    f.last = last;
    f.stop = stop;
    r->spans = 0;
    place(r, end);
    if (!shape_knots_put(&f)) {
        return r->vertex[end].u > r->knot[r->begun ? 5 : 3] ? -2 : end;
    }
    r->spans = f.spans;
    r->fitted = f.end;
    shape_fit_prepare(&f);
    put_weights(&f);
    shape_solve_assemble(&f);
    for (int round = 1; round <= ROUNDS; round++) {
        shape_solve(&f);
        shape_fit_look(&f);
        if (near(&f)) {
            r->proved = sure(&f);
            shape_fit_prove(&f, r->proved);
            if (f.worst <= 1.0) {
                return -1;
            }
        }
        if (!(f.worst < 1e100)) {
            return end;
        }
        const bool all = round <= FOLLOWS;
        shape_fit_push(&f, all);
        const bool finer =
            round % SPLIT == 0 && shape_knots_halve(&f, round < LATE ? LONGER : LONGER_LATE);
        if (finer || all) {
            shape_solve_assemble(&f);
        }
    }
    return f.worst_vertex;
}

static double least(double a, double b)
{
    return a < b ? a : b;
}

/* The smaller of two jerks, where 0 is one without limit. */
static double least_jerk(double a, double b)
{
    return a > 0.0 && b > 0.0 ? least(a, b) : a + b;
}

void shape_obey(struct segment *p, double feed, double cap, const struct ramp_limits *r)
{
    p->feed = least(p->feed, feed);
    p->cap = least(p->cap, cap);
    p->ramp.acc = least(p->ramp.acc, r->acc);
    p->ramp.dec = least(p->ramp.dec, r->dec);
    p->ramp.acc_jerk = least_jerk(p->ramp.acc_jerk, r->acc_jerk);
    p->ramp.dec_jerk = least_jerk(p->ramp.dec_jerk, r->dec_jerk);
}

void shape_run_segment(const struct shape_run *r, int32_t k, int32_t *vertex, struct segment *p)
{
    const double *t = r->knot + k;
    double m[4][4];

    memset(p, 0, sizeof *p);
    p->kind = SEGMENT_CURVE;
    p->joint = false;
    p->length = t[4] - t[3];
    shape_extract(t, m);
    for (int i = 0; i < AXES; i++) { /* from the first control point, so differences are small */
        const double at = r->control[k][i], c1 = r->control[k + 1][i] - at;
        const double c2 = r->control[k + 2][i] - at, c3 = r->control[k + 3][i] - at;
        const double start = m[0][1] * c1 + m[0][2] * c2;
        const double b1 = m[1][1] * c1 + m[1][2] * c2 - start;
        const double b2 = m[2][1] * c1 + m[2][2] * c2 - start;
        const double b3 = m[3][1] * c1 + m[3][2] * c2 + m[3][3] * c3 - start;
        p->origin[i] = r->origin[i] + (at + start);
        p->control[1][i] = 0.6 * b1; /* raised to degree 5 */
        p->control[2][i] = 0.6 * b1 + 0.3 * b2;
        p->control[3][i] = 0.3 * b1 + 0.6 * b2 + 0.1 * b3;
        p->control[4][i] = 0.6 * b2 + 0.4 * b3;
        p->control[5][i] = b3;
    }
    /* limits of the chords that have a part in the span */
    while (*vertex < r->vertices - 1 && r->vertex[*vertex].u <= t[3]) {
        (*vertex)++;
    }
    const struct shape_law *l = &r->vertex[*vertex].law;
    p->feed = l->feed;
    p->cap = l->cap;
    p->ramp = l->ramp;
    for (int32_t i = *vertex + 1; i < r->vertices && r->vertex[i - 1].u < t[4]; i++) {
        l = &r->vertex[i].law;
        shape_obey(p, l->feed, l->cap, &l->ramp);
    }
}

int32_t shape_run_drop(struct shape_run *r, int32_t n)
{
    const int32_t spans = r->spans - n, knots = r->spans + 7, controls = r->spans + 3;
    int32_t gone = 0;

    memmove(r->knot, r->knot + n, (size_t)(knots - n) * sizeof r->knot[0]);
    for (int i = 0; i < AXES; i++) {
        const double origin = r->origin[i];
        r->origin[i] += r->control[n][i];
        for (int32_t k = n; k < controls; k++) {
            r->control[k - n][i] = r->control[k][i] - (r->origin[i] - origin);
        }
    }
    r->spans = spans;
    r->kept = spans + 3 - UNSETTLED;
    r->begun = true;
    while (gone + 1 < r->vertices && r->vertex[gone + 1].u <= r->knot[3]) {
        gone++;
    }
    r->vertices -= gone;
    r->placed -= gone;
    memmove(r->vertex, r->vertex + gone, (size_t)r->vertices * sizeof r->vertex[0]);
    return gone;
}
