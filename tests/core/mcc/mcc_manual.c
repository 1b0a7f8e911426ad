/* Asynchronous point-to-point, jog, hand wheel: each call good and bad, exact ends, limits. */
#include "mcc_record.h"

static struct mcc before;

/* The call must return the code and leave the whole state as it was. */
#define REFUSED(call, code) \
    do { \
        memcpy(&before, &m, sizeof m); \
        CHECK_EQ(call, code); \
        CHECK(memcmp(&before, &m, sizeof m) == 0); \
    } while (0)

/* One report of the card and one point. */
static bool step(struct record *r)
{
    manual_look(&m);
    return point(r);
}

static void steps(struct record *r, int count)
{
    for (int k = 0; k < count; k++) {
        step(r);
    }
}

/* The latest place, speed and acceleration of an axis by differences of its points. */
struct motion {
    double s, v, a;
    int n;
};

static void watch(struct motion *w, double s)
{
    const double dt = machine_dda_time(&m.machine), v = (s - w->s) / dt;
    w->a = w->n > 1 ? (v - w->v) / dt : 0.0;
    w->v = w->n > 0 ? v : 0.0;
    w->s = s;
    w->n++;
}

static void not_open(void)
{
    const double place[AXES] = { 1.0 }, ms[AXES] = { 1, 1, 1, 1, 1, 1 };
    const int32_t order[AXES] = { 1 };
    const struct home_config c = { HOME_SENSOR, 0, true, 1.0, 1.0, 0.0, 1.0, 1.0 };

    memset(&m, 0, sizeof m);
    REFUSED(MCC_ptp_asyn(&m, place), MCC_INITIAL_MOTION);
    REFUSED(MCC_jog_c(&m, 0, 1, 10.0), MCC_INITIAL_MOTION);
    REFUSED(MCC_jog_i(&m, 0, 1.0, 10.0), MCC_INITIAL_MOTION);
    REFUSED(MCC_jog_s(&m, 0, 1), MCC_INITIAL_MOTION);
    REFUSED(MCC_MPG_set(&m, 0, 6, 1.0), MCC_INITIAL_MOTION);
    REFUSED(MCC_MPG_disable(&m), MCC_INITIAL_MOTION);
    REFUSED(MCC_go_home(&m, order), MCC_INITIAL_MOTION);
    REFUSED(MCC_check_homef(&m), MCC_HOME_COMMAND_NOTCALLED);
    REFUSED(MCC_set_ptp_asyn_acc_type(&m, "TTTTTT"), MCC_INITIAL_MOTION);
    REFUSED(MCC_set_ptp_asyn_dec_step(&m, ms), MCC_INITIAL_MOTION);
    REFUSED(homing_set(&m, 0, &c, false), MCC_INITIAL_MOTION);
    REFUSED(homing_set_settle(&m, 0.1), MCC_INITIAL_MOTION);
}

static void settings(void)
{
    const double good[AXES] = { 10, 20, 30, 40, 50, 60 }, bad[AXES] = { 10, 20, 0, 40, 50, 60 };
    const double nan[AXES] = { 10, 20, 30, 40, 50, NAN };
    double ms[AXES];
    char types[AXES];

    begin(mcc_machine());
    CHECK_EQ(MCC_get_ptp_asyn_acc_type(&m, types), 0);
    CHECK(memcmp(types, "TTTTTT", AXES) == 0);
    CHECK_EQ(MCC_get_ptp_asyn_acc_step(&m, ms), 0);
    CHECK_NEAR(ms[5], 100.0, 1e-12); /* acc_time of the machine */
    CHECK_EQ(MCC_set_ptp_asyn_acc_type(&m, "STSTST"), 0);
    CHECK_EQ(MCC_set_ptp_asyn_decc_type(&m, "TTTSSS"), 0);
    CHECK_EQ(MCC_set_ptp_asyn_acc_step(&m, good), 0);
    CHECK_EQ(MCC_set_ptp_asyn_dec_step(&m, (double[]){ 1, 2, 3, 4, 5, 6 }), 0);
    REFUSED(MCC_set_ptp_asyn_acc_type(&m, "TTTTTt"), MCC_PARAMETER);
    REFUSED(MCC_set_ptp_asyn_decc_type(&m, "STTT\0T"), MCC_PARAMETER);
    REFUSED(MCC_set_ptp_asyn_acc_step(&m, bad), MCC_PARAMETER);
    REFUSED(MCC_set_ptp_asyn_dec_step(&m, nan), MCC_PARAMETER);
    CHECK_EQ(MCC_get_ptp_asyn_acc_type(&m, types), 0);
    CHECK(memcmp(types, "STSTST", AXES) == 0);
    CHECK_EQ(MCC_get_ptp_asyn_dec_type(&m, types), 0);
    CHECK(memcmp(types, "TTTSSS", AXES) == 0);
    CHECK_EQ(MCC_get_ptp_asyn_acc_step(&m, ms), 0);
    CHECK(memcmp(ms, good, sizeof ms) == 0);
    CHECK_EQ(MCC_get_ptp_asyn_dec_step(&m, ms), 0);
    CHECK_NEAR(ms[3], 4.0, 1e-12);
}

