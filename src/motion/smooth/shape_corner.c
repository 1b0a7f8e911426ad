#include "shape_corner.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

/* One quintic is off the corner of two lines by CUT times its half length times the difference of
 * their directions. Where paths bend, about CUT_CURVED times the square of its half length times
 * the sum of their curvatures is added. The search for a half length begins there. */
static const double CUT = 0.1875, CUT_CURVED = 0.035;

/* Two quintics that swing out first: their middle is off the vertex by a part p of the half length
 * times half the turn. They swing out as far as they cut in at about p = SWING times the cosine of
 * half the angle (4 % less at small turns, more above 48 degrees). The search begins there. r'' in
 * the middle, in units of half the turn by the half length, is BEND + MORE_BEND (2 CUT - p), a line
 * from that of one quintic. With 8 - 20 p r''' would be 0 at the line's end, which lets the speed
 * rise on the way out; a little less swings out farther. The slope is the one with the least times.
 */
static const double SWING = 0.05, BEND = 1.5, MORE_BEND = 17.0;

/* The first attempt takes FIRST of what should fit. Each one takes SWING_SHORTER (two quintics) or
 * SHORTER (one) of the half length before it, and none less than LEAST. [mm] */
static const double FIRST = 0.99, SWING_SHORTER = 0.97, SHORTER = 0.85, LEAST = 1e-6;

enum { SWINGS = 64, ATTEMPTS = 24 };

/* A cut leaves at least this part of a curve or none: a sliver's derivatives would be rounding. */
static const double SLIVER = 0.1;

/* Directions that differ by more turn back: the curve would come to a point. */
static const double BACK = 1.98;

/* r' [1] and r'' [1/mm] that differ by less are the same. */
static const double SAME = 1e-11;

/* Part of the tolerance that a chord of an arc may take. */
static const double SAGITTA = 0.05;

/* A corner cuts no more of an arc or a cubic than this angle, by the curvature at its end. [rad] */
static const double ARC = 0.5;

struct segment *shape_made(struct shape *s, int64_t number)
{
    return &s->segment[number % SHAPE_SEGMENTS];
}

void shape_push(struct shape *s, const struct segment *p)
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
    s->corner_cut_from = s->cut_from;
    s->corner_tolerance = tolerance;
    s->cut_from = s->made;
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

/* Chords of a long segment at a corner: one of a line; of an arc equal ones over `half` and one
 * more. *left is the tolerance that they leave. Their number; 0: they leave none. */
static int32_t chords(const struct segment *p, double half, double tolerance, double *step,
                      double *left)
{
    struct segment_bounds b;

    *step = p->length;
    *left = tolerance;
    if (p->kind == SEGMENT_LINE) {
        return 1;
    }
    segment_bounds(p, 0.0, p->length, &b);
    const double most = sqrt(8.0 * SAGITTA * tolerance / b.most[1]);
    const int32_t n = (int32_t)el_min(20.0, ceil(half / most));
    *step = half / n;
    *left = tolerance - b.most[1] * *step * *step / 8.0; /* chords: |r''| h^2 / 8 off at most */
    return *left > 0.0 ? n + (p->length >= half + *step) : 0;
}

static bool way_before(struct shape *s, double half, struct shape_way *w)
{
    const struct segment *p = shape_made(s, s->corner_made - 1);
    struct segment_state at;
    double step, left;

    if (p->kind == SEGMENT_CURVE) {
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
        segment_at(p, el_max(0.0, p->length - k * step), &at);
        add(w, at.point, half - k * step, left);
    }
    return n > 0;
}

static bool way_behind(struct shape *s, double before, double half, double tolerance,
                       struct shape_way *w)
{
    const struct segment *p = shape_made(s, s->corner_made);
    struct segment_state at;
    double step, left;

    if (p->kind == SEGMENT_CURVE) {
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
        segment_at(p, el_min(p->length, k * step), &at);
        add(w, at.point, before + k * step, left);
    }
    return n > 0;
}

