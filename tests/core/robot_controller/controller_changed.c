/* Jobs whose positions change: moves by increments in each frame, where the arm is as a position,
 * and moves that an input ends. */
#include "controller_pc.h"

static const int64_t LONG = 60LL * FPGA_CLOCK_HZ; /* [clocks] no job takes so long */

static void begin(const char *job)
{
    config = pc_config();
    for (int i = 0; i < OPW_JOINTS; i++) {
        config.orders.pulses[i] = config.robot.scale[i];
    }
    pc_start(job, NULL);
}

static void finish(void)
{
    while (!controller_done(&controller) && controller.trouble.error == CONTROLLER_OK
           && now < LONG) {
        pc_cycle();
    }
    CHECK_EQ(controller.trouble.error, CONTROLLER_OK);
}

/* The tool of P001 points down, its X is that of the base turned about, its Y is the base's, Z is
 * the base's turned about: A=180 C=180 is a half turn about Y. */
static void increments(void)
{
    begin("MOVJ P001\nSETE P090 (1) 10000\nSETE P090 (2) 20000\nSETE P090 (3) -30000\n"
          "IMOV P090 V=500 BF\nEND\n");
    finish();
    pc_at(910.0, 20.0, 320.0, 1e-6);
    CHECK_NEAR(pc_off(180.0, 0.0, 180.0), 0.0, 1e-6);
    begin("MOVJ P001\nSETE P090 (1) 10000\nSETE P090 (2) 20000\nSETE P090 (3) -30000\n"
          "IMOV P090 V=500 TF\nEND\n");
    finish();
    pc_at(890.0, 20.0, 380.0, 1e-6);
    CHECK_EQ(controller.robot.tool.at[2], 150.0); /* that of the move before */
    /* User frame 2 is turned by 90 degrees about z. */
    begin("MOVJ P001\nSETE P090 (1) 10000\nSETE P090 (3) -30000\nIMOV P090 V=500 UF#(2)\nEND\n");
    finish();
    pc_at(900.0, 10.0, 320.0, 1e-6);
    /* Turns: 30 degrees about the axis X of each frame. Those of the tool add up in it. */
    begin("MOVJ P001\nSETE P090 (4) 300000\nIMOV P090 VR=50 UF#(2)\nEND\n");
    finish();
    pc_at(900.0, 0.0, 350.0, 1e-6);
    CHECK_NEAR(pc_off(0.0, 210.0, 0.0), 0.0, 1e-6); /* about the base's Y */
    begin("MOVJ P001\nSETE P090 (4) 150000\nSETE P091 (3) 10000\nIMOV P090 VR=50 TF\n"
          "IMOV P090 VR=50 TF\nIMOV P091 V=500 TF\nEND\n");
    finish();
    pc_at(900.0, 10.0 * sin(30.0 * DEGREE) * -1.0, 350.0 - 10.0 * cos(30.0 * DEGREE), 1e-6);
}

/* What GETS finds is where the arm goes back to, in joints and as a pose with its configuration. */
static void here(void)
{
    for (int pose = 0; pose < 2; pose++) {
        begin(pose ? "MOVJ P006\nGETS PX050 $PX001\nMOVJ P002\nMOVJ P050\nEND\n"
                   : "MOVJ P006\nGETS PX050 $PX000\nMOVJ P002\nMOVJ P050\nEND\n");
        while (controller.given < 2 && now < LONG) {
            pc_cycle();
        }
        double was[OPW_JOINTS];
        memcpy(was, controller.joint, sizeof was);
        finish();
        CHECK_EQ(controller.given, 3);
        for (int i = 0; i < OPW_JOINTS; i++) {
            CHECK_NEAR(controller.robot.joint[i], was[i], 2e-3);
        }
        pc_at(900.0, 0.0, 350.0, 1e-6);
    }
}

/* A position as the job has left it. */
static void is(int32_t number, const double value[6])
{
    const struct robot_job_point *q =
        robot_job_place(&controller.orders.job, &jobs, &points, number);

    CHECK_EQ(q->kind, ROBOT_JOB_POSE);
    for (int i = 0; i < 6; i++) {
        CHECK_NEAR(i < 3 ? q->value[i] : remainder(q->value[i] - value[i], 360.0),
                   i < 3 ? value[i] : 0.0, 1e-9);
    }
}

