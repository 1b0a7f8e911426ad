/* shape_fit - the equations of a run's spline, and how far it is from its chords. */
#ifndef SHAPE_FIT_H
#define SHAPE_FIT_H

#include "shape_run.h"

/* Equations couple a control point with the three behind it; fewest spans. */
enum { SHAPE_BAND = 4, SHAPE_SPANS_LEAST = 3 };

/* One fit under way: control points of a span's Bernstein values, and the equations. */
struct shape_fit {
    struct shape_run *run;
    int32_t spans, end;
    bool last;
    int32_t left, known_right;                  /* control points that hold at either end */
    const struct piece_state *stop;
    int axis[AXES], axes;                       /* those that move */
    double extract[SHAPE_SPANS][4][4];          /* [Bernstein value][control point] */
    double bend[SHAPE_SPANS + 3][SHAPE_BAND];         /* equations of integral |r'''|^2 */
    double band[SHAPE_SPANS + 3][SHAPE_BAND], right[SHAPE_SPANS + 3][AXES];
    double worst;                               /* largest distance, of the tolerance */
    int32_t worst_vertex;
};

/* Bernstein values of a span, between knots t[3] and t[4], from its control points. */
void shape_extract(const double t[7], double m[4][4]);

/* Once knots are placed: extractions, equations of the bend, known control points, axes. */
void shape_fit_prepare(struct shape_fit *f);

/* Control points for the present weights and places of the vertices. */
void shape_fit_solve(struct shape_fit *f);

/* Distances of all vertices and chords, and how far each vertex is from its foot. */
void shape_fit_look(struct shape_fit *f);

#endif
