/* scurve_reach - the fastest way to a target position and speed. */
#ifndef SCURVE_REACH_H
#define SCURVE_REACH_H

#include "scurve_leg.h"

/* For a leg that starts within its limits and whose way is longer than that of its fastest change
 * to v1: times of its phases, none below 0. */
void scurve_reach(const struct scurve_leg *l, double t[SCURVE_LEG_PHASES]);

#endif
