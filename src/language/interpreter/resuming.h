/* resuming - what is left of a program when it has ended, and where the next text goes on: another
 * program, or lines that are given by hand.
 *
 * Origins, shifts, tools, parameters, F, S and the modes outlive the text; M2 and M30 put some of
 * the modes back, as in LinuxCNC.
 */
#ifndef RESUMING_H
#define RESUMING_H

#include "modes.h"

/* The text has ended: G15 G17 G40 G50 G54 G69 G80 G90 G94. Of G93 and G95 no F is left, and
 * `feed` [mm/s] is in force. */
void resuming_end(struct interpreter *in, double feed);

/* What was read has been dropped before it was driven: all modes as at the first start. */
void resuming_defaults(struct interpreter *in, double feed);

/* Read on at a place of another text; no call, loop or condition is open. */
void resuming_text(struct interpreter *in, int64_t offset, int32_t line);

/* Nothing is open or waits for a next motion, and the axes rest in a point, machine coordinates
 * [mm], [deg]. */
void resuming_place(struct interpreter *in, const double point[AXES]);

/* Whether a motion waits for the next one, for a curve, or for its corner. */
bool resuming_held(const struct interpreter *in);

#endif
