/* frame - turns program coordinates into machine coordinates, and back.
 *
 *     program -> scaling (G51) -> rotation (G68) -> + G52, G92 -> turn of the system (G10 L2 R)
 *             -> + origin of the system (G54 .. G59.3) and of the tool -> machine
 *
 * Scaling comes in front of rotation, as on Fanuc's controls, so it scales the centre of the
 * rotation, too.
 */
#ifndef FRAME_H
#define FRAME_H

#include "gcode.h"
#include "modes.h"

/* Machine coordinates [mm], [deg] of program coordinates, and the reverse. */
void frame_machine(const struct interpreter *in, const double program[AXES], double machine[AXES]);
void frame_program(const struct interpreter *in, const double machine[AXES], double program[AXES]);

/* Scale and turn a displacement in X Y Z [mm] as frame_machine does points, without offsets. */
void frame_way(const struct interpreter *in, double way[3]);

/* Programmed position, machine coordinates [mm], [deg]: in->point; or the end of the contour, while
 * the tool still stands beside it behind G40. */
void frame_here(const struct interpreter *in, double here[AXES]);

/* Where the axis words of a block count from, machine coordinates [mm], [deg]: frame_here if the
 * block has words in the plane of the contour; else in->point, so that the tool stays beside it. */
void frame_from(const struct interpreter *in, const struct block *b, double from[AXES]);

/* End point of a block in machine coordinates [mm], [deg]: from there by its axis words, with G53,
 * G91, G16 and @ ^. An axis without a word, and that no rotation couples to one with a word, keeps
 * its value to the bit. FAULT_AXIS: the machine lacks the axis; FAULT_POLE, FAULT_SHARED: @ ^. */
enum fault frame_end(struct interpreter *in, const struct program *p, const struct block *b,
                     double end[AXES], struct fault_report *r);

/* Step from one hole of a cycle's block to the next: with G91 as from `before`, where the tool was
 * in front of the first hole (program coordinates [mm]), to that hole; with G90 none. */
void frame_cycle_way(const struct interpreter *in, const struct block *b, const double before[AXES],
                     struct cycle_way *way);

/* Move a hole, in program coordinates, by that step. False: it lies in the pole of @ ^, where no
 * angle is known. */
bool frame_go_on(struct interpreter *in, const struct cycle_way *way, double place[AXES]);

/* What scaling and rotation make of circles in a plane: *ratio is the factor of their radius, and
 * *mirrored says that they turn the other way round. False: they do not stay circles in it. */
bool frame_circles(const struct interpreter *in, enum path_plane plane, double *ratio,
                   bool *mirrored);

/* Execute G50, G51, G68, G69, G15 and G16 of a block. FAULT_FRAME: G50 or G51 while G68 is in
 * force; FAULT_NO_FACTOR, FAULT_NO_ANGLE: a word is missing; FAULT_VALUE: a factor out of range. */
enum fault frame_change(struct interpreter *in, const struct program *p, const struct block *b,
                        struct fault_report *r);

/* Whether the block has G51 or G68, which take its axis words. */
bool frame_takes_axes(const struct block *b);

#endif
