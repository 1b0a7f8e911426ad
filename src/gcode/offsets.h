/* offsets - where the zero of the program lies: G10 L2, G52, G92 to G92.3.
 *
 *     machine coordinate = program coordinate + origin (G54 .. G59) + local (G52) + shift (G92)
 */
#ifndef OFFSETS_H
#define OFFSETS_H

#include "gcode.h"
#include "modes.h"

/* The program's zero of one axis in machine coordinates. [mm] */
double offsets_zero(const struct interpreter *in, int axis);

/* Whether the block has one of the codes that change it. */
bool offsets_changed(const struct block *b);

/* Execute that code. */
enum fault offsets_change(struct interpreter *in, const struct program *p, const struct block *b,
                          struct fault_report *r);

#endif
