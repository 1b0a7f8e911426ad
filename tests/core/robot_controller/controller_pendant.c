/* Jog in three frames against differences of poses, increments, keys that change, teach and replay,
 * limits and back, and the emergency stop of the card. */
#include "controller_pc.h"

static void begin(void)
{
    static const double zero[] = { 10, 20, 10, 5, 60, 15 };
    config = pc_config();
    config.robot.arm.tool.at[2] = 150.0;
    for (int i = 0; i < OPW_JOINTS; i++) {
        config.zero[i] = zero[i] * DEGREE;
    }
    pc_start(NULL, NULL);
    pc_run(3);
}

static void release(void)
{
    memset(panel.jog, 0, sizeof panel.jog);
    pc_run(1);
    for (int n = 0; n < 30000 && !robot_idle(&controller.robot); n++) {
        pc_cycle();
    }
    CHECK(robot_idle(&controller.robot) && !controller.jogs);
}

/* Each direction, forward and back, in each frame: its coordinate changes and nothing else. */
static void directions(void)
{
    for (int n = 0; n < 36; n++) {
        const enum robot_frame frame = (enum robot_frame)(n / 12);
        const int k = n % 12 / 2;
        const double sign = n % 2 ? -1.0 : 1.0;
        begin();
        const struct pose from = controller.robot.pose;
        double joint[OPW_JOINTS], back[4], v[3], moved[6], motion[6], way;
        memcpy(joint, controller.robot.joint, sizeof joint);
        panel.frame = frame;
        panel.jog[k] = sign;
        pc_run(2000);
        CHECK_EQ(controller_status(&controller, &panel), CONTROLLER_JOG);
        release();
        quaternion_inverse(from.turn, back);
        quaternion_product(controller.robot.pose.turn, back, back);
        quaternion_vector(back, v);
        for (int i = 0; i < 3; i++) {
            moved[i] = controller.robot.pose.at[i] - from.at[i];
            moved[3 + i] = v[i] / DEGREE;
        }
        if (frame == ROBOT_IN_TOOL) { /* as seen from the tool */
            quaternion_inverse(from.turn, back);
            quaternion_turn(back, moved, moved);
            quaternion_turn(back, moved + 3, moved + 3);
        }
        for (int i = 0; i < 6; i++) {
            motion[i] = frame == ROBOT_IN_JOINTS ? (controller.robot.joint[i] - joint[i]) / DEGREE
                                                 : moved[i];
        }
        way = motion[k] * sign;
        CHECK(way > (frame == ROBOT_IN_JOINTS || k > 2 ? 1.0 : 20.0));
        for (int i = 0; i < 6; i++) {
            CHECK(i == k || fabs(motion[i]) < 1e-7);
        }
    }
}

/* An increment in mm, in degrees of a joint, in degrees of the tool. */
static void increments(void)
{
    static const struct {
        enum robot_frame frame;
        int k;
        double way;
    } a[] = { { ROBOT_IN_BASE, 1, 7.5 }, { ROBOT_IN_JOINTS, 4, 3.0 }, { ROBOT_IN_TOOL, 5, 4.0 } };
    for (int n = 0; n < 3; n++) {
        begin();
        const struct pose from = controller.robot.pose;
        const double joint = controller.robot.joint[4];
        double back[4], v[3];
        panel.frame = a[n].frame;
        panel.jog_way = a[n].way;
        panel.jog[a[n].k] = 1.0;
        pc_run(30000); /* the key stays down */
        quaternion_inverse(from.turn, back);
        quaternion_product(controller.robot.pose.turn, back, back);
        quaternion_vector(back, v);
        const double got = n == 0   ? controller.robot.pose.at[1] - from.at[1]
                           : n == 1 ? (controller.robot.joint[4] - joint) / DEGREE
                                    : sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) / DEGREE;
        CHECK_NEAR(got, a[n].way, 1e-6);
        release();
        panel.jog[a[n].k] = 1.0; /* once more */
        pc_run(30000);
        release();
        CHECK(n != 1 || fabs((controller.robot.joint[4] - joint) / DEGREE - 6.0) < 1e-6);
    }
}

/* Another key without letting go: the first jog ends, then the other begins. */
static void changes(void)
{
    begin();
    panel.frame = ROBOT_IN_BASE;
    panel.jog[0] = 1.0;
    pc_run(3000);
    panel.jog[0] = 0.0;
    panel.jog[2] = -1.0;
    pc_run(5000);
    const struct pose at = controller.robot.pose;
    pc_run(100);
    CHECK_NEAR(controller.robot.pose.at[0], at.at[0], 1e-9);
    CHECK(controller.robot.pose.at[2] < at.at[2] - 1.0);
    panel.hold = true; /* hold keeps it, and it goes on */
    pc_run(5000);
    CHECK_EQ(controller.robot.speed, 0.0);
    panel.hold = false;
    pc_run(2000);
    CHECK(controller.robot.speed > 100.0);
    release();
}

