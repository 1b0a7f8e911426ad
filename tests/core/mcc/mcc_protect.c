/* Reactions of the library, each with its stop, its code, what is refused meanwhile, recovery; with
 * a card that puts out each point at once. mcc_emergency.c has the real one. */
#include "mcc_react.h"

static const double T = 1.024e-3; /* [s] DDA time */

static struct machine limited(double low, double high)
{
    struct machine machine = one_ahead();
    for (int i = 0; i < 2; i++) {
        machine.axis[i].check_ot = true;
        machine.axis[i].high_limit = high;
        machine.axis[i].low_limit = low;
    }
    return machine;
}

/* A command that would leave is refused before it moves, one that ends on the limit is not. */
static void refused_before(void)
{
    const struct machine machine = limited(-10.0, 20.0);
    const int off[AXES] = { 0 }, x[AXES] = { 1 }, bad[AXES] = { 0, 0, 2 };
    int on[AXES];
    struct run r = { 0 };
    open_machine(&machine);
    REFUSED(MCC_line_x(&m, 20.001), MCC_PARAMETER);
    REFUSED(MCC_ptp_y(&m, -10.001), MCC_PARAMETER);
    REFUSED(MCC_circle_xy(&m, 10.001, 0.0, 1), MCC_PARAMETER);
    REFUSED(MCC_arc_xy(&m, -10.001, 1.0, 0.0, 2.0), MCC_PARAMETER);
    CHECK(MCC_circle_xy(&m, -5.0, 0.0, 1) > 0);
    CHECK(MCC_line_x(&m, 20.0) > 0);
    run(&r);
    CHECK_EQ(r.sum[0], 20000);
    CHECK_EQ(MCC_get_errcode(&m), 0);
    REFUSED(MCC_set_check_OT(&m, bad), MCC_PARAMETER);
    CHECK_EQ(MCC_set_check_OT(&m, off), 0);
    CHECK(MCC_line_x(&m, 25.0) > 0);
    run(&r);
    CHECK_EQ(MCC_set_check_OT(&m, x), 0);
    CHECK_EQ(MCC_get_check_OT(&m, on), 0);
    CHECK(on[0] == 1 && on[1] == 0);
    REFUSED(MCC_line_x(&m, 25.001), MCC_PARAMETER); /* outside: only back */
    CHECK(MCC_line_x(&m, 24.0) > 0);
    CHECK(MCC_line_x(&m, 0.0) > 0);
    run(&r);
    CHECK_EQ(r.sum[0], 0);
    CHECK_EQ(MCC_get_errcode(&m), 0);
}

/* A check that is switched on in the middle of a motion: a ramp that ends within a pulse of the
 * limit, on the path. */
static void stopped_in_time(void)
{
    uint64_t seed = 11;
    for (int i = 0; i < 100; i++) {
        struct machine machine = limited(-1000.0, check_real(&seed, 5.0, 60.0));
        struct run r = { 0 };
        machine.axis[0].check_ot = machine.axis[1].check_ot = false;
        open_machine(&machine);
        CHECK(MCC_line(&m, (double[AXES]){ 80.0, -160.0 }) > 0);
        const double high = machine.axis[0].high_limit;
        while (r.last.place[0] < check_real(&seed, 0.0, high - 3.0)) {
            point(&r);
        }
        CHECK_EQ(MCC_set_check_OT(&m, (int[AXES]){ 1, 1 }), 0);
        run(&r);
        CHECK_EQ(MCC_get_errcode(&m), MCC_ERROR_TRAVEL);
        const double way = high - r.last.place[0]; /* one DDA time at feed earlier at most */
        CHECK(r.last.pulses[0] <= lround(high * 1000.0) && way < 50.0 * T);
        CHECK_NEAR(r.last.place[1], -2.0 * r.last.place[0], 1e-9);
        CHECK(r.change <= 2); /* 0.5 mm/s per DDA time, and rounding */
        REFUSED(MCC_line_x(&m, 0.0), MCC_RUN_TIME);
        CHECK_EQ(MCC_clear_error(&m), 0);
        REFUSED(MCC_line_x(&m, high + 0.001), MCC_PARAMETER);
        CHECK(MCC_line(&m, (double[AXES]){ 0.0 }) > 0);
        run(&r);
        CHECK_EQ(r.sum[0] | r.sum[1], 0);
    }
}

