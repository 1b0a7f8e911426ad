/* A pause on the path: acceleration and jerk of the ramped motion, its distance, its time. */
#include "check.h"

#include <string.h>

#include "player.h"

static const double PI = 3.14159265358979323846, TICK = 20e-9;
static struct player p;

/* A planned motion of two axes over `length` seconds: sums of cosines, at rest at both ends.
 *     axis 0: X (u - sin(2 pi u) / 2 pi)                   there
 *     axis 1: Y sin^2(pi k u) sin^2(pi u)                  and back, k times
 * Derivative d (0 .. 3) by planned time. */
struct plan {
    double length, x, y;
    int k, frames;
};

static double planned(const struct plan *m, int axis, int d, double time)
{
    const double u = time / m->length, scale = pow(1.0 / m->length, d);
    if (axis == 0) {
        const double w = 2.0 * PI, phase = w * u + d * PI / 2.0;
        return scale * m->x * ((d == 0 ? u : d == 1 ? 1.0 : 0.0) - pow(w, d - 1) * sin(phase));
    }
    double sum = d == 0 ? 1.0 : 0.0;
    const int factor[] = { m->k, 1, m->k - 1, m->k + 1 };
    const double size[] = { -1.0, -1.0, 0.5, 0.5 };
    for (int i = 0; i < 4; i++) {
        const double w = 2.0 * PI * factor[i];
        sum += size[i] * (w == 0.0 && d > 0 ? 0.0 : pow(w, d) * cos(w * u + d * PI / 2.0));
    }
    return scale * m->y * sum / 4.0;
}

static double largest(const struct plan *m, int axis, int d)
{
    double most = 0.0;
    for (int i = 0; i <= 20000; i++) {
        most = fmax(most, fabs(planned(m, axis, d, m->length * i / 20000)));
    }
    return most;
}

static struct frame frame_of(const struct plan *m, int n)
{
    struct frame f = { { 0 }, 0 };
    for (int i = 0; i < 2; i++) {
        f.command[i] = (int16_t)(lround(planned(m, i, 0, 1e-3 * (n + 1)))
                                 - lround(planned(m, i, 0, 1e-3 * n)));
    }
    return f;
}

static double worst_acc, worst_jerk;
static long long samples, ramps, turned, tight;

/* Planned time that has been played. */
static double played(const struct player *q)
{
    return 1e-3 * (double)(q->frames - 1)
           + TICK
                 * ((double)q->phase / PLAYER_FULL_RATE
                    + (double)q->rate / PLAYER_FULL_RATE * (double)(q->clock - q->base));
}

/* The sample before: of a ramp that goes on, its slope; else 0. */
static struct {
    int64_t clock;
    double rate, slope;
    struct rate_bounds bounds;
} before;

/* At a sample of a ramp: rate and slope go on from the sample before, within their bounds, and with
 * them the motion is within its limits. The bend of a piece is that of the slopes around it. */
