#include "path.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"
#include "elementary.h"

static const double TAU = 6.283185307179586;

/* An arc may miss its end by so much if nothing else is said: rounding at 3 decimals of a mm. */
static const struct path_tolerance TIGHT = { 0.005, 1e-3 };
static const double MISS_MAX = 100.0; /* times the least: more is refused at any radius */

/* An end nearer to the start than this angle means a full circle: 0.1 um at a radius of 100 mm,
 * less than a pulse, so no program can mean the tiny arc. [rad] */
static const double CLOSED = 1e-6;

int path_first(enum path_plane p)
{
    return p == PATH_XY ? 0 : p == PATH_YZ ? 1 : 2;
}

int path_second(enum path_plane p)
{
    return (path_first(p) + 1) % 3;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double norm3(const double a[3])
{
    return sqrt(dot(a, a));
}

static void cross(const double a[3], const double b[3], double c[3])
{
    for (int i = 0; i < 3; i++) {
        c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    }
}

/* Axes of a tilted arc: from the centre to the start, and a quarter turn on. [mm] */
static void tilted_axes(const struct path *p, double a[3], double b[3])
{
    for (int i = 0; i < 3; i++) {
        a[i] = p->start[i] - p->middle[i];
    }
    cross(p->normal, a, b);
}

void path_line(struct path *p, const double start[AXES], const double end[AXES])
{
    double way[AXES];
    memset(p, 0, sizeof *p);
    memcpy(p->start, start, sizeof p->start);
    memcpy(p->end, end, sizeof p->end);
    for (int i = 0; i < AXES; i++) {
        way[i] = end[i] - start[i];
    }
    p->length = norm3(way);
    if (p->length == 0.0) {
        p->length = norm3(way + 3);
    }
}

enum path_status path_arc(struct path *p, enum path_plane plane, const double start[AXES],
                          const double end[AXES], const double centre[2], bool ccw, int turns,
                          double *miss)
{
    return path_arc_within(p, plane, start, end, centre, ccw, turns, &TIGHT, miss);
}

enum path_status path_arc_within(struct path *p, enum path_plane plane, const double start[AXES],
                                 const double end[AXES], const double centre[2], bool ccw,
                                 int turns, const struct path_tolerance *t, double *miss)
{
    const int a = path_first(plane), b = path_second(plane), n = (int)plane;
    const double sa = start[a] - centre[0], sb = start[b] - centre[1];
    const double ea = end[a] - centre[0], eb = end[b] - centre[1];
    const double r0 = el_hypot(sa, sb), r1 = el_hypot(ea, eb);

    *miss = fabs(r1 - r0);
    if (r0 == 0.0 || r1 == 0.0) {
        return PATH_NO_RADIUS;
    }
    if (*miss > MISS_MAX * t->least || (*miss > t->least && *miss > t->share * el_max(r0, r1))) {
        return PATH_MISSES_END;
    }
    path_line(p, start, end);
    p->arc = true;
    p->plane = plane;
    p->centre[0] = centre[0];
    p->centre[1] = centre[1];
    p->radius = r0;
    p->growth = r1 - r0;
    p->angle = el_atan2(sb, sa);
    double turn = el_atan2(sa * eb - sb * ea, sa * ea + sb * eb); /* -pi..pi, ccw positive */
    if (!ccw) {
        turn = -turn;
    }
    if (fabs(turn) < CLOSED) {
        turn += TAU;
    } else if (turn < 0.0) {
        turn += TAU;
    }
    turn += TAU * (turns - 1);
    p->sweep = ccw ? turn : -turn;
    const double way[3] = { (r0 + 0.5 * p->growth) * p->sweep, p->growth, end[n] - start[n] };
    p->length = norm3(way);
    return p->length > 0.0 ? PATH_OK : PATH_NO_RADIUS; /* 0: its square underflows */
}

enum path_status path_tilted(struct path *p, const double start[AXES], const double end[AXES],
                             const double middle[3], const double normal[3], double sweep)
{
    double a[3], b[3];

    path_line(p, start, end);
    p->arc = true;
    p->plane = PATH_TILTED;
    memcpy(p->middle, middle, sizeof p->middle);
    memcpy(p->normal, normal, sizeof p->normal);
    p->sweep = sweep;
    tilted_axes(p, a, b);
    p->radius = norm3(a);
    p->length = p->radius * fabs(sweep);
    if (!(p->length > 0.0)) {
        return PATH_NO_RADIUS;
    }
    const struct el_turn t = el_sincos(sweep);
    for (int i = 0; i < 3; i++) {
        p->end[i] = p->middle[i] + (t.cosine * a[i] + t.sine * b[i]);
    }
    return PATH_OK;
}

enum path_status path_tilted_by_point(const double start[3], const double via[3],
                                      const double end[3], double middle[3], double normal[3],
                                      double *sweep)
{
    double x[3], y[3], n[3], xn[3], ny[3], a[3], b[3];

    for (int i = 0; i < 3; i++) {
        x[i] = via[i] - start[i];
        y[i] = end[i] - start[i];
    }
    cross(x, y, n);
    const double xx = dot(x, x), yy = dot(y, y), nn = dot(n, n), twice = sqrt(nn);
    if (!(twice > 1e-12 * (xx + yy))) { /* flatter than rounding: radius unknown */
        return PATH_OPEN;
    }
    /* The middle lies at (|x|^2 (y x n) + |y|^2 (n x x)) / (2 |n|^2) from the start. */
    cross(y, n, ny);
    cross(n, x, xn);
    for (int i = 0; i < 3; i++) {
        middle[i] = start[i] + (xx * ny[i] + yy * xn[i]) / (2.0 * nn);
        normal[i] = n[i] / twice;
        a[i] = start[i] - middle[i];
        x[i] = end[i] - middle[i];
    }
    cross(normal, a, b);
    *sweep = el_atan2(dot(x, b), dot(x, a));
    *sweep += *sweep <= 0.0 ? TAU : 0.0;
    return PATH_OK;
}

enum path_status path_centre_by_radius(enum path_plane plane, const double start[AXES],
                                       const double end[AXES], double r, bool ccw, double tolerance,
                                       double centre[2], double *half)
{
    const int a = path_first(plane), b = path_second(plane);
    const double da = end[a] - start[a], db = end[b] - start[b];
    const double chord = el_hypot(da, db);

    *half = 0.5 * chord;
    if (chord == 0.0) {
        return PATH_OPEN;
    }
    if (r == 0.0) {
        return PATH_NO_RADIUS;
    }
    if (*half - fabs(r) > tolerance) {
        return PATH_SHORT_RADIUS;
    }
    /* The centre lies on the perpendicular bisector: left of the way for a ccw arc of less than
     * half a turn. A radius short of half the chord by the rounding of the program: half turn. */
    const double rise = sqrt(el_max(0.0, r * r - *half * *half));
    const double side = (ccw == (r > 0.0) ? rise : -rise) / chord;
    centre[0] = start[a] + 0.5 * da - side * db;
    centre[1] = start[b] + 0.5 * db + side * da;
    return PATH_OK;
}

enum path_status path_centre_by_point(enum path_plane plane, const double start[AXES],
                                      const double via[2], const double end[AXES], double centre[2],
                                      bool *ccw)
{
    const double xa = via[0] - start[path_first(plane)], xb = via[1] - start[path_second(plane)];
    const double ya = end[path_first(plane)] - start[path_first(plane)];
    const double yb = end[path_second(plane)] - start[path_second(plane)];
    const double cross = xa * yb - xb * ya; /* twice the area of the triangle */
    const double xx = xa * xa + xb * xb, yy = ya * ya + yb * yb;

    if (!(fabs(cross) > 1e-12 * (xx + yy))) { /* flatter than rounding: radius unknown */
        return PATH_OPEN;
    }
    centre[0] = start[path_first(plane)] + (xx * yb - yy * xb) / (2.0 * cross);
    centre[1] = start[path_second(plane)] + (yy * xa - xx * ya) / (2.0 * cross);
    *ccw = cross > 0.0;
    return PATH_OK;
}

/* Whether all control points lie on the line from start to end, one after the other. */
static bool straight(const double start[3], const double end[3], const double inner[2][3])
{
    double chord[3], way[3], off[3], reached = 0.0;

    for (int i = 0; i < 3; i++) {
        chord[i] = end[i] - start[i];
    }
    const double length = norm3(chord);
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 3; i++) {
            way[i] = inner[k][i] - start[i];
        }
        const double along = dot(way, chord);
        cross(chord, way, off);
        if (norm3(off) > 1e-12 * length * length || along < reached) {
            return false;
        }
        reached = along;
    }
    return reached <= length * length;
}