/* The same in a chain of short lines with look-ahead, the ramps S-shaped or not: where it stops no
 * command has been lost, and the way is that of the corners. */
static void stopped_in_a_chain(void)
{
    uint64_t seed = 17;
    for (int i = 0; i < 60; i++) {
        struct machine machine = limited(-1000.0, check_real(&seed, 10.0, 60.0));
        struct run r = { 0 };
        machine.axis[0].check_ot = machine.axis[1].check_ot = false;
        open_machine(&machine);
        MCC_set_acc_type(&m, i % 2 ? 'S' : 'T');
        MCC_set_dec_type(&m, i % 2 ? 'S' : 'T');
        MCC_enable_quit(&m);
        CHECK_EQ(mcc_set_tolerance(&m, 0.05), 0);
        for (int k = 1; k <= 200; k++) {
            CHECK(MCC_line(&m, (double[AXES]){ 0.4 * k, k % 2 ? 0.0 : 0.01 }) > 0);
        }
        const double high = machine.axis[0].high_limit;
        const double at = check_real(&seed, 0.0, high - 8.0);
        while (r.last.place[0] < at) {
            point(&r);
        }
        CHECK_EQ(MCC_set_check_OT(&m, (int[AXES]){ 1 }), 0);
        run(&r);
        CHECK_EQ(MCC_get_errcode(&m), MCC_ERROR_TRAVEL);
        const double way = high - r.last.place[0];
        CHECK(r.last.pulses[0] <= lround(high * 1000.0) && way < 50.0 * T);
        CHECK(r.last.place[1] >= 0.0 && r.last.place[1] <= 0.01);
        CHECK(r.change <= 2 && MCC_check_stop(&m));
        CHECK_EQ(MCC_clear_error(&m), 0);
        MCC_disable_quit(&m);
        CHECK(MCC_line(&m, (double[AXES]){ 0.0 }) > 0);
        run(&r);
        CHECK_EQ(r.sum[0] | r.sum[1], 0);
    }
}

/* A smooth curve of a program that ends its ways on the limit swings out at its corners: it is
 * driven to the end, by no more than the tolerance beyond. */
static void curve_on_the_limit(void)
{
    uint64_t seed = 29;
    int beyond = 0;
    for (int i = 0; i < 40; i++) {
        const double high = check_real(&seed, 3.0, 20.0), wide = 0.01 + 0.002 * i;
        char text[200];
        const int length =
            snprintf(text, sizeof text, "G64P%.3f\nG1F%d X%.3fY4\nY%.3f\nX0Y3\nX%.3f\nX0Y0\n", wide,
                     1000 + 200 * i, high, 4.0 + check_real(&seed, 0.5, 9.0), high);
        struct source_text lines = { text, length };
        const struct source source = source_of(&lines);
        struct machine machine = limited(0.0, round(1e3 * high) * 1e-3);
        const double top = machine.axis[0].high_limit;
        struct run r = { 0 };
        machine.axis[1].check_ot = false;
        program = &source;
        open_machine(&machine);
        CHECK_EQ(task_start(&m), 0);
        while (r.n < LONGEST && point(&r)) {
            CHECK(r.last.place[0] <= top + wide && r.last.place[0] >= -wide);
            beyond += r.last.pulses[0] > lround(1e3 * top);
        }
        CHECK_EQ(MCC_get_errcode(&m), 0);
        CHECK_EQ(r.sum[0] | r.sum[1], 0);
    }
    CHECK(beyond > 40);
    program = NULL;
}

/* A chain from a program that keeps the ring full, out to 24 mm and back: what the refused point
 * has taken out is still there. When the check comes on, all lines outwards have been read. */