/* The middle of a curve that swings out and then cuts in, `part` of its half length times half the
 * turn off the vertex. Between lines r' along the bisector is constant, as in one quintic, so that
 * all else is along the normal and the same for each turn. Returns how far off it is. [mm]
 */
static double middle(const struct segment_state *in, const struct segment_state *out, double half,
                     double part, struct segment_state *m)
{
    const double bend = (BEND + MORE_BEND * (2.0 * CUT - part)) / half;
    double square = 0.0;

    for (int i = 0; i < AXES; i++) {
        const double turn = 0.5 * (out->slope[i] - in->slope[i]);
        m->point[i] = in->point[i] + part * half * turn;
        m->slope[i] = 0.5 * (in->slope[i] + out->slope[i]);
        m->bend[i] = 0.5 * (in->bend[i] + out->bend[i]) + bend * turn;
        square += turn * turn;
    }
    return part * half * sqrt(square);
}

/* Where a corner cuts: in which segment before and behind it, and where in these. [mm] */
struct cut {
    int64_t segment[2];
    double at[2];
};

/* A curve that takes `half` of either side: with part > 0 two quintics that meet `part` of the half
 * length times half the turn off the vertex, else one. Their number; 0: not within the tolerance.
 */
static int32_t attempt(struct shape *s, double half, double part, double tolerance,
                       struct segment p[2], struct cut *c)
{
    struct shape_way way = { .points = 0 };
    struct segment_state a, b, in, out, m;

    c->segment[0] = s->corner_made - 1;
    c->segment[1] = s->corner_made;
    segment_at(shape_made(s, c->segment[0]), shape_made(s, c->segment[0])->length, &in);
    segment_at(shape_made(s, c->segment[1]), 0.0, &out);
    c->at[0] = shape_made(s, c->segment[0])->length - half;
    while (c->at[0] < 0.0) {
        c->segment[0]--;
        c->at[0] += shape_made(s, c->segment[0])->length;
    }
    c->at[1] = half;
    while (c->at[1] > shape_made(s, c->segment[1])->length) {
        c->at[1] -= shape_made(s, c->segment[1])->length;
        c->segment[1]++;
    }
    const struct segment *x = shape_made(s, c->segment[0]), *y = shape_made(s, c->segment[1]);
    const double more = x->kind == SEGMENT_CURVE ? el_max(0.0, SLIVER * x->length - c->at[0]) : 0.0;
    const double less =
        y->kind == SEGMENT_CURVE ? el_max(0.0, c->at[1] - (1.0 - SLIVER) * y->length) : 0.0;
    c->at[0] += more;
    c->at[1] -= less;
    const double before = half - more, behind = half - less;
    if (!(before > 0.0 && behind > 0.0) || !way_before(s, before, &way)) {
        return 0;
    }
    segment_at(x, c->at[0], &a);
    segment_at(y, c->at[1], &b);
    if (part <= 0.0) {
        return way_behind(s, before, behind, tolerance, &way)
               && shape_join(&p[0], &a, &b, before + behind, &way);
    }
    const double off = middle(&in, &out, half, part, &m);
    if (off > way.tolerance[way.points - 1] || !shape_join(&p[0], &a, &m, before, &way)) {
        return 0;
    }
    way.points = 0;
    add(&way, in.point, 0.0, tolerance);
    return way_behind(s, 0.0, behind, tolerance, &way) && off <= way.tolerance[1]
                   && shape_join(&p[1], &m, &b, behind, &way)
               ? 2
               : 0;
}

/* Puts n segments in the place of what they cut off. */
static void insert(struct shape *s, const struct segment *p, int32_t segments, const struct cut *c)
{
    struct segment behind[SHAPE_SPANS];
    int32_t n = 0;

    for (int64_t k = c->segment[1]; k < s->made; k++) {
        behind[n++] = *shape_made(s, k);
    }
    const double length = behind[0].length;
    const bool left = c->at[1] < length;
    if (left) {
        shape_cut(&behind[0], c->at[1], length);
    }
    s->made = c->segment[0];
    if (c->at[0] > 0.0) {
        shape_cut(shape_made(s, c->segment[0]), 0.0, c->at[0]);
        s->made++;
    }
    for (int32_t k = 0; k < segments; k++) {
        *shape_made(s, s->made) = p[k];
        s->made++;
    }
    s->cut_from = s->made;
    for (int32_t k = left ? 0 : 1; k < n; k++) {
        *shape_made(s, s->made) = behind[k];
        s->made++;
    }
}

