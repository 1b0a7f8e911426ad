/* shape_turn - where a run of chords has a corner. */
#ifndef SHAPE_TURN_H
#define SHAPE_TURN_H

#include "shape_run.h"

/* 0: no corner at a vertex, neither its first nor its last one; else the greater the more it turns
 * within 15 tolerances. The steps of a raster are no corners. */
double shape_turn(const struct shape_run *r, int32_t vertex);

#endif
