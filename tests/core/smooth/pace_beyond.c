/* A state that no limit of the axes allows, as a saved one may hold: the ride goes on and ends. */
#include <string.h>

#include "check.h"
#include "pace.h"

static const double LENGTH = 100.0; /* [mm] */

static struct pace pace;

/* Under way along a line in X, 50 mm/s, 1000 mm/s^2, 20000 mm/s^3. */
static void begin(void)
{
    const double start[AXES] = { 0.0 }, end[AXES] = { LENGTH };
    struct pace_limits l = { .speed = { 0.0 } };
    struct segment p;
    struct path path;

    for (int k = 0; k < AXES; k++) {
        l.acc[k] = 1000.0;
        l.jerk[k] = 20000.0;
    }
    memset(&p, 0, sizeof p);
    p.kind = SEGMENT_LINE;
    p.feed = p.cap = 50.0;
    p.ramp = (struct ramp_limits){ 1000.0, 1000.0, 20000.0, 20000.0 };
    path_line(&path, start, end);
    p.length = path.length;
    path_at(&path, 0.0, p.start, p.slope);
    memset(&pace, 0, sizeof pace);
    pace_start(&pace, &l);
    CHECK(pace_join(&pace, &p));
    pace_advance(&pace, 1.0, 0.2);
    CHECK(pace.at.here > 5.0 && pace.at.here < 10.0);
}

/* A speed and an acceleration in the place of those of the ride. [mm/s], [mm/s^2] */
static void put(double v, double a)
{
    pace.at.step.kind = PACE_NO_STEP;
    pace.at.state = (struct pace_state){ v * v, 2.0 * a };
    pace.at.rate = v;
    pace.at.gain = a;
}

/* No bend of the acceleration keeps the limits, so that it stays as it is for a step: over a way s
 * the square of the speed changes by 2 a s, and there is no jerk. */
static void keeps_its_acceleration(double v, double a)
{
    begin();
    put(v, a);
    const double from = pace.at.here;
    pace_advance(&pace, 0.0, 1e-7);
    CHECK_EQ(pace.at.step.kind, PACE_BENT);
    CHECK(pace.at.step.c == 0.0 && pace.at.twitch == 0.0 && pace.at.gain == a);
    CHECK_NEAR(pace.at.rate * pace.at.rate, v * v + 2.0 * a * (pace.at.here - from), 1e-9 * v * v);
}

/* Braking, it comes to rest by one jerk: after 2 v / |a|, over 2 v^2 / (3 |a|). */
static void lands(double v, double a)
{
    begin();
    put(v, a);
    const double from = pace.at.here;
    pace_advance(&pace, 0.0, -2.0 * v / a * (1.0 + 1e-9));
    CHECK(pace.at.rate == 0.0);
    CHECK_NEAR(pace.at.here - from, -2.0 * v * v / (3.0 * a), 1e-9 * v * v / -a);
}

/* Held, it rests before the end or at it, without a step back; let go, it arrives. */
static void ends(double v, double a)
{
    begin();
    put(v, a);
    double before = pace.at.way;
    const double stop = pace_stop_way(&pace);
    CHECK(stop >= before && stop <= LENGTH);
    for (int n = 0; n < 100000 && (pace.at.rate > 0.0 || n == 0); n++) {
        pace_advance(&pace, 0.0, 1e-4);
        CHECK(pace.at.way >= before && pace.at.way <= LENGTH && isfinite(pace.at.rate));
        before = pace.at.way;
    }
    CHECK(pace.at.rate == 0.0);
    pace_advance(&pace, 1.0, 60.0);
    CHECK(pace_at_end(&pace) && pace.at.way == LENGTH);
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
