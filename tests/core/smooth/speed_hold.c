/* A hold on a straight way brings the motion to rest in little more time than the jerk needs. */
#include <string.h>

#include "check.h"
#include "speed_profile.h"

static const double LENGTH = 100.0, ACC = 1000.0, JERK = 20000.0; /* [mm, mm/s^2, mm/s^3] */

static struct speed_profile profile;

/* Under way along a line in X at 50 mm/s. */
static void begin(void)
{
    const double start[AXES] = { 0.0 }, end[AXES] = { LENGTH };
    struct speed_limits l = { .speed = { 0.0 } };
    struct segment p;
    struct path path;

    for (int k = 0; k < AXES; k++) {
        l.acc[k] = ACC;
        l.jerk[k] = JERK;
    }
    memset(&p, 0, sizeof p);
    p.kind = SEGMENT_LINE;
    p.feed = p.cap = 50.0;
    p.ramp = (struct ramp_limits){ ACC, ACC, JERK, JERK };
    path_line(&path, start, end);
    p.length = path.length;
    path_at(&path, 0.0, p.start, p.slope);
    memset(&profile, 0, sizeof profile);
    speed_profile_start(&profile, &l);
    CHECK(speed_profile_join(&profile, &p));
    speed_profile_advance(&profile, 1.0, 0.2);
}

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
    begin();
    profile.at.step.kind = SPEED_NO_STEP;
    profile.at.state = (struct speed_state){ v * v, -2.0 * braking };
    profile.at.rate = v;
    profile.at.gain = -braking;
    double time = 0.0;
    const double dt = 0.001 * least(v, braking);
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
            worst = fmax(worst, ratio);
        }
    }
    printf("at most %.2f times the least time\n", worst);
    CHECK(worst < 2.0);
    return check_result();
}
