/* pace_leg - a part of a chain that limited jerk is kept in: at both ends a = 0.
 *
 *   v ^        ____________
 *     |       /            \__     ramps begin and end with a = 0, so what the motion can still do
 *     |  ____/                \    at a border is told by its speed alone; in between v, a and j
 *     +--+--------------------+-> u   are in boxes that keep each axis within its limits:
 *
 * axis k has the acceleration r''_k v^2 + r'_k a, the jerk r'''_k v^3 + 3 r''_k v a + r'_k j.
 */
#ifndef PACE_LEG_H
#define PACE_LEG_H

#include "pace_cell.h"

struct pace_leg {
    double length;          /* [mm] */
    double feed, cap;       /* [mm/s] du/dt: programmed, and most with any override and within the
                             * limits */
    double brisk;           /* [mm/s] up to which enough is left for ramps */
    double bound[3][AXES];  /* most |r'_k|, |r''_k| [1/mm], |r'''_k| [1/mm^2] */
    int32_t axes;           /* that move are below this one */
    double most[3];         /* of |r'|, |r''|, |r'''|; for the path's ramp */
    struct ramp_limits ramp;    /* its jerks may be INFINITY */
    double ideal;           /* [s] its parts would take at their own caps */
    bool last;              /* ends with a piece */
    double enter;           /* [mm/s] at its start, from which the rest can be driven */
};

/* Whether the axes have limits of their own. */
bool pace_by_axes(const struct pace_limits *l);

/* Of a part of a piece, with the bounds of that part. */
void pace_leg_make(struct pace_leg *g, const struct piece *p, const struct pace_limits *l,
                   double length, const struct piece_bounds *b);

/* Two that follow each other as one; false: it would be slower than two. */
bool pace_leg_join(struct pace_leg *g, const struct pace_leg *next, const struct pace_limits *l);

/* A change of speed that begins and ends with a = 0. */
struct pace_ramp {
    double from, to;        /* [mm/s] */
    double acc, jerk;       /* [mm/s^2], [mm/s^3] */
};

/* Fastest one within the limits of a leg. */
struct pace_ramp pace_ramp_make(const struct pace_leg *g, const struct pace_limits *l, double from,
                                double to);

double pace_ramp_time(const struct pace_ramp *r);   /* [s] */
double pace_ramp_way(const struct pace_ramp *r);    /* [mm] */

/* Way, speed, acceleration and jerk at a time. */
struct pace_motion {
    double way, rate, gain, jerk;
};

struct pace_motion pace_ramp_at(const struct pace_ramp *r, double t);

/* The same ramp, ended as early as the jerk allows, when it is at a time. */
struct pace_ramp pace_ramp_cut(const struct pace_ramp *r, double t);

/* Whether another end is still open then: the acceleration has not begun to fall. */
bool pace_ramp_open(const struct pace_ramp *r, double t);

/* Where a ramp is better made as two, as the limits are less the faster it is; else `to`. */
double pace_leg_stage(const struct pace_leg *g, const struct pace_limits *l, double from,
                      double to);

/* Way of that ramp or both. [mm] */
double pace_leg_way(const struct pace_leg *g, const struct pace_limits *l, double from, double to);

/* Most speed, up to `most`, from which `to` (or less, if that is less) is reached on a way. */
double pace_leg_enter(const struct pace_leg *g, const struct pace_limits *l, double to, double most,
                      double way);

/* Most speed between two of which the first is the lower one or both are the same, on a way. */
double pace_leg_peak(const struct pace_leg *g, const struct pace_limits *l, double from, double to,
                     double most, double way);

/* Speed that a lower one is reached with on a way: `want`, or less, or as little as can be. */
double pace_leg_low(const struct pace_leg *g, const struct pace_limits *l, double from, double want,
                    double way);

#endif
