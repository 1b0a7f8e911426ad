/* reach - whether the ramp of an abort, from here, would lead beyond the bounds of a joint.
 *
 *      .---.  limit        One move: the exact extent of its path.
 *     /  .--\------        Chain: the extent of its paths up to where it comes to rest; a corner's
 *    / ./   .              to the nanometre.
 *   /./     :              Two moves mixed, independent axes: the points at their times, in
 *  /        : box          halves until a bound of what lies between two of them decides.
 */
#ifndef REACH_H
#define REACH_H

#include "trajectory.h"

/* First joint that the ramp would bring further beyond a bound than the latest point is; -1 none.
 * The points of the ramp are dt seconds apart. With kinematics there is no box: the places of the
 * points decide, those of a chain where it goes so far in dt at the joints' highest speed. */
int reach_beyond(const struct trajectory *p, const struct trajectory_beside *b,
                 const struct mechanism *m, double dt);

#endif
