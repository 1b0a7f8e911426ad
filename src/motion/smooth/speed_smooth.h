/* speed_smooth - the speed profile along a chain with limited jerk. */
#ifndef SPEED_SMOOTH_H
#define SPEED_SMOOTH_H

#include "speed_profile.h"

bool speed_smooth_join(struct speed_profile *p, const struct segment *segment);
double speed_smooth_advance(struct speed_profile *p, double override, double dt);
double speed_smooth_stop_way(const struct speed_profile *p);
bool speed_smooth_nears_end(const struct speed_profile *p, double further);

/* The chain ends at a way within it; false: it can't come to rest there, nothing changes. */
bool speed_smooth_end(struct speed_profile *p, double way);

#endif
