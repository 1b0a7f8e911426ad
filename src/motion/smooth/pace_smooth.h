/* pace_smooth - the way along a chain with limited jerk, for pace. */
#ifndef PACE_SMOOTH_H
#define PACE_SMOOTH_H

#include "pace.h"

bool pace_smooth_join(struct pace *p, const struct segment *segment);
double pace_smooth_advance(struct pace *p, double override, double dt);
double pace_smooth_stop_way(const struct pace *p);
bool pace_smooth_nears_end(const struct pace *p, double further);

/* The chain ends at a way within it; false: it can't come to rest there, nothing changes. */
bool pace_smooth_end(struct pace *p, double way);

#endif
