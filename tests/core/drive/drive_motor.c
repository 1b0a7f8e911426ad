/* What the motor bears, and how its brake takes over: heat, times of the brake. */
#include "check.h"
#include "drive.h"

#include <math.h>

static struct drive_config motor(void)
{
    return (struct drive_config){
        .mode = DRIVE_VELOCITY,
        .period = 1e-3,
        .speed_per_volt = 300.0,
        .encoder_lines = 2500,
        .encoder_counts = 1048576,
        .pulses_per_turn = 10000,
        .velocity_gain = 0.1,
        .torque_limit = 3.9,
        .speed_limit = 3000.0,
        .error_limit = 5.0,
        .rated_torque = 1.3,
        .thermal_time = 30.0,
        .thermal_limit = 1.15,
        .brake_torque = 5.0,
        .brake_speed = 30.0,
    };
}

/* Volts at which a standing motor is given a torque of so many times the rated one. */
static double volts(const struct drive_config *c, double ratio)
{
    return ratio * c->rated_torque / c->velocity_gain / (300.0 * 3.14159265358979323846 / 30.0);
}

/* From cold the alarm comes after -T ln(1 - (limit/r)^2); at the limit and below never. */
static void time_to_alarm(void)
{
    const struct drive_config c = motor();
    const double ratios[] = { 0.5, 1.0, 1.149, 1.2, 1.5, 2.0, 2.9 };
    for (int i = 0; i < 7; i++) {
        struct drive_state s = { 0 };
        struct drive_output out = { 0 };
        const double share = c.thermal_limit / ratios[i];
        const struct drive_input in = { .enable = true, .volts = volts(&c, ratios[i]) };
        int k = 0;
        for (; k < 400000 && out.alarm == DRIVE_NO_ALARM; k++) {
            drive_tick(&c, &s, &in, &out);
            const double warm = 1.0 - pow(c.thermal_time / (c.thermal_time + c.period), k + 1);
            CHECK_NEAR(out.load_ratio, ratios[i] * sqrt(warm), 1e-9);
        }
        if (ratios[i] < c.thermal_limit) {
            CHECK_EQ(out.alarm, DRIVE_NO_ALARM);
            continue;
        }
        CHECK_EQ(out.alarm, DRIVE_OVERLOAD);
        CHECK(!out.ready);
        CHECK_NEAR(k * c.period, -c.thermal_time * log(1.0 - share * share), 2.5 * c.period);
    }
}

/* Only the mean square counts: twice the rated torque for a quarter of the time is rated torque. */
static void by_rms(void)
{
    const struct drive_config c = motor();
    for (int busy = 3; busy <= 4; busy++) { /* of ten: 110 and 126 % of the rated torque */
        struct drive_state s = { 0 };
        struct drive_output out = { 0 };
        for (int k = 0; k < 400000 && out.alarm == DRIVE_NO_ALARM; k++) {
            const double v = volts(&c, k % 10 < busy ? 2.0 : 0.0);
            drive_tick(&c, &s, &(struct drive_input){ .enable = true, .volts = v }, &out);
        }
        CHECK_EQ(out.alarm, busy == 4 ? DRIVE_OVERLOAD : DRIVE_NO_ALARM);
        CHECK(busy == 4 || fabs(out.load_ratio - 2.0 * sqrt(0.3)) < 1e-3);
    }
}

/* Heat outlives the alarm: a reset helps only once it is below the limit; without a rated torque
 * nothing is warm. */
static void cools(void)
{
    struct drive_config c = motor();
    struct drive_state s = { 0 };
    struct drive_output out = { 0 };
    struct drive_input in = { .enable = true, .volts = volts(&c, 2.9) };
    while (out.alarm == DRIVE_NO_ALARM)
        drive_tick(&c, &s, &in, &out);
    s.heat = 1.2 * 1.2;
    const double wanted = c.thermal_time * log(1.2 * 1.2 / (1.15 * 1.15)); /* [s] */
    in.volts = 0.0;
    int k = 0;
    for (out.ready = false; !out.ready; k++) {
        in.alarm_reset = k % 2 == 0;
        drive_tick(&c, &s, &in, &out);
        CHECK(out.alarm == (out.ready ? DRIVE_NO_ALARM : DRIVE_OVERLOAD));
    }
    CHECK_NEAR(k * c.period, wanted, 4.0 * c.period);
    c.rated_torque = 0.0;
    struct drive_state cold = { 0 };
    in.volts = 100.0;
    for (k = 0; k < 100000; k++)
        drive_tick(&c, &cold, &in, &out);
    CHECK(out.load_ratio == 0.0 && out.alarm == DRIVE_NO_ALARM);
}