/* Each axis takes the time scurve plans for it, the command that of the last one. */
static void asyn_durations(void)
{
    const double target[AXES] = { 60.0, -15.0, 3.0 };
    const double dt = 1.024e-3;
    struct record r = { 0 };
    double last[3] = { 0.0 };
    int moved[3] = { 0 };

    begin(mcc_machine());
    CHECK_EQ(MCC_set_ptp_spd(&m, 40.0), 0);
    CHECK_EQ(MCC_set_ptp_asyn_acc_type(&m, "SSTSSS"), 0);
    CHECK_EQ(MCC_set_ptp_asyn_decc_type(&m, "SSTSSS"), 0);
    CHECK_EQ(MCC_ptp_asyn(&m, target), 1);
    CHECK_EQ(MCC_set_ptp_spd(&m, 10.0), 0); /* counts from the next command on */
    CHECK_EQ(MCC_line_x(&m, 61.0), 2);      /* waits behind it */
    while (step(&r) && r.last.command == 1) {
        for (int i = 0; i < 3; i++) {
            moved[i] = r.last.place[i] != last[i] ? r.n : moved[i];
            last[i] = r.last.place[i];
        }
    }
    CHECK_EQ(r.last.command, 2);
    for (int i = 0; i < 3; i++) {
        const double acc = i < 2 ? 200.0 / (0.1 * 0.75) : 200.0 / 0.1;
        const struct scurve_limits l = { 200.0, acc, acc, i < 2 ? acc / 0.025 : acc / 1e-9 };
        const struct scurve_start rest = { 0.0, 0.0, 0.0 };
        struct scurve s;
        CHECK_EQ(scurve_plan(&s, &rest, target[i], &l), SCURVE_OK);
        const int n = moved[i] + (i == 0); /* in its last one the line begins */
        CHECK(scurve_total(&s) <= n * dt && scurve_total(&s) > (n - 1) * dt - 1e-9);
        CHECK(i == 0 || last[i] == target[i]);
    }
    CHECK(moved[0] > moved[1] && moved[1] > moved[2]);
    run(&r);
    CHECK(r.last.place[0] == 61.0 && MCC_check_stop(&m));
    CHECK_EQ(r.sum[1], -15000);
}

/* Incremental, to the same place, unused axes, far away, full ring. */
static void asyn_calls(void)
{
    const double u[AXES] = { [3] = 1.0 }, far[AXES] = { 1e6 }, nan[AXES] = { NAN };
    const double one[AXES] = { 1.0, 1.0 };
    struct record r = { 0 };

    begin(mcc_machine());
    REFUSED(MCC_ptp_asyn(&m, u), MCC_PARAMETER);
    REFUSED(MCC_ptp_asyn(&m, far), MCC_PARAMETER);
    REFUSED(MCC_ptp_asyn(&m, nan), MCC_PARAMETER);
    CHECK_EQ(MCC_set_inc(&m), 0);
    CHECK_EQ(MCC_ptp_asyn(&m, (double[AXES]){ 0.0 }), 1); /* nothing to do */
    for (int i = 0; i < RING_SIZE; i++) {
        CHECK_EQ(MCC_ptp_asyn(&m, one), 2 + i);
    }
    REFUSED(MCC_ptp_asyn(&m, one), MCC_COMMAND_BUFFER_FULL);
    REFUSED(MCC_jog_s(&m, 0, 1), MCC_COMMAND_NOTFINISHED);
    run(&r);
    CHECK(r.last.place[0] == RING_SIZE && r.last.place[1] == RING_SIZE && r.last.place[2] == 0.0);
}

