/* contour_offset - the way of a tool beside a contour: corners of it and the motions between them.
 *
 * Everything here lies in the first and second axis of a plane. `edge` is how far the tool's centre
 * is to the left of the contour, seen along the motion; to the right it is negative. [mm]
 */
#ifndef CONTOUR_OFFSET_H
#define CONTOUR_OFFSET_H

#include "path.h"

/* A motion of the contour in the plane. */
struct contour {
    double start[2], end[2];  /* [mm] */
    double first[2], last[2]; /* unit vectors to the left at both */
    double turn;              /* 1 arc counter-clockwise, -1 clockwise, 0 line */
    double centre[2];         /* [mm] */
    double radius[2];         /* [mm] at the start and the end */
};

enum contour_corner {
    CONTOUR_JOINED,  /* the centre goes from one motion straight to the next: slight corner */
    CONTOUR_CONCAVE, /* the same, and both are shorter than the contour */
    CONTOUR_CONVEX,  /* it turns about the corner */
    CONTOUR_BACK,    /* the contour turns back on itself */
    CONTOUR_DEEP     /* the tool does not fit into the corner */
};

/* The motion of a path, which moves in the plane. */
void contour_of(struct contour *s, const struct path *p, enum path_plane plane);

/* Where the tool's centre is beside the start or the end of a motion. */
void contour_beside(const struct contour *s, bool end, double edge, double place[2]);

/* Whether the tool fits into an arc, by more than a nanometre. */
bool contour_fits(const struct contour *s, double edge);

/* The corner between two motions: where the centre ends the first and begins the second. */
enum contour_corner contour_corner(const struct contour *a, const struct contour *b, double edge,
                                   double from[2], double to[2]);

/* The path of the centre between two places, the other axes as in `along`. False: nothing is left
 * of it, or it would be driven backwards, unless it may lead `back`. */
bool contour_path(const struct contour *s, const struct path *along, enum path_plane plane,
                  const double from[2], const double to[2], bool back, struct path *path);

/* The arc of the centre that begins anywhere and ends at a place as the arc of the contour does. */
bool contour_entry(const struct contour *s, const struct path *along, enum path_plane plane,
                   const double to[2], struct path *path);

#endif
