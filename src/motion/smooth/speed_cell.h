/* speed_cell - a short part of a segment, and what the speed along it may be.
 *
 * With x = (du/dt)^2 and a = d2u/dt2 axis k has the acceleration r''_k x + r'_k a. While a is
 * constant x runs straight over the cell, from x0 at its start to x1 at its end. So r''_k x is at
 * most a product of two straight lines and what r'' and r' bend away from theirs. Thus a limit of
 * an axis becomes three planes g0 x0 + g1 x1 <= 1 (the coefficients in Bernstein's form). They hold
 * at every instant of the cell, and an error of the bounds falls with the square of its length.
 */
#ifndef SPEED_CELL_H
#define SPEED_CELL_H

#include <stdint.h>

#include "segment.h"

struct speed_limits {
    double speed[AXES]; /* [mm/s] highest of each axis; 0: no limit */
    double acc[AXES];   /* [mm/s^2] of each axis, > 0; or all 0: along the path and across it
                         * within the ramp of the segment, each by itself */
    double jerk[AXES];  /* [mm/s^3] of each axis, with acc; 0: no limit */
};

enum {
    SPEED_PLANES = 11, /* more are joined to fewer, a little inside */
    SPEED_SPLIT = 32   /* cells of a segment, at most */
};

struct speed_cell {
    double length;    /* [mm] */
    double feed, cap; /* [mm/s] du/dt: programmed, and most with any override */
    double flat;      /* [mm^2/s^2] up to this x the limits allow a = 0 */
    double bend;      /* [s^2/mm^2] bend x + up a <= 1 and bend x + down |a| <= 1 are */
    double up, down;  /* [s^2/mm]   within the limits, too, anywhere in the cell */
    double plane[SPEED_PLANES][2]; /* [s^2/mm^2] g0, g1; for x0, x1 >= 0 */
    int32_t planes;
    double most; /* [mm^2/s^2] x at its start from which the rest can be driven */
    double top;  /* feed below `flat`: x at the start of the line of steepest braking,
                  * whatever the feed; else x at the end of a cell begun with `most` */
};

/* A segment in up to SPEED_SPLIT parts of equal length, one after another: as many as its turn and
 * the bend of r' ask for. */
struct speed_part {
    const struct segment *segment;
    int32_t count, next;
    double from, to;              /* [mm] the latest part of the segment */
    struct segment_bounds bounds; /* bounds over that part */
    struct segment_rest rest;
};

void speed_part_first(struct speed_part *part, const struct segment *p);
bool speed_part_next(struct speed_part *part);

/* Cut a segment into cells; returns their number, 1 .. SPEED_SPLIT. */
int32_t speed_cut(const struct segment *p, const struct speed_limits *l,
                  struct speed_cell cell[SPEED_SPLIT]);

/* Most x at the start, up to `most`, from which x1 or less is reached: that is *end. */
double speed_back(const struct speed_cell *c, double x1, double most, double *end);

/* x at the start of the line of steepest braking to x1, however fast; for x1 <= most <= flat. */
double speed_top(const struct speed_cell *c, double x1, double most);

/* Accelerations with which x may go on from where it is, `left` before the end, for the rest of the
 * cell. None (low > high) above all the lines that keep the limits. [mm/s^2] */
struct speed_span {
    double low, high;
};

struct speed_span speed_span(const struct speed_cell *c, double left, double x);

/* Most acceleration that keeps the limits up to x = *until >= x, anywhere in the cell; *until may
 * be lowered. -INFINITY: none. */
double speed_rise(const struct speed_cell *c, double x, double *until);

/* Most deceleration from x on, anywhere in the cell. [mm/s^2] */
double speed_fall(const struct speed_cell *c, double x);

#endif
