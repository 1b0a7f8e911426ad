/* shape_run - a run of short chords becomes a cubic spline with continuous r'', within a tolerance.
 *
 * Control points are those of least  integral |r'''|^2 + sum of weight |r(u_i) - vertex_i|^2  over
 * a window. Weights grow and knots come closer where the curve leaves the tolerance. Five sixths
 * of the window are then made into segments. What they share with the rest holds in the next one.
 *
 * A place u_i of the curve belongs to each vertex, in order, and two things hold of each segment
 * that is made:
 * (1) r(u_i) is within the tolerance of its vertex.
 * (2) The control points of the curve's parts between u_i and u_i+1 are within the tolerance of the
 *     chord between the vertices.
 * From that follows:
 * - The curve is within the tolerance of the path. What lies around a chord is convex, so it holds
 *   the hull of the control points.
 * - The path is within the tolerance of the curve. By continuity a point of the chord is the foot
 *   of some point of its part of the curve, and (2) bounds their distance. Else it lies before the
 *   foot of r(u_i) [behind that of r(u_i+1)]. Its distance from r(u_i) is convex along the chord,
 *   and bounded at that foot by (2) and at the vertex by (1).
 * All distances are those of six coordinates.
 */
#ifndef SHAPE_RUN_H
#define SHAPE_RUN_H

#include <stdint.h>

#include "segment.h"

enum {
    SHAPE_SPANS = 64,    /* most spans of a window */
    SHAPE_CROWD = 16,    /* about the most vertices of a span */
    SHAPE_VERTICES = 900 /* most vertices of a window and of what waits behind it */
};

/* What a chord's command asks of the motion along it. */
struct shape_law {
    double feed, cap; /* [mm/s] */
    struct ramp_limits ramp;
};

struct shape_vertex {
    double point[AXES];   /* [mm] */
    double s;             /* [mm] where it lies along the polyline */
    double u;             /* [mm] parameter of its place on the curve */
    double tolerance;     /* [mm] tolerance of the chord that ends here */
    double weight;        /* weight of its distance; 0: none yet */
    double off;           /* largest squared distance last seen here, in tolerance^2 */
    struct shape_law law; /* limits of the chord that ends here */
    int32_t marks;        /* number of commands that begin here */
    bool joint;           /* a command ends here: it may be a corner */
    bool corner;
};

struct shape_run {
    int32_t vertices, placed; /* number of vertices; how many of them have a u */
    bool begun;               /* segments of it exist: knots and control points hold at the left */
    bool bound;               /* it begins with the state `begin`, else with r'' = 0 */
    struct segment_state begin;
    int32_t spans, fitted;        /* spans of the last fit; its last vertex */
    int32_t proved;               /* so many of its first spans keep the tolerance */
    int32_t kept;                 /* knots up to this one are good for the next window, too */
    double knot[SHAPE_SPANS + 7]; /* [mm]; span k lies between knots k + 3 and k + 4 */
    double origin[AXES];          /* [mm] a point near the run */
    double control[SHAPE_SPANS + 3][AXES]; /* [mm] control points, from the origin */
    struct shape_vertex vertex[SHAPE_VERTICES];
};

/* Lower the limits of a segment to those of a law, too. */
void shape_obey(struct segment *p, double feed, double cap, const struct ramp_limits *r);

/* Distance of two points in six coordinates. [mm] */
double shape_distance(const double a[AXES], const double b[AXES]);

/* Closest spacing of knots for a tolerance. [mm] */
double shape_spacing(double tolerance);

/* Fits vertices 0 .. end. `last`: the run ends there, with a state or, NULL, with r'' = 0, else it
 * goes on behind, and less than all of it may be fitted. Returns -1 if
 * every chord of the spans that are proved is within its tolerance, -2 if the run is too long for
 * one window, else the vertex that is farthest out. */
int32_t shape_run_fit(struct shape_run *r, int32_t end, bool last,
                      const struct segment_state *stop);

/* After a fit that failed: places and weights as before it, but where knots hold. */
void shape_run_afresh(struct shape_run *r);

/* The span k of the fit as a segment, with the least of its chords' laws. *vertex: one before it or
 * the first in it; goes on to the latter. */
void shape_run_segment(const struct shape_run *r, int32_t k, int32_t *vertex, struct segment *p);

/* The first n spans have been made into segments. Returns how many vertices went with them: one
 * that lies before the first span left stays. */
int32_t shape_run_drop(struct shape_run *r, int32_t n);

#endif
