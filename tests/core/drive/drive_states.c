/* Enabling, alarms and reset of the servo drive. */
#include "check.h"
#include "drive.h"

#include <math.h>
#include <string.h>

static struct drive_config config(int32_t mode)
{
    return (struct drive_config){
        .mode = mode,
        .period = 1e-4,
        .speed_per_volt = 300.0,
        .encoder_lines = 2500,
        .encoder_counts = 10000,
        .pulses_per_turn = 10000,
        .velocity_gain = 0.5,
        .velocity_time = 0.02,
        .position_gain = 50.0,
        .torque_limit = 10.0,
        .speed_limit = 3000.0,
        .error_limit = 0.5,
    };
}

/* Whatever speed, command and position it is enabled at, the torque starts from zero, and moves on
 * without a jump: by Kp T / Ti e at most in a sample of constant error. */
static void bumpless(int32_t mode, double volts)
{
    struct drive_config c = config(mode);
    struct drive_state s = { 0 };
    struct drive_output out;
    struct drive_input in = { .volts = volts, .pulses = 123456, .phase = 77.0 };
    double turns_per_sample = 600.0 / 60.0 * 1e-4;
    for (int k = 0; k < 40; k++) {
        in.enable = k >= 20;
        in.phase += turns_per_sample * 2500;
        drive_tick(&c, &s, &in, &out);
        if (k < 20) {
            CHECK(out.torque == 0.0 && out.speed_command == 0.0 && !out.ready);
            CHECK(k == 0 || fabs(out.speed - 600.0) < 61.0); /* one count is 60 rpm */
        } else {
            double error = (out.speed_command - out.speed) * 3.14159265358979 / 30.0;
            CHECK(out.ready);
            CHECK(k > 20 || (out.torque == 0.0 && !out.saturated));
            CHECK(fabs(out.torque) <= (k - 20) * 0.5 * fabs(error) * 1e-4 / 0.02 + 0.5 * 6.3 * 2);
        }
        in.pulses += mode == DRIVE_POSITION ? 10 : 0;
    }
    if (mode == DRIVE_POSITION)
        CHECK(fabs(out.following_error) < 0.0015);
}

static void following_error_alarm(void)
{
    struct drive_config c = config(DRIVE_POSITION);
    struct drive_state s = { 0 };
    struct drive_output out;
    struct drive_input in = { .enable = true };
    drive_tick(&c, &s, &in, &out);
    in.pulses = 5000; /* exactly the limit of half a turn */
    drive_tick(&c, &s, &in, &out);
    CHECK_EQ(out.alarm, DRIVE_NO_ALARM);
    CHECK(out.torque > 0.0);
    in.pulses = 5001;
    drive_tick(&c, &s, &in, &out);
    CHECK_EQ(out.alarm, DRIVE_FOLLOWING_ERROR);
    CHECK(!out.ready && out.torque == 0.0 && out.speed_command == 0.0);
    in.enable = false; /* only a reset edge clears it */
    drive_tick(&c, &s, &in, &out);
    in.enable = true;
    drive_tick(&c, &s, &in, &out);
    CHECK_EQ(out.alarm, DRIVE_FOLLOWING_ERROR);
    in.alarm_reset = true;
    drive_tick(&c, &s, &in, &out);
    CHECK_EQ(out.alarm, DRIVE_NO_ALARM);
    CHECK(out.ready && out.following_error == 0.0 && out.torque == 0.0);
    in.pulses += 6000; /* a reset held up does not clear the next one */
    drive_tick(&c, &s, &in, &out);
    CHECK_EQ(out.alarm, DRIVE_FOLLOWING_ERROR);
    drive_tick(&c, &s, &in, &out);
    CHECK_EQ(out.alarm, DRIVE_FOLLOWING_ERROR);
    in.alarm_reset = false;
    drive_tick(&c, &s, &in, &out);
    in.alarm_reset = true;
    drive_tick(&c, &s, &in, &out);
    CHECK_EQ(out.alarm, DRIVE_NO_ALARM);
}