/* Runs a motor at a speed [rpm], switches it off at sample 10 and tells when the drive's torque
 * ends and when that of the brake begins [samples after]. */
struct times {
    int hold, brake;
};

static struct times switched_off(const struct drive_config *c, double rpm, bool alarm)
{
    struct drive_state s = { 0 };
    struct drive_output out = { 0 };
    struct times found = { 0, -1 };
    double turns = 0.0;
    for (int k = 0; k < 400; k++) {
        if (k >= 10 && rpm == 0.0)
            turns -= 1e-4; /* the load sinks at 6 rpm: the loops pull against it */
        struct drive_input in = { .enable = k < 10 || alarm,
                                  .volts = rpm / 300.0 + (rpm == 0.0 ? 0.5 : 0.1),
                                  .phase = turns * 2500.0,
                                  .unplugged = alarm && k >= 10 };
        drive_tick(c, &s, &in, &out);
        turns += rpm / 60.0 * c->period;
        if (k < 10)
            continue;
        CHECK(!out.ready && !out.saturated);
        const bool loops = s.on;
        found.hold += loops;
        if (!loops && out.torque != 0.0 && found.brake < 0)
            found.brake = k - 10;
        CHECK(loops || found.brake >= 0 || out.torque == 0.0);
    }
    return found;
}

/* Panasonic Pr4.37: at rest the loops hold the load while the brake closes. Pr4.38, Pr4.39: a motor
 * that turns has its brake closed late. An alarm takes the torque at once. */
static void brake_times(void)
{
    struct drive_config c = motor();
    c.velocity_gain = 1e-3;
    struct times t = switched_off(&c, 0.0, false);
    CHECK(t.hold == 0 && t.brake == 0);
    c.brake_close_time = 0.05;
    t = switched_off(&c, 0.0, false); /* nobody holds the load for 50 ms */
    CHECK(t.hold == 0 && t.brake == 50);
    c.brake_hold_time = 0.08;
    t = switched_off(&c, 0.0, false);
    CHECK(t.hold == 80 && t.brake == 80);
    c.brake_hold_time = 0.03; /* too short: it falls in between */
    t = switched_off(&c, 0.0, false);
    CHECK(t.hold == 30 && t.brake == 50);
    t = switched_off(&c, 0.0, true);
    CHECK(t.hold == 0 && t.brake == 50);
    c.brake_run_time = 0.1;
    t = switched_off(&c, 0.0, false); /* it rests already */
    CHECK(t.hold == 30 && t.brake == 50);
    t = switched_off(&c, 29.0, false);
    CHECK(t.hold == 30 && t.brake == 50);
    t = switched_off(&c, 600.0, false);
    CHECK(t.hold == 0 && t.brake == 150);
    t = switched_off(&c, 600.0, true); /* without an encoder it does not wait */
    CHECK(t.hold == 0 && t.brake == 50);
    c.brake_speed = 700.0;
    t = switched_off(&c, 600.0, false);
    CHECK(t.hold == 30 && t.brake == 50);
}

/* A motor that was never switched on has its brake closed, whatever its times. */
static void closed_at_first(void)
{
    struct drive_config c = motor();
    struct drive_state s = { 0 };
    struct drive_output out;
    c.brake_close_time = c.brake_run_time = 1.0;
    for (int k = 0; k < 3; k++)
        drive_tick(&c, &s, &(struct drive_input){ .phase = 50.0 * k }, &out);
    CHECK(out.torque < 0.0);
}

int main(void)
{
    time_to_alarm();
    by_rms();
    cools();
    brake_times();
    closed_at_first();
    return check_result();
}
