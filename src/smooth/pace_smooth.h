/* pace_smooth - the way along a chain with limited jerk, for pace. */
#ifndef PACE_SMOOTH_H
#define PACE_SMOOTH_H

#include "pace.h"

bool pace_smooth_join(struct pace *p, const struct piece *piece);
double pace_smooth_advance(struct pace *p, double override, double dt);
double pace_smooth_stop_way(const struct pace *p);

/* Whether it can come to rest at the end of leg i. */
bool pace_smooth_can_rest(const struct pace *p, int32_t i);

#endif
