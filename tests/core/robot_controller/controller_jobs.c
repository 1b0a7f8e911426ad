/* Jobs of the robot language: targets that say all, part or nothing of their configuration; frames,
 * tools, outputs behind moves, waits, pauses, single step, abort and begin again, refusals. */
#include "controller_pc.h"

static const int64_t LONG = 60LL * FPGA_CLOCK_HZ; /* [clocks] no job takes so long */

static void begin(const char *job)
{
    config = pc_config();
    pc_start(job, NULL);
}

static void finish(void)
{
    while (!controller_done(&controller) && controller.trouble.error == CONTROLLER_OK
           && now < LONG) {
        pc_cycle();
    }
}

static int branch(void)
{
    return opw_branch(&config.robot.arm.opw, controller.robot.joint);
}

static void configurations(void)
{
    begin("MOVJ P001\nMOVJ P006\nEND\n"); /* FLIP alone: the rest is nearest */
    finish();
    CHECK_EQ(branch(), OPW_FLIP);
    begin("MOVJ P006\nMOVJ P005\nEND\n"); /* FRONT and UP: the wrist stays flipped */
    finish();
    CHECK_EQ(branch(), OPW_FLIP);
    begin("MOVJ P006\nMOVJ P001\nEND\n");
    finish();
    CHECK_EQ(branch(), 0);
    /* Through joint 5 = 0, and back: the wrist is open. */
    begin("MOVJ P010\nMOVL P011 V=100\nMOVL P012 V=100\nEND\n");
    pc_until(CONTROLLER_RUNNING);
    while (controller.robot.line < 2 && now < LONG) {
        pc_cycle();
    }
    const int before = branch();
    finish();
    CHECK_EQ(controller.trouble.error, CONTROLLER_OK);
    CHECK_EQ(branch(), before);
    CHECK_EQ(before, OPW_FLIP);
    begin("MOVJ P002\nMOVL P006\nEND\n"); /* a line keeps its wrist */
    finish();
    CHECK_EQ(controller.trouble.error, CONTROLLER_MOVE);
    CHECK_EQ(controller.trouble.line, 2);
    CHECK_EQ(controller.trouble.status, ROBOT_OTHER_BRANCH);
    CHECK_EQ(controller.trouble.refusal.which, OPW_FLIP);
    pc_run(10000);
    pc_at(1000.0, 100.0, 350.0, 1e-6); /* what was given before has run to its end */
    CHECK_EQ(controller.given, 1);
}

/* One turn that is said leaves the others to what is nearest. */
static void turns(void)
{
    for (int line = 0; line < 2; line++) {
        begin(line ? "MOVL P009 VR=50\nMOVL P007 VR=50\nEND\n" : "MOVJ P009\nMOVJ P007\nEND\n");
        config.zero[1] = 20.0 * DEGREE;
        config.zero[5] = 355.0 * DEGREE;
        controller_start(&controller, &config);
        finish();
        CHECK_EQ(controller.trouble.error, CONTROLLER_OK);
        CHECK_NEAR(controller.robot.joint[5] / DEGREE, 360.0, 1e-6);
        CHECK_NEAR(controller.robot.joint[3] / DEGREE, 0.0, 1e-6);
        pc_at(900.0, 0.0, 350.0, 1e-6);
    }
}

static void frames(void)
{
    begin("MOVJ P001\nMOVL P004 V=500\nEND\n");
    finish();
    /* User frame 2 is turned by 90 degrees about z: X = 900 + 200, Y = -300 + 300. */
    pc_at(1100.0, 0.0, 350.0, 1e-6);
    CHECK_NEAR(pc_off(180.0, 0.0, 180.0), 0.0, 1e-6);
    CHECK_EQ(controller.robot.tool.at[2], 150.0);
    begin("MOVJ P001\nMOVC P002 P003 V=100\nEND\n");
    double off = 0.0;
    while (!controller_done(&controller) && now < LONG) {
        pc_cycle();
        const double *at = controller.robot.pose.at;
        off = controller.robot.line == 2 ? fmax(off, fabs(hypot(at[0] - 1000.0, at[1]) - 100.0))
                                         : off;
    }
    CHECK(off < 1e-6);
    pc_at(1100.0, 0.0, 350.0, 1e-6);
}

