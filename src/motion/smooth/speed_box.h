/* speed_box - a part of a chain in which limited jerk is kept by boxes.
 *
 * With x = (du/dt)^2, b = dx/du and c = db/du axis k has the acceleration r''_k x + r'_k b / 2 and
 * the jerk (r'''_k x + 3/2 r''_k b + r'_k c / 2) sqrt(x). Both are kept with the bounds of r', r''
 * and r''' in the box. What is possible with x(u) is possible with any share of it.
 */
#ifndef SPEED_BOX_H
#define SPEED_BOX_H

#include "speed_cell.h"

/* Low and high bound, rounded outwards. */
struct speed_bound {
    float low, high;
};

/* A limit of an axis, or of the path: bounds over what is allowed. */
struct speed_row {
    struct speed_bound acc[2];  /* r' [s^2/mm], r'' [s^2/mm^2] over the acceleration */
    struct speed_bound jerk[3]; /* r' [s^3/mm], r'' [s^3/mm^2], r''' [s^3/mm^3] over the jerk */
};

struct speed_box {
    double from, length; /* [mm] of the chain's parameter */
    double feed, cap;    /* [mm/s] du/dt: programmed, and most with any override and within the
                          * limits */
    double brisk;        /* [mm/s] speed up to which enough is left to change it */
    double ideal;        /* [s] time of its parts at their own speeds */
    double along[2];     /* [s^2/mm] 1 / most acceleration, most braking of the way, beside the
                           * rows; 0: none */
    int32_t rows;
    struct speed_row row[AXES];
};

/* Speed of the way and how it changes. */
struct speed_state {
    double x, b; /* [mm^2/s^2], [mm/s^2] */
};

/* Whether the axes have limits of their own. */
bool speed_by_axes(const struct speed_limits *l);

/* The box of a part of a segment that begins at `from` [mm], by the bounds of that part. */
void speed_box_make(struct speed_box *g, const struct segment *p, const struct speed_limits *l,
                    double from, double length, const struct segment_bounds *b);

/* Join a box and the next one to one; false, and not done: it would be slower than two. */
bool speed_box_join(struct speed_box *g, const struct speed_box *next);

/* The most |b| of this sign that the accelerations allow at x. [mm/s^2] */
double speed_box_steepest(const struct speed_box *g, double x, double sign);

/* Whether a step of s with a constant c keeps the limits all along. */
bool speed_box_keeps(const struct speed_box *g, struct speed_state from, double c, double s);

/* Most c (sign 1) or least (-1) with which a step of s from a state, or to it, keeps the limits;
 * false: none is found. */
bool speed_box_turn(const struct speed_box *g, struct speed_state from, double s, double sign,
                    double *c);
bool speed_box_turn_to(const struct speed_box *g, struct speed_state to, double s, double sign,
                       double *c);

/* Length of a step: `rest`, or an even share of it in which x and b do not change too much. */
double speed_box_stride(const struct speed_box *g, struct speed_state from, double rest);

/* Jerk of the way that keeps the limits while speed and acceleration are up to v and a, or down to
 * a below 0. [mm/s^3] */
double speed_box_jerk(const struct speed_box *g, double v, double a);

/* Time in which the jerk reaches the most acceleration. [s] */
double speed_box_rise(const struct speed_box *g);

/* Acceleration, and jerk, of a state that goes on with c = 0, over what the box allows. */
double speed_box_acc(const struct speed_box *g, struct speed_state s);
double speed_box_twist(const struct speed_box *g, struct speed_state s);

/* The state at the end of a step. */
static inline struct speed_state speed_step_to(struct speed_state from, double c, double s)
{
    const struct speed_state to = { from.x + s * (from.b + 0.5 * c * s), from.b + c * s };
    return to;
}

/* The state at the start of a step. */
static inline struct speed_state speed_step_from(struct speed_state to, double c, double s)
{
    const struct speed_state from = { to.x - s * (to.b - 0.5 * c * s), to.b - c * s };
    return from;
}

/* Most x on a step. */
double speed_step_top(struct speed_state from, double c, double s);

#endif
