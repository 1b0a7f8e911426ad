/* offsets - where the zero of the program lies: G10 L2 and L20, G52, G92 to G92.3; and the points
 * of G28.1 and G30.1.
 *
 *     machine coordinate = program coordinate + origin (G54 .. G59.3) + shift (G52, G92)
 *
 * As in RS-274/NGC with G52, which LinuxCNC added, G52 and G92 set the same shift. `frame` has what
 * turns or scales beside it.
 */
#ifndef OFFSETS_H
#define OFFSETS_H

#include "gcode.h"
#include "modes.h"

/* Origin of the system in force with the tool's length; shift in force; and both: the program's
 * zero of one axis in machine coordinates, if the system is not turned. [mm] */
double offsets_origin(const struct interpreter *in, int axis);
double offsets_shift(const struct interpreter *in, int axis);
double offsets_zero(const struct interpreter *in, int axis);

/* Whether the block has one of the codes that change it, and whether that takes the axis words. */
bool offsets_changed(const struct block *b);
bool offsets_take_axes(const struct block *b);

/* Execute that code. */
enum fault offsets_change(struct interpreter *in, const struct program *p, const struct block *b,
                          struct fault_report *r);

/* The code G54 .. G59.3, or G54.1 and its P, of a block comes into force. */
enum fault offsets_select(struct interpreter *in, const struct block *b, struct fault_report *r);

/* X Y Z A B C U V W of a parameter's nine, from 0, as an axis; -1 if it is none of those here. */
int offsets_axis(bool angles, int letter);

/* Numbered parameters of these values in mm and degrees: 5161.. G28, 5181.. G30, 5210 whether the
 * shift is in force, 5211.. the shift, 5220 the system, 5221.. origins, 20 apart, and the turn of
 * each behind its nine; on Fanuc's controls 7001.. and 14001.. origins of G54.1. False: no such
 * parameter here. */
bool offsets_parameter(const struct interpreter *in, const struct program *p, int number,
                       double *value);

#endif
