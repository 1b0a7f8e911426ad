/* tool_spline - the tool's way from one pose to the next through a row of them.
 *
 *     before ── from ══ to ── next    The parabola through before, from, to becomes the one through
 *                                     from, to, next: as much of either as a quintic says that
 *                                     rises from 0 to 1 with ends of no slope and no bend.
 *
 * So at each pose the way has the slope and the bend of one parabola, on both sides. The parameter
 * is the distance from pose to pose. An orientation is a rotation vector from the middle one of its
 * parabola's three.
 */
#ifndef TOOL_SPLINE_H
#define TOOL_SPLINE_H

#include <stdbool.h>

#include "pose.h"

/* x = slope t + bend t^2 from a pose: X Y Z [mm], a rotation vector [rad]. */
struct tool_spline_parabola {
    struct pose middle;
    double at; /* [mm] t is 0 there, counted from the way's start */
    double slope[6], bend[6];
};

struct tool_spline {
    double length; /* [mm] from pose to pose */
    struct tool_spline_parabola parabola[2];
};

/* Which way is meant: the one between both parabolas, or one of these alone. */
enum tool_spline_part { TOOL_SPLINE_FIRST, TOOL_SPLINE_SECOND, TOOL_SPLINE_WAY };

/* `before` and `next` may be NULL: with one of them the way is on its parabola, without both it is
 * straight. False: two poses in a row are the same. */
bool tool_spline_make(struct tool_spline *s, const struct pose *before, const struct pose *from,
                      const struct pose *to, const struct pose *next);

/* The pose at a part 0..1, of a parabola also beyond. */
struct pose tool_spline_pose(const struct tool_spline *s, enum tool_spline_part which, double part);

/* Speed of the tip [mm] and of the turn [rad] for a unit rate of the parameter. [1], [rad/mm] */
void tool_spline_rates(const struct tool_spline *s, double part, double *way, double *turn);

#endif
