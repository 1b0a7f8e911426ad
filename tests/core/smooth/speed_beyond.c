/* A state that no limit of the axes allows, as a saved one may hold: the ride goes on and ends. */
#include "speed_line.h"

/* No bend of the acceleration keeps the limits, so that it stays as it is for a step: over a way s
 * the square of the speed changes by 2 a s, and there is no jerk. */
static void keeps_its_acceleration(double v, double a)
{
    begin();
    put(v, a);
    const double from = profile.at.here;
    speed_profile_advance(&profile, 0.0, 1e-7);
    CHECK_EQ(profile.at.step.kind, SPEED_BENT);
    CHECK(profile.at.step.c == 0.0 && profile.at.twitch == 0.0 && profile.at.gain == a);
    CHECK_NEAR(profile.at.rate * profile.at.rate, v * v + 2.0 * a * (profile.at.here - from),
               1e-9 * v * v);
}

/* Braking, it comes to rest by one jerk: after 2 v / |a|, over 2 v^2 / (3 |a|). */
static void lands(double v, double a)
{
    begin();
    put(v, a);
    const double from = profile.at.here;
    speed_profile_advance(&profile, 0.0, -2.0 * v / a * (1.0 + 1e-9));
    CHECK(profile.at.rate == 0.0);
    CHECK_NEAR(profile.at.here - from, -2.0 * v * v / (3.0 * a), 1e-9 * v * v / -a);
}

/* Held, it rests before the end or at it, without a step back; let go, it arrives. */
static void ends(double v, double a)
{
    begin();
    put(v, a);
    double before = profile.at.way;
    const double stop = speed_profile_stop_way(&profile);
    CHECK(stop >= before && stop <= LENGTH);
    for (int n = 0; n < 100000 && (profile.at.rate > 0.0 || n == 0); n++) {
        speed_profile_advance(&profile, 0.0, 1e-4);
        CHECK(profile.at.way >= before && profile.at.way <= LENGTH && isfinite(profile.at.rate));
        before = profile.at.way;
    }
    CHECK(profile.at.rate == 0.0);
    speed_profile_advance(&profile, 1.0, 60.0);
    CHECK(speed_profile_at_end(&profile) && profile.at.way == LENGTH);
}

int main(void)
{
    static const double speeds[] = { 1.0, 50.0, 1e3 };
    static const double rates[] = { -1e9, -1e6, -2e3, 0.0, 2e3, 1e6, 1e9 };

    keeps_its_acceleration(50.0, 2e3);
    lands(50.0, -2e3);
    keeps_its_acceleration(1e3, 1e5);
    lands(1e3, -1e5);
    for (size_t i = 0; i < sizeof speeds / sizeof *speeds; i++) {
        for (size_t k = 0; k < sizeof rates / sizeof *rates; k++) {
            ends(speeds[i], rates[k]);
        }
    }
    return check_result();
}
