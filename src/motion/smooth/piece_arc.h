/* piece_arc - derivatives of pieces that are arcs. */
#ifndef PIECE_ARC_H
#define PIECE_ARC_H

#include "piece.h"

void piece_arc_at(const struct piece *p, double u, struct piece_state *s);

/* Writes the bounds of an arc over those in *b, which are all 0. */
void piece_arc_bounds(const struct piece *p, double from, double to, struct piece_bounds *b);

#endif
