#include "contour_offset.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"
#include "elementary.h"

static const double TAU = 6.283185307179586;

/* Shorter is no motion, nor room for one: far below a pulse, far above rounding errors. [mm] */
static const double SHORT = 1e-9;

/* An arc about a corner that is shorter is left out. That moves the path by less than its square
 * over eight radii. [mm] */
static const double SMOOTH = 1e-5;

/* A concave corner below this angle is what rounded coordinates make of a smooth contour. The tool
 * may go back in it, and so cuts into the contour by less than 1.3e-5 of its radius. [rad] */
static const double SLIGHT = 0.01;

/* A corner nearer to half a turn than this leads back on the contour. [rad] */
static const double BACK = 1e-6;

static double dot(const double a[2], const double b[2])
{
    return a[0] * b[0] + a[1] * b[1];
}

static double cross(const double a[2], const double b[2])
{
    return a[0] * b[1] - a[1] * b[0];
}

static double distance(const double a[2], const double b[2])
{
    return el_hypot(a[0] - b[0], a[1] - b[1]);
}

static void in_plane(const double place[AXES], enum path_plane plane, double flat[2])
{
    flat[0] = place[path_first(plane)];
    flat[1] = place[path_second(plane)];
}

void contour_of(struct contour *s, const struct path *p, enum path_plane plane)
{
    memset(s, 0, sizeof *s);
    in_plane(p->start, plane, s->start);
    in_plane(p->end, plane, s->end);
    if (!p->arc) {
        const double way = distance(s->start, s->end);
        s->first[0] = s->last[0] = -(s->end[1] - s->start[1]) / way;
        s->first[1] = s->last[1] = (s->end[0] - s->start[0]) / way;
        return;
    }
    s->turn = p->sweep > 0.0 ? 1.0 : -1.0;
    memcpy(s->centre, p->centre, sizeof s->centre);
    s->radius[0] = distance(s->start, s->centre);
    s->radius[1] = distance(s->end, s->centre);
    for (int i = 0; i < 2; i++) {
        s->first[i] = s->turn * (s->centre[i] - s->start[i]) / s->radius[0];
        s->last[i] = s->turn * (s->centre[i] - s->end[i]) / s->radius[1];
    }
}

void contour_beside(const struct contour *s, bool end, double edge, double place[2])
{
    for (int i = 0; i < 2; i++) {
        place[i] = end ? s->end[i] + edge * s->last[i] : s->start[i] + edge * s->first[i];
    }
}

bool contour_fits(const struct contour *s, double edge)
{
    return s->turn == 0.0 || el_min(s->radius[0], s->radius[1]) - s->turn * edge > SHORT;
}

/* Angle [rad] about the centre of an arc from a to b, along the arc, 0 .. 2 pi; negative if
 * rounding or a corner that is left out puts b a little behind a. */
static double angle_along(const struct contour *s, const double a[2], const double b[2])
{
    const double u[2] = { a[0] - s->centre[0], a[1] - s->centre[1] };
    const double v[2] = { b[0] - s->centre[0], b[1] - s->centre[1] };
    const double angle = s->turn * el_atan2(cross(u, v), dot(u, v));
    return angle * el_hypot(u[0], u[1]) < -10.0 * SMOOTH ? angle + TAU : angle;
}

/* The two crossings of a line, `edge` to the left of that through a corner, and a circle; false:
 * there is none. `left` is the unit vector to the left of the line. */
static bool line_circle(const double corner[2], const double left[2], double edge,
                        const double centre[2], double radius, double place[2][2])
{
    const double along[2] = { left[1], -left[0] };
    const double to[2] = { centre[0] - corner[0], centre[1] - corner[1] };
    const double off = dot(to, left) - edge, u = dot(to, along);
    const double rest = radius * radius - off * off, half = sqrt(el_max(rest, 0.0));

    for (int i = 0; i < 2; i++) {
        place[0][i] = corner[i] + edge * left[i] + (u - half) * along[i];
        place[1][i] = corner[i] + edge * left[i] + (u + half) * along[i];
    }
    return rest >= 0.0;
}

/* The two crossings of circles of radius ra about a and rb about b; false: there is none. */
static bool circles(const double a[2], double ra, const double b[2], double rb, double place[2][2])
{
    const double d = el_max(distance(a, b), SHORT);
    const double along[2] = { (b[0] - a[0]) / d, (b[1] - a[1]) / d };
    const double across[2] = { -along[1], along[0] };
    const double u = 0.5 * (d + (ra - rb) * (ra + rb) / d);
    const double rest = (ra - u) * (ra + u), half = sqrt(el_max(rest, 0.0));

    for (int i = 0; i < 2; i++) {
        place[0][i] = a[i] + u * along[i] - half * across[i];
        place[1][i] = a[i] + u * along[i] + half * across[i];
    }
    return rest >= 0.0;
}

/* The two crossings of the centre's paths beside two motions; false: there is none. Two lines have
 * one, which is given twice. */
