/* In-position: how long the next command waits, in every mode. */
#include "mcc_react.h"

/* Command after command in position: `left` counts that fade by a tenth per DDA time, looked at
 * once in it. Looks from the end of one command to the begin of the next; -1 if it did not. */
static int wait_for_position(int mode, double settle, double timeout, double left, double fade)
{
    struct machine machine = one_ahead();
    struct run r = { 0 };
    int waits = 0, in[AXES];
    machine.inpos_mode = mode;
    machine.inpos_settle = settle;
    machine.inpos_timeout = timeout;
    open_machine(&machine);
    CHECK_EQ(MCC_set_inpos_tol(&m, (double[AXES]){ 0.02, 0.01 }), 0);
    CHECK_EQ(MCC_enable_in_pos(&m, 3), 0);
    CHECK(MCC_line(&m, (double[AXES]){ 3.0, 4.0 }) > 0);
    CHECK(MCC_line_x(&m, 0.0) > 0);
    m.signals.err[1] = 1000;
    run(&r);
    CHECK_EQ(r.sum[1], 4000);
    CHECK(m.trajectory.confirming && !MCC_check_stop(&m));
    do {
        m.signals.err[1] = (int32_t)left;
        left *= fade;
        MCC_check_in_pos(&m, in);
        CHECK(in[0] == 1 && in[1] == (m.signals.err[1] <= 10));
        waits++;
    } while (!point(&r) && waits < 100000 && !m.error);
    CHECK(!m.error || mode == 0 || mode == 2);
    if (m.error) {
        CHECK_EQ(m.error, MCC_ERROR_IN_POS);
        CHECK(MCC_check_stop(&m));
        REFUSED(MCC_line_x(&m, 0.0), MCC_RUN_TIME);
        CHECK_EQ(MCC_clear_error(&m), 0);
    }
    m.signals.err[1] = 0;
    CHECK_EQ(MCC_disable_in_pos(&m, 2), 0);
    CHECK_EQ(MCC_get_errcode(&m), 0);
    CHECK(MCC_line_x(&m, 0.0) > 0);
    for (int k = 0; k < 20000 && !MCC_check_stop(&m); k++) {
        point(&r);
    }
    CHECK_EQ(r.sum[0], 0);
    return waits;
}

static void in_position(void)
{
    const double look_time = 1e-4; /* BUS */
    /* 1000 0.9^n < 11 from the 44th look on; the settle time takes 20 more. The look that found the
     * queue empty is not counted here. */
    CHECK_EQ(wait_for_position(0, 20 * look_time, 1.0, 1000.0, 0.9), 44);
    CHECK_EQ(wait_for_position(2, 20 * look_time, 1.0, 1000.0, 0.9), 64);
    CHECK_EQ(wait_for_position(2, 0.0, 0.0, 1000.0, 0.999), 4509);
    CHECK_EQ(wait_for_position(2, 0.0, 200 * look_time, 1000.0, 1.0), 199);
    CHECK_EQ(wait_for_position(0, 0.0, 200 * look_time, 1000.0, 1.0), 199);
    CHECK_EQ(wait_for_position(1, 0.0, 200 * look_time, 1000.0, 1.0), 199);
    CHECK_EQ(wait_for_position(3, 1.0, 200 * look_time, 1000.0, 0.9), 199);
}

/* With continuous path only the end of the last command is waited for; delays never are. */
static void in_position_of_a_path(double tolerance)
{
    const struct machine machine = one_ahead();
    struct run r = { 0 };
    open_machine(&machine);
    CHECK_EQ(MCC_enable_in_pos(&m, 1), 0);
    MCC_enable_quit(&m);
    CHECK_EQ(mcc_set_tolerance(&m, tolerance), 0);
    m.signals.err[0] = 1000;
    CHECK(MCC_line_x(&m, 5.0) > 0);
    CHECK(MCC_line_y(&m, 5.0) > 0);
    run(&r);
    CHECK(r.sum[1] == 5000 && m.trajectory.confirming);
    CHECK_EQ(MCC_motion_abort(&m), 0); /* nothing is waited for any more */
    CHECK(MCC_check_stop(&m));
    CHECK(MCC_motion_delay(&m, 10.0) > 0);
    run(&r);
    CHECK(MCC_check_stop(&m));
}

int main(void)
{
    in_position();
    in_position_of_a_path(0.0);
    in_position_of_a_path(0.1); /* look-ahead */
    return check_result();
}