static void stopped_in_a_program(void)
{
    enum { LINES = 1200 };
    static char text[LINES * 24];
    int length = 0;
    for (int k = 1; k <= LINES; k++) {
        length += snprintf(text + length, sizeof text - (size_t)length, "%sX%.2fY%.2f\n",
                           k == 1 ? "G64P.1G1F3000" : "", 0.04 * (k <= 600 ? k : 1200 - k),
                           0.02 * (k % 2));
    }
    struct source_text lines = { text, length };
    const struct source source = source_of(&lines);
    program = &source;
    for (int i = 0; i < 20; i++) {
        struct machine machine = limited(-1000.0, 20.0 + 0.013 * i);
        struct run r = { 0 };
        machine.axis[0].check_ot = machine.axis[1].check_ot = false;
        open_machine(&machine);
        CHECK_EQ(task_start(&m), 0);
        while (r.last.place[0] < 16.0) {
            point(&r);
        }
        CHECK_EQ(MCC_set_check_OT(&m, (int[AXES]){ 1 }), 0);
        run(&r);
        CHECK_EQ(MCC_get_errcode(&m), MCC_ERROR_TRAVEL);
        const int32_t most = 20000 + 13 * i + 100; /* by the tolerance further than the limit */
        CHECK(r.last.pulses[0] <= most && r.last.pulses[0] > most - 52);
        CHECK(r.last.place[1] >= 0.0 && r.last.place[1] <= 0.02);
        CHECK(MCC_check_stop(&m));
    }
    program = NULL;
}

/* Jog, hand wheel and axes for themselves: no way past the limit either, but back. */
static void by_hand(void)
{
    uint64_t seed = 23;
    for (int i = 0; i < 60; i++) {
        struct machine machine = limited(-1000.0, check_real(&seed, 2.0, 30.0));
        const double high = machine.axis[0].high_limit;
        struct run r = { 0 };
        for (int k = 0; k < AXES; k++) {
            machine.asyn.acc_type[k] = i & 1 ? 'S' : 'T';
            machine.asyn.dec_type[k] = i & 2 ? 'S' : 'T';
            machine.asyn.acc_time[k] = check_real(&seed, 0.02, 0.2);
            machine.asyn.dec_time[k] = check_real(&seed, 0.02, 0.2);
        }
        open_machine(&machine);
        REFUSED(MCC_ptp_asyn(&m, (double[AXES]){ high + 0.001 }), MCC_PARAMETER);
        CHECK_EQ(MCC_jog_c(&m, 1, 1, 5.0), 0);
        if (i % 3 == 0) {
            CHECK_EQ(MCC_MPG_set(&m, 0, 6, 100.0), 0);
            m.signals.enc_aux[0] = 1000; /* 100 mm further */
        } else {
            CHECK_EQ(MCC_jog_c(&m, 0, 1, check_real(&seed, 1.0, 30.0)), 0);
        }
        run(&r);
        CHECK(MCC_get_errcode(&m) == MCC_ERROR_TRAVEL
              || MCC_get_errcode(&m) == MCC_ERROR_TRAVEL + 1);
        const int axis = MCC_get_errcode(&m) - MCC_ERROR_TRAVEL;
        CHECK(r.last.pulses[0] <= lround(high * 1000.0));
        CHECK(r.last.pulses[1] <= lround(high * 1000.0));
        /* A DDA time more would have brought it this far and made the ramp longer. */
        const double more = 1.0 + machine.asyn.dec_time[axis] / machine.asyn.acc_time[axis];
        CHECK(high - r.last.place[axis] < 500.0 * T * more);
        CHECK(r.last.feed == 0.0 && MCC_check_stop(&m));
        REFUSED(MCC_jog_c(&m, axis, -1, 1.0), MCC_RUN_TIME);
        CHECK_EQ(MCC_clear_error(&m), 0);
        const int32_t rest = r.sum[axis];
        CHECK_EQ(MCC_jog_i(&m, axis, -1.0, 10.0), 0);
        run(&r);
        CHECK_EQ(MCC_get_errcode(&m), 0);
        CHECK_EQ(r.sum[axis], rest - 1000);
        CHECK(MCC_ptp_asyn(&m, (double[AXES]){ 0.0 }) > 0);
        run(&r);
        CHECK_EQ(MCC_get_errcode(&m), 0);
        CHECK_EQ(r.sum[0] | r.sum[1], 0);
    }
}

