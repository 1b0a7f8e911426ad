/* The library's calls: return codes, and that a refused call changes nothing. */
#include "mcc_check.h"
#include "task.h"

static struct mcc m, before; /* 300 kB each: not on the stack */

/* The call must return the code and, if it is an error, leave the whole state as it was. */
#define REFUSED(call, code) \
    do { \
        memcpy(&before, &m, sizeof m); \
        CHECK_EQ(call, code); \
        CHECK(memcmp(&before, &m, sizeof m) == 0); \
    } while (0)

static const double far_away[AXES] = { 1e6 }, beyond[AXES] = { 1e308, -1e308 },
                    nowhere[AXES] = { NAN }, u_axis[AXES] = { [3] = 1.0 };

static void not_open(void)
{
    const double origin[AXES] = { 0.0 };
    double place[AXES];
    memset(&m, 0, sizeof m);
    REFUSED(MCC_line_x(&m, 1.0), MCC_INITIAL_MOTION);
    REFUSED(MCC_ptp(&m, origin), MCC_INITIAL_MOTION);
    REFUSED(MCC_circle_xy(&m, 1.0, 1.0, 0), MCC_INITIAL_MOTION);
    REFUSED(MCC_motion_delay(&m, 1.0), MCC_INITIAL_MOTION);
    REFUSED(MCC_motion_hold(&m), MCC_INITIAL_MOTION);
    REFUSED(MCC_motion_conti(&m), MCC_INITIAL_MOTION);
    REFUSED(MCC_motion_abort(&m), MCC_INITIAL_MOTION);
    REFUSED(MCC_set_fspd(&m, 1.0), MCC_INITIAL_MOTION);
    REFUSED(MCC_set_dda(&m, 1.0), MCC_INITIAL_MOTION);
    REFUSED(MCC_get_cpos(&m, place), MCC_INITIAL_MOTION);
    REFUSED(MCC_close_motion(&m), MCC_INITIAL_MOTION);
    REFUSED(task_start(&m), MCC_INITIAL_MOTION);
}

static void bad_machine(void)
{
    memset(&m, 0, sizeof m);
    for (int i = 0; i < 12; i++) {
        struct machine bad = mcc_machine();
        double *const number[] = { &bad.dda_time,    &bad.feed,
                                   &bad.max_feed,    &bad.acc_time,
                                   &bad.dec_time,    &bad.axis[5].pitch,
                                   &bad.axis[1].rpm, &bad.axis[0].gear_ratio };
        if (i < 8) {
            *number[i] = i % 2 ? NAN : 0.0;
        } else if (i == 8) {
            bad.dda_length = 9;
        } else if (i == 9) {
            bad.queue_depth = QUEUE_SIZE + 1;
        } else if (i == 10) {
            bad.axis[2].ppr = 0;
        } else {
            bad.feed = bad.max_feed * 1.01;
        }
        REFUSED(MCC_init_motion(&m, &bad), MCC_PARAMETER);
    }
}

