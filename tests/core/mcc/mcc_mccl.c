/* The calls in the spelling of later releases do what the document's calls do: two libraries, one
 * called this way and one that, are the same bytes after every pair of calls. */
#include "mccl.h"
#include "mcc_check.h"

static struct mcc a, b; /* 140 kB each: not on the stack */

static void same_start(void)
{
    struct machine machine = mcc_machine();
    for (int i = 3; i < AXES; i++) {
        machine.axis[i].used = true;
    }
    memset(&a, 0, sizeof a);
    memset(&b, 0, sizeof b);
    CHECK_EQ(MCC_init_motion(&a, &machine), MCC_NO_ERR);
    CHECK_EQ(MCC_init_motion(&b, &machine), MCC_NO_ERR);
}

/* Both plan ahead; the card takes it all. */
static void plan(void)
{
    task_run(&a, NULL);
    task_run(&b, NULL);
    queue_drop(&a.queue, a.queue.count);
    queue_drop(&b.queue, b.queue.count);
}

#define SAME(document, later) \
    do { \
        CHECK_EQ(document, later); \
        plan(); \
        CHECK(memcmp(&a, &b, sizeof a) == 0); \
    } while (0)

static void moves(void)
{
    same_start();
    SAME(MCC_line(&a, (double[AXES]){ 1, 2, 3, 4, 5, 6 }), MCC_Line(&b, 1, 2, 3, 4, 5, 6));
    SAME(MCC_ptp(&a, (double[AXES]){ 0, 1, 0, 2, 0, 3 }), MCC_SyncPtP(&b, 0, 1, 0, 2, 0, 3));
    SAME(MCC_line_x(&a, 3), MCC_LineX(&b, 3));
    SAME(MCC_line_y(&a, 4), MCC_LineY(&b, 4));
    SAME(MCC_line_z(&a, 5), MCC_LineZ(&b, 5));
    SAME(MCC_ptp_x(&a, 1), MCC_PtPX(&b, 1));
    SAME(MCC_ptp_y(&a, 1), MCC_PtPY(&b, 1));
    SAME(MCC_ptp_z(&a, 1), MCC_PtPZ(&b, 1));
    SAME(MCC_set_inc(&a), MCC_SetIncrease(&b));
    SAME(MCC_arc_xy(&a, 1, 1, 2, 0), MCC_ArcXY(&b, 1, 1, 2, 0));
    SAME(MCC_arc_yz(&a, 1, 1, 2, 0), MCC_ArcYZ(&b, 1, 1, 2, 0));
    SAME(MCC_arc_zx(&a, 1, 1, 2, 0), MCC_ArcZX(&b, 1, 1, 2, 0));
    SAME(MCC_circle_xy(&a, 1, 2, 1), MCC_CircleXY(&b, 1, 2, 1));
    SAME(MCC_circle_yz(&a, 1, 2, 0), MCC_CircleYZ(&b, 1, 2, 0));
    SAME(MCC_circle_zx(&a, 1, 2, 1), MCC_CircleZX(&b, 1, 2, 1));
    SAME(MCC_motion_delay(&a, 20), MCC_DelayMotion(&b, 20));
}

static void moves_with_uvw(void)
{
    const double arc[4] = { 1, 1, 2, 0 }, centre[2] = { 1, 2 }, uvw[3] = { 3, 4, 5 };
    same_start();
    MCC_set_inc(&a);
    MCC_set_inc(&b);
    SAME(MCC_arc_xyuvw(&a, arc, uvw), MCC_ArcXYUVW(&b, 1, 1, 2, 0, 3, 4, 5));
    SAME(MCC_arc_yzuvw(&a, arc, uvw), MCC_ArcYZUVW(&b, 1, 1, 2, 0, 3, 4, 5));
    SAME(MCC_arc_zxuvw(&a, arc, uvw), MCC_ArcZXUVW(&b, 1, 1, 2, 0, 3, 4, 5));
    SAME(MCC_circle_xyuvw(&a, centre, 1, uvw), MCC_CircleXYUVW(&b, 1, 2, 3, 4, 5, 1));
    SAME(MCC_circle_yzuvw(&a, centre, 0, uvw), MCC_CircleYZUVW(&b, 1, 2, 3, 4, 5, 0));
    SAME(MCC_circle_zxuvw(&a, centre, 1, uvw), MCC_CircleZXUVW(&b, 1, 2, 3, 4, 5, 1));
}