static void overspeed_alarm(void)
{
    struct drive_config c = config(DRIVE_VELOCITY);
    c.encoder_counts = 1000000;
    struct drive_state s = { 0 };
    struct drive_output out;
    struct drive_input in = { .enable = true };
    drive_tick(&c, &s, &in, &out);
    in.phase += 3599.0 / 60.0 * 1e-4 * 2500;
    drive_tick(&c, &s, &in, &out);
    CHECK_EQ(out.alarm, DRIVE_NO_ALARM);
    in.phase -= 3601.0 / 60.0 * 1e-4 * 2500;
    drive_tick(&c, &s, &in, &out);
    CHECK_EQ(out.alarm, DRIVE_OVERSPEED);
    CHECK(out.torque == 0.0);
    in.alarm_reset = true; /* too fast still: comes back at once */
    in.phase -= 3601.0 / 60.0 * 1e-4 * 2500;
    drive_tick(&c, &s, &in, &out);
    CHECK_EQ(out.alarm, DRIVE_OVERSPEED);
    struct drive_state off = { 0 }; /* turned by hand while off: no alarm */
    in.enable = in.alarm_reset = false;
    drive_tick(&c, &off, &in, &out);
    in.phase += 100.0;
    drive_tick(&c, &off, &in, &out);
    CHECK_EQ(out.alarm, DRIVE_NO_ALARM);
}

/* A load that the torque does not move: the alarm is raised one sample after the time allowed. Time
 * below the limit counts back, so that a share of less than half never does. */
static void overload_alarm(void)
{
    struct drive_config c = config(DRIVE_VELOCITY);
    struct drive_output out;
    c.overload_time = 0.1;
    for (int busy = 3; busy <= 10; busy++) { /* of ten samples in a row */
        struct drive_state s = { 0 };
        struct drive_input in = { .enable = true };
        int limited = 0, first = -1;
        c.velocity_time = 0.0; /* torque by the volts of this sample alone */
        for (int k = 0; k < 20000 && first < 0; k++) {
            in.volts = k % 10 < busy ? 8.0 : 0.001;
            drive_tick(&c, &s, &in, &out);
            limited += out.saturated || out.alarm ? 1 : limited > 0 ? -1 : 0;
            CHECK(out.alarm == (limited > 1000 ? DRIVE_OVERLOAD : DRIVE_NO_ALARM));
            first = out.alarm ? k : -1;
            CHECK(!(out.saturated && out.alarm)); /* no torque is at no limit */
            CHECK(out.ready == !out.alarm && (out.alarm ? out.torque == 0.0 : out.torque > 0.0));
        }
        CHECK((first > 0) == (busy > 5));
        CHECK(busy < 10 || first == 1000);
        if (busy == 10) {
            drive_tick(&c, &s, &in, &out);
            CHECK(out.alarm == DRIVE_OVERLOAD && out.torque == 0.0 && !out.ready);
            in.alarm_reset = true;
            drive_tick(&c, &s, &in, &out);
            CHECK(out.alarm == DRIVE_NO_ALARM && out.ready);
        }
    }
    /* However long the torque was below the limit before, nothing is saved up. */
    struct drive_state rested = { 0 };
    for (int k = 0; k < 5000 + 1001; k++) {
        CHECK_EQ(out.alarm, DRIVE_NO_ALARM);
        const double volts = k < 5000 ? 0.001 : 8.0;
        drive_tick(&c, &rested, &(struct drive_input){ .enable = true, .volts = volts }, &out);
    }
    CHECK_EQ(out.alarm, DRIVE_OVERLOAD);
    struct drive_state never = { 0 };
    c.overload_time = 0.0;
    for (int k = 0; k < 20000; k++)
        drive_tick(&c, &never, &(struct drive_input){ .enable = true, .volts = 8.0 }, &out);
    CHECK(out.saturated && out.alarm == DRIVE_NO_ALARM);
}

/* A motor with a load that pulls: falls when the drive goes off, or the brake stops and holds it as
 * long as it bears the load. */
