#include "shape_run.h"

#include <math.h>
#include <string.h>

#include "shape_fit.h"

/* Of the tolerance: closest spacing of knots; way over which the direction of a raster is taken. */
static const double SPACING = 12.0, SMOOTHED = 12.0;

/* Closest spacings of a span at first. */
enum { COARSE = 4 };

/* Wave length of the first weights' smoothing, in spacings of knots. */
static const double WAVE = 18.0;

/* Spans are at least this part of the spacing. */
static const double LEAST = 1e-3;

/* Weights grow where a distance is above this part of the tolerance, so often; each SPLIT rounds
 * spans of more than so many spacings are halved there. */
static const double GROWS = 0.9, LONGER = 0.75;
enum { ROUNDS = 24, SPLIT = 2 };

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
        const double ratio = way > 0.0 ? fmax(0.5, chord / way) : 1.0;
        v[i].u = v[i - 1].u + (v[i].s - v[i - 1].s) * ratio;
    }
    r->placed = end + 1 > r->placed ? end + 1 : r->placed;
}

/* Knots from those that hold on, at most so many vertices between two. False: no room for them. */
static bool put_knots(struct shape_fit *f)
{
    struct shape_run *r = f->run;
    const struct shape_vertex *v = r->vertex;
    const double to = v[f->end].u;
    int32_t k = r->begun ? 5 : 3, i = 1, crowd = 0;

    if (!r->begun) {
        for (int j = 0; j <= 3; j++) {
            r->knot[j] = v[0].u;
        }
    }
    const double from = r->knot[k];
    const int32_t held = k;
    if (!(to > from)) {
        return false;
    }
    while (k < SHAPE_SPANS + 3) {
        double h = COARSE * shape_spacing(v[i].tolerance);
        while (i < f->end && (v[i].u <= r->knot[k]
                              || (v[i].u < r->knot[k] + h && crowd < COARSE * SHAPE_CROWD))) {
            crowd += v[i].u > r->knot[k];
            i++;
        }
        h = crowd >= COARSE * SHAPE_CROWD ? fmax(LEAST * h, fmin(h, v[i].u - r->knot[k])) : h;
        crowd = 0;
        r->knot[k + 1] = r->knot[k] + h;
        k++;
        if (r->knot[k] >= to) {
            break;
        }
    }
    if (r->knot[k] < to && f->last) {
        return false;
    }
    while (f->end > 1 && v[f->end].u > r->knot[k]) {
        f->end--;
    }
    const double at_end = v[f->end].u;
    /* the last one at the end: drop it if it is nearer to the one before */
    if (k > held + 1 && k > SHAPE_SPANS_LEAST + 3
        && r->knot[k] - at_end > at_end - r->knot[k - 1]) {
        k--;
    }
    int32_t n = k - held;
    const double stretch = (at_end - from) / (r->knot[k] - from);
    for (int32_t j = held + 1; j <= k; j++) {
        r->knot[j] = from + (r->knot[j] - from) * stretch;
    }
    if (k < SHAPE_SPANS_LEAST + 3) {      /* short: evenly */
        n = SHAPE_SPANS_LEAST + 3 - held;
        k = SHAPE_SPANS_LEAST + 3;
        for (int32_t j = 1; j <= n; j++) {
            r->knot[held + j] = from + (at_end - from) * j / n;
        }
    }
    r->knot[k] = at_end;
    for (int j = 1; j <= 3; j++) {
        r->knot[k + j] = at_end;
    }
    f->spans = k - 3;
    return true;
}