/* Hold, conti, override, abort at random instants; the axes keep their limits at every point. */
static void asyn_reactions(void)
{
    uint64_t random = 7;

    for (int run_no = 0; run_no < 60; run_no++) {
        const bool s = run_no % 2 == 1;
        struct motion w[2] = { { .n = 0 } };
        struct record r = { 0 };
        const double target[AXES] = { check_real(&random, -90.0, 90.0),
                                      check_real(&random, -90.0, 90.0) };
        const double acc = s ? 5000.0 / 0.75 : 5000.0, jerk = acc / 0.025;
        bool aborted = false;

        begin(mcc_machine());
        CHECK_EQ(MCC_set_ptp_asyn_acc_type(&m, s ? "SSSSSS" : "TTTTTT"), 0);
        CHECK_EQ(MCC_set_ptp_asyn_decc_type(&m, s ? "SSSSSS" : "TTTTTT"), 0);
        CHECK_EQ(MCC_ptp_asyn(&m, target), 1);
        for (int k = 0; k < 2000 && !aborted; k++) {
            const double what = check_real(&random, 0.0, 1.0);
            if (what < 0.02) {
                MCC_motion_hold(&m);
            } else if (what < 0.05) {
                MCC_motion_conti(&m);
            } else if (what < 0.07) {
                MCC_set_ptp_ospd(&m, check_real(&random, 0.0, 200.0));
            } else if (what < 0.071) {
                aborted = MCC_motion_abort(&m) == 0;
            }
            const double before_a[2] = { w[0].a, w[1].a };
            if (step(&r)) {
                for (int i = 0; i < 2; i++) {
                    watch(&w[i], r.last.place[i]);
                    CHECK(fabs(w[i].v) <= 500.0 + 1e-6);
                    CHECK(fabs(w[i].a) <= acc + 1e-3);
                    CHECK(!s || w[i].n < 4 || fabs(w[i].a - before_a[i]) <= jerk * 1.024e-3 + 1e-3);
                }
            } else {
                w[0].n = w[1].n = 0;
            }
        }
        MCC_set_ptp_ospd(&m, 100.0);
        MCC_motion_conti(&m);
        run(&r);
        CHECK(MCC_check_stop(&m));
        for (int i = 0; i < 2 && r.n; i++) {
            CHECK(aborted ? m.end[i] == r.last.place[i] : r.last.place[i] == target[i]);
        }
    }
}