/* CNVRT: pulses, joints and poses as a pose in a frame, with a tool; the arm goes back there with
 * the joints that it had. User frame 2 is at 900, -300, 200, turned by 90 degrees about z. */
static void conversions(void)
{
    begin("MOVJ P006\nGETS PX050 $PX000\nCNVRT PX051 PX050 UF#(2)\nMOVJ P000\nMOVJ P051\nEND\n");
    while (controller.given < 2 && now < LONG) {
        pc_cycle();
    }
    double was[OPW_JOINTS];
    memcpy(was, controller.joint, sizeof was);
    finish();
    is(51, (double[6]){ 300, 0, 150, 180, 0, 90 });
    for (int i = 0; i < OPW_JOINTS; i++) {
        CHECK_NEAR(controller.robot.joint[i], was[i], 2e-3);
    }
    pc_at(900.0, 0.0, 350.0, 1e-6);
    begin("CNVRT PX050 P004 BF\nCNVRT PX051 PX050 RF TL#(0)\nCNVRT PX052 PX050 UF#(2) TL#(1)\n"
          "TOOL 1\nCNVRT PX053 P000 BF\nMOVJ P001\nMOVJ P053\nEND\n");
    finish();
    is(50, (double[6]){ 1100, 0, 350, 180, 0, 180 });
    is(51, (double[6]){ 1100, 0, 500, 180, 0, 180 }); /* the flange: the tool points down */
    is(52, (double[6]){ 300, -200, 150, 180, 0, 90 });
    CHECK_EQ(robot_job_place(&controller.orders.job, &jobs, &points, 51)->tool, 0);
    static const double zero[] = { 0, -20, 10, 0, 90, 0 };
    for (int i = 0; i < OPW_JOINTS; i++) {
        CHECK_NEAR(controller.robot.joint[i], zero[i] * DEGREE, 1e-9);
    }
}

/* MSHIFT: what leads from one position to another, in each frame; IMOV and SFTON go that way. */
static void differences(void)
{
    begin("MSHIFT PX050 BF P001 P002\nMSHIFT PX051 UF#(2) P001 P002\nMSHIFT PX052 TF P001 P002\n"
          "MSHIFT PX053 RF P003 P009\nMSHIFT PX054 TF P003 P009\nMSHIFT PX055 BF P001 P004\n"
          "MOVJ P003\nIMOV PX054 V=500 TF\nEND\n");
    finish();
    is(50, (double[6]){ 100, 100, 0, 0, 0, 0 });
    is(51, (double[6]){ 100, -100, 0, 0, 0, 0 });
    is(52, (double[6]){ -100, 100, 0, 0, 0, 0 });
    is(53, (double[6]){ -200, 0, 0, 0, 0, -10 });
    is(54, (double[6]){ 200, 0, 0, 0, 0, 10 }); /* whose z points down */
    is(55, (double[6]){ 200, 0, 0, 0, 0, 0 });
    pc_at(900.0, 0.0, 350.0, 1e-6);
    CHECK_NEAR(pc_off(180.0, 0.0, 170.0), 0.0, 1e-6);
    /* From a place of the arm in pulses; its turns are none by less than an element says. */
    begin("MOVJ P001\nGETS PX050 $PX000\nMSHIFT PX051 UF#(2) PX050 P002\nSFTON P051 UF#(2)\n"
          "MOVL P001 V=500\nEND\n");
    finish();
    pc_at(1000.0, 100.0, 350.0, 1e-6);
    /* A turn about an axis that is none of the frame's: IMOV leads by it to the same attitude. */
    begin("MOVJ P001\nSETE P060 (4) 200000\nSETE P060 (5) -100000\nIMOV P060 VR=50 UF#(2)\n"
          "GETS PX061 $PX001\nMSHIFT PX062 UF#(2) P001 PX061\nMOVJ P001\n"
          "IMOV P062 VR=50 UF#(2)\nEND\n");
    finish();
    is(62, (double[6]){ 0, 0, 0, 20, -10, 0 });
    const struct robot_job_point *q = robot_job_place(&controller.orders.job, &jobs, &points, 61);
    CHECK_NEAR(pc_off(q->value[3], q->value[4], q->value[5]), 0.0, 1e-6);
}

/* A line of 200 mm from P001 to P003 at V=100 with an input that comes `after` cycles in it.
 * Returns where the move has ended, from its begin; *braked: what the tool went after the input.
 * [mm] */
