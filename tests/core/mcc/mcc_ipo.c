/* Interpolation: durations, exact stop, path mixing, circles. */
#include "mcc_record.h"

static double time_of(double way, double v, double ta, double td)
{
    const double ramps = v * (ta + td) / 2.0;
    return way >= ramps ? way / v + (ta + td) / 2.0 : sqrt(2.0 * way / v * (ta + td));
}

/* N exact stops last the sum of N durations: what ends inside a DDA time costs no more. */
static void no_time_is_lost(void)
{
    struct machine machine = mcc_machine();
    struct record r = { 0 };
    double want = 0.0;
    uint64_t seed = 7;
    machine.acc_time = 0.004;
    machine.dec_time = 0.003;
    begin(machine);
    CHECK_EQ(MCC_set_fspd(&m, 20.0), 0);
    CHECK_EQ(MCC_set_inc(&m), 0);
    for (int i = 0; i < 60; i++) {
        const double way = check_real(&seed, 0.01, 0.4);
        CHECK(MCC_line_x(&m, way) > 0);
        want += time_of(way, 20.0, 0.004, 0.003);
    }
    CHECK(MCC_motion_delay(&m, 12.3) > 0);
    want += 0.0123;
    run(&r);
    CHECK_EQ(r.n, (int)ceil(want / 1.024e-3));
    CHECK_NEAR(r.last.place[0], m.end[0], 0.0);
    CHECK(MCC_check_stop(&m));
}

/* An S-shaped ramp takes the acceleration time; jerk and acceleration stay below those of the
 * ramp, a/(share T/2) and v/(T (1 - share/2)) with share 0.5, at every sample. */
static void s_shaped(void)
{
    const double dt = 1.024e-3, acc = 50.0 / (0.1 * 0.75), jerk = acc / 0.025;
    struct machine machine = mcc_machine();
    struct record r = { 0 };
    double s[4] = { 0 };
    begin(machine);
    MCC_set_fspd(&m, 50.0);
    MCC_set_acc_type(&m, 'S');
    MCC_set_dec_type(&m, 'S');
    CHECK(MCC_line(&m, (double[AXES]){ 30.0, 40.0 }) > 0);
    while (point(&r)) {
        memmove(s + 1, s, 3 * sizeof *s);
        s[0] = hypot(r.last.place[0], r.last.place[1]);
        CHECK(s[0] - s[1] <= 50.0 * dt * (1.0 + 1e-9));
        CHECK(fabs(s[0] - 2.0 * s[1] + s[2]) <= acc * dt * dt * (1.0 + 1e-6));
        CHECK(fabs(s[0] - 3.0 * s[1] + 3.0 * s[2] - s[3]) <= jerk * dt * dt * dt * (1.0 + 1e-6));
    }
    CHECK_EQ(r.n, (int)ceil((50.0 / 50.0 + 0.1) / dt));
    CHECK_NEAR(r.speed_max, 50.0, 1e-9);
    CHECK_NEAR(r.last.place[1], 40.0, 0.0);
}

/* Path mixing on a straight line, equal ramps: the speed never dips, n moves save n - 1 ramps. */
static void mixing_is_smooth(void)
{
    struct record r = { 0 };
    begin(mcc_machine());
    MCC_set_fspd(&m, 50.0);
    MCC_enable_quit(&m);
    CHECK_EQ(MCC_check_quit(&m), 0);
    MCC_set_inc(&m);
    for (int i = 0; i < 10; i++) {
        CHECK(MCC_line(&m, (double[AXES]){ 6.0, 8.0 }) > 0);
    }
    while (point(&r)) {
        const double t = r.n * 1.024e-3;
        CHECK(r.last.feed <= 50.0 * (1.0 + 1e-9));
        if (t > 0.1 && t < 2.0) {
            CHECK_NEAR(r.last.feed, 50.0, 1e-9);
        }
    }
    CHECK_EQ(r.n, (int)ceil((100.0 / 50.0 + 0.1) / 1.024e-3));
    CHECK_NEAR(r.last.place[0], 60.0, 0.0);
    CHECK_NEAR(r.last.place[1], 80.0, 0.0);
}

/* A square corner: cut inside by as much as two equal ramps say. At time t of the ramp time T, X
 * lacks v (T-t)^2/(2T) and Y has v t^2/(2T); nearest to the corner at T/2: v T/8 in each. Only
 * meanwhile two commands are told. */
static void corner(void)
{
    struct record r = { 0 };
    double nearest = 1e9;
    begin(mcc_machine());
    MCC_set_fspd(&m, 40.0);
    MCC_enable_quit(&m);
    CHECK(MCC_line_x(&m, 10.0) > 0);
    CHECK(MCC_line_y(&m, 10.0) > 0);
    while (point(&r)) {
        nearest = fmin(nearest, hypot(r.last.place[0] - 10.0, r.last.place[1]));
        CHECK(r.last.place[0] <= 10.0 && r.last.place[1] >= 0.0);
        CHECK_EQ(r.last.command, r.last.place[0] < 10.0 ? 1 : 2);
        CHECK_EQ(r.last.newest, r.last.place[1] > 0.0 ? 2 : 1);
    }
    CHECK_NEAR(nearest, 40.0 * 0.1 / 8.0 * sqrt(2.0), 1e-4);
    CHECK_NEAR(r.last.place[0], 10.0, 0.0);
    CHECK_NEAR(r.last.place[1], 10.0, 0.0);
}

/* With path mixing off again the corner is met: every point lies on one of the two lines. */
static void mixing_off_again(void)
{
    struct record r = { 0 };
    begin(mcc_machine());
    MCC_set_fspd(&m, 40.0);
    MCC_enable_quit(&m);
    CHECK_EQ(MCC_disable_quit(&m), 0);
    CHECK(MCC_line_x(&m, 10.0) > 0);
    CHECK(MCC_line_y(&m, 10.0) > 0);
    while (point(&r)) {
        CHECK(r.last.place[0] == 10.0 || r.last.place[1] == 0.0);
    }
    CHECK_EQ(r.n, (int)ceil(2.0 * (10.0 / 40.0 + 0.1) / 1.024e-3));
}

/* Speed and acceleration of a circle: v along the true circle, chord error v^2 T^2/(8 R). */
static void circle(void)
{
    struct record r = { 0 };
    double last[2] = { 50.0, 0.0 }, chord_error = 0.0;
    begin(mcc_machine());
    MCC_set_fspd(&m, 100.0);
    CHECK(MCC_ptp(&m, (double[AXES]){ 50.0 }) > 0);
    run(&r);
    CHECK(MCC_circle_xy(&m, 0.0, 0.0, 1) > 0);
    while (point(&r)) {
        CHECK_NEAR(hypot(r.last.place[0], r.last.place[1]), 50.0, 1e-12);
        const double mid = hypot(r.last.place[0] + last[0], r.last.place[1] + last[1]) / 2.0;
        chord_error = fmax(chord_error, 50.0 - mid);
        last[0] = r.last.place[0];
        last[1] = r.last.place[1];
    }
    const double vt = 100.0 * 1.024e-3;
    CHECK_NEAR(chord_error, vt * vt / (8.0 * 50.0), 1e-10);
    CHECK_NEAR(last[0], 50.0, 0.0);
    CHECK_NEAR(last[1], 0.0, 0.0);
}

int main(void)
{
    no_time_is_lost();
    s_shaped();
    mixing_is_smooth();
    corner();
    mixing_off_again();
    circle();
    return check_result();
}
