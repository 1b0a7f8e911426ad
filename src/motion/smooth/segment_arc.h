/* segment_arc - derivatives of segments that are arcs. */
#ifndef SEGMENT_ARC_H
#define SEGMENT_ARC_H

#include "segment.h"

void segment_arc_at(const struct segment *p, double u, struct segment_state *s);

/* Writes the bounds of an arc over those in *b, which are all 0. */
void segment_arc_bounds(const struct segment *p, double from, double to, struct segment_bounds *b);

#endif
