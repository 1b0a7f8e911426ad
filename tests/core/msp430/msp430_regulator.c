/* The control laws against the same sums written out, their widths, and closed forms on an ideal
 * integrator. */
#include "check.h"
#include "fixed.h"
#include "regulator.h"

#include <math.h>
#include <stdbool.h>

static double clip(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

/* The laws in doubles, which hold every number exactly here (48 bit). */
static void against_sums(void)
{
    uint64_t seed = 11;
    for (int i = 0; i < 300; i++) {
        const struct regulator_config c = {
            .kind = (enum regulator_kind)check_random(&seed, 0, 2),
            .p_gain = (int16_t)check_random(&seed, 0, 32767),
            .i_gain = (int16_t)check_random(&seed, 0, 32767),
            .p_shift = (int)check_random(&seed, 0, REGULATOR_SHIFT_MAX),
            .i_shift = (int)check_random(&seed, 0, REGULATOR_SHIFT_MAX),
            .band = (int16_t)(check_random(&seed, 0, 1) * check_random(&seed, 1, 20000)),
            .outside = (enum regulator_outside)check_random(&seed, 0, 1),
        };
        struct regulator s = { 0 };
        double count = 0.0, sum = 0.0;
        for (int k = 0; k < 200; k++) {
            const int16_t e = (int16_t)check_random(&seed, -32768, 32767);
            const bool on = c.kind != REGULATOR_P && (c.band == 0 || (e < c.band && -e < c.band));
            count = c.kind != REGULATOR_LITERAL    ? 0.0
                    : on                           ? count + 1.0
                    : c.outside == REGULATOR_RESET ? 0.0
                                                   : count;
            sum = c.kind != REGULATOR_SUM        ? 0.0
                  : on                           ? clip(sum + e, -2147483648.0, 2147483647.0)
                  : c.outside == REGULATOR_RESET ? 0.0
                                                 : sum;
            const double factor = c.kind == REGULATOR_LITERAL ? count * e : sum;
            const double p = floor(ldexp((double)c.p_gain * e, -c.p_shift) + 0.5);
            const double n = floor(ldexp(c.i_gain * factor, -c.i_shift) + 0.5);
            const double low = clip(p, -32768, 32767), high = clip(n, -32768, 32767);
            CHECK_EQ(regulator_tick(&c, &s, e), clip(low + high, -32768, 32767));
            CHECK_EQ(s.proportional, low);
            CHECK_EQ(s.integral, high);
        }
    }
}

/* Count and sum stop at the ends of their words. */
static void saturation(void)
{
    const struct regulator_config literal = { .kind = REGULATOR_LITERAL, .i_gain = 1, .p_gain = 0 };
    struct regulator s = { 0 };
    for (int k = 0; k < 40000; k++)
        regulator_tick(&literal, &s, 1);
    CHECK_EQ(s.count, 32767);
    regulator_move(&s);
    CHECK_EQ(s.count, 0);
    const struct regulator_config sum = { .kind = REGULATOR_SUM, .i_gain = 1, .i_shift = 16 };
    struct regulator w = { 0 };
    for (int k = 0; k < 80000; k++)
        regulator_tick(&sum, &w, 32767);
    CHECK_EQ(w.sum, INT32_MAX);
    CHECK_EQ(w.integral, 32767);
    regulator_move(&w);
    CHECK_EQ(w.sum, INT32_MAX);
}

/* The band's own edge is outside. */
static void edge_of_band(void)
{
    struct regulator_config c = {
        .kind = REGULATOR_SUM, .i_gain = 1, .band = 10, .outside = REGULATOR_HOLD
    };
    struct regulator s = { 0 };
    const int errors[] = { 10, -10, 9, -9, 9, -10 }, sums[] = { 0, 0, 9, 0, 9, 9 };
    for (int i = 0; i < 6; i++) {
        regulator_tick(&c, &s, (int16_t)errors[i]);
        CHECK_EQ(s.sum, sums[i]);
    }
    c.outside = REGULATOR_RESET;
    regulator_tick(&c, &s, 10);
    CHECK_EQ(s.sum, 0);
}

/* Ideal integrator ds/dt = u behind a law without rounding of its own: errors are scaled so that a
 * count is small, and Kp, Ki so that 1 s has 10000 ticks. Against the closed forms, in shares of
 * the step. */
static double worst(const struct regulator_config *c, double kp, double ki)
{
    const double t = 1e-4;
    const int16_t step = 20000;
    struct regulator s = { 0 };
    double place = 0.0, most = 0.0;
    for (int k = 0; k < 30000; k++) {
        const double time = k * t;
        const double wn = sqrt(ki > 0.0 ? ki : 1.0), z = kp / (2.0 * wn);
        const double wd = wn * sqrt(1.0 - z * z);
        const double rest =
            c->kind == REGULATOR_P ? exp(-kp * time)
            : c->kind == REGULATOR_LITERAL
                ? exp(-kp * time - ki * time * time / 2.0)
                : exp(-z * wn * time) * (cos(wd * time) - z * wn / wd * sin(wd * time));
        most = fmax(most, fabs((step - place) / step - rest));
        const int16_t error = (int16_t)lround(step - place);
        place += regulator_tick(c, &s, error) * t; /* u in counts/s */
    }
    return most;
}

/* Kp = 1/s, Ki = 2/s^2: per tick of 0.1 ms 2e-4, as 13 / 2^16 = 1.984e-4. */
static void closed_forms(void)
{
    const double ki = 13.0 / 65536.0 / 1e-4;
    struct regulator_config c = { .kind = REGULATOR_P, .p_gain = 1, .i_gain = 13, .i_shift = 16 };
    CHECK(worst(&c, 1.0, 0.0) < 1e-3);
    c.kind = REGULATOR_LITERAL;
    CHECK(worst(&c, 1.0, ki) < 1e-3);
    CHECK(worst(&c, 1.0, 0.9 * ki) > 1e-2);
    c.kind = REGULATOR_SUM;
    CHECK(worst(&c, 1.0, ki) < 1e-3);
    CHECK(worst(&c, 1.0, 0.9 * ki) > 1e-2);
    CHECK(worst(&c, 1.02, ki) > 3e-3);
}

int main(void)
{
    against_sums();
    saturation();
    edge_of_band();
    closed_forms();
    return check_result();
}
