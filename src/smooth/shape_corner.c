#include "shape_corner.h"

#include <math.h>
#include <string.h>

/* Farthest of the quintic from two lines whose directions differ by 1, of its half length; and from
 * paths of a curvature of 1 that touch, of its square. Where the search begins. */
static const double CUT = 0.1875, CUT_CURVED = 0.035;

/* The first attempt takes a little less, each one so much less than the one before, and none less
 * than that. [mm] */
static const double FIRST = 0.99, SHORTER = 0.85, LEAST = 1e-6;

enum { ATTEMPTS = 24 };

/* Of a curve at least this part is left or nothing: a sliver's derivatives would be rounding. */
static const double SLIVER = 0.1;

/* Directions that differ by more turn back: the curve would come to a point. */
static const double BACK = 1.98;

/* r' [1] and r'' [1/mm] that differ by less are the same. */
static const double SAME = 1e-11;

/* Part of the tolerance that a chord of an arc may take. */
static const double SAGITTA = 0.05;

/* Of an arc or a cubic no more than this angle, by the curvature at its end, is cut. [rad] */
static const double ARC = 0.5;

struct piece *shape_made(struct shape *s, int64_t number)
{
    return &s->piece[number % SHAPE_PIECES];
}

void shape_push(struct shape *s, const struct piece *p)
{
    *shape_made(s, s->made) = *p;
    s->made++;
    s->u += p->length;
}

void shape_corner_begin(struct shape *s, int32_t end, double tolerance)
{
    const int32_t n = end + 1 < SHAPE_TAIL ? end + 1 : SHAPE_TAIL;

    s->corner = true;
    s->corner_made = s->made;
    s->corner_stretch = s->stretch;
    s->corner_tolerance = tolerance;
    s->stretch = s->made;
    s->tail_points = n;
    for (int32_t k = 0; k < n; k++) {
        const struct shape_vertex *v = &s->run.vertex[end + 1 - n + k];
        memcpy(s->tail[k], v->point, sizeof s->tail[k]);
        s->tail_u[k] = v->u - s->run.vertex[end].u;
        s->tail_tolerance[k] = v->tolerance;
    }
}

static void add(struct shape_way *w, const double point[AXES], double u, double tolerance)
{
    memcpy(w->point[w->points], point, sizeof w->point[0]);
    w->u[w->points] = u;
    w->tolerance[w->points] = tolerance;
    w->points++;
}

/* Chords of a long piece in a corner: a line whole, an arc in equal ones and one more. */
static int32_t chords(const struct piece *p, double half, double tolerance, double *step,
                      double *left)
{
    struct piece_bounds b;

    *step = p->length;
    *left = tolerance;
    if (p->kind == PIECE_LINE) {
        return 1;
    }
    piece_bounds(p, 0.0, p->length, &b);
    const double most = sqrt(8.0 * SAGITTA * tolerance / b.most[1]);
    const int32_t n = (int32_t)fmin(20.0, ceil(half / most));
    *step = half / n;
    *left = tolerance - b.most[1] * *step * *step / 8.0;    /* chords: |r''| h^2 / 8 off at most */
    return *left > 0.0 ? n + (p->length >= half + *step) : 0;
}

static bool way_before(struct shape *s, double half, struct shape_way *w)
{
    const struct piece *p = shape_made(s, s->corner_made - 1);
    struct piece_state at;
    double step, left;

    if (p->kind == PIECE_CURVE) {
        int32_t k = s->tail_points - 2;
        while (k > 0 && s->tail_u[k] > -half) {
            k--;
        }
        if (k < 0 || s->tail_u[k] > -half) {
            return false;
        }
        for (; k < s->tail_points; k++) {
            add(w, s->tail[k], half + s->tail_u[k], s->tail_tolerance[k]);
        }
        return true;
    }
    const int32_t n = chords(p, half, s->corner_tolerance, &step, &left);
    for (int32_t k = n; k >= 0; k--) {
        piece_at(p, fmax(0.0, p->length - k * step), &at);
        add(w, at.point, half - k * step, left);
    }
    return n > 0;
}

static bool way_behind(struct shape *s, double before, double half, double tolerance,
                       struct shape_way *w)
{
    const struct piece *p = shape_made(s, s->corner_made);
    struct piece_state at;
    double step, left;

    if (p->kind == PIECE_CURVE) {
        for (int32_t k = 1; k < s->run.vertices && w->points < SHAPE_WAY; k++) {
            const struct shape_vertex *v = &s->run.vertex[k];
            add(w, v->point, before + v->u - s->run.vertex[0].u, v->tolerance);
            if (v->u - s->run.vertex[0].u >= half) {
                return true;
            }
        }
        return false;
    }
    const int32_t n = chords(p, half, tolerance, &step, &left);
    for (int32_t k = 1; k <= n && w->points < SHAPE_WAY; k++) {
        piece_at(p, fmin(p->length, k * step), &at);
        add(w, at.point, before + k * step, left);
    }
    return n > 0;
}