/* Vertices go to their feet, in order; weights grow where the distance is too large. */
static void follow(struct shape_fit *f)
{
    struct shape_run *r = f->run;
    double least = r->knot[3];

    for (int32_t i = 1; i <= f->end; i++) {
        struct shape_vertex *v = &r->vertex[i];
        if (i < f->end || !f->last) {
            const double to = v->u + v->shift;
            v->u = to < least ? least : to > r->knot[f->spans + 3] ? r->knot[f->spans + 3] : to;
            least = v->u;
        }
        if (v->off > GROWS) {
            const double x = v->off / GROWS, y = x * x;
            v->weight *= y > 10.0 ? 10.0 : y * y > 10.0 ? 10.0 : y * y;
        }
    }
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

/* Halves the spans of chords that are too far out, as far as there is room. */
static bool split(struct shape_fit *f)
{
    struct shape_run *r = f->run;
    const int32_t first = r->begun ? 2 : 0;     /* before it knots hold */
    bool wide[SHAPE_SPANS] = { false };
    double knot[SHAPE_SPANS + 7];
    int32_t k = 0, n = 0, more = 0;

    for (int32_t i = 1; i <= f->end; i++) {
        const struct shape_vertex *v = &r->vertex[i];
        while (k < f->spans - 1 && v[-1].u >= r->knot[k + 4]) {
            k++;
        }
        for (int32_t j = k; j < f->spans && r->knot[j + 3] <= v->u && v->off > 1.0; j++) {
            wide[j] = wide[j] || (j >= first && r->knot[j + 4] - r->knot[j + 3]
                                > LONGER * shape_spacing(v->tolerance));
        }
    }
    for (k = 0; k < f->spans; k++) {
        knot[n++] = r->knot[k + 3];
        if (wide[k] && f->spans + more < SHAPE_SPANS) {
            knot[n++] = 0.5 * (r->knot[k + 3] + r->knot[k + 4]);
            more++;
        }
    }
    const double to = r->knot[f->spans + 3];
    memcpy(r->knot + 3, knot, (size_t)n * sizeof knot[0]);
    f->spans = r->spans = n;
    for (k = 0; k < 4; k++) {
        r->knot[n + 3 + k] = to;
    }
    return more > 0;
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

int32_t shape_run_fit(struct shape_run *r, int32_t end, bool last, const struct piece_state *stop)
{
    struct shape_fit f = { .run = r, .end = end, .last = last, .stop = stop };

    r->spans = 0;
    place(r, end);
    if (!put_knots(&f)) {
        return r->vertex[end].u > r->knot[r->begun ? 5 : 3] ? -2 : end;
    }
    r->spans = f.spans;
    r->fitted = f.end;
    shape_fit_prepare(&f);
    put_weights(&f);
    for (int round = 1; round <= ROUNDS; round++) {
        shape_fit_solve(&f);
        shape_fit_look(&f);
        if (f.worst <= 1.0) {
            return -1;
        }
        if (!(f.worst < 1e100)) {
            return end;
        }
        if (round % SPLIT == 0 && split(&f)) {
            shape_fit_prepare(&f);
        }
        follow(&f);
    }
    return f.worst_vertex;
}

/* Of two jerks the smaller; 0 is one without limit. */
static double least_jerk(double a, double b)
{
    return a > 0.0 && b > 0.0 ? fmin(a, b) : fmax(a, b);
}

void shape_obey(struct piece *p, double feed, double cap, const struct ramp_limits *r)
{
    p->feed = fmin(p->feed, feed);
    p->cap = fmin(p->cap, cap);
    p->ramp.acc = fmin(p->ramp.acc, r->acc);
    p->ramp.dec = fmin(p->ramp.dec, r->dec);
    p->ramp.acc_jerk = least_jerk(p->ramp.acc_jerk, r->acc_jerk);
    p->ramp.dec_jerk = least_jerk(p->ramp.dec_jerk, r->dec_jerk);
}

void shape_run_piece(const struct shape_run *r, int32_t k, int32_t *vertex, struct piece *p)
{
    const double *t = r->knot + k;
    double m[4][4];

    memset(p, 0, sizeof *p);
    p->kind = PIECE_CURVE;
    p->length = t[4] - t[3];
    shape_extract(t, m);
    for (int i = 0; i < AXES; i++) {
        double b[4];
        for (int j = 0; j < 4; j++) {
            b[j] = 0.0;
            for (int c = 0; c < 4; c++) {
                b[j] += m[j][c] * r->control[k + c][i];
            }
        }
        const double raised[PIECE_POINTS] = {
            b[0], (2.0 * b[0] + 3.0 * b[1]) / 5.0, (b[0] + 6.0 * b[1] + 3.0 * b[2]) / 10.0,
            (3.0 * b[1] + 6.0 * b[2] + b[3]) / 10.0, (3.0 * b[2] + 2.0 * b[3]) / 5.0, b[3] };
        for (int j = 0; j < PIECE_POINTS; j++) {
            p->control[j][i] = raised[j];
        }
    }
    /* chords with a part in it */
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
    memmove(r->control, r->control + n, (size_t)(controls - n) * sizeof r->control[0]);
    r->spans = spans;
    r->begun = true;
    while (gone + 1 < r->vertices && r->vertex[gone + 1].u <= r->knot[3]) {
        gone++;
    }
    r->vertices -= gone;
    r->placed -= gone;
    memmove(r->vertex, r->vertex + gone, (size_t)r->vertices * sizeof r->vertex[0]);
    return gone;
}