static bool crossings(const struct contour *a, const struct contour *b, double edge,
                      double place[2][2])
{
    const double *corner = a->end;
    const double ra = a->radius[1] - a->turn * edge, rb = b->radius[0] - b->turn * edge;

    if (a->turn != 0.0 && b->turn != 0.0) {
        return circles(a->centre, ra, b->centre, rb, place);
    }
    if (a->turn != 0.0) {
        return line_circle(corner, b->first, edge, a->centre, ra, place);
    }
    if (b->turn != 0.0) {
        return line_circle(corner, a->last, edge, b->centre, rb, place);
    }
    const double half = edge / (1.0 + dot(a->last, b->first));
    for (int i = 0; i < 2; i++) {
        place[0][i] = place[1][i] = corner[i] + half * (a->last[i] + b->first[i]);
    }
    return true;
}

/* The crossing at which the centre leaves the first motion for the second one: of both the one that
 * is nearer in front of the end of the first. False: there is none. */
static bool crossing(const struct contour *a, const struct contour *b, double edge, double meets[2])
{
    double place[2][2], end[2], back[2];

    if (!crossings(a, b, edge, place)) {
        return false;
    }
    contour_beside(a, true, edge, end);
    for (int i = 0; i < 2; i++) {
        const double way[2] = { end[0] - place[i][0], end[1] - place[i][1] };
        const double along = cross(way, a->last);
        back[i] = a->turn != 0.0 ? angle_along(a, place[i], end) : along >= 0.0 ? along : INFINITY;
    }
    memcpy(meets, place[back[1] < back[0]], 2 * sizeof *meets);
    return true;
}

enum contour_corner contour_corner(const struct contour *a, const struct contour *b, double edge,
                                   double from[2], double to[2])
{
    const double angle = el_atan2(cross(a->last, b->first), dot(a->last, b->first));

    if (fabs(angle) > TAU / 2.0 - BACK) {
        return CONTOUR_BACK;
    }
    if (fabs(angle * edge) < SMOOTH) {
        const double sum[2] = { a->last[0] + b->first[0], a->last[1] + b->first[1] };
        for (int i = 0; i < 2; i++) {
            from[i] = to[i] = a->end[i] + edge * sum[i] / el_hypot(sum[0], sum[1]);
        }
        return CONTOUR_JOINED;
    }
    if (angle * edge < 0.0) {
        contour_beside(a, true, edge, from);
        contour_beside(b, false, edge, to);
        return CONTOUR_CONVEX;
    }
    if (!crossing(a, b, edge, from)) {
        return CONTOUR_DEEP;
    }
    memcpy(to, from, 2 * sizeof *to);
    return fabs(angle) < SLIGHT ? CONTOUR_JOINED : CONTOUR_CONCAVE;
}

bool contour_path(const struct contour *s, const struct path *along, enum path_plane plane,
                  const double from[2], const double to[2], bool back, struct path *path)
{
    const int a = path_first(plane), b = path_second(plane);
    const double way[2] = { to[0] - from[0], to[1] - from[1] };
    const bool any = back && el_hypot(way[0], way[1]) > SHORT;
    double start[AXES], end[AXES], miss;

    memcpy(start, along->start, sizeof start);
    memcpy(end, along->end, sizeof end);
    start[a] = from[0];
    start[b] = from[1];
    end[a] = to[0];
    end[b] = to[1];
    if (s->turn == 0.0) {
        path_line(path, start, end);
        return any || cross(way, s->first) > SHORT;
    }
    /* The arc of the contour, less what the corners take at its ends. */
    const double sweep =
        fabs(along->sweep) - angle_along(s, s->start, from) - angle_along(s, to, s->end);
    if (any && sweep <= 0.0) {
        path_line(path, start, end);
        return true;
    }
    if (path_arc(path, plane, start, end, s->centre, s->turn > 0.0, 1, &miss) != PATH_OK) {
        return false;
    }
    /* Below 1 if nothing is left: path_arc has then gone round for a sweep of 0 or less. */
    const int turns = 1 + (int)round((sweep - fabs(path->sweep)) / TAU);
    return turns >= 1
           && path_arc(path, plane, start, end, s->centre, s->turn > 0.0, turns, &miss) == PATH_OK;
}

bool contour_entry(const struct contour *s, const struct path *along, enum path_plane plane,
                   const double to[2], struct path *path)
{
    const int a = path_first(plane), b = path_second(plane);
    const double back[2] = { s->start[0] - to[0], s->start[1] - to[1] };
    const double inward[2] = { s->turn * s->last[0], s->turn * s->last[1] };
    const double radius = dot(back, back) / (2.0 * dot(back, inward));
    const double centre[2] = { to[0] + radius * inward[0], to[1] + radius * inward[1] };
    double end[AXES], miss;

    memcpy(end, along->end, sizeof end);
    end[a] = to[0];
    end[b] = to[1];
    return radius > SHORT && isfinite(radius)
           && path_arc(path, plane, along->start, end, centre, s->turn > 0.0, 1, &miss) == PATH_OK;
}