static bool is_arc(const struct segment *p)
{
    return p->kind != SEGMENT_LINE && p->kind != SEGMENT_CURVE;
}

/* Rounds the corner by such an attempt; false, and not done: it is not within the tolerance. */
static bool rounded(struct shape *s, double half, double part, double tolerance)
{
    const struct segment *a = shape_made(s, s->corner_made - 1);
    struct segment curve[2] = { { .feed = a->feed, .cap = a->cap, .ramp = a->ramp } };
    struct cut c;

    curve[1] = curve[0];
    const int32_t n = attempt(s, half, part, tolerance, curve, &c);
    if (n == 0) {
        return false;
    }
    for (int64_t k = c.segment[0]; k <= c.segment[1]; k++) {
        const struct segment *x = shape_made(s, k);
        for (int32_t i = 0; i < n; i++) {
            shape_obey(&curve[i], x->feed, x->cap, &x->ramp);
        }
    }
    insert(s, curve, n, &c);
    return true;
}

/* CCN 24: a corner is none, cannot be rounded, or is tried with ever shorter curves. */
void shape_corner_round(struct shape *s, double tolerance)
{
    struct segment *a = shape_made(s, s->corner_made - 1), *b = shape_made(s, s->corner_made);
    struct segment_state in, out;
    double turn = 0.0, bend = 0.0, before = 0.0, behind = 0.0, kin = 0.0, kout = 0.0;

    s->corner = false;
    if (s->corner_made == 0) {
        return; /* nothing before it: the chain begins here */
    }
    segment_at(a, a->length, &in);
    segment_at(b, 0.0, &out);
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
        s->cut_from = s->corner_cut_from;
        return;
    }
    for (int64_t k = s->corner_made - 1;
         k >= s->corner_cut_from && k >= s->corner_made - SHAPE_HELD; k--) {
        before += shape_made(s, k)->length;
    }
    for (int64_t k = s->corner_made; k < s->made && k < s->corner_made + SHAPE_HELD; k++) {
        behind += 0.5 * shape_made(s, k)->length;
    }
    const double of_a = a->kind == SEGMENT_CURVE && s->tail_points > 0
                            ? s->tail_tolerance[s->tail_points - 1]
                            : s->corner_tolerance;
    const double of_b = b->kind == SEGMENT_CURVE ? s->run.vertex[1].tolerance : tolerance;
    const double p = CUT * turn, q = CUT_CURVED * (kin + kout), most = el_min(of_a, of_b);
    const double plain = 2.0 * most / (p + sqrt(p * p + 4.0 * q * most));
    double room = el_min(before * (1.0 - 1e-9), behind);
    const bool arcs[2] = { is_arc(a), is_arc(b) };
    room = arcs[0] ? el_min(room, ARC / kin) : room;
    room = arcs[1] ? el_min(room, ARC / kout) : room;
    if (turn >= BACK) {
        a->rest = true;
        return;
    }
    const double off = FIRST * most * (arcs[0] || arcs[1] ? 1.0 - SAGITTA : 1.0) / (0.5 * turn);
    double half = el_min(room, off / (SWING * sqrt(1.0 - 0.25 * turn * turn)));
    for (int k = 0; k < SWINGS && half > el_max(plain, 0.5 * off / CUT) && half > LEAST;
         k++, half *= SWING_SHORTER) {
        if (rounded(s, half, off / half, tolerance)) {
            return;
        }
    }
    half = el_min(FIRST * plain, room);
    for (int k = 0; k < ATTEMPTS && half > LEAST; k++, half *= SHORTER) {
        if (rounded(s, half, 0.0, tolerance)) {
            return;
        }
    }
    a->rest = true;
}
