/* What the kinematics of the arm cost: poses forward, all branches back; and a cycle of a line.
 *
 *     kinematics_cost
 *
 * Prints the seconds of processor time per pose, per pose with all its branches, per cycle of a
 * line with its poses and joints, and per planned line of one piece.
 */
#define _POSIX_C_SOURCE 199309L /* clock_gettime */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "robot.h"

enum { POSES = 20000, LINES = 2000 };

static const struct opw IRB = { 0.150,
                                -0.115,
                                0.0,
                                0.445,
                                0.700,
                                0.795,
                                0.085,
                                { 0, 0, -1.5707963267948966 },
                                { 1, 1, 1, 1, 1, 1 } };
static struct robot robot;
static struct opw_pose pose[POSES];
static double joint[POSES][OPW_JOINTS];

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Uniform in -1 .. 1 (xorshift64). */
static double uniform(uint64_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return (double)(*state >> 11) * 0x1p-52 - 1.0;
}

/* A UR5e by its axes: [s] of a pose of joints, and of the joints of a pose in all branches. */
static void by_axes(double cost[2])
{
    static const double origin[OPW_JOINTS][3] = { { 0, 0, .1625 },  { 0, 0, 0 },
                                                  { -.425, 0, 0 },  { -.3922, -.1333, 0 },
                                                  { 0, 0, -.0997 }, { 0, -.0996, 0 } };
    static const double axis[OPW_JOINTS][3] = { { 0, 0, 1 },  { 0, -1, 0 }, { 0, -1, 0 },
                                                { 0, -1, 0 }, { 0, 0, -1 }, { 0, -1, 0 } };
    struct chain c = { .joints = OPW_JOINTS,
                       .flange.turn = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
    static struct chain_pose end[POSES];
    double all[CHAIN_BRANCHES][CHAIN_JOINTS], q[CHAIN_JOINTS] = { 0.0 };
    struct chain_form form;
    uint64_t found = 0;

    for (int i = 0; i < OPW_JOINTS; i++) {
        memcpy(c.joint[i].origin, origin[i], sizeof origin[i]);
        memcpy(c.joint[i].axis, axis[i], sizeof axis[i]);
    }
    chain_form_of(&c, CHAIN_NONE, &form);
    double start = now();
    for (int n = 0; n < POSES; n++) {
        memcpy(q, joint[n], sizeof joint[n]);
        chain_forward(&c, q, &end[n]);
    }
    cost[0] = (now() - start) / POSES;
    start = now();
    for (int n = 0; n < POSES; n++) {
        found += chain_inverse(&form, &end[n], q, 0xff, all) > 0;
    }
    cost[1] = found == POSES ? (now() - start) / POSES : (double)NAN;
}

int main(void)
{
    uint64_t state = 1, found = 0;
    double branches[OPW_BRANCHES][OPW_JOINTS], sum = 0.0;

    for (int n = 0; n < POSES; n++) {
        for (int i = 0; i < OPW_JOINTS; i++) {
            joint[n][i] = 3.1 * uniform(&state);
        }
    }
    double start = now();
    for (int n = 0; n < POSES; n++) {
        opw_forward(&IRB, joint[n], &pose[n]);
    }
    const double forward = (now() - start) / POSES;
    start = now();
    for (int n = 0; n < POSES; n++) {
        found += opw_inverse(&IRB, &pose[n], joint[n], branches);
        sum += branches[0][0];
    }
    const double inverse = (now() - start) / POSES;

    struct robot_config c = { .arm.opw = IRB,
                              .arm.tool = pose_none(),
                              .feed = 1e3,
                              .acc = 4e3,
                              .spin = 3.0,
                              .smooth = 0.05,
                              .cycle = 1e-4,
                              .slot = 5e-6,
                              .slot_pulses = 49.0 };
    const double bent[OPW_JOINTS] = { 0.1, 0.2, 0.1, 0.1, 1.0, 0.3 };
    for (int i = 0; i < OPW_JOINTS; i++) {
        c.arm.joint[i] = (struct manipulator_joint){ -6.0, 6.0, 3.0, 20.0 };
        c.scale[i] = 4e4;
    }
    struct robot_move move = { .kind = ROBOT_LINE,
                               .feed = 50.0,
                               .target.branch = ROBOT_ANY_BRANCH };
    struct robot_refusal why;
    double plan = 0.0;
    int64_t cycles = 0, planned = 0;
    for (int n = 0; n < LINES; n++) {
        robot_start(&robot, &c, bent);
        move.target.pose = robot.pose;
        for (int i = 0; i < 3; i++) {
            move.target.pose.at[i] += 100.0 * uniform(&state);
        }
        start = now();
        planned += robot_move(&robot, &c, &move, &why) == ROBOT_OK;
        plan += now() - start;
    }
    start = now();
    while (!robot_idle(&robot)) {
        robot_cycle(&robot, &c);
        cycles++;
    }
    const double cycle = (now() - start) / (double)cycles;
    double axes[2];
    by_axes(axes);
    printf("%.4g %.4g %.4g %.4g %.4g %.4g\n", forward, inverse, cycle, plan / LINES, axes[0],
           axes[1]);
    return planned == LINES && found > 0 && isfinite(sum) ? 0 : 1;
}
