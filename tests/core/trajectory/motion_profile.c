/* Trapezoidal profile: closed-form durations, limits under any sequence of replanning. */
#include "check.h"
#include "profile.h"

/* T of a rest-to-rest move: L/v + v (1/a + 1/d)/2 if v is reached, else the triangle. */
static double duration(double way, double v, double a, double d)
{
    const double ramps = v * v / 2.0 * (1.0 / a + 1.0 / d);
    const double peak = sqrt(2.0 * way / (1.0 / a + 1.0 / d));
    return ramps <= way ? way / v + v / 2.0 * (1.0 / a + 1.0 / d) : peak * (1.0 / a + 1.0 / d);
}

static void plan(struct profile *p, double s, double v, double length,
                 const struct profile_limits *l)
{
    profile_plan(p, &(struct scurve_start){ s, v, 0.0 }, length, l);
}

static struct scurve_start at(struct profile *p, double t)
{
    p->t = t;
    return profile_state(p);
}

static void rest_to_rest(void)
{
    uint64_t seed = 1;
    for (int i = 0; i < 2000; i++) {
        const double way = pow(10.0, check_real(&seed, -6.0, 4.0));
        const double acc = check_real(&seed, 10.0, 5000.0), dec = check_real(&seed, 10.0, 5000.0);
        const struct profile_limits l = { check_real(&seed, 0.1, 500.0), { acc, dec, 0.0, 0.0 } };
        struct profile p;
        plan(&p, 0.0, 0.0, way, &l);
        const double want = duration(way, l.speed, acc, dec);
        CHECK(p.ends);
        CHECK_NEAR(p.total, want, 1e-12 * want);
        const double top = fmin(l.speed, sqrt(2.0 * way * acc * dec / (acc + dec)));
        CHECK_NEAR(at(&p, p.tail).v, top, 1e-9 * top);
        CHECK(at(&p, p.total).s == way && at(&p, p.total).v == 0.0);
    }
}

/* Nearer to the end than this a plan has lost its digits: v^2/(2 d) of 1e-9 mm needs s to
 * 1e-15 mm for the deceleration of 1e-6 relative. A pulse is a million times larger. [mm] */
static const double NEAR = 1e-6;

/* New targets at random moments: s and v stay continuous, v and a within limits, the end exact. */
static void replanned(void)
{
    uint64_t seed = 2;
    for (int i = 0; i < 500; i++) {
        const double way = check_real(&seed, 0.01, 200.0);
        const double acc = check_real(&seed, 50.0, 3000.0), dec = check_real(&seed, 50.0, 3000.0);
        struct profile p;
        double s = 0.0, v = 0.0, fastest = 0.0;
        for (int k = 0; k < 8; k++) {
            const double target = k == 7 ? 50.0
                                  : check_real(&seed, 0.0, 1.0) < 0.3
                                      ? 0.0
                                      : check_real(&seed, 1.0, 300.0);
            const struct profile_limits l = { target, { acc, dec, 0.0, 0.0 } };
            const double s0 = s, v0 = v;
            fastest = fmax(fastest, target);
            plan(&p, s, v, way, &l);
            s = at(&p, 0.0).s;
            v = at(&p, 0.0).v;
            CHECK_NEAR(s, s0, 1e-12 * way);
            const bool far = way - s0 > NEAR;
            CHECK(!far || fabs(v - v0) <= 1e-9 * fastest);
            for (int j = 0; j < PROFILE_PHASES; j++) {
                CHECK(p.time[j] >= 0.0);
                CHECK(p.acc[j] <= acc * (1.0 + 1e-9));
                CHECK(p.time[j] == 0.0 || !far || p.acc[j] >= -dec * (1.0 + 1e-6));
            }
            const double t1 = k == 7 ? p.total : check_real(&seed, 0.0, 1.1) * p.total;
            double last_s = s;
            for (int j = 1; j <= 50; j++) {
                s = at(&p, j < 50 ? t1 * j / 50.0 : t1).s;
                v = at(&p, p.t).v;
                CHECK(s >= last_s - 1e-12 * way && s <= way);
                CHECK(v >= 0.0 && v <= fastest * (1.0 + 1e-12));
                last_s = s;
            }
        }
        CHECK(p.ends && s == way && v == 0.0);
    }
}

/* To rest on the path: v^2/(2 d) further, v/d later. */
static void brake(void)
{
    const struct profile_limits l = { 0.0, { 100.0, 400.0, 0.0, 0.0 } };
    struct profile p;
    plan(&p, 3.0, 20.0, 10.0, &l);
    CHECK(!p.ends);
    CHECK_NEAR(p.total, 0.05, 1e-15);
    CHECK_NEAR(at(&p, p.total).s, 3.5, 1e-14);
    CHECK(at(&p, p.total).v == 0.0);
    CHECK_NEAR(at(&p, 1.0).s, 3.5, 1e-14);

    plan(&p, 9.5, 20.0, 10.0, &l); /* exactly the way that is left */
    CHECK(p.ends && at(&p, p.total).s == 10.0);
    CHECK_NEAR(p.acc[2], -400.0, 1e-9);
}

int main(void)
{
    rest_to_rest();
    replanned();
    brake();
    return check_result();
}