static void within(const struct plan *m, const struct player_job *job)
{
    const double t = TICK * (double)(p.clock - p.ramp_begin), end = rate_ramp_length(&p.ramp),
                 dt = TICK * (double)(p.clock - before.clock), near = 1e-7;
    double slope, s0, s1;
    if (t >= end) {
        return;
    }
    const double r = rate_ramp_at(&p.ramp, t, &slope),
                 middle = t + TICK * (double)(p.ramp_step - p.clock - PLAYER_GRID / 2);
    CHECK_NEAR(player_rate(&p), rate_ramp_at(&p.ramp, middle, &s0), 0x1p-24);
    rate_ramp_at(&p.ramp, fmax(t - near, 0.0), &s0);
    rate_ramp_at(&p.ramp, fmin(t + near, end - 1e-12), &s1);
    const double bend = (s1 - s0) / (fmin(t + near, end - 1e-12) - fmax(t - near, 0.0)),
                 slope_most = rate_ramp_slope_most(&p.bounds, r),
                 bend_most = rate_ramp_bend_most(&p.bounds, r);
    CHECK(fabs(slope) <= slope_most * (1.0 + 1e-9));
    CHECK(fabs(bend) <= bend_most * (1.0 + 1e-4));
    tight += fmax(fabs(slope) / slope_most, fabs(bend) / bend_most) > 0.9;
    const double bent = fmax(fmax(bend_most, rate_ramp_bend_most(&p.bounds, before.rate)),
                             rate_ramp_bend_most(&before.bounds, before.rate));
    CHECK(fabs(slope - before.slope) <= dt * bent * 1.001 + 1e-9);
    CHECK(fabs(r - before.rate) <= dt * fmax(fabs(slope), fabs(before.slope)) + 0x1p-20);
    const double at = played(&p);
    for (int i = 0; i < 2; i++) {
        const double v = planned(m, i, 1, at), a = planned(m, i, 2, at), j = planned(m, i, 3, at);
        const double acc = fabs(r * r * a + slope * v) / job->acc[i],
                     jerk = fabs(r * r * r * j + 3.0 * r * slope * a + bend * v) / job->jerk[i];
        CHECK(fabs(v) <= p.bounds.speed[i] * (1.0 + 1e-6));
        CHECK(acc <= 1.0 + 1e-9);
        CHECK(jerk <= 1.0 + 1e-6);
        worst_acc = fmax(worst_acc, acc);
        worst_jerk = fmax(worst_jerk, jerk);
    }
    before.rate = r;
    before.slope = slope;
    before.bounds = p.bounds;
    samples++;
}

/* The bounds leave the motion exactly its limits, whatever v, a and j the plan has. */
static void bounds_are_limits(void)
{
    uint64_t seed = 2;
    int by_acc = 0, by_jerk = 0;
    for (int n = 0; n < 20000; n++) {
        const double a = pow(10.0, check_real(&seed, 3.0, 8.0)),
                     j = a * pow(10.0, check_real(&seed, 0.0, 4.0)),
                     v = a * pow(10.0, check_real(&seed, -3.0, 1.0)), r = check_real(&seed, 0, 1),
                     reserve = check_real(&seed, 0.02, 1.0), q = 1.0 - reserve;
        const struct rate_bounds b = { reserve, { 0.0, v }, { 1.0, a }, { 1.0, j } };
        const double slope = rate_ramp_slope_most(&b, r), bend = rate_ramp_bend_most(&b, r),
                     acc = (r * r * q * a + slope * v) / a,
                     half = 3.0 * r * slope * q * a / ((1.0 - r * r * r * q) * j),
                     jerk = r * r * r * q + (3.0 * r * slope * q * a + bend * v) / j;
        CHECK(acc <= 1.0 + 1e-12 && half <= 0.5 + 1e-12 && jerk <= 1.0 + 1e-12);
        CHECK(fmax(acc, half + 0.5) >= 1.0 - 1e-12);
        by_acc += acc >= 1.0 - 1e-12;
        by_jerk += jerk >= 1.0 - 1e-12;
    }
    CHECK(by_acc > 2000 && by_jerk > 2000);
}

