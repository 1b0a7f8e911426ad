#include "segment_arc.h"

#include <math.h>
#include <string.h>

#include "bernstein.h"
#include "el_extremes.h"

enum { DEGREE = SEGMENT_POINTS - 1 };

/* A cubic in X Y Z; U V W follow evenly with its length. */
static void cubic_at(const struct segment *p, double u, struct segment_state *s)
{
    const struct path *c = &p->path;
    const double way = p->from + u;

    memset(s->bend, 0, sizeof s->bend);
    for (int i = 3; i < AXES; i++) {
        s->slope[i] = (c->end[i] - c->start[i]) / c->length;
        s->point[i] = way < c->length ? c->start[i] + way * s->slope[i] : c->end[i];
    }
    bezier_frame(&c->bezier, c->start, c->end, c->length, way, s->point, s->slope, s->bend);
}

/* De Casteljau, from 0: the last three, two and one give r'', r' and r. */
static void curve_at(const struct segment *p, double u, struct segment_state *s)
{
    const double t = u / p->length, per = DEGREE / p->length, both = per * (DEGREE - 1) / p->length;
    const bool end = !(t < 1.0);

    for (int i = 0; i < AXES; i++) {
        const double c1 = p->control[1][i], c2 = p->control[2][i], c3 = p->control[3][i];
        const double c4 = p->control[4][i], c5 = p->control[5][i];
        if (c1 == 0.0 && c2 == 0.0 && c3 == 0.0 && c4 == 0.0 && c5 == 0.0) {
            s->point[i] = p->origin[i];
            s->slope[i] = s->bend[i] = 0.0;
            continue;
        }
        const double d0 = t * c1, d1 = c1 + t * (c2 - c1), d2 = c2 + t * (c3 - c2);
        const double d3 = c3 + t * (c4 - c3), d4 = c4 + t * (c5 - c4);
        const double e0 = d0 + t * (d1 - d0), e1 = d1 + t * (d2 - d1);
        const double e2 = d2 + t * (d3 - d2), e3 = d3 + t * (d4 - d3);
        const double f0 = e0 + t * (e1 - e0), f1 = e1 + t * (e2 - e1), f2 = e2 + t * (e3 - e2);
        const double a = f1 - f0, b = f2 - f1, slope = a + t * (b - a);
        s->bend[i] = both * (b - a);
        s->slope[i] = per * slope;
        s->point[i] = p->origin[i] + (end ? c5 : f0 + t * a + t * slope);
    }
}

void segment_at(const struct segment *p, double u, struct segment_state *s)
{
    if (p->kind == SEGMENT_ARC) {
        segment_arc_at(p, u, s);
    } else if (p->kind == SEGMENT_CURVE) {
        curve_at(p, u, s);
    } else if (p->kind == SEGMENT_CUBIC) {
        cubic_at(p, u, s);
    } else {
        for (int i = 0; i < AXES; i++) {
            s->point[i] = p->start[i] + p->slope[i] * u;
            s->slope[i] = p->slope[i];
            s->bend[i] = 0.0;
        }
    }
}

void segment_between(struct segment *p, const struct segment_state *a,
                     const struct segment_state *b, double length)
{
    const double fifth = length / 5.0, second = length * length / 20.0;

    p->kind = SEGMENT_CURVE;
    p->length = length;
    for (int i = 0; i < AXES; i++) {
        const double chord = b->point[i] - a->point[i];
        p->origin[i] = a->point[i];
        p->control[0][i] = 0.0;
        p->control[1][i] = fifth * a->slope[i];
        p->control[2][i] = 2.0 * fifth * a->slope[i] + second * a->bend[i];
        p->control[3][i] = chord - 2.0 * fifth * b->slope[i] + second * b->bend[i];
        p->control[4][i] = chord - fifth * b->slope[i];
        p->control[5][i] = chord;
    }
}

/* From the middle r' and r'' change by at most half the length times a bound of r'' and r'''. */
static void cubic_bounds(const struct segment *p, double from, double to, struct segment_bounds *b)
{
    const struct path *c = &p->path;
    const double half = 0.5 * (to - from);
    struct segment_state s[2], middle;

    b->most[0] = 1.0;
    bezier_most(&c->bezier, c->start, c->end, c->length, p->from + from, p->from + to, &b->most[1],
                &b->most[2]);
    cubic_at(p, from, &s[0]);
    cubic_at(p, from + half, &middle);
    cubic_at(p, to, &s[1]);
    for (int i = 0; i < AXES; i++) {
        const double turn = i < 3 ? half * b->most[1] : 0.0, bend = i < 3 ? b->most[1] : 0.0;
        const double twist = i < 3 ? b->most[2] : 0.0;
        b->low[0][i] = middle.slope[i] - turn;
        b->high[0][i] = middle.slope[i] + turn;
        b->low[1][i] = el_max(-bend, middle.bend[i] - half * twist);
        b->high[1][i] = el_min(bend, middle.bend[i] + half * twist);
        b->low[2][i] = -twist;
        b->high[2][i] = twist;
        for (int k = 0; k < 2; k++) {
            b->slope[k][i] = s[k].slope[i];
            b->bend[k][i] = s[k].bend[i];
        }
        b->axis[b->axes] = i;
        b->axes += i < 3 || middle.slope[i] != 0.0;
    }
}

static void line_bounds(const struct segment *p, struct segment_bounds *b)
{
    double square[2] = { 0.0, 0.0 }; /* of |r'| in X Y Z, in U V W */

    for (int i = 0; i < AXES; i++) {
        b->low[0][i] = b->high[0][i] = b->slope[0][i] = b->slope[1][i] = p->slope[i];
        b->axis[b->axes] = i;
        b->axes += p->slope[i] != 0.0;
        square[i >= 3] += p->slope[i] * p->slope[i];
    }
    b->most[0] = sqrt(square[square[0] <= 0.0]);
}