static void brake(void)
{
    static const double INERTIA = 1e-3, STEP = 1e-4, PULL = 2.0; /* [kg.m^2] [s] [N.m] */

    for (int bears = 0; bears < 3; bears++) { /* none, too little, enough */
        struct drive_config c = config(DRIVE_VELOCITY);
        struct drive_state s = { 0 };
        struct drive_output out = { 0 };
        double speed = 20.0, angle = 0.0, at = 0.0, most = 0.0; /* [rad/s] [rad] */
        c.brake_torque = bears == 0 ? 0.0 : bears == 1 ? 0.5 * PULL : 2.0 * PULL;
        c.velocity_gain = 0.2;
        c.velocity_time = 0.05;
        for (int k = 0; k < 10000; k++) {
            const struct drive_input in = { .phase = angle / 6.283185307179586 * c.encoder_lines };
            CHECK_EQ(drive_tick(&c, &s, &in, &out), DRIVE_OK);
            CHECK(!out.ready && !out.saturated && out.speed_command == 0.0);
            CHECK(fabs(out.torque) <= c.brake_torque);
            speed += STEP * (out.torque + PULL) / INERTIA;
            angle += STEP * speed;
            at = k == 5000 ? angle : at;
            most = k > 5000 ? fmax(most, fabs(angle - at)) : most;
        }
        const double pull = (PULL - c.brake_torque) / INERTIA; /* [rad/s^2] it falls with */
        if (bears < 2)
            CHECK_NEAR(speed, 20.0 + pull, 0.01 * pull);
        else
            CHECK(most < 2.0 * 6.283185307179586 / c.encoder_counts);
    }
}

/* A phase that cannot be counted changes nothing. */
/* A motor that turns: without its encoder the drive trips at once and sees no speed. Its brake
 * holds all the same, and a reset helps only once the plug is in. */
static void encoder_alarm(void)
{
    struct drive_config c = config(DRIVE_VELOCITY);
    struct drive_state s = { 0 };
    struct drive_output out;
    struct drive_input in = { .enable = true, .volts = 1.0 };
    const double turn = 2500 * 5.0 * 1e-4; /* [line periods] of a sample at 300 rpm */

    c.brake_torque = 3.0;
    for (int k = 0; k < 20; k++, in.phase += turn)
        drive_tick(&c, &s, &in, &out);
    CHECK(out.ready && fabs(out.speed - 300.0) < 61.0);
    in.unplugged = true;
    for (int k = 0; k < 20; k++, in.phase += turn) {
        in.alarm_reset = k % 2;
        drive_tick(&c, &s, &in, &out);
        CHECK(out.alarm == DRIVE_ENCODER && !out.ready && out.speed == 0.0);
        CHECK(out.torque < 0.0 && out.torque >= -3.0); /* of the brake */
    }
    in.unplugged = in.alarm_reset = false;
    drive_tick(&c, &s, &in, &out);
    CHECK(out.alarm == DRIVE_ENCODER && !out.ready && fabs(out.speed - 300.0) < 61.0);
    in.alarm_reset = true;
    drive_tick(&c, &s, &in, &out);
    CHECK(out.alarm == DRIVE_NO_ALARM && out.ready && out.torque == 0.0);
}

static void bad_phase(void)
{
    struct drive_config c = config(DRIVE_POSITION);
    struct drive_state s = { 0 };
    struct drive_output out = { 0 };
    drive_tick(&c, &s, &(struct drive_input){ .enable = true, .phase = 3.0 }, &out);
    struct drive_state was = s;
    const double bad[] = { NAN, INFINITY, -INFINITY, 1e16 };
    for (int i = 0; i < 4; i++)
        CHECK_EQ(drive_tick(&c, &s, &(struct drive_input){ .enable = true, .phase = bad[i] }, &out),
                 DRIVE_BAD_PHASE);
    CHECK(memcmp(&s, &was, sizeof s) == 0);
    CHECK_EQ(drive_tick(&c, &s, &(struct drive_input){ .enable = true, .phase = 2e15 }, &out),
             DRIVE_OK);
}

int main(void)
{
    bumpless(DRIVE_VELOCITY, 0.0);
    bumpless(DRIVE_VELOCITY, 5.0);
    bumpless(DRIVE_VELOCITY, -9.0);
    bumpless(DRIVE_POSITION, 0.0);
    following_error_alarm();
    overspeed_alarm();
    overload_alarm();
    brake();
    encoder_alarm();
    bad_phase();
    return check_result();
}
