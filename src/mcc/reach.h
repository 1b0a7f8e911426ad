/* reach - whether the ramp of an abort, from here, would lead beyond a software limit.
 *
 *      .---.  limit        One move: the exact extent of its path.
 *     /  .--\------        Chain: the extent of its paths up to where it comes to rest; a corner's
 *    / ./   .              to the nanometre.
 *   /./     :              Two moves mixed, independent axes: points at the DDA boundaries, in
 *  /        : box          halves until a bound of what lies between two of them decides.
 */
#ifndef REACH_H
#define REACH_H

#include "ipo.h"

/* First axis that the ramp would bring further beyond a limit than the latest point is; -1 none. */
int reach_beyond(const struct ipo *p, struct ring *r, const struct machine *m);

#endif