/* Continuous: until stopped, or turned round; other axes at once; commands wait. */
static void jog_continuous(void)
{
    const double target[AXES] = { 1.0 };
    struct record r = { 0 };

    begin(mcc_machine());
    REFUSED(MCC_jog_c(&m, 3, 1, 10.0), MCC_PARAMETER); /* not used */
    REFUSED(MCC_jog_c(&m, -1, 1, 10.0), MCC_PARAMETER);
    REFUSED(MCC_jog_c(&m, 0, 2, 10.0), MCC_PARAMETER);
    REFUSED(MCC_jog_c(&m, 0, 1, 0.0), MCC_PARAMETER);
    REFUSED(MCC_jog_c(&m, 0, 1, 100.1), MCC_PARAMETER);
    REFUSED(MCC_jog_c(&m, 0, 1, NAN), MCC_PARAMETER);
    REFUSED(MCC_jog_c(&m, 0, 0, 0.0), MCC_NO_ERR); /* it stands */
    CHECK_EQ(MCC_jog_c(&m, 0, 1, 10.0), 0);
    CHECK_EQ(MCC_jog_c(&m, 1, -1, 20.0), 0);
    REFUSED(MCC_jog_i(&m, 0, 1.0, 10.0), MCC_COMMAND_NOTFINISHED);
    REFUSED(MCC_jog_s(&m, 0, 1), MCC_COMMAND_NOTFINISHED);
    REFUSED(MCC_MPG_set(&m, 0, 6, 1.0), MCC_COMMAND_NOTFINISHED);
    REFUSED(MCC_line(&m, target), MCC_COMMAND_NOTACCEPTED);
    REFUSED(MCC_ptp_asyn(&m, target), MCC_COMMAND_NOTACCEPTED);
    REFUSED(task_start(&m), MCC_COMMAND_NOTACCEPTED);
    REFUSED(MCC_close_motion(&m), MCC_COMMAND_NOTFINISHED);
    REFUSED(MCC_go_home(&m, (int32_t[AXES]){ 1 }), MCC_PARAMETER);
    steps(&r, 1000);
    CHECK_NEAR(r.last.place[0], 50.0 * (1.024 - 0.05), 1e-6);
    CHECK_NEAR(r.last.place[1], -100.0 * (1.024 - 0.05), 1e-6);
    CHECK_NEAR(r.last.feed, hypot(50.0, 100.0), 1e-9);
    CHECK(task_moving(&m) && task_status(&m) == TASK_RUNNING);
    CHECK_EQ(MCC_jog_c(&m, 0, 0, 0.0), 0);
    CHECK_EQ(MCC_jog_c(&m, 1, 1, 20.0), 0); /* it turns round */
    steps(&r, 1000);
    CHECK_NEAR(r.last.place[0], 50.0 * (1.024 - 0.05) + 2.5, 1e-6);
    CHECK_NEAR(r.last.place[1], -100.0 * 0.974 + 100.0 * (1.024 - 0.2), 1e-6);
    CHECK_EQ(MCC_set_ptp_ospd(&m, 50.0), 0);
    steps(&r, 200);
    CHECK_NEAR(r.last.feed, 50.0, 1e-9);
    CHECK_EQ(MCC_motion_hold(&m), 0);
    run(&r);
    CHECK_EQ(task_status(&m), TASK_HOLD);
    CHECK_EQ(MCC_motion_conti(&m), 0);
    steps(&r, 200);
    CHECK_NEAR(r.last.feed, 50.0, 1e-9);
    CHECK_EQ(MCC_motion_abort(&m), 0);
    REFUSED(MCC_jog_c(&m, 0, 1, 10.0), MCC_ABORT_NOT_FINISH);
    run(&r);
    CHECK(MCC_check_stop(&m) && m.end[1] == r.last.place[1]);
    CHECK(MCC_line(&m, target) > 0);
    run(&r);
    CHECK(r.last.place[0] == 1.0);
    CHECK_NEAR(r.last.place[1], 0.0, 0.0);
}

/* A limit switch stops the axis that moves onto it, and no other; away from it is allowed. */
/* From a fast jog to a slow one, and to rest, the axis comes down on the ramps of the fast one. */
static void jog_slower(void)
{
    const struct machine machine = mcc_machine();
    const double down = machine.dec_time;
    struct record r = { 0 };
    begin(machine);
    CHECK_EQ(MCC_jog_c(&m, 0, 1, 10.0), 0);
    steps(&r, 200);
    const double fast = r.last.feed;
    CHECK_EQ(MCC_jog_c(&m, 0, 1, 0.01), 0);
    steps(&r, (int)ceil(down / machine_dda_time(&m.machine)) + 1);
    CHECK_NEAR(r.last.feed, fast / 1000.0, 1e-9 * fast);
    CHECK_EQ(MCC_jog_c(&m, 0, 1, 10.0), 0);
    steps(&r, 200);
    CHECK_EQ(MCC_jog_c(&m, 0, -1, 0.01), 0);
    CHECK_EQ(MCC_motion_abort(&m), 0);
    int n = 0;
    while (n < 1000 && !MCC_check_stop(&m)) {
        step(&r);
        n++;
    }
    CHECK(n * machine_dda_time(&m.machine) < down + 0.01);
}

