/* Interpolation: durations, exact stop and path mixing, hold, override, abort, pulse limits. */
#include "mcc_check.h"
#include "task.h"

static struct mcc m;    /* 140 kB: not on the stack */
enum { LONGEST = 200000 };

/* A recording of everything the task queues. */
struct record {
    int n;
    int32_t sum[AXES];
    double  speed_max;
    struct point last;
};

static void begin(struct machine machine)
{
    machine.queue_depth = 1;    /* one point per cycle: the test acts between points */
    CHECK_EQ(MCC_init_motion(&m, &machine), MCC_NO_ERR);
}

/* One point; false if the axes rest. Each frame must be the way between half-pulse ideal points. */
static bool point(struct record *r)
{
    task_run(&m, NULL, 0);
    if (m.queue.count == 0) {
        return false;
    }
    r->last = *queue_peek(&m.queue, 0);
    queue_drop(&m.queue, 1);
    for (int i = 0; i < 3; i++) {
        r->sum[i] += r->last.frame[i];
        CHECK_EQ(r->sum[i], r->last.pulses[i]);
        CHECK(fabs(r->last.place[i] * 1000.0 - r->last.pulses[i]) <= 0.5 + 1e-6);
    }
    r->speed_max = fmax(r->speed_max, r->last.feed);
    r->n++;
    return true;
}

static void run(struct record *r)
{
    while (r->n < LONGEST && point(r)) {
    }
    CHECK(r->n < LONGEST);
}

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
        const double way = mcc_random(&seed, 0.01, 0.4);
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

/* Path mixing on a straight line with equal ramps: the speed never dips, n moves save n - 1 ramps. */
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

/* A square corner: cut inside by as much as two equal ramps say. At time t of the ramp time T, X lacks
 * v (T-t)^2/(2T) and Y has v t^2/(2T); nearest to the corner at T/2: v T/8 in each. */
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
    }
    CHECK_NEAR(nearest, 40.0 * 0.1 / 8.0 * sqrt(2.0), 1e-4);
    CHECK_NEAR(r.last.place[0], 10.0, 0.0);
    CHECK_NEAR(r.last.place[1], 10.0, 0.0);
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
    MCC_set_fspd(&m, 50.0);     /* 51.2 pulses per DDA time */
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

/* Random lines and arcs with random holds, overrides and aborts: every axis stays within the sum of
 * two commands' accelerations, ends at the target or in the abort, and no pulse is unaccounted for. */
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
            MCC_set_fspd(&m, mcc_random(&seed, 5.0, 60.0));
            if (mcc_random(&seed, 0, 1) < 0.5) {
                MCC_enable_quit(&m);
            } else {
                MCC_disable_quit(&m);
            }
            const double a = mcc_random(&seed, -5, 5), b = mcc_random(&seed, -5, 5);
            const int code = k % 3 == 0 ? MCC_circle_xy(&m, a, b, k % 2)
                                        : MCC_line(&m, (double[AXES]){ a, b, a - b });
            CHECK(code == k + 1);
        }
        const double target[3] = { m.end[0], m.end[1], m.end[2] };
        for (int k = 0; k < LONGEST; k++) {
            const double die = mcc_random(&seed, 0, 1);
            if (die < 0.01) {
                MCC_motion_hold(&m);
            } else if (die < 0.03) {
                MCC_motion_conti(&m);
            } else if (die < 0.05) {
                MCC_set_over_spd(&m, mcc_random(&seed, -50.0, 200.0));
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

int main(void)
{
    no_time_is_lost();
    mixing_is_smooth();
    corner();
    circle();
    hold();
    override();
    abort_motion();
    pulse_limit();
    anything();
    return check_result();
}
