/* compensate - pitch and backlash compensation of the axes, between interpolation and card.
 *
 * The position of the library, in mm and in pulses, is the uncompensated one; only the frames of
 * the card carry the correction. When motion ends, frames go on until all of it has been driven in.
 */
#ifndef COMPENSATE_H
#define COMPENSATE_H

#include "mcc.h"

/* Some correction is still to be driven in where the axes stand. */
bool compensate_due(const struct mcc *m);

/* Add what fits to the frames of the next point, whose pulses and frames are uncompensated;
 * in a dry run the frames become zero. */
void compensate_frame(struct mcc *m, struct point *p);

#endif
