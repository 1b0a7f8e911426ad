/* Rest after an abort or a hold: as soon as the ramp has ended wherever it ends, and the next
 * command begins where the axes stand. */
#include "mcc_chain.h"

/* Points until the axes rest, `most` at most. */
static int points_to_rest(int most)
{
    int n = 0;
    for (; n < most && task_can_point(&m); n++) {
        task_run(&m, NULL);
        queue_drop(&m.queue, m.queue.count);
    }
    return n;
}

/* A chain of random lines, in a hold or an abort after some points: which one rounds so that its
 * ways along the chain do not add up is a matter of chance, once in some ten thousand. */
static void chains(bool smooth)
{
    /* From the feed to 0; S: at acc/0.75, and the mean's 0.05 s. */
    const int longest = (int)ceil((smooth ? 0.075 + 0.05 : 0.1) / DT) + 1;
    uint64_t seed = 17;
    int late = 0, most = 0;

    for (int i = 0; i < 1000; i++) {
        begin(mcc_machine());
        smooth_ramps(smooth);
        MCC_set_fspd(&m, 50.0);
        MCC_set_inc(&m);
        CHECK_EQ(mcc_set_tolerance(&m, 0.1), 0);
        for (int k = 0; k < 12; k++) {
            const double x = check_real(&seed, 0.01, 3.0), y = check_real(&seed, -1.0, 1.0) * x;
            CHECK(MCC_line(&m, (double[AXES]){ x, y }) > 0);
        }
        for (int stops = 0; stops < 6; stops++) {
            points_to_rest((int)check_real(&seed, 100.0, 200.0));
            if (m.ring.count == 0) {
                break;
            }
            CHECK_EQ(MCC_motion_hold(&m), MCC_NO_ERR);
            const int n = points_to_rest(2 * longest);
            late += n > longest;
            most = n > most ? n : most;
            MCC_motion_conti(&m);
        }
        points_to_rest(30);
        if (MCC_motion_abort(&m) == MCC_NO_ERR) {
            late += points_to_rest(2 * longest) > longest || !MCC_check_stop(&m);
        }
    }
    CHECK_EQ(late, 0);
    CHECK(most > longest - 4);
}

/* At rest already, an abort ends at once; a command given in the same instant begins where the
 * axes stand, not at the target that was dropped. */
static void abort_at_rest(bool under_way)
{
    struct record r = { 0 };
    begin(mcc_machine());
    CHECK(MCC_line_x(&m, 20.0) > 0);
    if (under_way) {
        while (r.n < 500 && point(&r)) {
        }
        CHECK_EQ(MCC_motion_hold(&m), MCC_NO_ERR);
        run(&r);
    }
    const double x = r.last.place[0];
    CHECK(under_way ? x > 1.0 && x < 19.0 : x == 0.0);
    CHECK_EQ(MCC_motion_abort(&m), MCC_NO_ERR);
    CHECK(MCC_check_stop(&m));
    CHECK(MCC_line_y(&m, 5.0) > 0);
    while (point(&r)) {
        CHECK(r.last.place[0] == x);
    }
    CHECK_EQ(m.error, 0);
    CHECK(r.last.place[1] == 5.0 && MCC_check_stop(&m));
}

/* An override that comes in the very instant in which the ramp of an abort has no speed left: the
 * ramp of 20 ms from 500 mm/s has speeds that reach 0 at a point exactly, before the time of the
 * plan is over. Whatever the points at which overrides come, the abort ends. */
static void override_at_the_end(void)
{
    int32_t instants = 0;

    for (int k = 1; k < 400; k++) {
        struct machine machine = mcc_machine();
        machine.acc_time = 0.01;
        machine.dec_time = 0.02;
        machine.dda_time = 1e-4;
        machine.dda_length = 10;
        begin(machine);
        CHECK(MCC_ptp_x(&m, 100.0) > 0);
        CHECK(MCC_line_y(&m, 1.0) > 0);
        points_to_rest(k);
        if (MCC_motion_abort(&m) != MCC_NO_ERR) {
            continue;
        }
        for (int n = 0; n < 3; n++) {
            CHECK_EQ(MCC_set_ptp_ospd(&m, n % 2 ? 2.0 : 0.5), MCC_NO_ERR);
            points_to_rest(k);
            instants += MCC_check_stop(&m);
        }
        points_to_rest(4000);
        CHECK(MCC_check_stop(&m) && m.ring.count == 0 && !m.trajectory.abort);
    }
    CHECK(instants > 100);
}

int main(void)
{
    override_at_the_end();
    chains(false);
    chains(true);
    abort_at_rest(false);
    abort_at_rest(true);
    return check_result();
}
