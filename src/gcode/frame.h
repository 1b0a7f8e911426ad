/* frame - from coordinates as they are programmed to those of the machine and back.
 *
 *     program -> scaling (G51) -> rotation (G68) -> + G52, G92 -> turn of the system (G10 L2 R)
 *             -> + origin of the system (G54 .. G59.3) and of the tool -> machine
 *
 * The first two in the order that Fanuc gives them; the centre of the rotation is scaled, too.
 */
#ifndef FRAME_H
#define FRAME_H

#include "gcode.h"
#include "modes.h"

/* Machine coordinates of program coordinates, and the other way round. [mm], [deg] */
void frame_machine(const struct interpreter *in, const double program[AXES],
                   double machine[AXES]);
void frame_program(const struct interpreter *in, const double machine[AXES],
                   double program[AXES]);

/* A way in X Y Z, no place. [mm] */
void frame_way(const struct interpreter *in, double way[3]);

/* Where the axis words of a block lead from in->point, with G53, G91, G16 and @ ^; machine
 * coordinates. Axes without a word keep exactly what they have. */
enum fault frame_end(struct interpreter *in, const struct program *p, const struct block *b,
                     double end[AXES], struct fault_report *r);

/* What becomes of circles in a plane: their radius grows by *ratio, and `mirrored` ones turn the
 * other way round. False if they do not stay circles in this plane. */
bool frame_circles(const struct interpreter *in, enum path_plane plane, double *ratio,
                   bool *mirrored);

/* G51, G68 (which take the axis words), G50, G69, G15, G16 of a block. */
enum fault frame_change(struct interpreter *in, const struct program *p, const struct block *b,
                        struct fault_report *r);

/* Whether G51 or G68 of this block takes the axis words. */
bool frame_takes_axes(const struct block *b);

#endif
