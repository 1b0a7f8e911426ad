/* rate_ramp - ramp of the rate at which a planned motion is played, as fast as the limits of
 * acceleration and jerk of all axes allow: for a pause on the path and for going on.
 *
 * A path planned as q(T) is driven at T' = r, the rate, 0 <= r <= 1. Of each axis
 *
 *     speed          r q'
 *     acceleration   r^2 q'' + r' q'
 *     jerk           r^3 q''' + 3 r r' q'' + r'' q'
 *
 * Let V be the largest |q'| on the way, A and J the axis' limits, and p A and p J the largest
 * values in the plan, p = 1 - reserve. Then acceleration and jerk are within A and J if
 *
 *     |r'|  <= min((1 - p r^2) A / V, (1 - p r^3) J / (6 r p A))
 *     |r''| <= (1 - p r^3) J / (2 V)
 *
 * where each of the last two terms of the jerk gets half of its margin. The ramp is the quickest
 * one within these bounds: r'^2 as a function of r by a forward and a backward pass over a grid of
 * r. Between two of its nodes r'' is constant, and the bounds are those of the larger r.
 */
#ifndef RATE_RAMP_H
#define RATE_RAMP_H

#include <stdbool.h>
#include <stdint.h>

enum { RATE_RAMP_PIECES = 64, RATE_RAMP_AXES = 4 };

/* Smallest reserve that a plan must leave; without one the rate could not leave 1. */
#define RATE_RAMP_LEAST 0.02

struct rate_bounds {
    double reserve;               /* share of the limits left free, RATE_RAMP_LEAST .. 1 */
    double speed[RATE_RAMP_AXES]; /* V [pulses/s]; 0: the axis is at rest or does not matter */
    double acc[RATE_RAMP_AXES];   /* A [pulses/s^2] > 0 */
    double jerk[RATE_RAMP_AXES];  /* J [pulses/s^3]; 0: no limit */
};

struct rate_ramp {
    int32_t pieces;                     /* number of intervals between nodes */
    double time[RATE_RAMP_PIECES + 1];  /* [s] of each node since the ramp's begin, rising */
    double rate[RATE_RAMP_PIECES + 1];  /* r at each node */
    double slope[RATE_RAMP_PIECES + 1]; /* [1/s] r' at each node, signed */
};

/* Bounds of |r'| [1/s] and |r''| [1/s^2] at this rate and below; INFINITY if nothing limits
 * them. */
double rate_ramp_slope_most(const struct rate_bounds *b, double rate);
double rate_ramp_bend_most(const struct rate_bounds *b, double rate);

/* Make the quickest ramp from a rate to another, r' = 0 at both ends. */
void rate_ramp_make(struct rate_ramp *r, const struct rate_bounds *b, double from, double to);

/* Give up the ramp at a time [s]: *r becomes the quickest ramp to r' = 0 from there. */
void rate_ramp_brake(struct rate_ramp *r, const struct rate_bounds *b, double time);

/* Duration of the ramp [s]; planned time that is played in it, the integral of r [s]. */
double rate_ramp_length(const struct rate_ramp *r);
double rate_ramp_way(const struct rate_ramp *r);

/* Rate and its slope [1/s] at a time [s] since the ramp's begin; after its end those of the end. */
double rate_ramp_at(const struct rate_ramp *r, double time, double *slope);

#endif