/* Joint 5 to its limit and back out; the same at the edge of reach. */
static void limits(void)
{
    begin();
    panel.jog[4] = 1.0;
    panel.jog_speed = 0.5;
    pc_run(30000);
    CHECK_NEAR(controller.robot.joint[4] / DEGREE, 120.0, 1e-6);
    CHECK_EQ(controller.robot.speed, 0.0);
    release();
    panel.jog[4] = 1.0; /* no further */
    pc_run(1000);
    CHECK_NEAR(controller.robot.joint[4] / DEGREE, 120.0, 1e-6);
    panel.jog[4] = -1.0;
    pc_run(5000);
    CHECK(controller.robot.joint[4] / DEGREE < 110.0);
    release();
    begin();
    panel.frame = ROBOT_IN_BASE;
    panel.jog[0] = 1.0;
    pc_run(200000);
    const double edge = controller.robot.pose.at[0];
    CHECK_EQ(controller.robot.speed, 0.0);
    release();
    panel.jog[0] = -1.0; /* slowly at first: the elbow is stretched */
    pc_run(20000);
    CHECK(controller.robot.pose.at[0] < edge - 50.0);
    release();
}

static void jog_to(int joint, double sign, int cycles)
{
    panel.jog[joint] = sign;
    pc_run(cycles);
    release();
    pc_press(&panel.teach);
}

/* Replay goes through the taught points, also after a program that has failed. */
static void replays(void)
{
    double taught[3][OPW_JOINTS], least[3] = { 1e9, 1e9, 1e9 };

    begin();
    pc_start("MOVJ P008\nEND\n", NULL);
    pc_until(CONTROLLER_ERROR);
    jog_to(0, 1.0, 5000);
    jog_to(4, -1.0, 5000);
    jog_to(5, 1.0, 9000);
    CHECK_EQ(controller.taught_count, 3);
    for (int n = 0; n < 3; n++) {
        CHECK(controller.taught[n].by_joints);
        memcpy(taught[n], controller.taught[n].joint, sizeof taught[n]);
    }
    panel.jog_speed = 0.5;
    pc_press(&panel.replay);
    pc_press(&panel.replay); /* while it goes: nothing */
    for (int k = 0; k < 200000 && controller_status(&controller, &panel) != CONTROLLER_IDLE; k++) {
        pc_cycle();
        for (int n = 0; n < 3; n++) {
            double off = 0.0;
            for (int i = 0; i < OPW_JOINTS; i++) {
                off = fmax(off, fabs(controller.robot.joint[i] - taught[n][i]));
            }
            least[n] = fmin(least[n], off);
        }
    }
    for (int n = 0; n < 3; n++) {
        CHECK(least[n] < 1e-5);
    }
    for (int i = 0; i < OPW_JOINTS; i++) {
        CHECK_NEAR(controller.robot.joint[i], taught[2][i], 1e-12);
    }
    pc_run(3000);
    CHECK_EQ(controller_status(&controller, &panel), CONTROLLER_IDLE);
    CHECK_EQ(controller.trouble.error, CONTROLLER_OK);
}

/* The card stops in the middle: pulses of a memory are lost, the joints are what it has counted;
 * keys that were pressed meanwhile are forgotten. */
static void stop(void)
{
    config = pc_config();
    pc_start("MOVJ P001\nMOVJ P000\nEND\n", NULL);
    pc_run(3000);
    CHECK(controller.robot.speed > 10.0);
    card.stopped = true;
    pc_run(50);
    CHECK_EQ(controller_status(&controller, &panel), CONTROLLER_STOPPED);
    pc_press(&panel.start);
    pc_press(&panel.replay);
    panel.jog[0] = 1.0;
    pc_run(50);
    panel.jog[0] = 0.0;
    const int32_t before = host.reset_seq;
    pc_press(&panel.reset);
    CHECK_EQ(host.reset_seq, before + 1);
    card.pulse_count[2] += 7; /* what the card has counted and the PC has not */
    card.stopped = false;
    pc_run(5);
    CHECK_EQ(controller_status(&controller, &panel), CONTROLLER_IDLE);
    for (int i = 0; i < OPW_JOINTS; i++) {
        const double zero = (double)llround(config.zero[i] * config.robot.scale[i]);
        CHECK_NEAR(controller.robot.joint[i] * config.robot.scale[i], zero + card.pulse_count[i],
                   1e-6);
    }
    pc_run(2000);
    CHECK_EQ(controller.robot.speed, 0.0);
    pc_press(&panel.start);
    for (int n = 0; n < 200000 && !controller_done(&controller); n++) {
        pc_cycle();
    }
    CHECK(controller_done(&controller));
    CHECK_NEAR(controller.robot.joint[1] / DEGREE, -20.0, 1e-9);
}

int main(void)
{
    directions();
    increments();
    changes();
    limits();
    replays();
    stop();
    return check_result();
}
