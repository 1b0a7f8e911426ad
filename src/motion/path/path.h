/* path - exact geometry of one command: point and direction at any arc length.
 *
 * A line runs straight in all six axes. An arc turns about a normal along X, Y or Z, its third
 * axis (helix) and U V W follow linearly; or about any normal, and U V W follow. A cubic is a curve
 * of Bezier in X Y Z, and U V W follow evenly with its length. Length is measured in X Y Z; a move
 * of U V W alone is measured in U V W.
 */
#ifndef PATH_H
#define PATH_H

#include <stdbool.h>

#include "axis_count.h"
#include "bezier.h"

/* Plane by its normal's index: YZ 0 (normal X), ZX 1 (normal Y), XY 2 (normal Z); any other one. */
enum path_plane { PATH_YZ, PATH_ZX, PATH_XY, PATH_TILTED };

/* Why there is no arc. */
enum path_status {
    PATH_OK,
    PATH_NO_RADIUS,    /* radius zero */
    PATH_MISSES_END,   /* start and end have different distances from the centre */
    PATH_SHORT_RADIUS, /* radius smaller than half the distance start - end */
    PATH_CUSP,         /* a curve turns on the spot */
    PATH_OPEN          /* R form with end = start, or three points on one line */
};

struct path {
    bool arc;
    bool cubic; /* neither of them: a line */
    enum path_plane plane;
    double start[AXES], end[AXES]; /* [mm] */
    union {
        struct {                         /* an arc: */
            double centre[2];            /* [mm] in the plane's first and second axis */
            double middle[3], normal[3]; /* a tilted arc: centre [mm], unit vector */
            double radius;               /* [mm] at the start */
            double growth;               /* [mm] radius at the end - radius at the start;
                                          * rounding of the program makes it, and keeps start
                                          * and end exact */
            double angle;                /* [rad] where it starts, seen from the normal's end */
            double sweep;                /* [rad] counter-clockwise positive */
        };
        struct bezier bezier; /* a cubic */
    };
    double length; /* [mm] */
};

/* First and second axis of a plane: XY, YZ, ZX, not of a tilted one. */
int path_first(enum path_plane p);
int path_second(enum path_plane p);

void path_line(struct path *p, const double start[AXES], const double end[AXES]);

/* How far an arc may miss its end: `least` whatever the radius, and up to 100 times that `share` of
 * the larger radius. The radius then changes evenly along the arc. */
struct path_tolerance {
    double least; /* [mm] */
    double share;
};

/* Arc about a centre (in the plane's axes); ccw seen from the normal's positive end; turns >= 1,
 * each one above 1 adds a full circle. Same start and end make a full circle. Refused, *p is
 * undefined and *miss [mm] says by how much the end misses the circle. */
enum path_status path_arc(struct path *p, enum path_plane plane, const double start[AXES],
                          const double end[AXES], const double centre[2], bool ccw, int turns,
                          double *miss);

/* An arc as by path_arc, with a tolerance; path_arc has 0.005 mm and 0.1 %. */
enum path_status path_arc_within(struct path *p, enum path_plane plane, const double start[AXES],
                                 const double end[AXES], const double centre[2], bool ccw,
                                 int turns, const struct path_tolerance *t, double *miss);

/* Arc through an angle [rad], counter-clockwise about a normal of length 1, from a start to the end
 * that follows from it in X Y Z. PATH_NO_RADIUS: the start is on the axis. */
enum path_status path_tilted(struct path *p, const double start[AXES], const double end[AXES],
                             const double middle[3], const double normal[3], double sweep);

/* Middle, normal and angle of the arc start - via - end. PATH_OPEN: they are on one line. */
enum path_status path_tilted_by_point(const double start[3], const double via[3],
                                      const double end[3], double middle[3], double normal[3],
                                      double *sweep);

/* Centre of the arc of radius |r|; r < 0 takes the one of more than half a turn. A radius short of
 * half the distance by a tolerance [mm] makes half a circle.
 * *half is half the distance from start to end [mm]. */
enum path_status path_centre_by_radius(enum path_plane plane, const double start[AXES],
                                       const double end[AXES], double r, bool ccw, double tolerance,
                                       double centre[2], double *half);

/* Centre and direction of the arc start - via - end. */
enum path_status path_centre_by_point(enum path_plane plane, const double start[AXES],
                                      const double via[2], const double end[AXES], double centre[2],
                                      bool *ccw);

/* Curve of Bezier with two inner control points; a line if it is one. PATH_CUSP: it turns on the
 * spot, or at a radius below 0.1 um. */
enum path_status path_cubic(struct path *p, const double start[AXES], const double end[AXES],
                            const double inner[2][3]);

/* Point at arc length s, 0..length, and d(point)/ds; s = length gives the end exactly. */
void path_at(const struct path *p, double s, double point[AXES], double slope[AXES]);

/* Largest |d(point)/ds| of one axis anywhere on the path: axis speed per unit of feed. */
double path_share(const struct path *p, int axis);

/* Largest curvature. [1/mm] */
double path_bend(const struct path *p);

/* Bound of |d^3(point)/ds^3| in X Y Z. [1/mm^2] */
double path_twist(const struct path *p);

/* Smallest and largest coordinate of one axis between two arc lengths, the exact ones. [mm] */
void path_extent(const struct path *p, int axis, double from, double to, double *low, double *high);

#endif
