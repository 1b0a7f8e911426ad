/* Steps of the way in time: what is told at an instant are derivatives of each other, and the ends
 * are those of the step. */
#include "check.h"
#include "speed_step.h"

enum { PARTS = 400 };

/* Simpson's rule over a part of the time, which is exact for constant jerk and off by the fifth
 * power of the part for a bent step. */
static double over(double h, double a, double b, double c)
{
    return h / 6.0 * (a + 4.0 * b + c);
}

static void look(const struct speed_step *s, double speed, double acc)
{
    const double h = s->time / PARTS;
    struct speed_motion a = speed_step_at(s, 0.0), from = a;
    double rate = 0.0, gain = 0.0;

    CHECK_NEAR(a.way, 0.0, 1e-12);
    CHECK_NEAR(a.rate, speed, 1e-12 * (1.0 + speed));
    CHECK_NEAR(a.gain, acc, 1e-12 * (1.0 + fabs(acc)));
    for (int k = 0; k < PARTS; k++) {
        const struct speed_motion b = speed_step_at(s, (k + 0.5) * h);
        const struct speed_motion c = speed_step_at(s, (k + 1) * h);
        rate = fmax(rate, fmax(b.rate, c.rate));
        gain = fmax(gain, fmax(fabs(b.gain), fabs(c.gain)));
        CHECK_NEAR(c.way - a.way, over(h, a.rate, b.rate, c.rate), 1e-9 * s->way);
        CHECK_NEAR(c.rate - a.rate, over(h, a.gain, b.gain, c.gain), 1e-9 * rate);
        /* The jerk of a hop changes where a part ends: that of the middle is the part's. */
        const double jerk = s->kind == SPEED_BENT ? over(1.0, a.jerk, b.jerk, c.jerk) : b.jerk;
        CHECK_NEAR(c.gain - a.gain, h * jerk, 1e-9 * gain);
        a = c;
    }
    CHECK(s->way > 0.0 && (rate > from.rate || gain > 0.0));
    CHECK_NEAR(a.way, s->way, 1e-9 * s->way);
}

/* On a hop the fastest is in the middle, where a fourth of the most jerk has built up twice. */
static void hop(double jerk, double way)
{
    const struct speed_step s = speed_step_hop(jerk, way);
    const double part = s.time / 4.0;
    const struct speed_motion half = speed_step_at(&s, 2.0 * part);

    look(&s, 0.0, 0.0);
    CHECK_NEAR(half.way, 0.5 * way, 1e-12 * way);
    CHECK_NEAR(half.rate, jerk * part * part, 1e-9 * half.rate);
    CHECK_NEAR(speed_step_at(&s, part).gain, jerk * part, 1e-9 * jerk * part);
    CHECK_NEAR(speed_step_at(&s, 3.0 * part).gain, -jerk * part, 1e-9 * jerk * part);
    CHECK_NEAR(speed_step_at(&s, s.time).rate, 0.0, 1e-9 * half.rate);
}

int main(void)
{
    uint64_t seed = 3;

    for (int i = 0; i < 50; i += CHECK_EACH) {
        const double jerk = pow(10.0, check_real(&seed, 2.0, 7.0));
        const double way = pow(10.0, check_real(&seed, -3.0, 2.0));
        const struct speed_state from = { check_real(&seed, 1.0, 1e4), check_real(&seed, -50, 50) };
        const double c = check_real(&seed, -20.0, 20.0);
        hop(jerk, way);
        const struct speed_step start = speed_step_start(jerk, 0.01);
        look(&start, 0.0, 0.0);
        CHECK_NEAR(pow(speed_step_at(&start, 0.01).rate, 2.0), start.to.x, 1e-9 * start.to.x);
        CHECK_NEAR(2.0 * speed_step_at(&start, 0.01).gain, start.to.b, 1e-9 * start.to.b);
        const struct speed_state fast = { from.x, -1.0 - fabs(from.b) };
        const struct speed_step land = speed_step_land(fast);
        look(&land, sqrt(fast.x), 0.5 * fast.b);
        CHECK_NEAR(speed_step_at(&land, land.time).rate, 0.0, 1e-9 * sqrt(fast.x));
        CHECK_NEAR(speed_step_at(&land, land.time).gain, 0.0, 1e-9 * fabs(fast.b));
        const struct speed_step bent = speed_step_bent(from, c, 0.01);
        look(&bent, sqrt(from.x), 0.5 * from.b);
        const struct speed_motion end = speed_step_at(&bent, bent.time);
        CHECK_NEAR(end.rate, sqrt(bent.to.x), 1e-9 * end.rate);
        CHECK_NEAR(end.gain, 0.5 * bent.to.b, 1e-9 * (1.0 + fabs(end.gain)));
    }
    return check_result();
}
