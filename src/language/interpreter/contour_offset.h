/* contour_offset - geometry of the path that a tool's centre takes beside a contour: its corners,
 * and the motions between them.
 *
 * Points lie in the first and second axis of a plane [mm]. `edge` [mm] is the distance of the
 * tool's centre from the contour: positive to the left, seen along the motion, negative to the
 * right.
 */
#ifndef CONTOUR_OFFSET_H
#define CONTOUR_OFFSET_H

#include "path.h"

/* A line or an arc of the contour, in the plane. */
struct contour {
    double start[2], end[2];  /* [mm] */
    double first[2], last[2]; /* unit vectors to the left of the motion at start and end */
    double turn;              /* 1: arc counter-clockwise, -1: clockwise, 0: line */
    double centre[2];         /* [mm] */
    double radius[2];         /* [mm] of the arc at start and end */
};

/* What the tool's centre does in a corner between two motions. */
enum contour_corner {
    CONTOUR_JOINED,  /* slight corner: the centre goes straight from one motion to the next */
    CONTOUR_CONCAVE, /* likewise, and both of its motions are shorter than the contour's */
    CONTOUR_CONVEX,  /* it goes round the corner on an arc of radius |edge| */
    CONTOUR_BACK,    /* the contour turns back on itself */
    CONTOUR_DEEP     /* the tool does not fit into the corner */
};

/* The line or arc that a path is in the plane, in which it must move. */
void contour_of(struct contour *s, const struct path *p, enum path_plane plane);

/* Where the tool's centre is beside the start, or the `end`, of a motion: square to it. */
void contour_beside(const struct contour *s, bool end, double edge, double place[2]);

/* Whether the arc of the tool's centre has a radius above 1 nm; always true of a line. */
bool contour_fits(const struct contour *s, double edge);

/* The corner between two motions: the centre ends the first one at `from` and begins the second one
 * at `to`. These are undefined for CONTOUR_BACK and CONTOUR_DEEP. */
enum contour_corner contour_corner(const struct contour *a, const struct contour *b, double edge,
                                   double from[2], double to[2]);

/* Path of the centre beside a motion of the contour, between two places; the other axes move as in
 * `along`, the motion's own path. False: nothing is left of it, or it would go against the contour,
 * which only `back` allows, as a line. */
bool contour_path(const struct contour *s, const struct path *along, enum path_plane plane,
                  const double from[2], const double to[2], bool back, struct path *path);

/* Path of the centre where compensation begins with an arc: from the start of `along` to a place,
 * where it has the direction of the contour's arc. False: there is no such arc. */
bool contour_entry(const struct contour *s, const struct path *along, enum path_plane plane,
                   const double to[2], struct path *path);

#endif
