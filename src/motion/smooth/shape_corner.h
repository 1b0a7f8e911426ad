/* shape_corner - the corner between two rows of segments, rounded as far as there is room. */
#ifndef SHAPE_CORNER_H
#define SHAPE_CORNER_H

#include "shape.h"

struct segment *shape_made(struct shape *s, int64_t number);
void shape_push(struct shape *s, const struct segment *p);

/* The row of segments made so far ends at a corner: at vertex `end` of the run, or of a long
 * command. */
void shape_corner_begin(struct shape *s, int32_t end, double tolerance);

/* Behind it there are segments now: of the run, or a long one with its tolerance [mm]. */
void shape_corner_round(struct shape *s, double tolerance);

#endif
