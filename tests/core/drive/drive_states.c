/* Enabling, alarms and reset of the servo drive. */
#include "check.h"
#include "drive.h"

#include <math.h>
#include <string.h>

static struct drive_config config(int32_t mode)
{
    return (struct drive_config){
        .mode = mode, .period = 1e-4, .speed_per_volt = 300.0, .encoder_lines = 2500,
        .encoder_counts = 10000, .pulses_per_turn = 10000, .velocity_gain = 0.5,
        .velocity_time = 0.02, .position_gain = 50.0, .torque_limit = 10.0, .speed_limit = 3000.0,
        .error_limit = 0.5,
    };
}

/* Whatever speed, command and position it is enabled at, the torque starts from zero, and moves on
 * without a jump: by Kp T / Ti e at most in a sample of constant error. */
static void bumpless(int32_t mode, double volts)
{
    struct drive_config c = config(mode);
    struct drive_state s = {0};
    struct drive_output out;
    struct drive_input in = {.volts = volts, .pulses = 123456, .phase = 77.0};
    double turns_per_sample = 600.0 / 60.0 * 1e-4;
    for (int k = 0; k < 40; k++) {
        in.enable = k >= 20;
        in.phase += turns_per_sample * 2500;
        drive_tick(&c, &s, &in, &out);
        if (k < 20) {
            CHECK(out.torque == 0.0 && out.speed_command == 0.0 && !out.ready);
            CHECK(k == 0 || fabs(out.speed - 600.0) < 61.0);    /* one count is 60 rpm */
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
    struct drive_state s = {0};
    struct drive_output out;
    struct drive_input in = {.enable = true};
    drive_tick(&c, &s, &in, &out);
    in.pulses = 5000;                       /* exactly the limit of half a turn */
    drive_tick(&c, &s, &in, &out);
    CHECK_EQ(out.alarm, DRIVE_NO_ALARM);
    CHECK(out.torque > 0.0);
    in.pulses = 5001;
    drive_tick(&c, &s, &in, &out);
    CHECK_EQ(out.alarm, DRIVE_FOLLOWING_ERROR);
    CHECK(!out.ready && out.torque == 0.0 && out.speed_command == 0.0);
    in.enable = false;                      /* only a reset edge clears it */
    drive_tick(&c, &s, &in, &out);
    in.enable = true;
    drive_tick(&c, &s, &in, &out);
    CHECK_EQ(out.alarm, DRIVE_FOLLOWING_ERROR);
    in.alarm_reset = true;
    drive_tick(&c, &s, &in, &out);
    CHECK_EQ(out.alarm, DRIVE_NO_ALARM);
    CHECK(out.ready && out.following_error == 0.0 && out.torque == 0.0);
    in.pulses += 6000;                      /* a reset held up does not clear the next one */
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
    struct drive_state s = {0};
    struct drive_output out;
    struct drive_input in = {.enable = true};
    drive_tick(&c, &s, &in, &out);
    in.phase += 3599.0 / 60.0 * 1e-4 * 2500;
    drive_tick(&c, &s, &in, &out);
    CHECK_EQ(out.alarm, DRIVE_NO_ALARM);
    in.phase -= 3601.0 / 60.0 * 1e-4 * 2500;
    drive_tick(&c, &s, &in, &out);
    CHECK_EQ(out.alarm, DRIVE_OVERSPEED);
    CHECK(out.torque == 0.0);
    in.alarm_reset = true;                  /* too fast still: comes back at once */
    in.phase -= 3601.0 / 60.0 * 1e-4 * 2500;
    drive_tick(&c, &s, &in, &out);
    CHECK_EQ(out.alarm, DRIVE_OVERSPEED);
    struct drive_state off = {0};           /* turned by hand while off: no alarm */
    in.enable = in.alarm_reset = false;
    drive_tick(&c, &off, &in, &out);
    in.phase += 100.0;
    drive_tick(&c, &off, &in, &out);
    CHECK_EQ(out.alarm, DRIVE_NO_ALARM);
}

/* A phase that cannot be counted changes nothing. */
static void bad_phase(void)
{
    struct drive_config c = config(DRIVE_POSITION);
    struct drive_state s = {0};
    struct drive_output out = {0};
    drive_tick(&c, &s, &(struct drive_input){.enable = true, .phase = 3.0}, &out);
    struct drive_state was = s;
    const double bad[] = {NAN, INFINITY, -INFINITY, 1e16};
    for (int i = 0; i < 4; i++)
        CHECK_EQ(drive_tick(&c, &s, &(struct drive_input){.enable = true, .phase = bad[i]}, &out),
                 DRIVE_BAD_PHASE);
    CHECK(memcmp(&s, &was, sizeof s) == 0);
    CHECK_EQ(drive_tick(&c, &s, &(struct drive_input){.enable = true, .phase = 2e15}, &out),
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
    bad_phase();
    return check_result();
}
