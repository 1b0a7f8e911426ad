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
void frame_machine(const struct interpreter *in, const double program[AXES], double machine[AXES]);
void frame_program(const struct interpreter *in, const double machine[AXES], double program[AXES]);

/* A way in X Y Z, no place. [mm] */
void frame_way(const struct interpreter *in, double way[3]);

/* Where the program has led the axes, machine coordinates: in->point, or behind G40, while the tool
 * stands beside it, the end of the contour. */
void frame_here(const struct interpreter *in, double here[AXES]);

/* The point from which the axis words of a block count, machine coordinates: that, if
 * the block has words in the plane of the contour; without any the tool stays beside it. */
void frame_from(const struct interpreter *in, const struct block *b, double from[AXES]);

/* Where the axis words of a block lead from there, with G53, G91, G16 and @ ^; machine coordinates.
 * Axes without a word keep exactly what they have. */
enum fault frame_end(struct interpreter *in, const struct program *p, const struct block *b,
                     double end[AXES], struct fault_report *r);

/* The way from one hole of a cycle's block to its next with G91, from a place before the first. */
void frame_cycle_way(const struct interpreter *in, const struct block *b, const double before[AXES],
                     struct cycle_way *way);

/* Go on by it. False: the tool is at the pole, from which no angle is known. [mm] program */
bool frame_go_on(struct interpreter *in, const struct cycle_way *way, double place[AXES]);

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