static void motion(void)
{
    const struct machine machine = mcc_machine();
    CHECK_EQ(MCC_init_motion(&m, &machine), MCC_NO_ERR);
    REFUSED(MCC_line(&m, far_away), MCC_PARAMETER);
    REFUSED(MCC_line(&m, nowhere), MCC_PARAMETER);
    REFUSED(MCC_line(&m, beyond), MCC_PARAMETER);
    REFUSED(MCC_ptp(&m, beyond), MCC_PARAMETER);
    REFUSED(MCC_line(&m, u_axis), MCC_PARAMETER);
    REFUSED(MCC_ptp(&m, far_away), MCC_PARAMETER);
    REFUSED(MCC_arc_xy(&m, 1.0, 1.0, 2.0, 2.0), MCC_PARAMETER); /* three points on a line */
    REFUSED(MCC_arc_yz(&m, NAN, 1.0, 2.0, 2.0), MCC_PARAMETER);
    REFUSED(MCC_circle_xy(&m, 0.0, 0.0, 0), MCC_PARAMETER); /* radius 0 */
    REFUSED(MCC_circle_xy(&m, INFINITY, 0.0, 0), MCC_PARAMETER);
    REFUSED(MCC_circle_zx(&m, 1.0, 1.0, 2), MCC_PARAMETER);
    REFUSED(MCC_motion_delay(&m, -1.0), MCC_PARAMETER);
    REFUSED(MCC_set_fspd(&m, 0.0), MCC_FEED_RATE);
    REFUSED(MCC_set_fspd(&m, 1000.1), MCC_FEED_RATE);
    REFUSED(MCC_set_fspd(&m, NAN), MCC_FEED_RATE);
    REFUSED(MCC_set_fspd(&m, 5e-324), MCC_FEED_RATE); /* its ramps would have no numbers */
    REFUSED(MCC_set_fspd(&m, 0.99e-9), MCC_FEED_RATE);
    REFUSED(MCC_motion_hold(&m), MCC_HOLD_ILLEGAL);
    REFUSED(MCC_motion_conti(&m), MCC_CONTI_ILLEGAL);
    REFUSED(MCC_motion_abort(&m), MCC_ABORT_ILLEGAL);

    CHECK_EQ(MCC_set_fspd(&m, 600.0), 0);
    REFUSED(MCC_line_y(&m, 1.0), MCC_FEED_RATE);           /* Y cannot go faster than 500 mm/s */
    CHECK_EQ(MCC_line(&m, (double[AXES]){ 3.0, 4.0 }), 1); /* 480 mm/s in Y */
    CHECK_EQ(MCC_set_inc(&m), 0);
    CHECK_EQ(MCC_get_pos_type(&m), 0);
    CHECK_EQ(MCC_line_z(&m, 0.0), 2); /* nothing to do: an index, no command */
    CHECK_EQ(m.ring.count, 1);
    CHECK_EQ(MCC_set_fspd(&m, 100.0), 0);
    CHECK_EQ(MCC_arc_xy(&m, 1.0, 1.0, 2.0, 0.0), 3); /* through (4, 5) to (5, 4) */
    CHECK_EQ(ring_head(&m.ring)->index, 1);
    CHECK_EQ(m.ring.entry[1].command.type, COMMAND_CW_ARC);
    CHECK_NEAR(m.ring.entry[1].command.path.centre[0], 4.0, 1e-12);
    CHECK_NEAR(m.ring.entry[1].command.path.centre[1], 4.0, 1e-12);
    CHECK_EQ(MCC_circle_yz(&m, 0.0, 2.0, 1), 4);
    CHECK_NEAR(m.ring.entry[2].command.path.length, 4.0 * acos(-1.0), 1e-12);
    CHECK_EQ(MCC_set_abs(&m), 0);
    CHECK_EQ(MCC_get_pos_type(&m), 1);
    REFUSED(MCC_set_dda(&m, 2.0), MCC_COMMAND_NOTFINISHED);
    REFUSED(MCC_close_motion(&m), MCC_COMMAND_NOTFINISHED);
    CHECK_EQ(MCC_check_stop(&m), 0);
    while (m.ring.count < RING_SIZE) {
        CHECK(MCC_line_x(&m, m.ring.count) > 0);
    }
    REFUSED(MCC_line_x(&m, 0.0), MCC_COMMAND_BUFFER_FULL);
}

