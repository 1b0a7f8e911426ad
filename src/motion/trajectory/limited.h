/* limited - what keeps a motion from being faster at an instant.
 *
 * While it holds its speed, the limit that it holds; while it gains speed, acceleration or jerk;
 * while it loses speed, what it slows down for.
 */
#ifndef LIMITED_H
#define LIMITED_H

#include "mechanism.h"
#include "profile.h"

enum limited_by {
    LIMITED_FEED = 1,     /* programmed feed, the machine's highest feed, override */
    LIMITED_SPEED,        /* highest speed of an axis */
    LIMITED_ACCELERATION, /* of the ramps, or of an axis on a bend */
    LIMITED_JERK,
    LIMITED_CORNER, /* tolerance of a corner */
    LIMITED_STOP,   /* rest at the end of a command */
    LIMITED_DWELL,
    LIMITED_WAIT /* hold, operator, in-position check */
};

struct limited {
    enum limited_by by;
    int32_t axis; /* from 1; 0: not one of an axis */
    double feed;  /* [mm/s] programmed for what moves, of a rapid its highest; 0: nothing moves */
};

/* A speed [mm/s] held along a path of this slope: that of the axis whose highest speed it reaches,
 * else the feed's. */
struct limited limited_speed(const struct mechanism *m, const double slope[AXES], double speed);

/* On a profile to rest at its end, whose speed held would be told as `held`. */
struct limited limited_profile(const struct profile *p, struct limited held);

#endif