static void outputs(void)
{
    begin("MOVJ P001\nDOUT OT#(1) ON\nAOUT AO#(2) 2.5\nMOVL P002 V=100 PL=3\nDOUT OT#(32) ON\n"
          "MOVL P003\nDOUT OT#(1) OFF\nWAIT IN#(3)=ON T=0.10\nTIMER T=0.05\nMOVL P001 V=500\n"
          "WAIT IN#(3)=ON\nEND\n");
    double on = 1e9, corner = 1e9, waited = 0.0;
    while (controller_status(&controller, &panel) != CONTROLLER_WAITING || controller.given < 4) {
        pc_cycle();
        const double *at = controller.robot.pose.at;
        on = on == 1e9 && (card.inputs & 1) ? at[0] : on;
        if (corner == 1e9 && card.inputs >> 31 & 1) {
            corner = hypot(at[0] - 1000.0, at[1] - 100.0);
        }
        waited += controller_status(&controller, &panel) == CONTROLLER_WAITING ? CYCLE : 0.0;
        if (now > LONG) {
            break;
        }
    }
    CHECK_NEAR(on, 900.0, 1e-3);
    CHECK(corner <= 2.001 && corner > 0.1); /* the corner passes its point within PL=3 */
    CHECK_EQ(card.inputs & 1, 0);
    CHECK_NEAR(host.ao[1], 2.5, 0.0);
    CHECK_NEAR(waited, 0.15, 1e-3);
    card.irq_inputs = 4;
    pc_run(3);
    CHECK(controller_done(&controller));
    card.irq_inputs = 0;
    pc_press(&panel.start); /* again: the outputs are as they were left */
    CHECK(!controller_done(&controller));
}

/* An output is known to the job that is begun again. */
static void again(void)
{
    begin("JUMP *SET IF OT#(1)=ON\nDOUT OT#(1) ON\nJUMP *END\n*SET\nDOUT OT#(2) ON\n"
          "*END\nNOP\nEND\n");
    finish();
    CHECK_EQ(card.inputs, 1);
    pc_press(&panel.start);
    finish();
    CHECK_EQ(card.inputs, 3);
}

/* PAUSE and single step, together, too; the start key counts only where it says something. */
static void steps(void)
{
    begin("MOVJ P001\nPAUSE\nMOVL P002 V=500\nEND\n");
    pc_run(50);
    pc_press(&panel.start); /* while it moves: it does not pass the pause to come */
    pc_until(CONTROLLER_PAUSED);
    pc_run(2000);
    pc_at(900.0, 0.0, 350.0, 1e-6);
    pc_press(&panel.start);
    finish();
    pc_at(1000.0, 100.0, 350.0, 1e-6);
    pc_run(100);
    CHECK_EQ(controller_status(&controller, &panel), CONTROLLER_IDLE);

    begin("MOVJ P001\nPAUSE\nMOVL P002 V=500 PL=3\nMOVL P003 V=500\nEND\n");
    panel.single = true;
    int keys = 0;
    while (!controller_done(&controller) && keys < 20 && now < LONG) {
        pc_until(CONTROLLER_PAUSED);
        pc_run(10);
        pc_press(&panel.start);
        keys++;
        for (int n = 0; n < 100000 && !controller_done(&controller)
                        && controller_status(&controller, &panel) != CONTROLLER_PAUSED;
             n++) {
            pc_cycle();
        }
    }
    CHECK(controller_done(&controller));
    CHECK_EQ(keys, 3); /* the pause, the second move, the third */
    pc_at(1100.0, 0.0, 350.0, 1e-6);

    /* The key while a move runs lets the next one begin, but once the arm rests: no zone. */
    begin("MOVJ P001\nMOVL P002 V=500 PL=3\nMOVL P003 V=500\nEND\n");
    panel.single = true;
    pc_until(CONTROLLER_PAUSED);
    pc_press(&panel.start);
    pc_run(200);
    CHECK_EQ(controller_status(&controller, &panel), CONTROLLER_RUNNING);
    pc_press(&panel.start);
    double nearest = INFINITY;
    for (int n = 0; n < 100000 && !controller_done(&controller); n++) {
        const double *at = controller.robot.pose.at;
        pc_cycle();
        nearest = fmin(nearest, hypot(hypot(at[0] - 1000.0, at[1] - 100.0), at[2] - 350.0));
    }
    CHECK(controller_done(&controller) && nearest < 1e-6);
}