static void jog_limits(void)
{
    struct record r = { 0 };

    begin(mcc_machine());
    CHECK_EQ(MCC_jog_c(&m, 0, 1, 10.0), 0);
    CHECK_EQ(MCC_jog_c(&m, 1, 1, 10.0), 0);
    steps(&r, 300);
    m.signals.upper = 1;
    m.signals.lower = 2;
    const double met = r.last.place[0];
    steps(&r, 300);
    CHECK_NEAR(r.last.place[0], met + 2.5, 1e-6);
    CHECK(r.last.place[1] > met + 10.0);
    REFUSED(MCC_jog_c(&m, 0, 1, 10.0), MCC_COMMAND_NOTACCEPTED);
    REFUSED(MCC_jog_s(&m, 0, 5), MCC_COMMAND_NOTACCEPTED);
    REFUSED(MCC_jog_i(&m, 0, 0.5, 5.0), MCC_COMMAND_NOTACCEPTED);
    CHECK_EQ(MCC_jog_i(&m, 0, -1.0, 5.0), 0);
    steps(&r, 200);
    CHECK_NEAR(r.last.place[0], met + 1.5, 1e-6);
    CHECK_EQ(MCC_motion_abort(&m), 0);
    run(&r);
    m.error = MCC_ERROR_SPEED;
    REFUSED(MCC_jog_c(&m, 0, -1, 10.0), MCC_RUN_TIME);
}

/* Single steps and pulses: the exact place, on top of any fraction. */
static void jog_steps(void)
{
    uint64_t random = 3;
    struct record r = { 0 };
    int64_t pulses = 0;

    begin(mcc_machine());
    REFUSED(MCC_jog_i(&m, 0, NAN, 10.0), MCC_PARAMETER);
    REFUSED(MCC_jog_i(&m, 0, 1e6, 10.0), MCC_PARAMETER);
    REFUSED(MCC_jog_i(&m, 0, 1.0, -1.0), MCC_PARAMETER);
    REFUSED(MCC_jog_s(&m, 0, INT32_MAX), MCC_PARAMETER);
    REFUSED(MCC_jog_s(&m, 5, 1), MCC_PARAMETER);
    CHECK_EQ(MCC_jog_i(&m, 0, 0.12345, 10.0), 0);
    CHECK_EQ(MCC_jog_i(&m, 1, -3.0, 100.0), 0); /* beside it */
    run(&r);
    CHECK(MCC_check_stop(&m) && r.last.place[0] == 0.12345 && r.last.place[1] == -3.0);
    pulses = 123;
    for (int k = 0; k < 50; k++) {
        const int32_t n = (int32_t)check_real(&random, -3000.0, 3000.0);
        CHECK_EQ(MCC_jog_s(&m, 0, n), 0);
        run(&r);
        pulses += n;
        CHECK_EQ(r.sum[0], pulses);
        CHECK_EQ(m.trajectory.pulses[0], pulses);
    }
    CHECK(MCC_check_stop(&m));
}

/* The axis ends at ratio * counts, whatever the wheel did in between; the counter wraps. */
static void wheel(void)
{
    static const double ratio[] = { 1.0, -2.5, 0.1, 7.0 / 3.0 };
    uint64_t random = 5;

    for (int k = 0; k < 4; k++) {
        struct record r = { 0 };
        struct motion w = { .n = 0 };
        int64_t counts = 0;

        begin(mcc_machine());
        m.signals.enc_aux[1] = INT32_MAX - 100;
        CHECK_EQ(MCC_jog_i(&m, 0, 0.0004, 1.0), 0); /* less than half a pulse */
        run(&r);
        REFUSED(MCC_MPG_set(&m, 0, 9, 1.0), MCC_PARAMETER);
        REFUSED(MCC_MPG_set(&m, 0, -1, 1.0), MCC_PARAMETER);
        REFUSED(MCC_MPG_set(&m, 0, 0, 1.0), MCC_PARAMETER); /* its own encoder */
        REFUSED(MCC_MPG_set(&m, 3, 7, 1.0), MCC_PARAMETER);
        REFUSED(MCC_MPG_set(&m, 0, 7, INFINITY), MCC_PARAMETER);
        CHECK_EQ(MCC_MPG_set(&m, 0, 7, ratio[k]), 0);
        REFUSED(MCC_MPG_set(&m, 0, 8, 1.0), MCC_COMMAND_NOTFINISHED);
        REFUSED(MCC_jog_c(&m, 0, 1, 5.0), MCC_COMMAND_NOTFINISHED);
        REFUSED(MCC_line_x(&m, 1.0), MCC_COMMAND_NOTACCEPTED);
        CHECK_EQ(task_status(&m), TASK_WHEEL);
        for (int j = 0; j < 3000; j++) {
            const int32_t n = (int32_t)check_real(&random, -60.0, 90.0);
            counts += n;
            m.signals.enc_aux[1] = (int32_t)((uint32_t)m.signals.enc_aux[1] + (uint32_t)n);
            if (step(&r)) {
                watch(&w, r.last.place[0]);
                CHECK(fabs(w.v) <= 500.0 + 1e-6 && fabs(w.a) <= 5000.0 + 1e-3);
            } else {
                w.n = 0;
            }
        }
        step(&r);
        run(&r);
        CHECK_EQ(r.sum[0], llround(ratio[k] * (double)counts));
        CHECK(!MCC_check_stop(&m));
        CHECK_EQ(MCC_MPG_disable(&m), 0);
        run(&r);
        CHECK(MCC_check_stop(&m));
        REFUSED(MCC_MPG_disable(&m), MCC_NO_ERR);
    }
}

