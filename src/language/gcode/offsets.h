/* offsets - where the zero of the program lies, by coordinate systems (G54 to G59.3, G10 L2, L20)
 * and the shift of G52 and G92 to G92.3; and the points that G28.1 and G30.1 keep.
 *
 *     machine coordinate = program coordinate + origin (G54 .. G59.3) + shift (G52, G92)
 *
 * G52 and G92 set the same shift, as in RS-274/NGC with the G52 that LinuxCNC added. `frame` adds
 * scaling and rotation to this sum.
 */
#ifndef OFFSETS_H
#define OFFSETS_H

#include "gcode.h"
#include "modes.h"

/* Offsets of one axis [mm], [deg]: origin of the system in force plus the tool's offset; shift in
 * force; and the sum of both, which is the machine coordinate of the program's zero if the system
 * is not turned. */
double offsets_origin(const struct interpreter *in, int axis);
double offsets_shift(const struct interpreter *in, int axis);
double offsets_zero(const struct interpreter *in, int axis);

/* Whether the block has G10, G28.1, G30.1, G52 or G92 to G92.3; and whether it has one of these
 * that takes its axis words: G10, G52, G92. */
bool offsets_changed(const struct block *b);
bool offsets_take_axes(const struct block *b);

/* Execute that code. FAULT_FRAME: G51 or G68 is in force, except for G28.1 and G30.1;
 * FAULT_NO_AXES, FAULT_AXIS; G10: FAULT_NO_SYSTEM, FAULT_VALUE, FAULT_UNUSED (R with L20). */
enum fault offsets_change(struct interpreter *in, const struct program *p, const struct block *b,
                          struct fault_report *r);

/* Bring the system of a block into force: G54 .. G59.3, or G54.1, G154 with P 1 to 99.
 * FAULT_MISSING: no P; FAULT_VALUE: another one. */
enum fault offsets_select(struct interpreter *in, const struct block *b, struct fault_report *r);

/* Axis of one of the nine letters X Y Z A B C U V W, numbered from 0 as parameters do; -1: the
 * machine does not have it. */
int offsets_axis(bool angles, int letter);

/* Value of a numbered parameter, in mm and degrees: from 5161 on the point of G28, from 5181 on
 * that of G30; 5210: the shift is in force, from 5211 on the shift. 5220: number of the system,
 * from 5221 on the origins, 20 numbers apart, and behind the nine axes of each its turn; on Fanuc's
 * controls from 7001 and 14001 on origins of G54.1. False: it is none of these. */
bool offsets_parameter(const struct interpreter *in, const struct program *p, int number,
                       double *value);

#endif