/* Random pauses of a random plan, one that uses all that the reserve leaves it. */
static void limits_kept(void)
{
    uint64_t seed = 3;
    for (int run = 0; run < 40 && !check_failures; run += CHECK_EACH) {
        const struct player_config c = { (int)check_random(&seed, 16, 512), 50, 250, 250 };
        struct plan m = { .frames = (int)check_random(&seed, 300, 2500),
                          .k = (int)check_random(&seed, 1, 4) };
        m.length = 1e-3 * m.frames;
        m.x = check_real(&seed, 1e3, 2e5) * m.length;
        m.y = check_real(&seed, 1e3, 8e4) * m.length / m.k;
        const int known = (int)check_random(&seed, 0, 1);
        struct player_job job = { .period = 50000, .reserve = check_real(&seed, 0.02, 0.5) };
        for (int i = 0; i < 2; i++) {
            job.speed[i] = largest(&m, i, 1) * (1.0 + 1e-9);
            job.acc[i] = largest(&m, i, 2) / (1.0 - job.reserve);
            job.jerk[i] = largest(&m, i, 3) / (1.0 - job.reserve);
        }
        if (known) { /* it looks ahead in the FIFO */
            job.speed[0] *= 3.0, job.speed[1] *= 3.0;
        }
        player_start(&p, &c);
        player_begin(&p, &job, 0);
        int pushed = 0, target = 1;
        player_set_target(&p, 0);
        for (; pushed < c.depth && pushed < m.frames; pushed++) {
            const struct frame f = frame_of(&m, pushed);
            player_push(&p, &f);
        }
        player_set_target(&p, 1);
        int64_t change = check_random(&seed, 0, m.frames * 50000LL), last = 0;
        memset(&before, 0, sizeof before);
        before.rate = 1.0;
        before.bounds = p.bounds;
        while (p.begun) {
            const int64_t next = player_next(&p);
            player_advance(&p, next < change ? next : change);
            if (p.clock == change) {
                target = !target;
                turned += p.ramping;
                player_set_target(&p, target);
                player_advance(&p, p.clock);
                ramps++;
                change += check_random(&seed, 0, 2) ? check_random(&seed, 1, 15000000)
                                                    : check_random(&seed, 1, 1000000);
            }
            if (p.ramping) {
                within(&m, &job);
            } else {
                CHECK(!p.begun
                      || fabs(player_rate(&p) - before.rate)
                             <= TICK * PLAYER_GRID * fabs(before.slope) + 0x1p-20);
                before.rate = player_rate(&p);
                before.slope = 0.0;
            }
            before.clock = p.clock;
            if (p.fifo.stock <= c.depth / 2 && pushed < m.frames) {
                for (; pushed < m.frames && p.fifo.stock < c.depth; pushed++) {
                    const struct frame f = frame_of(&m, pushed);
                    CHECK_EQ(player_push(&p, &f), PLAYER_OK);
                }
            }
            if (pushed == m.frames) {
                player_whole(&p);
            }
            last = p.clock;
        }
        int64_t n[FRAME_AXES];
        player_counts(&p, p.clock, n);
        CHECK_EQ(n[0], lround(planned(&m, 0, 0, m.length)));
        CHECK_EQ(n[1], lround(planned(&m, 1, 0, m.length)));
        CHECK(last > m.frames * 50000LL && p.dry == 0);
    }
    printf("rate: %lld samples in %lld ramps, %lld of them turned within one; largest "
           "acceleration %.3f, jerk %.3f of the limits; at a bound of the rate in %.0f %%\n",
           samples, ramps, turned, worst_acc, worst_jerk, 100.0 * (double)tight / (double)samples);
    CHECK(worst_acc > 0.6 && worst_jerk > 0.6 && 2 * tight > samples);
    CHECK(CHECK_EACH > 1 || (samples > 100000 && ramps > 200 && turned > 50));
}

/* An axis of steady speed [pulses/s] is paused at a clock: way and time to rest. */
struct rest {
    double way, time;
};

static struct rest pause(double speed, double acc, double jerk, double reserve)
{
    const struct player_config c = { 2304, 1, 0, 0 };
    const struct player_job job = {
        .period = 50000, .reserve = reserve, .speed = { speed }, .acc = { acc }, .jerk = { jerk }
    };
    const struct frame f = { { (int16_t)lround(speed * 1e-3) }, 0 };
    int64_t a[FRAME_AXES], b[FRAME_AXES];
    player_start(&p, &c);
    player_begin(&p, &job, 0);
    for (int i = 0; i < 2304; i++) {
        player_push(&p, &f);
    }
    player_set_target(&p, 1);
    player_advance(&p, 123457);
    player_take(&p);
    CHECK_NEAR(player_velocity(&p, 0), 1e3 * f.command[0], 1e-9 * speed);
    player_counts(&p, p.clock, a);
    player_set_target(&p, 0);
    const int64_t from = p.clock;
    while (player_next(&p) < INT64_MAX) {
        player_advance(&p, player_next(&p));
        CHECK_NEAR(player_velocity(&p, 0), 1e3 * f.command[0] * player_rate(&p), 1e-9 * speed);
    }
    player_counts(&p, p.clock, b);
    const struct player_told told = player_take(&p);
    CHECK((told.what & PLAYER_REST) && told.clock[3] == p.clock && player_at_rest(&p));
    return (struct rest){ (double)(b[0] - a[0]), TICK * (double)(p.clock - from) };
}