enum path_status path_cubic(struct path *p, const double start[AXES], const double end[AXES],
                            const double inner[2][3])
{
    path_line(p, start, end);
    if (straight(start, end, inner)) {
        return PATH_OK;
    }
    p->cubic = true;
    memcpy(p->bezier.inner, inner, sizeof p->bezier.inner);
    return bezier_make(&p->bezier, start, end, &p->length) ? PATH_OK : PATH_CUSP;
}

static void tilted_at(const struct path *p, double part, double point[AXES], double slope[AXES])
{
    const struct el_turn t = el_sincos(p->sweep * part);
    const double c = t.cosine, d = t.sine, per = p->sweep / p->length;
    double a[3], b[3];

    tilted_axes(p, a, b);
    for (int i = 0; i < 3; i++) {
        if (part < 1.0) {
            point[i] = p->middle[i] + (c * a[i] + d * b[i]);
        }
        slope[i] = (c * b[i] - d * a[i]) * per;
    }
}

void path_at(const struct path *p, double s, double point[AXES], double slope[AXES])
{
    const double part = p->length > 0.0 ? s / p->length : 1.0;
    const double per = p->length > 0.0 ? 1.0 / p->length : 0.0; /* d(part)/ds [1/mm] */

    for (int i = 0; i < AXES; i++) {
        const double way = p->end[i] - p->start[i];
        point[i] = part >= 1.0 ? p->end[i] : p->start[i] + way * part;
        slope[i] = way * per;
    }
    if (p->cubic) {
        double at[3];
        bezier_at(&p->bezier, p->start, p->end, p->length, s, at, slope);
        memcpy(point, part >= 1.0 ? p->end : at, sizeof at);
    } else if (p->arc && p->plane == PATH_TILTED) {
        tilted_at(p, part, point, slope);
    } else if (p->arc) {
        const int a = path_first(p->plane), b = path_second(p->plane);
        const struct el_turn t = el_sincos(p->angle + p->sweep * part);
        const double c = t.cosine, d = t.sine, r = p->radius + p->growth * part;
        if (part < 1.0) {
            point[a] = p->centre[0] + r * c;
            point[b] = p->centre[1] + r * d;
        }
        slope[a] = (-r * d * p->sweep + p->growth * c) * per;
        slope[b] = (r * c * p->sweep + p->growth * d) * per;
    }
}

