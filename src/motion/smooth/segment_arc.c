#include "segment_arc.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"
#include "elementary.h"

static const double TURN = 6.283185307179586;

void segment_arc_at(const struct segment *p, double u, struct segment_state *s)
{
    const struct path *a = &p->path;
    const double part = (p->from + u) / a->length, per = a->sweep / a->length;

    path_at(a, p->from + u, s->point, s->slope);
    memset(s->bend, 0, sizeof s->bend);
    if (a->plane == PATH_TILTED) {
        for (int i = 0; i < 3; i++) {
            s->bend[i] = -per * per * (s->point[i] - a->middle[i]);
        }
        return;
    }
    /* second derivative of (radius + growth part) (cos, sin) of an angle that runs evenly */
    const int x = path_first(a->plane), y = path_second(a->plane);
    const double r = a->radius + a->growth * part;
    const double twice = r > 0.0 ? 2.0 * per * a->growth / (a->length * r) : 0.0;
    const double from[2] = { s->point[x] - a->centre[0], s->point[y] - a->centre[1] };
    s->bend[x] = -per * per * from[0] - twice * from[1];
    s->bend[y] = -per * per * from[1] + twice * from[0];
}

struct range {
    double low, high;
};

static struct range span(double a, double b)
{
    return a < b ? (struct range){ a, b } : (struct range){ b, a };
}

static struct range minus(struct range r)
{
    return (struct range){ -r.high, -r.low };
}

/* Range of the product of r with a factor between a and b. */
static struct range times(struct range r, double a, double b)
{
    const struct range low = span(r.low * a, r.low * b), high = span(r.high * a, r.high * b);
    return (struct range){ low.low < high.low ? low.low : high.low,
                           low.high > high.high ? low.high : high.high };
}

/* Part of an arc: its place in the plane is radius (cos, sin), or that without the radius on two
 * vectors of a tilted one. */
struct part {
    double angle;             /* [rad] by which it turns, >= 0 */
    double radius[2], growth; /* [mm] at both ends, and its change in each mm of the parameter */
    double per;               /* [rad/mm] */
    double cos[2], sin[2];    /* of the angles at both ends */
};

/* Range of an oscillation up to `most` in the part. a, b: its values at both ends; from, to: its
 * slopes there. */
static struct range swing(const struct part *t, double a, double b, double from, double to,
                          double most)
{
    const bool wide = t->angle >= 0.5 * TURN;
    struct range r = span(a, b);

    if (wide ? t->angle >= TURN || !(from < 0.0 && to > 0.0) : from >= 0.0 && to <= 0.0) {
        r.high = most;
    }
    if (wide ? t->angle >= TURN || !(from > 0.0 && to < 0.0) : from <= 0.0 && to >= 0.0) {
        r.low = -most;
    }
    return r;
}

/* Derivatives of (radius + growth u) (x cos + y sin); a quarter turn adds to the angle with each.
 */
static void turn_bounds(struct segment_bounds *b, int axis, const struct part *t, double x,
                        double y)
{
    const double most = x == 0.0 || y == 0.0 ? fabs(x + y) : sqrt(x * x + y * y);
    const double sign = t->per < 0.0 ? -1.0 : 1.0;
    double e[2], f[2], power = 1.0; /* per^(n - 1) */

    for (int i = 0; i < 2; i++) {
        e[i] = x * t->cos[i] + y * t->sin[i];
        f[i] = y * t->cos[i] - x * t->sin[i];
        b->slope[i][axis] = t->radius[i] * t->per * f[i] + t->growth * e[i];
        b->bend[i][axis] = t->per * (2.0 * t->growth * f[i] - t->radius[i] * t->per * e[i]);
    }
    const struct range c = swing(t, e[0], e[1], sign * f[0], sign * f[1], most);
    const struct range d = swing(t, f[0], f[1], -sign * e[0], -sign * e[1], most);
    const struct range cycle[4] = { c, d, minus(c), minus(d) };
    for (int n = 1; n <= SEGMENT_DERIVATIVES; n++) {
        const double scale = power * t->per, side = n * power * t->growth;
        const struct range turned = times(cycle[n], scale * t->radius[0], scale * t->radius[1]);
        const struct range grown = times(cycle[n - 1], side, side);
        b->low[n - 1][axis] = turned.low + grown.low;
        b->high[n - 1][axis] = turned.high + grown.high;
        power *= t->per;
    }
}

/* Bounds of axes that follow evenly: their slope is constant. */
static void even_bounds(const struct path *a, struct segment_bounds *b)
{
    for (int i = 0; i < AXES; i++) {
        b->low[0][i] = b->high[0][i] = b->slope[0][i] = b->slope[1][i] =
            (a->end[i] - a->start[i]) / a->length;
    }
}

static void look_at_axes(struct segment_bounds *b)
{
    for (int i = 0; i < AXES; i++) {
        b->axis[b->axes] = i;
        b->axes += b->low[0][i] != 0.0 || b->high[0][i] != 0.0;
    }
}

void segment_arc_bounds(const struct segment *p, double from, double to, struct segment_bounds *b)
{
    const struct path *a = &p->path;
    const bool tilted = a->plane == PATH_TILTED;
    const double u[2] = { p->from + from, p->from + to };
    double along = 0.0; /* slope along the arc's axis, a part of |r'| */
    struct part t = { .angle = fabs(a->sweep) * (to - from) / a->length,
                      .growth = tilted ? 0.0 : a->growth / a->length,
                      .per = a->sweep / a->length };

    for (int i = 0; i < 2; i++) {
        const double angle = (tilted ? 0.0 : a->angle) + t.per * u[i];
        t.radius[i] = tilted ? 1.0 : a->radius + t.growth * u[i];
        const struct el_turn turn = el_sincos(angle);
        t.cos[i] = turn.cosine;
        t.sin[i] = turn.sine;
    }
    even_bounds(a, b);
    double most = el_max(fabs(t.radius[0]), fabs(t.radius[1]));
    if (tilted) {
        double x[3], y[3];
        for (int i = 0; i < 3; i++) {
            x[i] = a->start[i] - a->middle[i];
        }
        for (int i = 0; i < 3; i++) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            y[i] = a->normal[j] * x[k] - a->normal[k] * x[j];
            turn_bounds(b, i, &t, x[i], y[i]);
        }
        most = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    } else {
        turn_bounds(b, path_first(a->plane), &t, 1.0, 0.0);
        turn_bounds(b, path_second(a->plane), &t, 0.0, 1.0);
        along = b->slope[0][a->plane];
    }
    look_at_axes(b);
    const double side = t.per * most, grown = t.growth;
    b->most[0] = sqrt(side * side + grown * grown + along * along);
    b->most[1] = fabs(t.per) * sqrt(side * side + 4.0 * grown * grown);
    b->most[2] = t.per * t.per * sqrt(side * side + 9.0 * grown * grown);
}
