/* feed - the feed of a motion from its F: mm or inch per minute (G94), motions per minute (G93), mm
 * or inch per turn of the spindle (G95). */
#ifndef FEED_H
#define FEED_H

#include "gcode.h"
#include "modes.h"

/* Execute F, G93, G94, G95 of a block. A new mode forgets the F of the one before. FAULT_VALUE: F
 * is not above 0; FAULT_FEED: above the highest feed, if that is a fault; else it is a note. */
enum fault feed_set(struct interpreter *in, const struct program *p, const struct block *b,
                    struct fault_report *r);

/* Feed of a motion of the block along a path of a length [mm], into *feed [mm/s]:
 *
 *     G94  F/60      G93  length * F/60      G95  F * S/60, S the spindle's speed [rpm]
 *
 * Above the highest feed it is that; if it must be `exact`, or with p->strict_feed, a fault.
 * FAULT_NO_FEED; G95: FAULT_SURFACE (G96 is in force), FAULT_REST (the spindle does not turn). */
enum fault feed_of(const struct interpreter *in, const struct program *p, const struct block *b,
                   double length, bool exact, double *feed, struct fault_report *r);

#endif
