/* shape_fit - the equations of a run's spline, and how far it is from its chords.
 *
 * A round: control points for the weights and places of the vertices (solve), how far each vertex
 * is from its place on the curve (look), more weight where that is too much (push). Only once all
 * are near is it proved that the chords are (shape_run.h).
 */
#ifndef SHAPE_FIT_H
#define SHAPE_FIT_H

#include "shape_run.h"

/* Equations couple a control point with the three behind it; a fit has at least three spans. */
enum { SHAPE_BAND = 4, SHAPE_SPANS_LEAST = 3, SHAPE_CONTROLS = SHAPE_SPANS + 3 };

/* Part of the tolerance that is used: rounding may take the rest. */
#define SHAPE_USED 0.995

/* One fit under way: control points of a span's Bernstein values, and the equations. */
struct shape_fit {
    struct shape_run *run;
    int32_t spans, end;
    bool last;
    int32_t left, known_right; /* numbers of known control points at both ends */
    const struct segment_state *stop;
    int axis[AXES], axes;                    /* axes that move, an even number */
    double extract[SHAPE_SPANS][4][4];       /* [Bernstein value][control point] */
    int32_t first[SHAPE_SPANS + 1];          /* vertices first[k] .. first[k + 1] - 1 are in
                                              * span k */
    double row[SHAPE_VERTICES][4];           /* place of a vertex by its span's control points */
    double per[SHAPE_VERTICES];              /* [1/mm^2] 1 / (distance a vertex may be off)^2 */
    double bend[SHAPE_CONTROLS][SHAPE_BAND]; /* equations of integral |r'''|^2 */
    double band[SHAPE_CONTROLS][SHAPE_BAND], right[SHAPE_CONTROLS][AXES];
    double worst; /* largest squared distance, in tolerance^2 */
    int32_t worst_vertex;
};

/* Bernstein values of a span, between knots t[3] and t[4], from its control points. */
void shape_extract(const double t[7], double m[4][4]);

/* Put knots behind those that hold or are kept, with a bound of the vertices between two. False:
 * there is no room for them. */
bool shape_knots_put(struct shape_fit *f);

/* Halve the spans of chords that are too far out, if they are longer than so many closest spacings
 * and as far as there is room. Whether one was halved. */
bool shape_knots_halve(struct shape_fit *f, double longer);

/* Once knots are placed: extractions, equations of the bend, known control points, axes. */
void shape_fit_prepare(struct shape_fit *f);

/* Take all knots of a finer set, which has so many spans. */
void shape_fit_split(struct shape_fit *f, int32_t spans, const double knot[]);

/* Adds weight * row row^T to the equations of control points k .. k + 3. */
void shape_solve_add(double band[][SHAPE_BAND], int32_t k, const double row[4], double weight);

/* Equations for the present weights and places of the vertices. */
void shape_solve_assemble(struct shape_fit *f);

/* A vertex has another weight and place, within its span. */
void shape_solve_change(struct shape_fit *f, int32_t vertex, int32_t span, double weight, double u);

/* Solve the equations for the control points. */
void shape_solve(struct shape_fit *f);

/* See how far vertices are from their places on the curve. */
void shape_fit_look(struct shape_fit *f);

/* Give vertices that are too far out more weight; move all, or only these, to their feet. */
void shape_fit_push(struct shape_fit *f, bool all);

/* See how far vertices and chords in the first spans are; `worst` gets the largest. */
void shape_fit_prove(struct shape_fit *f, int32_t spans);

#endif