double path_share(const struct path *p, int axis)
{
    if (p->length == 0.0) {
        return 0.0;
    }
    if (p->cubic && axis < 3) {
        return bezier_share(&p->bezier, p->start, p->end, axis);
    }
    if (p->arc && p->plane == PATH_TILTED && axis < 3) {
        double a[3], b[3];
        tilted_axes(p, a, b);
        return el_hypot(a[axis], b[axis]) * fabs(p->sweep) / p->length;
    }
    if (p->arc && axis < 3 && axis != (int)p->plane) {
        const double r = p->radius + 0.5 * p->growth;
        return el_min(1.0, (fabs(r * p->sweep) + fabs(p->growth)) / p->length);
    }
    return fabs(p->end[axis] - p->start[axis]) / p->length;
}

double path_bend(const struct path *p)
{
    if (!p->arc) {
        return p->cubic ? p->bezier.bend : 0.0;
    }
    const double per = p->sweep / p->length; /* [rad/mm] */
    return el_max(p->radius, p->radius + p->growth) * per * per;
}

double path_twist(const struct path *p)
{
    const double bend = path_bend(p);
    return p->cubic ? p->bezier.twist : bend * bend;
}

/* Coordinate along an axis of the arc's plane where it turns back near a cosine of +1 or -1: the
 * k-th half turn of the angle from that axis. With r growing over the sweep, d/dt (r cos w) = 0 at
 * tan w = growth / (r sweep). Held within the parts t0 .. t1 of the way. [mm] */
