/* Loops of the servo drive against their equations. */
#include "check.h"
#include "drive.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

static struct drive_config usual(int32_t mode)
{
    return (struct drive_config){
        .mode = mode,
        .period = 1e-4,
        .speed_per_volt = 300.0,
        .encoder_lines = 2500,
        .encoder_counts = 1048576,
        .pulses_per_turn = 10000,
        .velocity_gain = 0.5,
        .velocity_time = 0.02,
        .position_gain = 50.0,
        .torque_limit = 10.0,
        .speed_limit = 5000.0,
        .error_limit = 5.0,
    };
}

/* Speed of a motor that turns by whole counts: exact, and one count coarse. */
static void measured_speed(uint64_t seed)
{
    struct drive_config c = usual(DRIVE_VELOCITY);
    c.velocity_gain = 0.0;
    struct drive_state s = { 0 };
    struct drive_output out;
    double turns = (double)check_random(&seed, -5, 5), old = 0.0;
    for (int k = 0; k < 500; k++) {
        drive_tick(&c, &s, &(struct drive_input){ .enable = true, .phase = turns * 2500 }, &out);
        double rpm = (turns - old) * 60.0 / 1e-4;
        if (k == 0)
            CHECK(out.speed == 0.0);
        else
            CHECK(fabs(out.speed - rpm) <= 60.0 / (1048576 * 1e-4) * (1 + 1e-9));
        old = turns;
        turns += (double)check_random(&seed, -1000, 1000) * 1e-6;
    }
}

/* torque_k = Kp e_k + Kp T / Ti (e_1 + ... + e_k), far from the limit. */
static void pi_formula(uint64_t seed, double time)
{
    struct drive_config c = usual(DRIVE_VELOCITY);
    c.velocity_time = time;
    c.volt_offset = 0.013;
    c.torque_limit = 1e9;
    struct drive_state s = { 0 };
    struct drive_output out;
    long double sum = 0.0L;
    int64_t counts = 0, old = 0;
    double volts = -0.013; /* starts with no error: the integral starts at zero */
    for (int k = 0; k < 3000; k++) {
        struct drive_input in = { .enable = true,
                                  .volts = volts,
                                  .phase = (double)counts * 2500 / 1048576 };
        CHECK_EQ(drive_tick(&c, &s, &in, &out), DRIVE_OK);
        long double turns_per_s = (long double)(counts - old) / 1048576 / 1e-4L;
        long double command = ((long double)volts + 0.013L) * 300.0L / 60.0L;
        long double error = (command - turns_per_s) * 2.0L * (long double)pi;
        sum += k > 0 && time > 0.0 ? error * 1e-4L / (long double)time : 0.0L;
        long double want = 0.5L * (error + sum);
        CHECK(fabsl(out.torque - want) <= 1e-9L * (1.0L + fabsl(want)));
        CHECK(fabs(out.speed_command - (double)command * 60.0) < 1e-9);
        CHECK(!out.saturated && out.ready);
        old = counts;
        counts += check_random(&seed, -150, 150);
        volts = (double)check_random(&seed, -8000, 8000) * 1e-3;
    }
}

/* However long and hard it is driven into its limit, the torque leaves it in the sample in which
 * the error turns; the integral alone never exceeds the limit. */
static void anti_windup(uint64_t seed)
{
    for (int trial = 0; trial < 200; trial++) {
        struct drive_config c = usual(DRIVE_VELOCITY);
        c.velocity_time = 1e-3 * (double)check_random(&seed, 1, 50);
        c.torque_limit = 0.1 * (double)check_random(&seed, 1, 100);
        struct drive_state s = { 0 };
        struct drive_output out;
        drive_tick(&c, &s, &(struct drive_input){ .enable = true }, &out);
        int sign = trial % 2 ? 1 : -1;
        int steps = (int)check_random(&seed, 100, 1000);
        int limited = 0;
        for (int k = 0; k < steps; k++) {
            double volts = sign * 0.01 * (double)check_random(&seed, 0, 1000);
            drive_tick(&c, &s, &(struct drive_input){ .enable = true, .volts = volts }, &out);
            CHECK(fabs(out.torque) <= c.torque_limit);
            CHECK(fabs(s.integral) <= c.torque_limit * (1 + 1e-12));
            if (out.saturated)
                CHECK(out.torque == sign * c.torque_limit);
            limited += out.saturated;
        }
        CHECK(limited > 20);
        drive_tick(&c, &s, &(struct drive_input){ .enable = true, .volts = -sign * 0.001 }, &out);
        CHECK(!out.saturated && fabs(out.torque) < c.torque_limit);
    }
}

/* A torque limit lowered on the way: what the integral holds beyond it unwinds at its usual rate.
 * An integral time set to zero drops it. */