static double searched(const char *job, int after, double *braked)
{
    double there = 0.0;
    begin(job);
    while (controller.robot.line < 2 && now < LONG) {
        pc_cycle();
    }
    pc_run(after);
    const double seen = controller.robot.pose.at[0];
    card.irq_inputs = 4;
    while (controller.given < 3 && controller.trouble.error == CONTROLLER_OK && now < LONG) {
        there = controller.robot.pose.at[0];
        pc_cycle();
    }
    *braked = there - seen;
    finish();
    return there - 900.0;
}

static void until(void)
{
    static const char job[] = "MOVJ P001\nMOVL P003 V=100 UNTIL IN#(3)=ON\nDOUT OT#(1) ON\n"
                              "MOVL P002 V=500\nEND\n";
    double braked;
    const double went = searched(job, 10000, &braked);
    /* v t, less v^2 / 2 a while it comes up; the ramp to rest takes as much. */
    CHECK_NEAR(braked, 100.0 * 100.0 / (2.0 * config.robot.acc), 0.03);
    CHECK_NEAR(went, 100.0 * 10000.0 * CYCLE, 0.05);
    pc_at(1000.0, 100.0, 350.0, 1e-6);
    CHECK_EQ(card.inputs, 1);
    /* An input that never comes, or goes: the whole move. */
    begin(job);
    finish();
    CHECK_EQ(controller.given, 3);
    begin("MOVJ P001\nMOVL P003 V=100 UNTIL IN#(3)=OFF\nPAUSE\nEND\n");
    card.irq_inputs = 4;
    pc_until(CONTROLLER_PAUSED);
    pc_at(1100.0, 0.0, 350.0, 1e-6);
}

/* The input is on when the move would begin: from rest it does not; the next one begins there. */
static void at_once(void)
{
    begin("MOVJ P001\nMOVL P003 V=100 UNTIL IN#(3)=ON\nPAUSE\nMOVL P002 V=100\nEND\n");
    card.irq_inputs = 4;
    const double before = controller.robot.length;
    pc_until(CONTROLLER_PAUSED);
    pc_at(900.0, 0.0, 350.0, 1e-6);
    CHECK(controller.robot.length > before);
    pc_press(&panel.start);
    finish();
    pc_at(1000.0, 100.0, 350.0, 1e-6);
    /* The move before is not ended by it, rounded or not. */
    begin("MOVJ P001\nMOVL P002 V=100 PL=4\nMOVL P003 V=100 UNTIL IN#(3)=ON\nPAUSE\nEND\n");
    card.irq_inputs = 4;
    double near = 1e9;
    while (controller_status(&controller, &panel) != CONTROLLER_PAUSED && now < LONG) {
        pc_cycle();
        near = fmin(near, hypot(controller.robot.pose.at[0] - 1000.0,
                                controller.robot.pose.at[1] - 100.0));
    }
    CHECK(near < 4.001);
    CHECK(controller.robot.pose.at[0] < 1030.0);
    CHECK_EQ(controller.given, 3);
}

/* A search by joints, step by step towards an input; hold and abort in the middle of it. */
static void held(void)
{
    begin("MOVJ P001 VJ=5\nMOVJ P003 VJ=1 UNTIL IN#(3)=ON\nGETS PX001 $PX001\nMOVJ P000 VJ=50\n"
          "MOVL P001 V=500\nEND\n");
    while (controller.robot.line < 2 && now < LONG) {
        pc_cycle();
    }
    pc_run(3000);
    panel.hold = true;
    pc_run(3000);
    const double stood = controller.robot.pose.at[0];
    card.irq_inputs = 4; /* it ends the move that is held; the hold stays */
    pc_run(3000);
    CHECK_NEAR(controller.robot.pose.at[0], stood, 1e-9);
    CHECK_EQ(controller.given, 3); /* which waits */
    panel.hold = false;
    finish();
    CHECK_NEAR(controller.robot.pose.at[0], stood, 1e-6);
    begin("MOVJ P001\nMOVL P003 V=10 UNTIL IN#(3)=ON\nEND\n");
    while (controller.robot.line < 2 && now < LONG) {
        pc_cycle();
    }
    pc_press(&panel.abort);
    card.irq_inputs = 4;
    pc_run(10000);
    CHECK(!controller_running(&controller));
    CHECK_EQ(controller.until_move, 0);
}

int main(void)
{
    increments();
    here();
    conversions();
    differences();
    until();
    at_once();
    held();
    return check_result();
}