static double turning(const struct path *p, int axis, int k, double t0, double t1)
{
    const bool second = axis != path_first(p->plane);
    const double angle = p->angle - (second ? TAU / 4.0 : 0.0);
    double t = (k * TAU / 2.0 - angle) / p->sweep;

    t += el_atan(p->growth / ((p->radius + p->growth * t) * p->sweep)) / p->sweep;
    t = el_max(t0, el_min(t1, t));
    return p->centre[second] + (p->radius + p->growth * t) * el_cos(angle + p->sweep * t);
}

/* Half turns between two angles, the first and last ones, for between them nothing is further. */
static void turnings(const struct path *p, int axis, double t0, double t1, double *low,
                     double *high)
{
    const double angle = p->angle - (axis == path_first(p->plane) ? 0.0 : TAU / 4.0);
    const double a = (angle + p->sweep * t0) / (TAU / 2.0);
    const double b = (angle + p->sweep * t1) / (TAU / 2.0);
    const int first = (int)floor(el_min(a, b)), last = (int)ceil(el_max(a, b));

    for (int k = first; k <= last; k = k == first + 2 && last - 2 > k ? last - 2 : k + 1) {
        const double x = turning(p, axis, k, t0, t1);
        *low = el_min(*low, x);
        *high = el_max(*high, x);
    }
}

/* c a + d b is furthest where its angle is that of (a, b), and half a turn on. */
static void tilted_turnings(const struct path *p, int axis, double t0, double t1, double *low,
                            double *high)
{
    double a[3], b[3];

    tilted_axes(p, a, b);
    const double top = el_atan2(b[axis], a[axis]), r = el_hypot(a[axis], b[axis]);
    const double from = el_min(p->sweep * t0, p->sweep * t1);
    const double to = el_max(p->sweep * t0, p->sweep * t1);
    if (top + TAU * ceil((from - top) / TAU) <= to) {
        *high = el_max(*high, p->middle[axis] + r);
    }
    if (top + TAU * (ceil((from - top) / TAU - 0.5) + 0.5) <= to) {
        *low = el_min(*low, p->middle[axis] - r);
    }
}

/* A coordinate of a straight path. */
static double straight_at(const struct path *p, int axis, double s)
{
    const double part = p->length > 0.0 ? s / p->length : 1.0;

    return part >= 1.0 ? p->end[axis] : p->start[axis] + (p->end[axis] - p->start[axis]) * part;
}

void path_extent(const struct path *p, int axis, double from, double to, double *low, double *high)
{
    double a[AXES], b[AXES], slope[AXES];

    if (!p->arc && !p->cubic) {
        a[0] = straight_at(p, axis, from);
        b[0] = straight_at(p, axis, to);
        *low = el_min(a[0], b[0]);
        *high = el_max(a[0], b[0]);
        return;
    }
    path_at(p, from, a, slope);
    path_at(p, to, b, slope);
    *low = el_min(a[axis], b[axis]);
    *high = el_max(a[axis], b[axis]);
    if (p->cubic && axis < 3) {
        bezier_extent(&p->bezier, p->start, p->end, p->length, axis, from, to, low, high);
    } else if (p->arc && p->plane == PATH_TILTED && axis < 3) {
        tilted_turnings(p, axis, from / p->length, to / p->length, low, high);
    } else if (p->arc && axis < 3 && axis != (int)p->plane) {
        turnings(p, axis, from / p->length, to / p->length, low, high);
    }
}