static void settings(void)
{
    same_start();
    SAME(MCC_set_fspd(&a, 12), MCC_SetFeedSpeed(&b, 12));
    SAME(MCC_set_ptp_spd(&a, 50), MCC_SetPtPSpeed(&b, 50));
    SAME(MCC_set_over_spd(&a, 80), MCC_OverrideSpeed(&b, 80));
    SAME(MCC_set_ptp_ospd(&a, 70), MCC_OverridePtPSpeed(&b, 70));
    SAME(MCC_enable_quit(&a), MCC_EnableBlend(&b));
    SAME(MCC_check_quit(&a), MCC_CheckBlend(&b));
    SAME(MCC_disable_quit(&a), MCC_DisableBlend(&b));
    SAME(MCC_set_acc_type(&a, 'S'), MCC_SetAccType(&b, 'S'));
    SAME(MCC_set_dec_type(&a, 'S'), MCC_SetDecType(&b, 'S'));
    SAME(MCC_set_acc_step(&a, 200), MCC_SetAccTime(&b, 200));
    SAME(MCC_set_dec_step(&a, 150), MCC_SetDecTime(&b, 150));
    SAME(MCC_set_max_dda_spd(&a, (int32_t[AXES]){ 900, 800, 700, 600, 500, 400 }),
         MCC_SetMaxPulseSpeed(&b, 900, 800, 700, 600, 500, 400));
    SAME(MCC_set_P_gain(&a, (int32_t[AXES]){ 9, 8, 7, 6, 5, 4 }),
         MCC_SetPGain(&b, 9, 8, 7, 6, 5, 4));
    SAME(MCC_get_acc_type(&a), MCC_GetAccType(&b));
    SAME(MCC_get_dec_type(&a), MCC_GetDecType(&b));
    CHECK_NEAR(MCC_GetAccTime(&b), 200.0, 1e-9);
    CHECK_NEAR(MCC_GetDecTime(&b), 150.0, 1e-9);
    CHECK_NEAR(MCC_GetOverrideRate(&b), 80.0, 1e-9);
}

static void control(void)
{
    same_start();
    SAME(MCC_line_x(&a, 20), MCC_LineX(&b, 20));
    SAME(MCC_motion_hold(&a), MCC_HoldMotion(&b));
    SAME(MCC_motion_conti(&a), MCC_ContiMotion(&b));
    CHECK_EQ(MCC_GetMotionStatus(&b), TASK_RUNNING);
    SAME(MCC_motion_abort(&a), MCC_AbortMotion(&b));
    for (int i = 0; i < 100; i++) {
        plan();
    }
    CHECK_EQ(MCC_GetMotionStatus(&b), TASK_STOPPED);
    SAME(MCC_get_pos_type(&a), MCC_GetCoordType(&b));
    SAME(MCC_set_abs(&a), MCC_SetAbsolute(&b));
    SAME(MCC_get_errcode(&a), MCC_GetErrorCode(&b));
    SAME(MCC_clear_error(&a), MCC_ClearError(&b));
    SAME(MCC_close_motion(&a), MCC_CloseSystem(&b));
}

static void by_hand(void)
{
    char k[AXES];
    double x[AXES];
    same_start();
    SAME(MCC_set_ptp_asyn_acc_type(&a, "TSTSTS"),
         MCC_SetPtPAccType(&b, 'T', 'S', 'T', 'S', 'T', 'S'));
    SAME(MCC_set_ptp_asyn_decc_type(&a, "SSTTSS"),
         MCC_SetPtPDecType(&b, 'S', 'S', 'T', 'T', 'S', 'S'));
    SAME(MCC_set_ptp_asyn_acc_step(&a, (double[AXES]){ 10, 20, 30, 40, 50, 60 }),
         MCC_SetPtPAccTime(&b, 10, 20, 30, 40, 50, 60));
    SAME(MCC_set_ptp_asyn_dec_step(&a, (double[AXES]){ 60, 50, 40, 30, 20, 10 }),
         MCC_SetPtPDecTime(&b, 60, 50, 40, 30, 20, 10));
    CHECK_EQ(MCC_GetPtPAccType(&b, k, k + 1, k + 2, k + 3, k + 4, k + 5), MCC_NO_ERR);
    CHECK(memcmp(k, "TSTSTS", AXES) == 0);
    CHECK_EQ(MCC_GetPtPDecType(&b, k, k + 1, k + 2, k + 3, k + 4, k + 5), MCC_NO_ERR);
    CHECK(memcmp(k, "SSTTSS", AXES) == 0);
    CHECK_EQ(MCC_GetPtPAccTime(&b, x, x + 1, x + 2, x + 3, x + 4, x + 5), MCC_NO_ERR);
    CHECK_NEAR(x[1], 20.0, 1e-9);
    CHECK_EQ(MCC_GetPtPDecTime(&b, x, x + 1, x + 2, x + 3, x + 4, x + 5), MCC_NO_ERR);
    CHECK_NEAR(x[1], 50.0, 1e-9);
    SAME(MCC_jog_s(&a, 2, -30), MCC_JogPulse(&b, -30, 2));
    SAME(MCC_jog_i(&a, 1, 0.5, 40), MCC_JogSpace(&b, 0.5, 40, 1));
    SAME(MCC_jog_c(&a, 0, -1, 20), MCC_JogConti(&b, -1, 20, 0));
    SAME(MCC_MPG_disable(&a), MCC_DisableMpg(&b));
    SAME(MCC_motion_abort(&a), MCC_AbortGoHome(&b));
    for (int i = 0; i < 100; i++) {
        plan();
    }
    SAME(MCC_check_homef(&a), MCC_GetGoHomeStatus(&b));
    SAME(MCC_ptp_asyn(&a, (double[AXES]){ 1, 2, 3, 0, 0, 4 }), MCC_PtP(&b, 1, 2, 3, 0, 0, 4));
    const int32_t order[AXES] = { 0, 2, 1, 0, 0, 0 };
    SAME(MCC_go_home(&a, order), MCC_Home(&b, 0, 2, 1, 0, 0, 0));
}