/* A limit switch stops it; turned back it leaves at once. Disabled in motion it ramps to rest. */
static void wheel_limits(void)
{
    struct record r = { 0 };

    begin(mcc_machine());
    CHECK_EQ(MCC_MPG_set(&m, 2, 6, 1.0), 0);
    m.signals.enc_aux[0] = 100000;
    steps(&r, 200);
    m.signals.upper = 4;
    steps(&r, 300);
    const double met = r.last.place[2];
    CHECK(met > 10.0 && met < 99.0 && r.last.feed == 0.0);
    m.signals.enc_aux[0] += 5000; /* on against the switch */
    steps(&r, 100);
    CHECK_NEAR(r.last.place[2], met, 0.001);
    m.signals.enc_aux[0] -= 700;
    steps(&r, 100);
    CHECK_NEAR(r.last.place[2], met - 0.7, 0.001);
    m.signals.enc_aux[0] -= 50000;
    steps(&r, 60);
    const double left = r.last.place[2];
    CHECK_EQ(MCC_MPG_disable(&m), 0);
    run(&r);
    CHECK(MCC_check_stop(&m) && r.last.place[2] < left - 1.0 && r.last.place[2] > met - 25.0);
}

/* A panel's wheel leads to a software limit and not beyond, without an error; turned back it leaves
 * at once. From beyond a limit it leads back alone. */
static void wheel_rests(void)
{
    uint64_t seed = 11;

    for (int k = 0; k < 40; k++) {
        struct machine machine = mcc_machine();
        struct record r = { 0 };
        machine.axis[2].check_ot = true;
        machine.axis[2].high_limit = check_real(&seed, 5.0, 30.0);
        machine.axis[2].low_limit = -machine.axis[2].high_limit / 3.0;
        machine.axis[2].hot_offset = machine.axis[2].lot_offset = 1.0;
        machine.asyn.acc_type[2] = k & 1 ? 'S' : 'T';
        machine.asyn.dec_type[2] = k & 2 ? 'S' : 'T';
        machine.asyn.acc_time[2] = check_real(&seed, 0.02, 0.3);
        machine.asyn.dec_time[2] = check_real(&seed, 0.02, 0.3);
        const int32_t high = (int32_t)lround((machine.axis[2].high_limit - 1.0) * 1000.0);
        const int32_t low = (int32_t)lround((machine.axis[2].low_limit + 1.0) * 1000.0);
        begin(machine);
        REFUSED(manual_follow(&m, 2, 9, 1.0), MCC_PARAMETER);
        CHECK_EQ(manual_follow(&m, 2, 6, -2.0), 0);
        m.signals.enc_aux[0] = -100000; /* 200 mm up */
        steps(&r, 1500);
        CHECK_EQ(r.sum[2], high);
        m.signals.enc_aux[0] -= 30; /* on, from rest */
        steps(&r, 50);
        CHECK_EQ(r.sum[2], high);
        m.signals.enc_aux[0] += 350; /* 700 pulses back, at once */
        steps(&r, 500);
        CHECK_EQ(r.sum[2], high - 700);
        for (int j = 0; j < 4000; j++) { /* to and fro over both limits */
            m.signals.enc_aux[0] +=
                (int32_t)check_real(&seed, -400.0, 400.0) + (j / 400 % 2 ? 90 : -90);
            step(&r);
            CHECK(r.sum[2] <= high && r.sum[2] >= low);
        }
        CHECK_EQ(MCC_get_errcode(&m), 0);
        m.signals.enc_aux[0] += 100000;
        steps(&r, 1500);
        CHECK_EQ(r.sum[2], low);
        CHECK(MCC_get_errcode(&m) == 0 && m.manual.axis[2].use == MANUAL_WHEEL);
        CHECK_EQ(MCC_MPG_disable(&m), 0);
        run(&r);
        m.machine.axis[2].low_limit += 2.0; /* it stands 2 mm beyond */
        CHECK_EQ(manual_follow(&m, 2, 6, 1.0), 0);
        m.signals.enc_aux[0] -= 500;
        steps(&r, 100);
        CHECK_EQ(r.sum[2], low);
        m.signals.enc_aux[0] += 1500;
        steps(&r, 500);
        CHECK_EQ(r.sum[2], low + 1500);
        m.signals.enc_aux[0] -= 900;
        steps(&r, 500);
        CHECK_EQ(r.sum[2], low + 1500);
        CHECK_EQ(MCC_get_errcode(&m), 0);
    }
}

