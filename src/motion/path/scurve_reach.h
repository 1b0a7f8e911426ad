/* scurve_reach - the fastest way to a target position and speed. */
#ifndef SCURVE_REACH_H
#define SCURVE_REACH_H

#include "scurve_leg.h"

/* Times of the phases of the fastest way, none below 0. The leg starts within its limits, and its
 * way is longer than that of its fastest change to v1. */
void scurve_reach(const struct scurve_leg *l, double t[SCURVE_LEG_PHASES]);

#endif
