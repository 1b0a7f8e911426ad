/* A hold on a straight way brings the motion to rest in little more time than the jerk needs. */
#include "speed_line.h"

/* Least time to rest from a speed and a braking of so much: the jerk down to some braking, a while
 * with the most, and back to none. [s] */
static double least(double v, double braking)
{
    const double deep = sqrt(JERK * v + 0.5 * braking * braking);

    if (deep <= ACC) {
        return (2.0 * deep - braking) / JERK;
    }
    return (2.0 * ACC - braking) / JERK + v / ACC + (0.5 * braking * braking / ACC - ACC) / JERK;
}

/* Time in which it comes to rest. [s] */
static double taken(double v, double braking)
{
    const double dt = 0.001 * least(v, braking);
    double time = 0.0;

    begin();
    put(v, -braking);
    for (; profile.at.rate > 0.0 && time < 100.0; time += dt) {
        speed_profile_advance(&profile, 0.0, dt);
        CHECK(profile.at.gain >= -ACC * (1.0 + 1e-9));
        CHECK(fabs(profile.at.twitch) <= JERK * (1.0 + 1e-6));
    }
    return time;
}

int main(void)
{
    static const double speeds[] = { 1e-3, 0.01, 0.1, 1.0, 5.0, 20.0, 50.0 };
    static const double parts[] = { 0.0, 1e-4, 0.01, 0.1, 0.3, 0.6, 0.9, 0.999 };
    double worst = 0.0;

    for (size_t i = 0; i < sizeof speeds / sizeof *speeds; i++) {
        for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
            /* More braking than this goes beyond rest whatever the jerk does. */
            const double most = fmin(ACC, sqrt(2.0 * JERK * speeds[i]));
            const double braking = parts[k] * most;
            const double ratio = taken(speeds[i], braking) / least(speeds[i], braking);
            CHECK(ratio > 0.998); /* but for the last piece of time */
            worst = fmax(worst, ratio);
        }
    }
    CHECK(worst < 2.0);
    return check_result();
}