static void tuned_while_running(void)
{
    struct drive_config c = usual(DRIVE_VELOCITY);
    struct drive_state s = { 0 };
    struct drive_output out;
    struct drive_input in = { .enable = true };
    drive_tick(&c, &s, &in, &out);
    for (in.volts = 0.05; s.integral < 9.0;)
        drive_tick(&c, &s, &in, &out);
    c.torque_limit = 2.0;
    in.volts = -0.01;
    double p = 0.5 * 0.01 * 300.0 * pi / 30.0;
    for (int k = 0; k < 100; k++) {
        double before = s.integral;
        drive_tick(&c, &s, &in, &out);
        CHECK(out.torque == 2.0 && out.saturated);
        CHECK(fabs(before - s.integral - p * 1e-4 / 0.02) < 1e-12);
    }
    c.velocity_time = 0.0;
    drive_tick(&c, &s, &in, &out);
    CHECK(fabs(out.torque + p) < 1e-12);
}

/* Velocity mode on an inertia with a constant load: settles on the command, the torque on the load.
 * P alone leaves load / Kp. */
static void load_torque(double time)
{
    struct drive_config c = usual(DRIVE_VELOCITY);
    c.velocity_time = time;
    struct drive_state s = { 0 };
    struct drive_output out;
    const double inertia = 2e-3, load = 1.7;
    double speed = 0.0, angle = 0.0;
    for (int k = 0; k < 20000; k++) {
        struct drive_input in = { .enable = true, .volts = 2.0, .phase = angle / (2 * pi) * 2500 };
        drive_tick(&c, &s, &in, &out);
        double acceleration = (out.torque - load) / inertia;
        angle += speed * 1e-4 + 0.5 * acceleration * 1e-8;
        speed += acceleration * 1e-4;
    }
    double want = 600.0 - (time > 0.0 ? 0.0 : load / 0.5 * 30.0 / pi);
    CHECK(fabs(speed * 30.0 / pi - want) < 0.1);
    CHECK(fabs(out.torque - load) < 0.1);
}

/* Position mode on an ideal velocity source: following error v (1 - ff) / Kv. The command wraps. */
static void following_error(double feed_forward)
{
    struct drive_config c = usual(DRIVE_POSITION);
    c.feed_forward = feed_forward;
    struct drive_state s = { 0 };
    struct drive_output out;
    double turns = 0.3;
    uint32_t pulses = 0x7FFFFF00u;
    for (int k = 0; k < 10000; k++) {
        struct drive_input in = { .enable = true,
                                  .pulses = (int32_t)pulses,
                                  .phase = turns * 2500 };
        drive_tick(&c, &s, &in, &out);
        turns += out.speed_command / 60.0 * 1e-4;
        pulses += 10; /* 10 turns/s */
    }
    /* a held velocity lags half a period more; T ff is the pulses of the latest period */
    double want = 10.0 * (1.0 - feed_forward) / 50.0;
    CHECK(fabs(out.following_error - want) < 2e-6);
    CHECK(fabs(out.speed_command - 600.0) < 0.05);
    CHECK_EQ(out.alarm, DRIVE_NO_ALARM);
    CHECK(fabs(turns - 0.3 - (10.0 - out.following_error)) < 2e-3);
}

/* Speed command = 60 (Kv e + ff dp / (ppt T)), within the limit. */
static void position_formula(void)
{
    struct drive_config c = usual(DRIVE_POSITION);
    c.feed_forward = 0.7;
    struct drive_state s = { 0 };
    struct drive_output out;
    drive_tick(&c, &s, &(struct drive_input){ .enable = true, .pulses = 4000, .phase = 100.0 },
               &out);
    CHECK(out.following_error == 0.0 && out.speed_command == 0.0);
    drive_tick(&c, &s, &(struct drive_input){ .enable = true, .pulses = 4025, .phase = 100.0 },
               &out);
    CHECK(fabs(out.following_error - 25e-4) < 1e-15);
    CHECK(fabs(out.speed_command - 60.0 * (50.0 * 25e-4 + 0.7 * 25e-4 / 1e-4)) < 1e-9);
    drive_tick(&c, &s, &(struct drive_input){ .enable = true, .pulses = 4025, .phase = 100.0 },
               &out);
    CHECK(fabs(out.speed_command - 60.0 * 50.0 * 25e-4) < 1e-9);
    drive_tick(&c, &s, &(struct drive_input){ .enable = true, .pulses = 9000, .phase = 100.0 },
               &out);
    CHECK(out.speed_command == 5000.0);
    c.mode = DRIVE_VELOCITY;
    drive_tick(&c, &s, &(struct drive_input){ .enable = true, .volts = -100.0, .phase = 100.0 },
               &out);
    CHECK(out.speed_command == -5000.0);
}

int main(void)
{
    measured_speed(31);
    pi_formula(41, 0.02);
    pi_formula(59, 0.0);
    anti_windup(26);
    tuned_while_running();
    load_torque(0.02);
    load_torque(0.0);
    following_error(0.0);
    following_error(0.4);
    following_error(1.0);
    position_formula();
    return check_result();
}