/* Without a limit of jerk the quickest ramp is that of dr/dt = -(1 - p r^2) A / V, p = 1 - reserve:
 *     way  V^2 / (2 p A) ln(1 / (1 - p)),  time  V / (A sqrt p) artanh(sqrt p)
 * but for the pieces of its grid, and never further than V^2 / (2 A reserve). With one, never
 * further than the ramp with the bounds of r = 1 all the way, S and C: an S-shaped one. */
static void distances(void)
{
    uint64_t seed = 7;
    double longest = 0.0;
    for (int i = 0; i < 300; i += CHECK_EACH) {
        const double v = 1e3 * (double)check_random(&seed, 1, 300),
                     reserve = check_real(&seed, 0.02, 0.6), a = v * check_real(&seed, 4.0, 40.0),
                     q = 1.0 - reserve,
                     j = check_random(&seed, 0, 1) ? a * check_real(&seed, 10.0, 200.0) : 0.0;
        const struct rest r = pause(v, a, j, reserve);
        const double pulse = 2.0 + v * TICK * 2.0 * PLAYER_GRID;
        if (j == 0.0) {
            const double way = v * v / (2.0 * q * a) * log(1.0 / reserve),
                         time = v / (a * sqrt(q)) * 0.5 * log((1.0 + sqrt(q)) / (1.0 - sqrt(q)));
            const double cost = 1.06 + 0.003 / reserve;
            CHECK(r.way >= way - pulse && r.way <= cost * way + pulse);
            CHECK(r.time >= time - 1e-4 && r.time <= cost * time + 1e-4);
            CHECK(r.way <= v * v / (2.0 * a * reserve) + pulse);
            longest = fmax(longest, r.way / way);
        } else {
            const double s = fmin(a * reserve / v, (1.0 - q) * j / (6.0 * q * a)),
                         c = (1.0 - q) * j / (2.0 * v),
                         time = s * s < c ? 1.0 / s + s / c : 2.0 / sqrt(c);
            CHECK(r.way <= v * time / 2.0 + pulse && r.time <= time + 1e-4);
            CHECK(r.way >= v * v / (2.0 * a) - pulse);
        }
    }
    const struct rest card = pause(1e5, 1e6, 5e7, 0.1), hard = pause(1e5, 1e6, 0.0, 0.1);
    printf("rate: at 100 mm/s, 1000 mm/s^2 (and 50000 mm/s^3), reserve 0.1, 1 um a pulse: "
           "%.2f mm in %.0f ms (%.2f mm in %.0f ms); grid of the ramp costs at most %.3f\n",
           1e-3 * hard.way, 1e3 * hard.time, 1e-3 * card.way, 1e3 * card.time, longest);
    CHECK_NEAR(hard.way, 12.79e3, 0.08 * 12.79e3);
    CHECK(card.way > hard.way && card.way < 50e3);
}

/* Slow axes and axes that stand do not delay; without limits the rate jumps. */
static void at_once(void)
{
    const struct rest r = pause(1e5, 0.0, 0.0, 0.1);
    CHECK(r.way <= 1.0 && r.time == 0.0);
    CHECK(pause(1e3, 1e6, 5e7, 0.1).time < 0.15);
}

int main(void)
{
    bounds_are_limits();
    limits_kept();
    distances();
    at_once();
    return check_result();
}
