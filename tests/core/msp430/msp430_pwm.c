/* PWM, filter and op-amps against a fine integration and against closed forms; the converter. */
#include "adc12.h"
#include "check.h"
#include "pwm.h"

#include <math.h>

static const struct pwm_config PLAIN = {
    .period = 800, .tau = 16000.0, .high = 2.5, .offset = 1.25, .gain = 8.0, .limit = 10.0
};

static double ripple(const struct pwm_config *c, double d)
{
    const double x = c->period / c->tau;
    return c->gain * c->high * (1.0 - exp(-d * x)) * (1.0 - exp(-(1.0 - d) * x)) / (1.0 - exp(-x));
}

/* Mean and ripple of a duty that stands, to rounding. */
static void standing(void)
{
    for (double tau = 100.0; tau < 1e5; tau *= 7.0)
        for (int32_t duty = 0; duty <= 800; duty += 50) {
            struct pwm_config c = PLAIN;
            c.tau = tau;
            struct pwm p;
            pwm_reset(&p, &c, 1.25, duty);
            const int64_t settled = 800 * (int64_t)(40.0 * tau / 800.0 + 2.0);
            pwm_run(&p, &c, settled);
            pwm_mean(&p, &c);
            pwm_run(&p, &c, settled + 8001);
            CHECK(fabs(p.ripple - ripple(&c, duty / 800.0)) < 1e-9);
            pwm_run(&p, &c, settled + 80000);
            CHECK(fabs(pwm_mean(&p, &c) - (20.0 * duty / 800.0 - 10.0)) < 1e-9);
        }
    /* Half duty, tau = 2 ms at 10 kHz: near 20 V T / (4 tau) = 0.25 V */
    CHECK(fabs(ripple(&PLAIN, 0.5) - 0.25) < 1e-4);
}

/* A step of the duty: the filter's exponential, in the mean of whole periods. */
static void step(void)
{
    struct pwm p;
    pwm_reset(&p, &PLAIN, 1.25, 400);
    pwm_run(&p, &PLAIN, 800000);
    pwm_mean(&p, &PLAIN);
    pwm_write(&p, &PLAIN, 600);
    for (int k = 0; k < 100; k++) {
        pwm_run(&p, &PLAIN, 800000 + 800 * (k + 1));
        const double x = 800.0 / 16000.0;
        /* mean of 5 (1 - e^(-t/tau)) over the period; the rising edge is late within it */
        const double ideal = 5.0 * (1.0 - exp(-x * k) * (1.0 - exp(-x)) / x);
        CHECK(fabs(pwm_mean(&p, &PLAIN) - ideal) < 5.0 * x);
    }
    pwm_write(&p, &PLAIN, 5000);
    CHECK_EQ(p.wanted, 800);
    pwm_write(&p, &PLAIN, -5000);
    CHECK_EQ(p.wanted, 0);
}

/* Everything at once, in steps of a clock: any duty, written any time, the limit cutting off. */
static void fine(void)
{
    uint64_t seed = 12;
    for (int i = 0; i < 60; i++) {
        const struct pwm_config c = {
            .period = (int32_t)check_random(&seed, 2, 400),
            .tau = (double)check_random(&seed, 10, 3000),
            .high = 3.3,
            .offset = 0.01 * (double)check_random(&seed, 0, 330),
            .gain = 8.0,
            .limit = (double)check_random(&seed, 1, 12),
        };
        struct pwm p;
        double v = 0.01 * (double)check_random(&seed, 0, 330), area = 0.0;
        int32_t duty = (int32_t)check_random(&seed, 0, c.period), wanted = duty;
        pwm_reset(&p, &c, v, duty);
        int64_t last = 0;
        for (int64_t clock = 0; clock < 4000; clock++) {
            const int64_t place = clock % c.period;
            if (place == 0)
                duty = wanted;
            const double end = place < duty ? c.high : 0.0;
            enum { PARTS = 8 };
            for (int k = 0; k < PARTS; k++) { /* midpoint rule */
                const double half = end + (v - end) * exp(-0.5 / PARTS / c.tau);
                area += fmin(fmax(c.gain * (half - c.offset), -c.limit), c.limit) / PARTS;
                v = end + (v - end) * exp(-1.0 / PARTS / c.tau);
            }
            if (check_random(&seed, 0, 60) == 0) {
                pwm_run(&p, &c, clock + 1);
                CHECK(fabs(p.filtered - v) < 1e-9);
                CHECK(fabs(pwm_mean(&p, &c) - area / (double)(clock + 1 - last)) < 2e-3);
                last = clock + 1;
                area = 0.0;
                wanted = (int32_t)check_random(&seed, 0, c.period);
                pwm_write(&p, &c, wanted);
            }
        }
    }
}

/* Outside the limit from beginning to end. */
static void beyond(void)
{
    struct pwm_config c = PLAIN;
    c.limit = 3.0;
    struct pwm p;
    pwm_reset(&p, &c, 2.5, 800);
    pwm_run(&p, &c, 1234);
    CHECK(fabs(pwm_mean(&p, &c) - 3.0) < 1e-12);
    pwm_reset(&p, &c, 0.0, 0);
    pwm_run(&p, &c, 1234);
    CHECK(fabs(pwm_mean(&p, &c) + 3.0) < 1e-12);
}

static void converter(void)
{
    CHECK_EQ(adc12_code(-1.0, 2.5), 0);
    CHECK_EQ(adc12_code(0.0, 2.5), 0);
    CHECK_EQ(adc12_code(2.5, 2.5), 4095);
    CHECK_EQ(adc12_code(9.0, 2.5), 4095);
    CHECK_EQ(adc12_code(1.25, 2.5), 2048);
    for (int code = 0; code <= 4095; code++) {
        CHECK_EQ(adc12_code(2.5 * (code + 0.49) / 4095.0, 2.5), code);
        CHECK_EQ(adc12_code(2.5 * (code - 0.49) / 4095.0, 2.5), code);
    }
    CHECK_EQ(adc12_share(65536, 4095), 65536);
    CHECK_EQ(adc12_share(65536, 2048), 32768);
    CHECK_EQ(adc12_share(1073741823, 4095), 1073741823);
    CHECK_EQ(adc12_share(65536, 0), 0);
}

int main(void)
{
    standing();
    step();
    fine();
    beyond();
    converter();
    return check_result();
}
