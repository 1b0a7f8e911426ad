/* pace_box - a part of a chain in which limited jerk is kept by boxes.
 *
 * With x = (du/dt)^2, b = dx/du and c = db/du axis k has the acceleration r''_k x + r'_k b / 2 and
 * the jerk (r'''_k x + 3/2 r''_k b + r'_k c / 2) sqrt(x). Both are kept with the bounds of r', r''
 * and r''' in the box. What is possible with x(u) is possible with any share of it.
 */
#ifndef PACE_BOX_H
#define PACE_BOX_H

#include "pace_cell.h"

/* Low and high bound, rounded outwards. */
struct pace_bound {
    float low, high;
};

/* A limit of an axis, or of the path: bounds over what is allowed. */
struct pace_row {
    struct pace_bound acc[2];  /* r' [s^2/mm], r'' [s^2/mm^2] over the acceleration */
    struct pace_bound jerk[3]; /* r' [s^3/mm], r'' [s^3/mm^2], r''' [s^3/mm^3] over the jerk */
};

struct pace_box {
    double from, length; /* [mm] of the chain's parameter */
    double feed, cap;    /* [mm/s] du/dt: programmed, and most with any override and within the
                          * limits */
    double brisk;        /* [mm/s] speed up to which enough is left to change it */
    double ideal;        /* [s] time of its parts at their own speeds */
    int32_t rows;
    struct pace_row row[AXES];
};

/* Speed of the way and how it changes. */
struct pace_state {
    double x, b; /* [mm^2/s^2], [mm/s^2] */
};

/* Whether the axes have limits of their own. */
bool pace_by_axes(const struct pace_limits *l);

/* The box of a part of a segment that begins at `from` [mm], by the bounds of that part. */
void pace_box_make(struct pace_box *g, const struct segment *p, const struct pace_limits *l,
                   double from, double length, const struct segment_bounds *b);

/* Join a box and the next one to one; false, and not done: it would be slower than two. */
bool pace_box_join(struct pace_box *g, const struct pace_box *next);

/* The most |b| of this sign that the accelerations allow at x. [mm/s^2] */
double pace_box_steepest(const struct pace_box *g, double x, double sign);

/* Whether a step of s with a constant c keeps the limits all along. */
bool pace_box_keeps(const struct pace_box *g, struct pace_state from, double c, double s);

/* Most c (sign 1) or least (-1) with which a step of s from a state, or to it, keeps the limits;
 * false: none is found. */
bool pace_box_turn(const struct pace_box *g, struct pace_state from, double s, double sign,
                   double *c);
bool pace_box_turn_to(const struct pace_box *g, struct pace_state to, double s, double sign,
                      double *c);

/* Length of a step: `rest`, or an even share of it in which x and b do not change too much. */
double pace_box_stride(const struct pace_box *g, struct pace_state from, double rest);

/* Jerk of the way that keeps the limits while speed and acceleration are up to v and a. [mm/s^3] */
double pace_box_jerk(const struct pace_box *g, double v, double a);

/* Time in which the jerk reaches the most acceleration. [s] */
double pace_box_rise(const struct pace_box *g);

/* Acceleration, and jerk, of a state that goes on with c = 0, over what the box allows. */
double pace_box_acc(const struct pace_box *g, struct pace_state s);
double pace_box_twist(const struct pace_box *g, struct pace_state s);

/* The state at the end of a step. */
static inline struct pace_state pace_step_to(struct pace_state from, double c, double s)
{
    const struct pace_state to = { from.x + s * (from.b + 0.5 * c * s), from.b + c * s };
    return to;
}

/* The state at the start of a step. */
static inline struct pace_state pace_step_from(struct pace_state to, double c, double s)
{
    const struct pace_state from = { to.x - s * (to.b - 0.5 * c * s), to.b - c * s };
    return from;
}

/* Most x on a step. */
double pace_step_top(struct pace_state from, double c, double s);

#endif
