/* shape_turn - where a run of chords has a corner. */
#ifndef SHAPE_TURN_H
#define SHAPE_TURN_H

#include "shape_run.h"

/* How much a run turns within 15 tolerances at a vertex, neither its first nor its last one: sin^2
 * of half the angle, 0 if that is no corner. The steps of a raster are no corners. */
double shape_turn(const struct shape_run *r, int32_t vertex);

/* The vertex before `end` where the run turns most near a vertex, or that vertex itself. */
int32_t shape_turn_most(const struct shape_run *r, int32_t vertex, int32_t end);

/* The next vertex behind *looked that is a corner, marked as one; 0: none. `waits`: only as far as
 * the way behind is known; `goes_on`: the last vertex is not its end. *looked: none up to there. */
int32_t shape_turn_next(struct shape_run *r, int32_t *looked, bool waits, bool goes_on);

#endif