/* Commands at random along a side of a square, mixed at their corners; true if they got out. */
static bool mixed(uint64_t seed, bool check, struct run *r)
{
    const struct machine machine = limited(-10.0, 10.0);
    bool out = false;
    open_machine(&machine);
    MCC_enable_quit(&m);
    CHECK_EQ(mcc_set_tolerance(&m, seed % 4 == 0 ? 0.2 : 0.0), 0);
    for (int k = 0; k < 30; k++) {
        MCC_set_acc_type(&m, check_real(&seed, 0.0, 1.0) < 0.5 ? 'S' : 'T');
        MCC_set_dec_type(&m, check_real(&seed, 0.0, 1.0) < 0.5 ? 'S' : 'T');
        const double inside = k % 2 ? check_real(&seed, 0.0, 2.0) : 0.0;
        const double y = fmax(-10.0, fmin(10.0, m.end[1] + check_real(&seed, -1.0, 1.0)));
        MCC_set_acc_step(&m, check_real(&seed, 5.0, 100.0));
        MCC_set_dec_step(&m, check_real(&seed, 5.0, 100.0));
        MCC_set_fspd(&m, check_real(&seed, 5.0, 100.0));
        const double radius = check_real(&seed, 0.2, 3.0), x = m.end[0];
        const int code = k % 5 == 4
                             ? MCC_circle_xy(&m, x > 0.0 ? x - radius : x + radius, m.end[1], k % 2)
                             : MCC_line(&m, (double[AXES]){ 10.0 - inside, y });
        CHECK(code > 0 || code == MCC_PARAMETER); /* some circles leave */
    }
    MCC_set_check_OT(&m, (int[AXES]){ check, check });
    while (r->n < LONGEST && point(r)) {
        out = out || abs(r->last.pulses[0]) > 10000 || abs(r->last.pulses[1]) > 10000;
    }
    return out;
}

/* Mixing of commands that keep the limits can lead beyond them: then and only then it is stopped,
 * within them. */
static void mixing(void)
{
    int leaves = 0, early = 0;
    for (uint64_t seed = 1; seed <= 150; seed++) {
        struct run free = { 0 }, kept = { 0 };
        const bool out = mixed(seed, false, &free);
        CHECK_EQ(MCC_get_errcode(&m), 0);
        CHECK(!mixed(seed, true, &kept));
        const int code = MCC_get_errcode(&m);
        CHECK(code == 0 || code == MCC_ERROR_TRAVEL || code == MCC_ERROR_TRAVEL + 1);
        CHECK(!out || code != 0);
        CHECK(code != 0 || kept.n == free.n);
        leaves += out;
        early += !out && code != 0;
        CHECK(MCC_check_stop(&m));
        if (code != 0) {
            CHECK_EQ(MCC_clear_error(&m), 0);
            CHECK(MCC_line(&m, (double[AXES]){ 0.0 }) > 0);
            run(&kept);
            CHECK_EQ(kept.sum[0] | kept.sum[1], 0);
        }
    }
    CHECK(leaves > 10 && leaves < 140);
    CHECK(early <= leaves / 10); /* the ramp would have left where the motion did not */
}

