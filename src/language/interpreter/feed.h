/* feed - the speed of a motion: F in mm a minute (G94), motions a minute (G93), mm a turn (G95). */
#ifndef FEED_H
#define FEED_H

#include "gcode.h"
#include "modes.h"

/* F, G93, G94, G95 of a block. */
enum fault feed_set(struct interpreter *in, const struct program *p, const struct block *b,
                    struct fault_report *r);

/* Feed of a motion of the block along a path of a length [mm], into *feed [mm/s]: in G93 its F over
 * the time of all of it, in G95 with the spindle's speed in force; at most the highest feed, if it
 * need not be `exact`. */
enum fault feed_of(const struct interpreter *in, const struct program *p, const struct block *b,
                   double length, bool exact, double *feed, struct fault_report *r);

#endif
