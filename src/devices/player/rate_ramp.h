/* rate_ramp - how fast the rate of a path may change so that acceleration and jerk keep to limits.
 *
 * A path planned as q(T) is driven at T' = r, the rate, 0 <= r <= 1. Of each axis
 *
 *     speed          r q'
 *     acceleration   r^2 q'' + r' q'
 *     jerk           r^3 q''' + 3 r r' q'' + r'' q'
 *
 * Let V be the largest |q'| on the way, A and J what the axis may have, and p A and p J what the
 * plan uses of it, p = 1 - reserve. Then acceleration and jerk are within A and J if
 *
 *     |r'|  <= min((1 - p r^2) A / V, (1 - p r^3) J / (6 r p A))
 *     |r''| <= (1 - p r^3) J / (2 V)
 *
 * where half of the jerk's room is for each of its two last terms. The ramp is the quickest one
 * within that: r'^2 over r by a pass forward and a pass back on a grid of r, on whose pieces r'' is
 * constant and the bounds are those of the larger r.
 */
#ifndef RATE_RAMP_H
#define RATE_RAMP_H

#include <stdbool.h>
#include <stdint.h>

enum { RATE_RAMP_PIECES = 64, RATE_RAMP_AXES = 4 };

/* Smallest share of the limits that a plan must leave free, else the rate could not leave 1. */
#define RATE_RAMP_LEAST 0.02

struct rate_bounds {
    double reserve;               /* RATE_RAMP_LEAST .. 1 */
    double speed[RATE_RAMP_AXES]; /* V [pulses/s]; 0: the axis stands */
    double acc[RATE_RAMP_AXES];   /* A [pulses/s^2] > 0 */
    double jerk[RATE_RAMP_AXES];  /* J [pulses/s^3]; 0: no limit */
};

struct rate_ramp {
    int32_t pieces;
    double time[RATE_RAMP_PIECES + 1]; /* [s] of each node since its begin, rising */
    double rate[RATE_RAMP_PIECES + 1];
    double slope[RATE_RAMP_PIECES + 1]; /* [1/s] signed */
};

/* Bounds of |r'| [1/s] and |r''| [1/s^2] up to this rate; INFINITY without any. */
double rate_ramp_slope_most(const struct rate_bounds *b, double rate);
double rate_ramp_bend_most(const struct rate_bounds *b, double rate);

/* From rest to rest of the rate. */
void rate_ramp_make(struct rate_ramp *r, const struct rate_bounds *b, double from, double to);

/* Given up at a time: *r becomes the shortest way to r' = 0 from there. */
void rate_ramp_brake(struct rate_ramp *r, const struct rate_bounds *b, double time);

/* Its length [s], and planned time that passes in it [s]. */
double rate_ramp_length(const struct rate_ramp *r);
double rate_ramp_way(const struct rate_ramp *r);

/* Rate and slope [1/s] at a time since its begin; at its end from there on. */
double rate_ramp_at(const struct rate_ramp *r, double time, double *slope);

#endif