/* Bounds of the n-th derivative, from its control values. */
static inline void hull_bounds(const struct segment_hull *h, int n, struct segment_bounds *b)
{
    const int last = DEGREE - n, first = h->axis[0] < 3 ? 0 : 3;
    double square[SEGMENT_POINTS] = { 0.0 }, most = 0.0;

    for (int i = 0; i < h->axes; i++) {
        const double *c = h->control[i][n - 1];
        const int axis = h->axis[i];
        double low = c[0], high = c[0];
        for (int k = 1; k <= last; k++) {
            low = c[k] < low ? c[k] : low;
            high = c[k] > high ? c[k] : high;
        }
        b->low[n - 1][axis] = low;
        b->high[n - 1][axis] = high;
        if (axis < first + 3) {
            for (int k = 0; k <= last; k++) {
                square[k] += c[k] * c[k];
            }
        }
    }
    for (int k = 0; k <= last; k++) {
        most = square[k] > most ? square[k] : most;
    }
    b->most[n - 1] = sqrt(most);
}

static void curve_bounds(const struct segment_hull *h, struct segment_bounds *b)
{
    b->axes = h->axes;
    hull_bounds(h, 1, b);
    hull_bounds(h, 2, b);
    hull_bounds(h, 3, b);
    for (int i = 0; i < h->axes; i++) {
        const int axis = b->axis[i] = h->axis[i];
        b->slope[0][axis] = h->control[i][0][0];
        b->slope[1][axis] = h->control[i][0][DEGREE - 1];
        b->bend[0][axis] = h->control[i][1][0];
        b->bend[1][axis] = h->control[i][1][DEGREE - 2];
    }
}

void segment_rest_start(struct segment_rest *r, const struct segment *p)
{
    const double one = DEGREE / p->length, two = one * (DEGREE - 1) / p->length;
    const double three = two * (DEGREE - 2) / p->length;
    struct segment_hull *h = &r->hull;

    r->segment = p;
    r->from = 0.0;
    h->axes = h->axis[0] = 0;
    for (int i = 0; p->kind == SEGMENT_CURVE && i < AXES; i++) {
        const double c1 = p->control[1][i], c2 = p->control[2][i], c3 = p->control[3][i];
        const double c4 = p->control[4][i], c5 = p->control[5][i];
        if (c1 == 0.0 && c2 == 0.0 && c3 == 0.0 && c4 == 0.0 && c5 == 0.0) {
            continue;
        }
        double(*d)[SEGMENT_POINTS - 1] = h->control[h->axes];
        const double d1 = c2 - c1, d2 = c3 - c2, d3 = c4 - c3, d4 = c5 - c4;
        const double e0 = d1 - c1, e1 = d2 - d1, e2 = d3 - d2, e3 = d4 - d3;
        d[0][0] = one * c1;
        d[0][1] = one * d1;
        d[0][2] = one * d2;
        d[0][3] = one * d3;
        d[0][4] = one * d4;
        d[1][0] = two * e0;
        d[1][1] = two * e1;
        d[1][2] = two * e2;
        d[1][3] = two * e3;
        d[2][0] = three * (e1 - e0);
        d[2][1] = three * (e2 - e1);
        d[2][2] = three * (e3 - e2);
        h->axis[h->axes++] = i;
    }
}

/* `before` gets the hull of the part before `to`; the rest keeps that of the part behind it. */
static void cut(struct segment_rest *r, double to, struct segment_hull *before)
{
    const double t = (to - r->from) / (r->segment->length - r->from);
    struct segment_hull *h = &r->hull;

    before->axes = h->axes;
    for (int i = 0; i < h->axes; i++) {
        before->axis[i] = h->axis[i];
        for (int n = 0; n < SEGMENT_DERIVATIVES; n++) {
            bernstein_cut(h->control[i][n], DEGREE - 1 - n, t, before->control[i][n]);
        }
    }
    r->from = to;
}

static void bounds(const struct segment *p, double from, double to, const struct segment_hull *h,
                   struct segment_bounds *b)
{
    memset(b, 0, sizeof *b);
    if (p->kind == SEGMENT_CURVE) {
        curve_bounds(h, b);
    } else if (p->kind == SEGMENT_ARC) {
        segment_arc_bounds(p, from, to, b);
    } else if (p->kind == SEGMENT_CUBIC) {
        cubic_bounds(p, from, to, b);
    } else {
        line_bounds(p, b);
    }
}

void segment_rest_bounds(const struct segment_rest *r, struct segment_bounds *b)
{
    bounds(r->segment, r->from, r->segment->length, &r->hull, b);
}

void segment_rest_cut(struct segment_rest *r, double to, struct segment_bounds *b)
{
    const double from = r->from;
    struct segment_hull before;

    if (r->segment->kind == SEGMENT_CURVE && to < r->segment->length) {
        cut(r, to, &before);
        bounds(r->segment, from, to, &before, b);
    } else {
        bounds(r->segment, from, to, &r->hull, b);
        r->from = to;
    }
}

void segment_bounds(const struct segment *p, double from, double to, struct segment_bounds *b)
{
    struct segment_hull before;
    struct segment_rest r;

    segment_rest_start(&r, p);
    if (p->kind == SEGMENT_CURVE && from > 0.0) {
        cut(&r, from, &before);
    }
    r.from = from;
    segment_rest_cut(&r, to, b);
}
