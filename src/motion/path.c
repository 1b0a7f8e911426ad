#include "path.h"

#include <math.h>
#include <string.h>

static const double TAU = 6.283185307179586;

/* Radius tolerance of the part program: E1 of the facts, as LinuxCNC has it. [mm] */
static const double MISS_MAX = 0.5;         /* refused whatever the radius */
static const double MISS_MIN = 0.005;       /* accepted whatever the radius */
static const double MISS_RATIO = 1e-3;      /* of the radius, in between */

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

static double norm3(const double a[3])
{
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
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
    const int a = path_first(plane), b = path_second(plane), n = (int)plane;
    const double sa = start[a] - centre[0], sb = start[b] - centre[1];
    const double ea = end[a] - centre[0], eb = end[b] - centre[1];
    const double r0 = hypot(sa, sb), r1 = hypot(ea, eb);

    *miss = fabs(r1 - r0);
    if (r0 == 0.0 || r1 == 0.0) {
        return PATH_NO_RADIUS;
    }
    if (*miss > MISS_MAX || (*miss > MISS_MIN && *miss > MISS_RATIO * r0)) {
        return PATH_MISSES_END;
    }
    path_line(p, start, end);
    p->arc = true;
    p->plane = plane;
    p->centre[0] = centre[0];
    p->centre[1] = centre[1];
    p->radius = r0;
    p->growth = r1 - r0;
    p->angle = atan2(sb, sa);
    double turn = atan2(sa * eb - sb * ea, sa * ea + sb * eb);  /* -pi..pi, ccw positive */
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
    return p->length > 0.0 ? PATH_OK : PATH_NO_RADIUS;     /* its square is 0 */
}

enum path_status path_centre_by_radius(enum path_plane plane, const double start[AXES],
                                       const double end[AXES], double r, bool ccw,
                                       double centre[2], double *half)
{
    const int a = path_first(plane), b = path_second(plane);
    const double da = end[a] - start[a], db = end[b] - start[b];
    const double chord = hypot(da, db);

    *half = 0.5 * chord;
    if (chord == 0.0) {
        return PATH_OPEN;
    }
    if (r == 0.0) {
        return PATH_NO_RADIUS;
    }
    if (*half - fabs(r) > MISS_MIN) {
        return PATH_SHORT_RADIUS;
    }
    /* The centre lies on the perpendicular bisector: left of the way for a ccw arc of less than
     * half a turn. A radius short of half the chord by the rounding of the program: half turn. */
    const double rise = sqrt(fmax(0.0, r * r - *half * *half));
    const double side = (ccw == (r > 0.0) ? rise : -rise) / chord;
    centre[0] = start[a] + 0.5 * da - side * db;
    centre[1] = start[b] + 0.5 * db + side * da;
    return PATH_OK;
}

enum path_status path_centre_by_point(enum path_plane plane, const double start[AXES],
                                      const double via[2], const double end[AXES],
                                      double centre[2], bool *ccw)
{
    const double xa = via[0] - start[path_first(plane)], xb = via[1] - start[path_second(plane)];
    const double ya = end[path_first(plane)] - start[path_first(plane)];
    const double yb = end[path_second(plane)] - start[path_second(plane)];
    const double cross = xa * yb - xb * ya;     /* twice the area of the triangle */
    const double xx = xa * xa + xb * xb, yy = ya * ya + yb * yb;

    if (!(fabs(cross) > 1e-12 * (xx + yy))) {   /* flatter than rounding: radius unknown */
        return PATH_OPEN;
    }
    centre[0] = start[path_first(plane)] + (xx * yb - yy * xb) / (2.0 * cross);
    centre[1] = start[path_second(plane)] + (yy * xa - xx * ya) / (2.0 * cross);
    *ccw = cross > 0.0;
    return PATH_OK;
}

void path_at(const struct path *p, double s, double point[AXES], double slope[AXES])
{
    const double part = p->length > 0.0 ? s / p->length : 1.0;
    const double per = p->length > 0.0 ? 1.0 / p->length : 0.0;     /* d(part)/ds [1/mm] */

    for (int i = 0; i < AXES; i++) {
        const double way = p->end[i] - p->start[i];
        point[i] = part >= 1.0 ? p->end[i] : p->start[i] + way * part;
        slope[i] = way * per;
    }
    if (p->arc) {
        const int a = path_first(p->plane), b = path_second(p->plane);
        const double angle = p->angle + p->sweep * part;
        const double c = cos(angle), d = sin(angle), r = p->radius + p->growth * part;
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
    if (p->arc && axis < 3 && axis != (int)p->plane) {
        const double r = p->radius + 0.5 * p->growth;
        return fmin(1.0, (fabs(r * p->sweep) + fabs(p->growth)) / p->length);
    }
    return fabs(p->end[axis] - p->start[axis]) / p->length;
}

double path_bend(const struct path *p)
{
    if (!p->arc) {
        return 0.0;
    }
    const double per = p->sweep / p->length;    /* [rad/mm] */
    return fmax(p->radius, p->radius + p->growth) * per * per;
}

/* Coordinate along an axis of the arc's plane where it turns back near a cosine of +1 or -1: the
 * k-th half turn of the angle from that axis. With r growing over the sweep, d/dt (r cos w) = 0 at
 * tan w = growth / (r sweep). Held within the parts t0 .. t1 of the way. [mm] */
static double turning(const struct path *p, int axis, int k, double t0, double t1)
{
    const bool second = axis != path_first(p->plane);
    const double angle = p->angle - (second ? TAU / 4.0 : 0.0);
    double t = (k * TAU / 2.0 - angle) / p->sweep;

    t += atan(p->growth / ((p->radius + p->growth * t) * p->sweep)) / p->sweep;
    t = fmax(t0, fmin(t1, t));
    return p->centre[second] + (p->radius + p->growth * t) * cos(angle + p->sweep * t);
}

/* Half turns between two angles, the first and last ones, for between them nothing is further. */
static void turnings(const struct path *p, int axis, double t0, double t1, double *low,
                     double *high)
{
    const double angle = p->angle - (axis == path_first(p->plane) ? 0.0 : TAU / 4.0);
    const double a = (angle + p->sweep * t0) / (TAU / 2.0);
    const double b = (angle + p->sweep * t1) / (TAU / 2.0);
    const int first = (int)floor(fmin(a, b)), last = (int)ceil(fmax(a, b));

    for (int k = first; k <= last; k = k == first + 2 && last - 2 > k ? last - 2 : k + 1) {
        const double x = turning(p, axis, k, t0, t1);
        *low = fmin(*low, x);
        *high = fmax(*high, x);
    }
}

void path_extent(const struct path *p, int axis, double from, double to, double *low,
                 double *high)
{
    double a[AXES], b[AXES], slope[AXES];

    path_at(p, from, a, slope);
    path_at(p, to, b, slope);
    *low = fmin(a[axis], b[axis]);
    *high = fmax(a[axis], b[axis]);
    if (p->arc && axis < 3 && axis != (int)p->plane) {
        turnings(p, axis, from / p->length, to / p->length, low, high);
    }
}