/* The user program does not look at what stands behind a pause before that is over. */
static void pause_of_user(void)
{
    config = pc_config();
    config.user = true;
    pc_start("PAUSE\nJUMP *ON IF IN#(1)=ON\nJUMP *END\n*ON\nDOUT OT#(1) ON\n"
             "*END\nNOP\nEND\n",
             NULL);
    pc_run(3000);
    CHECK_EQ(controller_status(&controller, &panel), CONTROLLER_PAUSED);
    card.irq_inputs = 1;
    pc_run(3000);
    pc_press(&panel.start);
    for (int n = 0; n < 3000 && !controller_done(&controller); n++) {
        pc_cycle();
    }
    CHECK(controller_done(&controller));
    CHECK_EQ(card.inputs, 1);
}

/* Abort ramps to rest and drops all; start begins anew. Hold and override 0 keep all. */
static void abort_and_hold(void)
{
    begin("MOVJ P001\nMOVL P002 V=500\nDOUT OT#(1) ON\nMOVL P003 V=500\nEND\n");
    while (controller.robot.line < 2) {
        pc_cycle();
    }
    pc_run(500);
    panel.hold = true;
    pc_run(8000);
    CHECK_EQ(controller_status(&controller, &panel), CONTROLLER_HOLD);
    CHECK_EQ(controller.robot.speed, 0.0);
    const struct pose held = controller.robot.pose;
    pc_run(1000);
    CHECK(memcmp(&held, &controller.robot.pose, sizeof held) == 0);
    panel.hold = false;
    panel.override = 0.0;
    pc_run(5000);
    CHECK_EQ(controller.robot.speed, 0.0);
    panel.override = 0.5;
    pc_run(500);
    CHECK(controller.robot.speed > 0.0 && controller.robot.speed < 251.0);
    pc_press(&panel.abort);
    pc_run(8000);
    CHECK_EQ(controller_status(&controller, &panel), CONTROLLER_IDLE);
    CHECK(!controller_done(&controller));
    CHECK_EQ(card.inputs, 0);
    pc_press(&panel.abort); /* at rest it does nothing */
    panel.override = 1.0;
    pc_press(&panel.start);
    pc_run(500);
    CHECK_EQ(card.inputs, 0); /* the moves of before do not count */
    finish();
    pc_at(1100.0, 0.0, 350.0, 1e-6);
    CHECK_EQ(card.inputs, 1);
}

static void refused(void)
{
    begin("MOVJ P001\nMOVL P008 V=100\nMOVL P002\nEND\n");
    finish();
    CHECK_EQ(controller.trouble.error, CONTROLLER_MOVE);
    CHECK_EQ(controller.trouble.line, 2);
    CHECK_EQ(controller.trouble.status, ROBOT_FAR);
    pc_run(20000);
    CHECK_EQ(controller_status(&controller, &panel), CONTROLLER_ERROR);
    CHECK_EQ(controller.given, 1);
    begin("SET B000 200\nADD B000 100\nMOVJ P001\nEND\n");
    finish();
    CHECK_EQ(controller.trouble.error, CONTROLLER_PROGRAM);
    CHECK_EQ(controller.trouble.line, 2);
    CHECK(controller.trouble.fault != ROBOT_JOB_OK);
    CHECK_EQ(controller.given, 0);
    pc_run(100);
    pc_press(&panel.start); /* again, the same */
    CHECK_EQ(controller.trouble.error, CONTROLLER_PROGRAM);
}

int main(void)
{
    configurations();
    turns();
    frames();
    outputs();
    again();
    steps();
    pause_of_user();
    abort_and_hold();
    refused();
    return check_result();
}