static void axes(void)
{
    const struct comp_table table = { .interval = 100, .forward = { 1, 2, 3 } };
    same_start();
    SAME(MCC_set_comp(&a, 1, &table), MCC_SetCompParam(&b, &table, 1));
    SAME(MCC_enable_dry_run(&a), MCC_EnableDryRun(&b));
    SAME(MCC_check_dry_run(&a), MCC_CheckDryRun(&b));
    SAME(MCC_disable_dry_run(&a), MCC_DisableDryRun(&b));
    a.epcio_axis_param[0].RPM = b.epcio_axis_param[0].RPM = 1000.0;
    SAME(MCC_update_param(&a), MCC_UpdateParam(&b));
    SAME(task_set_single_block(&a, true), MCC_EnableSingleBlock(&b));
    SAME(MCC_line_x(&a, 1.0), MCC_LineX(&b, 1.0));
    a.written = b.written;
    SAME(task_continue(&a), MCC_RunSingleBlock(&b));
    SAME(task_set_single_block(&a, false), MCC_DisableSingleBlock(&b));
}

static void protection(void)
{
    int32_t n[AXES];
    int on[AXES];
    double x[AXES];
    same_start();
    SAME(MCC_set_max_dda_acc(&a, (int32_t[AXES]){ 9, 8, 7, 6, 5, 4 }),
         MCC_SetMaxPulseAcc(&b, 9, 8, 7, 6, 5, 4));
    SAME(MCC_set_check_OT(&a, (int[AXES]){ 0 }), MCC_SetOverTravelCheck(&b, 0, 0, 0, 0, 0, 0));
    SAME(MCC_set_inpos_tol(&a, (double[AXES]){ 1, 2, 3, 4, 5, 6 }),
         MCC_SetInPosToleranceEx(&b, 1, 2, 3, 4, 5, 6));
    SAME(MCC_enable_in_pos(&a, 5), MCC_EnableInPos(&b, 5));
    SAME(MCC_disable_in_pos(&a, 1), MCC_DisableInPos(&b, 1));
    CHECK_EQ(MCC_GetMaxPulseAcc(&b, n, n + 1, n + 2, n + 3, n + 4, n + 5), MCC_NO_ERR);
    CHECK(n[0] == 9 && n[5] == 4);
    CHECK_EQ(MCC_GetOverTravelCheck(&b, on, on + 1, on + 2, on + 3, on + 4, on + 5), MCC_NO_ERR);
    CHECK_EQ(MCC_GetInPosToleranceEx(&b, x, x + 1, x + 2, x + 3, x + 4, x + 5), MCC_NO_ERR);
    CHECK(x[0] == 1.0 && x[5] == 6.0);
    CHECK_EQ(MCC_GetInPosStatus(&b, on, on + 1, on + 2, on + 3, on + 4, on + 5), MCC_NO_ERR);
}

/* Six values come out in the order of the axes. */
static void six_values(void)
{
    const int32_t six[AXES] = { 1, 2, 3, 4, 5, 6 };
    int32_t n[AXES];
    double x[AXES];
    same_start();
    for (int i = 0; i < AXES; i++) {
        b.written.pulses[i] = 10 + i;
        b.written.place[i] = 20 + i;
        b.signals.err[i] = 30 + i;
    }
    CHECK_EQ(MCC_set_max_dda_spd(&b, six), MCC_NO_ERR);
    CHECK_EQ(MCC_set_P_gain(&b, six), MCC_NO_ERR);
    CHECK_EQ(MCC_GetMaxPulseSpeed(&b, n, n + 1, n + 2, n + 3, n + 4, n + 5), MCC_NO_ERR);
    CHECK(memcmp(n, six, sizeof n) == 0);
    CHECK_EQ(MCC_GetPGain(&b, n, n + 1, n + 2, n + 3, n + 4, n + 5), MCC_NO_ERR);
    CHECK(memcmp(n, six, sizeof n) == 0);
    CHECK_EQ(MCC_GetPulsePos(&b, n, n + 1, n + 2, n + 3, n + 4, n + 5), MCC_NO_ERR);
    CHECK(n[0] == 10 && n[1] == 11 && n[4] == 14 && n[5] == 15);
    CHECK_EQ(MCC_GetErrorCount(&b, n, n + 1, n + 2, n + 3, n + 4, n + 5), MCC_NO_ERR);
    CHECK(n[0] == 30 && n[1] == 31 && n[4] == 34 && n[5] == 35);
    CHECK_EQ(MCC_GetCurPos(&b, x, x + 1, x + 2, x + 3, x + 4, x + 5), MCC_NO_ERR);
    CHECK(x[0] == 20 && x[1] == 21 && x[4] == 24 && x[5] == 25);
}

int main(void)
{
    moves();
    moves_with_uvw();
    settings();
    control();
    by_hand();
    axes();
    protection();
    six_values();
    return check_result();
}