/* A change of the command above the limit: a ramp, which may change as it must. */
static void change_limit(void)
{
    const struct machine machine = one_ahead();
    const int32_t limit[AXES] = { 4, 4, 4, 4, 4, 4 }, none[AXES] = { 0 };
    int32_t is[AXES];
    struct run r = { 0 };
    open_machine(&machine);
    CHECK_EQ(MCC_get_max_dda_acc(&m, is), 0);
    CHECK_EQ(is[0], 2 * 4095);
    REFUSED(MCC_set_max_dda_acc(&m, none), MCC_PARAMETER);
    CHECK_EQ(MCC_set_max_dda_acc(&m, limit), 0);
    MCC_set_dec_step(&m, 5.0); /* 10.5 pulses per DDA time */
    CHECK(MCC_line_x(&m, 40.0) > 0);
    CHECK(MCC_line_y(&m, 40.0) > 0);
    run(&r);
    CHECK_EQ(MCC_get_errcode(&m), MCC_ERROR_ACC);
    CHECK(r.change >= 10 && r.change <= 12);
    CHECK_NEAR(r.last.feed, 0.0, 0.0);
    CHECK(r.sum[0] >= 40000 - 52 && r.sum[0] <= 40000); /* a DDA time early at most */
    CHECK_EQ(r.sum[1], 0);
    CHECK_EQ(MCC_clear_error(&m), 0);
    MCC_set_acc_step(&m, 5.0); /* already the first point would */
    CHECK(MCC_line_y(&m, 40.0) > 0);
    run(&r);
    CHECK_EQ(MCC_get_errcode(&m), MCC_ERROR_ACC);
    CHECK_EQ(r.sum[1], 0);
    CHECK_EQ(MCC_clear_error(&m), 0);
    MCC_set_acc_step(&m, 100.0);
    MCC_set_dec_step(&m, 100.0);
    CHECK(MCC_line(&m, (double[AXES]){ 0.0 }) > 0);
    run(&r);
    CHECK_EQ(r.sum[0], 0);
    CHECK_EQ(MCC_get_errcode(&m), 0);
}

/* A second error on the ramp of the first: at once, the first one is told. After the rest the
 * command begins from 0 again. */
static void second_error(void)
{
    const struct machine machine = one_ahead();
    int32_t limit[AXES] = { 4, 4, 4, 4, 4, 4 };
    struct run r = { 0 };
    open_machine(&machine);
    CHECK(MCC_line_x(&m, 40.0) > 0);
    points(&r, 300);
    protect_set_track_limit(&m, limit);
    m.signals.err[0] = 5;
    points(&r, 310);
    CHECK_EQ(MCC_get_errcode(&m), MCC_ERROR_TRACK);
    CHECK_EQ(MCC_set_max_dda_spd(&m, limit), 0);
    CHECK(!point(&r));
    CHECK_EQ(MCC_get_errcode(&m), MCC_ERROR_TRACK);
    CHECK(r.frame[0] == 0 && r.last.frame[0] > 40 && MCC_check_stop(&m));
    m.signals.err[0] = 0;
    CHECK_EQ(MCC_clear_error(&m), 0);
    CHECK_EQ(MCC_set_max_dda_acc(&m, limit), 0);
    MCC_set_fspd(&m, 3.0);
    CHECK(MCC_line_x(&m, 20.0) > 0);
    run(&r);
    CHECK_EQ(MCC_get_errcode(&m), 0);
    CHECK_EQ(r.sum[0], 20000);
}

