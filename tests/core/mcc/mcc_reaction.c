/* Motion that is interfered with: hold, override, abort, too many pulses, all at random. */
#include "mcc_record.h"
#include "reaction.h"

/* Hold: on the path, v^2/(2 d) further; continue: the same end, later by what was lost. */
static void hold(void)
{
    struct record r = { 0 };
    begin(mcc_machine());
    MCC_set_fspd(&m, 50.0);
    CHECK_EQ(MCC_motion_hold(&m), MCC_HOLD_ILLEGAL);
    CHECK(MCC_line(&m, (double[AXES]){ 30.0, 40.0 }) > 0);
    CHECK_EQ(MCC_motion_conti(&m), MCC_CONTI_ILLEGAL);
    while (r.n < 500) {
        point(&r);
    }
    const double held = hypot(r.last.place[0], r.last.place[1]);
    CHECK_EQ(MCC_motion_hold(&m), 0);
    CHECK_EQ(MCC_motion_hold(&m), MCC_HOLD_ILLEGAL);
    run(&r);
    CHECK_EQ(task_status(&m), TASK_HOLD);
    CHECK_EQ(r.n, 500 + (int)ceil(0.1 / 1.024e-3));
    CHECK_NEAR(hypot(r.last.place[0], r.last.place[1]), held + 50.0 * 0.1 / 2.0, 1e-9);
    CHECK_NEAR(r.last.place[0] * 4.0, r.last.place[1] * 3.0, 1e-12);
    CHECK_EQ(MCC_motion_conti(&m), 0);
    run(&r);
    CHECK_EQ(task_status(&m), TASK_STOPPED);
    CHECK_NEAR(r.last.place[0], 30.0, 0.0);
    CHECK_NEAR(r.speed_max, 50.0, 1e-9);
}

/* Override: the new speed after |dv|/a, no more than 200 %, 0 stops, the end stays. */
static void override(void)
{
    struct record r = { 0 };
    begin(mcc_machine());
    MCC_set_fspd(&m, 50.0);
    CHECK_EQ(MCC_set_over_spd(&m, 201.0), MCC_PARAMETER);
    CHECK_EQ(MCC_set_over_spd(&m, NAN), MCC_PARAMETER);
    CHECK(MCC_line_x(&m, 100.0) > 0);
    while (r.n < 200) {
        point(&r);
    }
    CHECK_EQ(MCC_set_over_spd(&m, 150.0), 0);
    while (r.n < 200 + 30) {
        point(&r);
    }
    CHECK_NEAR(r.last.feed, 50.0 + 500.0 * 30 * 1.024e-3, 1e-9);
    while (r.n < 200 + 60) {
        point(&r);
    }
    CHECK_NEAR(r.last.feed, 75.0, 1e-9);
    CHECK_EQ(MCC_set_over_spd(&m, 0.0), 0);
    run(&r);
    CHECK_NEAR(r.last.feed, 0.0, 0.0);
    CHECK(r.last.place[0] < 50.0 && !MCC_check_stop(&m));
    CHECK_EQ(MCC_set_over_spd(&m, 10.0), 0);
    run(&r);
    CHECK_NEAR(r.last.place[0], 100.0, 0.0);
    CHECK_NEAR(r.speed_max, 75.0, 1e-9);
}

/* Abort: on the path to rest; ring and end are dropped, the next move starts from there. */
static void abort_motion(void)
{
    struct record r = { 0 };
    begin(mcc_machine());
    MCC_set_fspd(&m, 50.0);
    CHECK_EQ(MCC_motion_abort(&m), MCC_ABORT_ILLEGAL);
    CHECK(MCC_line_x(&m, 100.0) > 0);
    CHECK(MCC_line_y(&m, 100.0) > 0);
    while (r.n < 300) {
        point(&r);
    }
    const double x = r.last.place[0];
    CHECK_EQ(MCC_motion_abort(&m), 0);
    CHECK_EQ(MCC_line_x(&m, 0.0), MCC_ABORT_NOT_FINISH);
    run(&r);
    CHECK_NEAR(r.last.place[0], x + 2.5, 1e-9);
    CHECK_NEAR(r.last.place[1], 0.0, 0.0);
    CHECK(MCC_check_stop(&m));
    CHECK_NEAR(m.end[0], x + 2.5, 1e-9);
    CHECK(MCC_line_x(&m, 0.0) > 0);
    run(&r);
    CHECK_EQ(r.sum[0], 0);
}

/* More pulses per DDA time than allowed: 0xF203, and no frame above the limit has been queued. */
static void pulse_limit(void)
{
    struct record r = { 0 };
    const int32_t limit[AXES] = { 40, 40, 40, 40, 40, 40 };
    begin(mcc_machine());
    MCC_set_fspd(&m, 50.0); /* 51.2 pulses per DDA time */
    CHECK_EQ(MCC_set_max_dda_spd(&m, limit), 0);
    CHECK(MCC_line_x(&m, 100.0) > 0);
    CHECK(MCC_line_y(&m, 100.0) > 0);
    while (point(&r)) {
        CHECK(r.last.frame[0] <= 40);
    }
    CHECK_EQ(MCC_get_errcode(&m), MCC_ERROR_SPEED);
    CHECK(r.last.frame[0] < 40 && r.last.feed == 0.0);
    CHECK_NEAR(r.speed_max, 40.0 / 1.024, 0.6);
    CHECK_EQ(MCC_line_x(&m, 0.0), MCC_RUN_TIME);
    CHECK_EQ(MCC_clear_error(&m), 0);
    CHECK(MCC_line_x(&m, 0.0) > 0);
}

/* The same in a chain of look-ahead, whose commands are short: a ramp on the path, and the library
 * knows where it ends. */
