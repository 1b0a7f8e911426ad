/* Profiles with S-shaped ramps: durations, limits at every sample under any replanning, joints. */
#include "check.h"
#include "profile.h"

static struct scurve_start at(struct profile *p, double t)
{
    p->t = t;
    return profile_state(p);
}

static double any(uint64_t *seed, double low, double high)
{
    return exp(check_real(seed, log(low), log(high)));
}

static struct ramp_limits random_ramp(uint64_t *seed, int kind)
{
    struct ramp_limits r = { any(seed, 50.0, 5000.0), any(seed, 50.0, 5000.0), 0.0, 0.0 };
    r.acc_jerk = kind & 1 ? any(seed, 1e3, 1e6) : 0.0;
    r.dec_jerk = kind & 2 ? any(seed, 1e3, 1e6) : 0.0;
    return r;
}

/* With one jerk for both ramps a plan is the time-optimal one, from rest and on the way. */
static void optimal(void)
{
    uint64_t seed = 1;
    for (int i = 0; i < 3000; i++) {
        struct profile_limits l = { any(&seed, 1.0, 500.0), random_ramp(&seed, 3) };
        const struct scurve_start rest = { 0.0, 0.0, 0.0 };
        const double way = any(&seed, 1e-4, 500.0);
        struct profile p;
        struct scurve best;
        l.ramp.dec_jerk = l.ramp.acc_jerk;
        const struct scurve_limits own = { l.speed, l.ramp.acc, l.ramp.dec, l.ramp.acc_jerk };
        profile_plan(&p, &rest, way, &l);
        CHECK(scurve_plan(&best, &rest, way, &own) == SCURVE_OK);
        CHECK_NEAR(p.total, best.total, 1e-9 * best.total);
        const double t = check_real(&seed, 0.0, 1.0) * p.total;
        const struct scurve_start on = at(&p, t);
        profile_plan(&p, &on, way, &l);
        CHECK_NEAR(t + p.total, best.total, 1e-6 * best.total);
    }
}

/* Without jerk limits on one side only, closed forms of the ramps' times. */
static void mixed(void)
{
    const struct scurve_start rest = { 0.0, 0.0, 0.0 };
    const struct profile_limits l = { 100.0, { 1000.0, 500.0, 0.0, 5000.0 } };
    struct profile p;
    /* up 0.1 s and 5 mm; down 100/500 + 500/5000 = 0.3 s and 15 mm; 80 mm at 100 mm/s */
    profile_plan(&p, &rest, 100.0, &l);
    CHECK_NEAR(p.total, 0.1 + 0.8 + 0.3, 1e-8);
    CHECK_NEAR(p.tail, 0.9, 1e-8);
    CHECK_NEAR(at(&p, 0.05).v, 50.0, 1e-5);
    CHECK_NEAR(at(&p, 0.9 + 0.15).v, 50.0, 1e-5);
    CHECK_NEAR(at(&p, 0.9 + 0.05).a, -250.0, 1e-5);
}

/* New targets at random moments: s, v and, where the jerk is limited, a stay continuous and within
 * their limits, the motion never turns back, the end is met. */
static void replanned(void)
{
    uint64_t seed = 2;
    for (int i = 0; i < 1500; i++) {
        const struct ramp_limits r = random_ramp(&seed, 1 + i % 3);
        const double way = any(&seed, 0.01, 300.0);
        const double jerk = fmax(r.acc_jerk, r.dec_jerk);
        struct scurve_start x = { 0.0, 0.0, 0.0 };
        struct profile p;
        double fastest = 0.0;
        for (int k = 0; k < 8; k++) {
            const double target = k == 7 ? 50.0
                                  : check_real(&seed, 0.0, 1.0) < 0.3
                                      ? 0.0
                                      : check_real(&seed, 1.0, 300.0);
            const struct profile_limits l = { target, r };
            const struct scurve_start before = x;
            fastest = fmax(fastest, target);
            profile_plan(&p, &x, way, &l);
            x = at(&p, 0.0);
            const bool far = way - before.s > 1e-5;
            CHECK_NEAR(x.s, before.s, 1e-9 * way + 2e-9 * fastest); /* 1 ns of a jump of a */
            CHECK(!far || fabs(x.v - before.v) <= 1e-6 * fastest);
            CHECK(!far || i % 3 != 2 || fabs(x.a - before.a) <= 1e-6 * (r.acc + r.dec));
            const double t1 = k == 7 ? p.total : check_real(&seed, 0.0, 1.1) * p.total;
            const double dt = t1 / 60.0;
            struct scurve_start last = x;
            for (int j = 1; j <= 60; j++) {
                x = at(&p, j < 60 ? dt * j : t1);
                CHECK(x.s >= last.s - 1e-12 * way - 2e-9 * fastest && x.s <= way);
                CHECK(x.v >= 0.0 && x.v <= fastest + 1e-9);
                CHECK(x.a <= r.acc * (1.0 + 1e-6) && x.a >= -r.dec * (1.0 + 1e-6));
                CHECK(x.s - last.s <= fastest * dt * (1.0 + 1e-6) + 1e-12 * way);
                CHECK(!far || x.v - last.v <= r.acc * dt * (1.0 + 1e-6) + 1e-9);
                CHECK(!far || last.v - x.v <= r.dec * dt * (1.0 + 1e-6) + 1e-9);
                CHECK(i % 3 != 2 || fabs(x.a - last.a) <= jerk * dt * (1.0 + 1e-6) + 1e-6 * r.acc);
                last = x;
            }
        }
        CHECK(p.ends && x.s == way && x.v == 0.0);
    }
}

int main(void)
{
    optimal();
    mixed();
    replanned();
    return check_result();
}
