/* The smoothed command of position mode: moving mean and filter of first order. */
#include "check.h"
#include "drive.h"

#include <math.h>

enum { KEPT = 4000 };

static struct drive_config smoothing(int32_t mean, double time)
{
    return (struct drive_config){
        .mode = DRIVE_POSITION,
        .period = 1e-4,
        .encoder_lines = 2500,
        .encoder_counts = 1048576,
        .pulses_per_turn = 1, /* the following error is the smoothed command in pulses */
        .position_gain = 1.0,
        .feed_forward = 1.0,
        .torque_limit = 1.0,
        .speed_limit = 1e15,
        .error_limit = 1e15,
        .command_mean = mean,
        .command_time = time,
    };
}

/* The smoothed command [pulses] after each sample of a motor that stands. */
static void follow(const struct drive_config *c, struct drive_state *s, const int32_t *pulses,
                   int count, double *seen)
{
    struct drive_output out;
    double before = 0.0;
    for (int k = 0; k < count; k++) {
        struct drive_input in = { .enable = true, .pulses = pulses[k] };
        CHECK_EQ(drive_tick(c, s, &in, &out), DRIVE_OK);
        seen[k] = out.following_error;
        /* fed forward is what the smoothed command moved by */
        const double forward = out.speed_command / 60.0 - out.following_error;
        CHECK_NEAR(forward * c->period, seen[k] - before, 1e-9 * (1.0 + fabs(seen[k])));
        before = seen[k];
    }
}

/* A step of the command goes in equal parts: k/N of it after k samples, exactly. */
static void mean_step(int32_t mean, int32_t step)
{
    const struct drive_config c = smoothing(mean, 0.0);
    struct drive_state s = { 0 };
    int32_t pulses[KEPT] = { 0 };
    double seen[KEPT];
    const int count = 2 * mean + 50;
    for (int k = 0; k < count; k++)
        pulses[k] = k < 20 ? 0 : step;
    follow(&c, &s, pulses, count, seen);
    for (int k = 0; k < count; k++) {
        const int gone = k < 20 ? 0 : k - 19 < mean ? k - 19 : mean;
        CHECK(seen[k] == (double)((int64_t)step * gone) / mean);
    }
}

/* A step goes as 1 - (tau/(tau + T))^k, to rounding, and arrives exactly. */
static void first_order_step(double time, int32_t step)
{
    const struct drive_config c = smoothing(0, time);
    struct drive_state s = { 0 };
    int32_t pulses[KEPT];
    double seen[KEPT];
    for (int k = 0; k < KEPT; k++)
        pulses[k] = k < 20 ? 0 : step;
    follow(&c, &s, pulses, KEPT, seen);
    for (int k = 0; k < KEPT; k++) {
        const long double left =
            k < 20 ? 1.0L : powl((long double)time / ((long double)time + 1e-4L), k - 19);
        CHECK(fabsl(seen[k] - step * (1.0L - left)) <= 1e-13L * fabsl((long double)step) + 1e-9L);
    }
    CHECK(seen[KEPT - 1] == step && s.lag == 0.0);
}

/* Behind a command of constant speed the mean lags by (N - 1)/2 samples, the filter by tau. */
static void delay(int32_t mean, double time)
{
    const struct drive_config c = smoothing(mean, time);
    struct drive_state s = { 0 };
    int32_t pulses[KEPT];
    double seen[KEPT];
    for (int k = 0; k < KEPT; k++)
        pulses[k] = 7 * k;
    follow(&c, &s, pulses, KEPT, seen);
    const double late = (mean > 1 ? (mean - 1) / 2.0 * c.period : 0.0) + time;
    CHECK_NEAR((7.0 * (KEPT - 1) - seen[KEPT - 1]) / 7.0 * c.period, late, 1e-12);
}

/* Whatever came, at any rate and over the wrap of the counter: at rest all of it is gone, to the
 * bit, and no smoothed command was ever beyond what was asked for. */
static void whole_way(uint64_t seed)
{
    for (int trial = 0; trial < 60; trial++) {
        const int32_t mean = (int32_t)check_random(&seed, 0, 300);
        const double time = 1e-4 * (double)check_random(&seed, 0, 60);
        const struct drive_config c = smoothing(mean, time);
        struct drive_state s = { 0 };
        int32_t pulses[KEPT];
        double seen[KEPT];
        uint32_t counter = 0x7FFFFF00u;
        int64_t way = 0, most = 0, least = 0;
        for (int k = 0; k < KEPT; k++) {
            const int64_t now = k > 0 && k < 1000 ? check_random(&seed, -400, 500) : 0;
            counter += (uint32_t)now;
            way += now;
            most = way > most ? way : most;
            least = way < least ? way : least;
            pulses[k] = (int32_t)counter;
        }
        follow(&c, &s, pulses, KEPT, seen);
        for (int k = 0; k < KEPT; k++)
            CHECK(seen[k] <= (double)most + 1e-6 && seen[k] >= (double)least - 1e-6);
        CHECK(seen[KEPT - 1] == (double)way);
    }
}

/* Switched off and on in the middle of a smoothed move: what was not gone yet is dropped. */
static void dropped_when_off(void)
{
    const struct drive_config c = smoothing(100, 5e-3);
    struct drive_state s = { 0 };
    struct drive_output out;
    struct drive_input in = { .enable = true };
    drive_tick(&c, &s, &in, &out);
    for (int k = 0; k < 50; k++, in.pulses += 30)
        drive_tick(&c, &s, &in, &out);
    CHECK(out.following_error > 0.0);
    in.enable = false;
    drive_tick(&c, &s, &in, &out);
    in.enable = true;
    for (int k = 0; k < 500; k++) {
        drive_tick(&c, &s, &in, &out);
        CHECK(out.following_error == 0.0 && out.speed_command == 0.0);
    }
}

int main(void)
{
    mean_step(1, 1000);
    mean_step(2, -7);
    mean_step(3, 1);
    mean_step(100, 12345);
    mean_step(DRIVE_MEAN_MOST, 2000000000);
    first_order_step(1e-4, 10);
    first_order_step(2.5e-3, -1234567);
    first_order_step(5e-3, 1);
    delay(0, 0.0);
    delay(64, 0.0);
    delay(DRIVE_MEAN_MOST, 0.0);
    delay(0, 5e-3);
    delay(37, 3e-3);
    whole_way(7);
    dropped_when_off();
    return check_result();
}