static void settings(void)
{
    const struct machine machine = mcc_machine();
    int32_t six[AXES] = { 1, 2, 3, 4, 5, 65536 };
    CHECK_EQ(MCC_init_motion(&m, &machine), MCC_NO_ERR);
    REFUSED(MCC_set_P_gain(&m, six), MCC_PARAMETER);
    six[5] = 65535;
    CHECK_EQ(MCC_set_P_gain(&m, six), 0);
    memset(six, 0, sizeof six);
    CHECK_EQ(MCC_get_P_gain(&m, six), 0);
    CHECK(six[0] == 1 && six[5] == 65535);
    REFUSED(MCC_set_max_dda_spd(&m, six), MCC_PARAMETER); /* 12 bit: no more than 4095 */
    CHECK_EQ(MCC_get_max_dda_spd(&m, six), 0);
    CHECK_EQ(six[3], 4095);
    CHECK_NEAR(MCC_get_dda(&m), 1.024, 1e-15);
    CHECK_EQ(MCC_set_dda(&m, 2.0), 0);
    CHECK_NEAR(MCC_get_dda(&m), 2.048, 1e-15); /* 2^12 * 20 * 25 ns */
    CHECK_EQ(MCC_set_dda(&m, 0.01), 0);
    CHECK_NEAR(MCC_get_dda(&m), 0.1024, 1e-15); /* divider 1 */
    REFUSED(MCC_set_acc_type(&m, 's'), MCC_PARAMETER);
    REFUSED(MCC_set_dec_type(&m, 0), MCC_PARAMETER);
    CHECK(MCC_get_acc_type(&m) == 'T' && MCC_get_dec_type(&m) == 'T');
    CHECK_EQ(MCC_set_acc_type(&m, 'S'), 0);
    CHECK(MCC_get_acc_type(&m) == 'S' && MCC_get_dec_type(&m) == 'T');
    CHECK_EQ(MCC_set_dec_type(&m, 'S'), 0);
    CHECK(MCC_get_dec_type(&m) == 'S');
    REFUSED(MCC_set_acc_step(&m, 0.0), MCC_PARAMETER);
    REFUSED(MCC_set_acc_step(&m, 0.99e-6), MCC_PARAMETER);
    REFUSED(MCC_set_dec_step(&m, 1.01e12), MCC_PARAMETER);
    CHECK_EQ(MCC_set_acc_step(&m, 250.0), 0);
    CHECK_EQ(MCC_set_dec_step(&m, 150.0), 0);
    CHECK_NEAR(MCC_get_acc_step(&m), 250.0, 1e-12);
    CHECK_NEAR(MCC_get_dec_step(&m), 150.0, 1e-12);
    REFUSED(MCC_set_over_spd(&m, -1.0), MCC_PARAMETER);
    REFUSED(MCC_set_over_spd(&m, 0.99e-7), MCC_PARAMETER);
    CHECK_EQ(MCC_set_ptp_ospd(&m, 50.0), 0);
    CHECK_NEAR(MCC_get_ptp_ospd(&m), 50.0, 0.0);
    CHECK_NEAR(MCC_get_over_spd(&m), 100.0, 0.0);
    CHECK_EQ(MCC_check_quit(&m), 1);
    CHECK_EQ(MCC_enable_quit(&m), 0);
    CHECK_EQ(MCC_check_quit(&m), 0);
    CHECK_EQ(MCC_disable_quit(&m), 0);
    CHECK_EQ(MCC_check_quit(&m), 1);
    REFUSED(task_set_origin(&m, 0, far_away), MCC_PARAMETER);
    REFUSED(task_set_origin(&m, 1, nowhere), MCC_PARAMETER);
    CHECK_EQ(MCC_close_motion(&m), 0);
}

/* While a program runs its commands alone are taken; origins move it. */
static void program(void)
{
    static const char good_text[] = "G55 G1 X1 Y2\nG53 X0 Y0 Z5\n";
    static const char bad_text[] = "G1 X1\nG2 X2 R0.1";
    struct source_text text = { good_text, sizeof good_text - 1 };
    struct source_text bad = { bad_text, sizeof bad_text - 1 };
    const struct source source = source_of(&text), other = source_of(&bad);
    const struct machine machine = mcc_machine();
    const double origin[AXES] = { 10.0, 20.0 };
    struct fault_report r;
    double place[AXES];
    CHECK_EQ(MCC_init_motion(&m, &machine), MCC_NO_ERR);
    CHECK_EQ(task_set_origin(&m, 2, origin), 0);
    memcpy(&before, &m, sizeof m);
    task_check(&m, &source, &r);
    CHECK_EQ(r.fault, FAULT_NONE);
    task_check(&m, &other, &r);
    CHECK(r.fault == FAULT_ARC_CHORD && r.line == 2);
    CHECK(memcmp(&before, &m, sizeof m) == 0);
    CHECK_EQ(task_start(&m), 0);
    REFUSED(MCC_line_x(&m, 1.0), MCC_COMMAND_NOTACCEPTED);
    REFUSED(task_start(&m), MCC_COMMAND_NOTACCEPTED);
    REFUSED(task_set_origin(&m, 2, origin), MCC_COMMAND_NOTFINISHED);
    task_run(&m, &source);
    CHECK_NEAR(m.ring.count + m.trajectory.mix.count, 2, 0.0);
    while (!MCC_check_stop(&m)) {
        m.written = *queue_peek(&m.queue, 0);
        queue_drop(&m.queue, 1);
        task_run(&m, &source);
    }
    CHECK_EQ(MCC_get_cpos(&m, place), 0);
    CHECK(place[0] == 0.0 && place[1] == 0.0 && place[2] == 5.0);
    CHECK_EQ(m.written.command, 2);
    CHECK_EQ(m.written.line, 2);
}

int main(void)
{
    not_open();
    bad_machine();
    motion();
    settings();
    program();
    return check_result();
}