/* A switch closes at a random moment; every mode. */
static void switch_closes(void)
{
    uint64_t seed = 5;
    for (int i = 0; i < 80; i++) {
        const int mode = i % 4, error = mode >= 2 ? MCC_ERROR_TRAVEL + 1 : 0;
        const struct machine machine = one_ahead();
        struct run r = { 0 };
        open_machine(&machine);
        REFUSED(protect_set_limit_mode(&m, 4), MCC_PARAMETER);
        REFUSED(protect_set_limit_mode(&m, -2), MCC_PARAMETER);
        CHECK_EQ(protect_set_limit_mode(&m, mode), 0);
        CHECK(MCC_line(&m, (double[AXES]){ 20.0, -40.0 }) > 0);
        CHECK(MCC_line_x(&m, 0.0) > 0);
        points(&r, 100 + (int)check_real(&seed, 0.0, 700.0));
        const double at = r.last.place[1];
        m.signals.lower = 2;
        run(&r);
        CHECK_EQ(MCC_get_errcode(&m), error);
        CHECK_NEAR(at - r.last.place[1], 50.0 * 2.0 / sqrt(5.0) * 0.1 / 2.0, 1e-9);
        CHECK_NEAR(r.last.place[0], -0.5 * r.last.place[1], 1e-9);
        CHECK(r.change <= 2 && MCC_check_stop(&m));
        const int32_t rest = r.sum[1];
        if (error) {
            REFUSED(MCC_line_y(&m, 0.0), MCC_RUN_TIME);
            CHECK_EQ(MCC_clear_error(&m), 0);
        }
        CHECK(MCC_line_y(&m, -80.0) > 0); /* further on: not one pulse */
        run(&r);
        CHECK_EQ(r.sum[1], rest);
        CHECK_EQ(MCC_get_errcode(&m), error);
        CHECK_EQ(MCC_clear_error(&m), 0);
        CHECK(MCC_line_x(&m, 0.0) > 0); /* other axes may */
        CHECK(MCC_line_y(&m, 0.0) > 0);
        run(&r);
        CHECK_EQ(r.sum[0], 0);
        CHECK_EQ(r.sum[1], mode % 2 == 0 ? rest : 0);
        CHECK_EQ(MCC_get_errcode(&m), mode == 2 ? error : 0);
        CHECK_EQ(MCC_clear_error(&m), 0);
        CHECK_EQ(protect_set_limit_mode(&m, -1), 0);
        CHECK(MCC_line_y(&m, -10.0) > 0);
        run(&r);
        CHECK_EQ(r.sum[1], -10000);
    }
}

/* The newest points already go back; the one to be written still runs onto the switch. */
static void queued_points(void)
{
    struct machine machine = one_ahead();
    machine.queue_depth = 1000;
    open_machine(&machine);
    CHECK_EQ(protect_set_limit_mode(&m, 3), 0);
    MCC_set_acc_step(&m, 10.0);
    MCC_set_dec_step(&m, 10.0);
    CHECK(MCC_line_x(&m, 10.0) > 0);
    CHECK(MCC_line_x(&m, -100.0) > 0);
    task_run(&m, NULL);
    CHECK(queue_peek(&m.queue, 999)->frame[0] < 0);
    m.signals.upper = 1;
    look();
    CHECK_EQ(MCC_get_errcode(&m), MCC_ERROR_TRAVEL);
}

/* Following error: a ramp; no clearing while it lasts or before the rest. */
static void following_error(void)
{
    const struct machine machine = one_ahead();
    const int32_t limit[AXES] = { 0, 100, 100 }, bad[AXES] = { -1 };
    struct run r = { 0 };
    open_machine(&machine);
    REFUSED(protect_set_track_limit(&m, bad), MCC_PARAMETER);
    CHECK_EQ(protect_set_track_limit(&m, limit), 0);
    CHECK(MCC_line_x(&m, 40.0) > 0);
    points(&r, 300);
    m.signals.err[0] = 5000; /* not watched */
    m.signals.err[2] = -100;
    point(&r);
    CHECK_EQ(MCC_get_errcode(&m), 0);
    const double at = r.last.place[0];
    m.signals.err[2] = -101;
    point(&r);
    CHECK_EQ(MCC_get_errcode(&m), MCC_ERROR_TRACK + 2);
    REFUSED(MCC_clear_error(&m), MCC_RUN_TIME);
    m.signals.err[2] = 0;
    REFUSED(MCC_clear_error(&m), MCC_COMMAND_NOTFINISHED);
    REFUSED(MCC_line_x(&m, 0.0), MCC_RUN_TIME);
    REFUSED(task_start(&m), MCC_RUN_TIME);
    run(&r);
    CHECK_NEAR(r.last.place[0], at + 2.5, 1e-9);
    CHECK(r.change <= 2);
    CHECK_EQ(MCC_clear_error(&m), 0);
    CHECK(MCC_line_x(&m, 0.0) > 0);
    run(&r);
    CHECK_EQ(r.sum[0], 0);
    m.signals.err[1] = 101; /* pushed at rest */
    look();
    CHECK_EQ(MCC_get_errcode(&m), MCC_ERROR_TRACK + 1);
}