/* A quintic that takes `half` of either side. The numbers of the pieces that it cuts, and where. */
static bool attempt(struct shape *s, double half, double tolerance, struct piece *p,
                    int64_t cut[2], double at[2])
{
    struct shape_way way;
    struct piece_state a, b;

    cut[0] = s->corner_made - 1;
    cut[1] = s->corner_made;
    at[0] = shape_made(s, cut[0])->length - half;
    while (at[0] < 0.0) {
        cut[0]--;
        at[0] += shape_made(s, cut[0])->length;
    }
    at[1] = half;
    while (at[1] > shape_made(s, cut[1])->length) {
        at[1] -= shape_made(s, cut[1])->length;
        cut[1]++;
    }
    const struct piece *x = shape_made(s, cut[0]), *y = shape_made(s, cut[1]);
    const double more = x->kind == PIECE_CURVE ? fmax(0.0, SLIVER * x->length - at[0]) : 0.0;
    const double less = y->kind == PIECE_CURVE
        ? fmax(0.0, at[1] - (1.0 - SLIVER) * y->length) : 0.0;
    at[0] += more;
    at[1] -= less;
    way.points = 0;
    if (!(half - more > 0.0 && half - less > 0.0) || !way_before(s, half - more, &way)
        || !way_behind(s, half - more, half - less, tolerance, &way)) {
        return false;
    }
    piece_at(x, at[0], &a);
    piece_at(y, at[1], &b);
    return shape_join(p, &a, &b, 2.0 * half - more - less, &way);
}

/* Puts the curve in the place of what it cuts off. */
static void insert(struct shape *s, const struct piece *p, const int64_t cut[2],
                   const double at[2])
{
    struct piece behind[SHAPE_SPANS];
    int32_t n = 0;

    for (int64_t k = cut[1]; k < s->made; k++) {
        behind[n++] = *shape_made(s, k);
    }
    const double length = behind[0].length;
    const bool left = at[1] < length;
    if (left) {
        shape_cut(&behind[0], at[1], length);
    }
    s->made = cut[0];
    if (at[0] > 0.0) {
        shape_cut(shape_made(s, cut[0]), 0.0, at[0]);
        s->made++;
    }
    *shape_made(s, s->made) = *p;
    s->made++;
    s->stretch = s->made;
    for (int32_t k = left ? 0 : 1; k < n; k++) {
        *shape_made(s, s->made) = behind[k];
        s->made++;
    }
}

void shape_corner_round(struct shape *s, double tolerance)
{
    struct piece *a = shape_made(s, s->corner_made - 1), *b = shape_made(s, s->corner_made);
    struct piece_state in, out;
    double turn = 0.0, bend = 0.0, before = 0.0, behind = 0.0, kin = 0.0, kout = 0.0;

    s->corner = false;
    if (s->corner_made == 0) {
        return;     /* nothing before it: the chain begins here */
    }
    piece_at(a, a->length, &in);
    piece_at(b, 0.0, &out);
    for (int i = 0; i < AXES; i++) {
        turn += (out.slope[i] - in.slope[i]) * (out.slope[i] - in.slope[i]);
        bend += (out.bend[i] - in.bend[i]) * (out.bend[i] - in.bend[i]);
        kin += in.bend[i] * in.bend[i];
        kout += out.bend[i] * out.bend[i];
    }
    turn = sqrt(turn);
    kin = sqrt(kin);
    kout = sqrt(kout);
    if (turn <= SAME && sqrt(bend) <= SAME) {
        s->stretch = s->corner_stretch;
        return;
    }
    for (int64_t k = s->corner_made - 1; k >= s->corner_stretch && k >= s->corner_made - SHAPE_HELD;
         k--) {
        before += shape_made(s, k)->length;
    }
    for (int64_t k = s->corner_made; k < s->made && k < s->corner_made + SHAPE_HELD; k++) {
        behind += 0.5 * shape_made(s, k)->length;
    }
    const double of_a = a->kind == PIECE_CURVE && s->tail_points > 0
        ? s->tail_tolerance[s->tail_points - 1] : s->corner_tolerance;
    const double of_b = b->kind == PIECE_CURVE ? s->run.vertex[1].tolerance : tolerance;
    const double p = CUT * turn, q = CUT_CURVED * (kin + kout), most = fmin(of_a, of_b);
    double half = 2.0 * most / (p + sqrt(p * p + 4.0 * q * most));
    half = fmin(FIRST * half, fmin(before * (1.0 - 1e-9), behind));
    half = a->kind != PIECE_LINE && a->kind != PIECE_CURVE ? fmin(half, ARC / kin) : half;
    half = b->kind != PIECE_LINE && b->kind != PIECE_CURVE ? fmin(half, ARC / kout) : half;
    for (int k = 0; k < ATTEMPTS && turn < BACK && half > LEAST; k++, half *= SHORTER) {
        struct piece curve = { .feed = a->feed, .cap = a->cap, .ramp = a->ramp };
        int64_t cut[2];
        double at[2];
        if (attempt(s, half, tolerance, &curve, cut, at)) {
            for (int64_t n = cut[0]; n <= cut[1]; n++) {
                const struct piece *x = shape_made(s, n);
                shape_obey(&curve, x->feed, x->cap, &x->ramp);
            }
            insert(s, &curve, cut, at);
            return;
        }
    }
    a->rest = true;
}
