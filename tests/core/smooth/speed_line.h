/* speed_line - a speed profile along a line in X of 100 mm, under way, for tests. */
#ifndef SPEED_LINE_H
#define SPEED_LINE_H

#include <string.h>

#include "check.h"
#include "speed_profile.h"

static const double LENGTH = 100.0, ACC = 1000.0, JERK = 20000.0; /* [mm, mm/s^2, mm/s^3] */

static struct speed_profile profile;

/* At rest, with the same limits for all axes. */
static inline void at_rest(void)
{
    struct speed_limits l = { .speed = { 0.0 } };

    for (int k = 0; k < AXES; k++) {
        l.acc[k] = ACC;
        l.jerk[k] = JERK;
    }
    memset(&profile, 0, sizeof profile);
    speed_profile_start(&profile, &l);
}

/* A piece of the line follows. [mm, mm, mm/s] */
static inline void piece(double from, double to, double feed)
{
    const double start[AXES] = { from }, end[AXES] = { to };
    struct segment p;
    struct path path;

    memset(&p, 0, sizeof p);
    p.kind = SEGMENT_LINE;
    p.feed = p.cap = feed;
    p.ramp = (struct ramp_limits){ ACC, ACC, JERK, JERK };
    path_line(&path, start, end);
    p.length = path.length;
    path_at(&path, 0.0, p.start, p.slope);
    CHECK(speed_profile_join(&profile, &p));
}

/* Under way at 50 mm/s. */
static inline void begin(void)
{
    at_rest();
    piece(0.0, LENGTH, 50.0);
    speed_profile_advance(&profile, 1.0, 0.2);
    CHECK(profile.at.here > 5.0 && profile.at.here < 10.0);
}

/* A speed and an acceleration in the place of those of the ride. [mm/s], [mm/s^2] */
static inline void put(double v, double a)
{
    profile.at.step.kind = SPEED_NO_STEP;
    profile.at.state = (struct speed_state){ v * v, 2.0 * a };
    profile.at.rate = v;
    profile.at.gain = a;
}

#endif