/* A software limit that is not in force holds no panel's wheel. */
static void wheel_past_what_is_off(void)
{
    struct machine machine = mcc_machine();
    struct record r = { 0 };

    machine.axis[2].high_limit = 5.0;
    machine.axis[2].check_ot = false;
    begin(machine);
    CHECK_EQ(manual_follow(&m, 2, 6, 1.0), 0);
    m.signals.enc_aux[0] = 20000; /* 20 mm up */
    steps(&r, 1500);
    CHECK_EQ(r.sum[2], 20000);
    CHECK_EQ(MCC_get_errcode(&m), 0);
}

/* Frames too large: a ramp to rest, the error, then nothing more is taken. */
static void too_many_pulses(void)
{
    struct record r = { 0 };

    begin(mcc_machine());
    CHECK_EQ(MCC_set_max_dda_spd(&m, (int32_t[AXES]){ 100, 4095, 4095, 4095, 4095, 4095 }), 0);
    CHECK_EQ(MCC_jog_c(&m, 0, 1, 100.0), 0); /* 512 pulses a DDA time */
    run(&r);
    CHECK_EQ(MCC_get_errcode(&m), MCC_ERROR_SPEED);
    CHECK(MCC_check_stop(&m) && r.sum[0] > 500);
    REFUSED(MCC_jog_c(&m, 0, -1, 1.0), MCC_RUN_TIME);
    CHECK_EQ(MCC_clear_error(&m), 0);
    CHECK_EQ(MCC_jog_s(&m, 0, -50), 0);
    const int32_t sum = r.sum[0];
    run(&r);
    CHECK_EQ(r.sum[0], sum - 50);
}

/* Jogged until the counter's range ends. */
static void range(void)
{
    struct machine machine = mcc_machine();
    struct record r = { 0 };

    machine.axis[0].ppr = 100000000;
    machine.dda_length = 15;
    machine.dda_time = 0.82e-3;
    machine.axis[0].rpm = 20.0; /* 33 million pulses per second */
    CHECK_EQ(MCC_init_motion(&m, &machine), 0);
    machine.queue_depth = 1;
    begin(machine);
    CHECK_EQ(MCC_jog_c(&m, 0, -1, 90.0), 0);
    for (int k = 0; k < 60000 && !MCC_check_stop(&m); k++) {
        manual_look(&m);
        task_run(&m, NULL);
        queue_drop(&m.queue, m.queue.count);
    }
    CHECK(MCC_check_stop(&m) && m.trajectory.pulses[0] < -700000000
          && m.trajectory.pulses[0] > -730000000);
    (void)r;
}

int main(void)
{
    not_open();
    settings();
    asyn_durations();
    asyn_calls();
    asyn_reactions();
    jog_continuous();
    jog_slower();
    jog_limits();
    jog_steps();
    wheel();
    wheel_limits();
    wheel_rests();
    wheel_past_what_is_off();
    too_many_pulses();
    range();
    return check_result();
}