/* Overflow of an error counter: what no transaction holds is dropped at once. */
static void overflow(void)
{
    struct machine machine = one_ahead();
    machine.queue_depth = 50;
    for (int flying = 0; flying < 5; flying += 4) {
        open_machine(&machine);
        CHECK(MCC_line(&m, (double[AXES]){ 30.0, 40.0 }) > 0);
        for (int i = 0; i < 5; i++) {
            task_run(&m, NULL);
            m.written = *queue_peek(&m.queue, 29);
            queue_drop(&m.queue, 30);
        }
        const struct reaction_look l = { .clocks = BUS, .flying = flying, .overflow = 2 };
        reaction_look(&m, &l);
        CHECK_EQ(MCC_get_errcode(&m), 0); /* not watched */
        protect_set_track_limit(&m, (int32_t[AXES]){ 1, 1 });
        const int32_t y =
            flying ? queue_peek(&m.queue, flying - 1)->pulses[1] : m.written.pulses[1];
        reaction_look(&m, &l);
        CHECK_EQ(MCC_get_errcode(&m), MCC_ERROR_TRACK + 1);
        CHECK_EQ(m.queue.count, flying);
        CHECK_EQ(m.trajectory.pulses[1], y);
        CHECK_NEAR(m.trajectory.rest[1], y / 1000.0, 0.0005001);
        task_run(&m, NULL);
        CHECK_EQ(m.queue.count, flying);
        CHECK_NEAR(m.end[1], m.trajectory.rest[1], 0.0);
        CHECK_EQ(MCC_clear_error(&m), flying ? MCC_COMMAND_NOTFINISHED : 0);
    }
}

static void settings(void)
{
    const double tol[AXES] = { 0.5, 0.25 }, bad[AXES] = { 0.0, -1.0 }, worse[AXES] = { NAN };
    double is[AXES];
    int in[AXES], on[AXES] = { 1 };
    int32_t change[AXES] = { 1, 1, 1, 1, 1, 8191 };
    struct machine machine = mcc_machine();
    memset(&m, 0, sizeof m);
    REFUSED(MCC_clear_error(&m), MCC_INITIAL_MOTION);
    REFUSED(MCC_set_check_OT(&m, on), MCC_INITIAL_MOTION);
    REFUSED(MCC_set_max_dda_acc(&m, change), MCC_INITIAL_MOTION);
    REFUSED(MCC_enable_in_pos(&m, 1), MCC_INITIAL_MOTION);
    REFUSED(MCC_check_in_pos(&m, in), MCC_INITIAL_MOTION);
    REFUSED(MCC_set_inpos_tol(&m, tol), MCC_INITIAL_MOTION);
    machine.axis[0].check_ot = true;
    machine.axis[0].high_limit = -1.0;
    REFUSED(MCC_init_motion(&m, &machine), MCC_PARAMETER);
    machine.axis[0].check_ot = false;
    open_machine(&machine);
    REFUSED(MCC_set_check_OT(&m, on), MCC_PARAMETER); /* no way between the limits */
    REFUSED(MCC_set_max_dda_acc(&m, change), MCC_PARAMETER);
    REFUSED(MCC_enable_in_pos(&m, 64), MCC_PARAMETER);
    REFUSED(MCC_disable_in_pos(&m, -1), MCC_PARAMETER);
    REFUSED(MCC_set_inpos_tol(&m, bad), MCC_PARAMETER);
    REFUSED(MCC_set_inpos_tol(&m, worse), MCC_PARAMETER);
    CHECK_EQ(MCC_set_inpos_tol(&m, tol), 0);
    CHECK_EQ(MCC_get_inpos_tol(&m, is), 0);
    CHECK(is[0] == 0.5 && is[1] == 0.25);
    change[5] = 8190;
    CHECK_EQ(MCC_set_max_dda_acc(&m, change), 0);
}

int main(void)
{
    refused_before();
    stopped_in_time();
    stopped_in_a_chain();
    stopped_in_a_program();
    curve_on_the_limit();
    by_hand();
    mixing();
    change_limit();
    second_error();
    switch_closes();
    queued_points();
    following_error();
    overflow();
    settings();
    return check_result();
}