static void pulse_limit_in_a_chain(char type)
{
    static const int32_t all[AXES] = { 4095, 4095, 4095, 4095, 4095, 4095 };
    int at_once = 0;

    for (int32_t n = 60; n < 100; n++) {
        struct record r = { 0 };
        struct machine machine = mcc_machine();
        const int32_t limit[AXES] = { n, n, n, n, n, n };
        machine.acc_time = machine.dec_time = 0.02;
        machine.acc_type = machine.dec_type = type;
        begin(machine);
        MCC_set_fspd(&m, 100.0); /* 102.4 pulses per DDA time */
        MCC_enable_quit(&m);
        CHECK_EQ(mcc_set_tolerance(&m, 0.01), 0);
        CHECK_EQ(MCC_set_max_dda_spd(&m, limit), 0);
        for (int k = 1; k < 240; k++) {
            CHECK(MCC_line_x(&m, k * 0.05) > 0);
        }
        run(&r);
        CHECK_EQ(MCC_get_errcode(&m), MCC_ERROR_SPEED);
        CHECK_EQ(lround(m.end[0] * 1000.0), m.trajectory.pulses[0]);
        at_once += r.last.feed > 0.0; /* the first frame of the ramp was too large too */
        if (type == 'T' && r.last.feed == 0.0) {
            const double v = n / 1.024; /* [mm/s] up and down at 5 m/s^2, to three DDA times */
            CHECK_NEAR(r.last.place[0], v * v / 5000.0, 3.0 * n / 1000.0);
        }
        CHECK_EQ(MCC_clear_error(&m), 0);
        CHECK_EQ(MCC_set_max_dda_spd(&m, all), 0);
        CHECK(MCC_ptp_x(&m, 0.0) > 0);
        run(&r);
        CHECK_EQ(r.sum[0], 0);
    }
    /* With S-shaped ramps the tool goes on gaining speed for a while, so there it is the rule. */
    CHECK(type == 'S' || at_once < 4);
}

/* Random lines and arcs with random holds, overrides and aborts: every axis stays within the sum
 * of two commands' accelerations, ends at the target or in the abort, every pulse accounted for. */
static void anything(void)
{
    uint64_t seed = 8;
    for (int i = 0; i < 60; i++) {
        struct record r = { 0 };
        double v0[3] = { 0 }, x0[3] = { 0 };
        bool aborted = false;
        begin(mcc_machine());
        MCC_set_acc_step(&m, 20.0);
        MCC_set_dec_step(&m, 30.0);
        for (int k = 0; k < 40; k++) {
            MCC_set_fspd(&m, check_real(&seed, 5.0, 60.0));
            if (check_real(&seed, 0, 1) < 0.5) {
                MCC_enable_quit(&m);
            } else {
                MCC_disable_quit(&m);
            }
            const double a = check_real(&seed, -5, 5), b = check_real(&seed, -5, 5);
            const int code = k % 3 == 0 ? MCC_circle_xy(&m, a, b, k % 2)
                                        : MCC_line(&m, (double[AXES]){ a, b, a - b });
            CHECK(code == k + 1);
        }
        const double target[3] = { m.end[0], m.end[1], m.end[2] };
        for (int k = 0; k < LONGEST; k++) {
            const double die = check_real(&seed, 0, 1);
            if (die < 0.01) {
                MCC_motion_hold(&m);
            } else if (die < 0.03) {
                MCC_motion_conti(&m);
            } else if (die < 0.05) {
                MCC_set_over_spd(&m, check_real(&seed, -50.0, 200.0));
            } else if (die < 0.0501 && MCC_motion_abort(&m) == 0) {
                aborted = true;
            }
            if (!point(&r)) {
                if (MCC_check_stop(&m)) {
                    break;
                }
                memset(v0, 0, sizeof v0);
                continue;
            }
            for (int j = 0; j < 3; j++) {
                const double v = (r.last.place[j] - x0[j]) / 1.024e-3;
                /* 60 mm/s in 20 ms from two commands, and v^2/r of circles of 0.1 mm and more */
                CHECK(fabs(v - v0[j]) / 1.024e-3 < 2.0 * 3000.0 + 2.0 * 120.0 * 120.0 / 0.1);
                CHECK(fabs(v) < 2.0 * 120.0);
                v0[j] = v;
                x0[j] = r.last.place[j];
            }
        }
        CHECK(MCC_check_stop(&m));
        for (int j = 0; j < 3; j++) {
            CHECK(aborted || r.last.place[j] == target[j]);
            CHECK_EQ(r.sum[j], (int32_t)lround(m.end[j] * 1000.0));
        }
    }
}

/* An emergency stop is cleared two DDA times after the release or the last pulse, whichever is
 * later. */
static void quiet_after_a_stop(void)
{
    enum { BUS = 4000 };
    const struct machine machine = mcc_machine();
    const int quiet = (int)ceil(2.0 * (double)machine_dda_clocks(&machine) / BUS); /* 20.48 */
    begin(machine);
    for (int k = -3; k <= 10 + quiet; k++) {
        m.signals.stop = k <= 0;
        m.signals.pulses[2] += k == 10;
        reaction_look(&m, &(struct reaction_look){ .clocks = BUS });
        CHECK_EQ(MCC_clear_error(&m), k <= 0           ? MCC_RUN_TIME
                                      : k < 10 + quiet ? MCC_COMMAND_NOTFINISHED
                                                       : MCC_NO_ERR);
    }
}

int main(void)
{
    hold();
    override();
    abort_motion();
    pulse_limit();
    pulse_limit_in_a_chain('T');
    pulse_limit_in_a_chain('S');
    anything();
    quiet_after_a_stop();
    return check_result();
}
