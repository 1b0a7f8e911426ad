/* speed_pull - what a limit of acceleration is for: an axis, or the way along the path.
 *
 * With v = du/dt, x = v^2 and a = d2u/dt2 its acceleration is q x + p a, its jerk
 * s v^3 + 3 q v a + p d3u/dt3; across the path the acceleration is n x:
 *
 *               p       q               s
 *     axis k    r'_k    r''_k           r'''_k                        n = |r' x r''| / |r'|
 *     way       |r'|    r' r'' / |r'|   derivative of that one
 *
 * Along and across the path: of X Y Z; without these of U V W.
 */
#ifndef SPEED_PULL_H
#define SPEED_PULL_H

#include "segment.h"

struct speed_pull {
    double p[2], q[2]; /* at both ends; q [1/mm] */
    double sag, stray; /* p and q leave their chords by at most that */
    double most[3];    /* bounds of |p|, |q| [1/mm], |s| [1/mm^2] */
};

/* The pull of an axis that moves, over a part of a segment with this length [mm] and these
 * bounds. */
void speed_pull_axis(struct speed_pull *l, int axis, double length, const struct segment_bounds *b);

/* The pull of the way along the path. Returns the most n. [1/mm] */
double speed_pull_path(struct speed_pull *along, const struct segment *p, double length,
                       const struct segment_bounds *b);

#endif
