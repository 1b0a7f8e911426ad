/* Moves of the joints, targets, hold, override, abort, pulses of the slots. */
#include <stdlib.h>

#include "robot_rig.h"

#include "slots.h"

static uint64_t seed = 3;

static void anywhere(const struct robot_config *c, double q[OPW_JOINTS])
{
    for (int i = 0; i < OPW_JOINTS; i++) {
        q[i] = check_real(&seed, c->arm.joint[i].low, c->arm.joint[i].high);
    }
}

/* Duration from rest to rest with limits of speed, acceleration and jerk. */
static double duration(double way, double v, double a, double j)
{
    if (v * j < a * a) {
        a = sqrt(v * j); /* the acceleration is not reached */
    }
    if (way >= v * (v / a + a / j)) {
        return way / v + v / a + a / j;
    }
    if (way >= 2.0 * a * a * a / (j * j)) {
        return a / j + sqrt(a * a / (j * j) + 4.0 * way / a);
    }
    return 4.0 * cbrt(way / (2.0 * j));
}

/* All joints start and end together; the slowest has the time of the closed form. */
static void moves(const struct robot_config *c)
{
    for (int n = 0; n < 100; n++) {
        struct robot_move m = { .kind = ROBOT_JOINTS, .share = check_real(&seed, 0.05, 1.0) };
        struct robot_refusal why;
        struct rig_watch w = { 0 };
        double from[OPW_JOINTS], least = INFINITY, way = 0.0, speed = INFINITY;
        anywhere(c, from);
        anywhere(c, m.target.joint);
        m.target.by_joints = true;
        robot_start(&robot, c, from);
        CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OK);
        for (int i = 0; i < OPW_JOINTS; i++) {
            const double d = fabs(m.target.joint[i] - from[i]);
            const double most = fmin(c->arm.joint[i].speed, 48.0 / (c->scale[i] * c->slot));
            speed = fmin(speed, m.share * most / d); /* of the part that is over */
            least = fmin(least, c->arm.joint[i].acc / d);
        }
        const double time = duration(1.0, speed, least, least / c->smooth);
        double off = 0.0;
        while (!robot_idle(&robot)) {
            rig_cycle(c, &w);
            const double part = (robot.joint[0] - from[0]) / (m.target.joint[0] - from[0]);
            for (int i = 0; i < OPW_JOINTS; i++) {
                way = m.target.joint[i] - from[i];
                off = fmax(off, fabs(robot.joint[i] - from[i] - part * way));
            }
        }
        rig_kept(&w);
        CHECK(off < 1e-9);
        CHECK_NEAR(w.time, time, 1.01 * CYCLE);
        for (int i = 0; i < OPW_JOINTS; i++) {
            CHECK_NEAR(robot.joint[i], m.target.joint[i], 1e-9);
        }
    }
}

/* To a pose: the branch and the turns asked for, or the nearest within the limits. */
static void targets(const struct robot_config *c)
{
    int other = 0, refused = 0;
    for (int n = 0; n < 200; n++) {
        struct robot_move m = { .kind = ROBOT_JOINTS, .share = 1.0 };
        struct robot_refusal why;
        double from[OPW_JOINTS], to[OPW_JOINTS];
        anywhere(c, from);
        anywhere(c, to);
        robot_start(&robot, c, to);
        struct robot_target taught;
        robot_teach(&robot, c, &taught);
        robot_start(&robot, c, from);
        m.target = taught;
        m.target.by_joints = false;
        CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OK);
        for (int i = 0; i < OPW_JOINTS; i++) {
            CHECK_NEAR(robot.rear_joint[i], to[i], 1e-6);
        }
        robot_start(&robot, c, from);
        m.target.turned = false;
        m.target.branch = ROBOT_ANY_BRANCH;
        CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OK);
        double most = 0.0, taught_most = 0.0;
        for (int i = 0; i < OPW_JOINTS; i++) {
            most = fmax(most, fabs(robot.rear_joint[i] - from[i]));
            taught_most = fmax(taught_most, fabs(to[i] - from[i]));
            CHECK(robot.rear_joint[i] <= c->arm.joint[i].high + 1e-9
                  && robot.rear_joint[i] >= c->arm.joint[i].low - 1e-9);
        }
        CHECK(most <= taught_most + 1e-6);
        other += most < taught_most - 1e-6;
        robot_start(&robot, c, from);
        m.target.branch = taught.branch ^ OPW_FLIP;
        m.target.turned = true;
        const enum robot_status s = robot_move(&robot, c, &m, &why);
        CHECK(s == ROBOT_OK || (s == ROBOT_OUTSIDE && why.which >= 0));
        refused += s == ROBOT_OUTSIDE;
        if (s == ROBOT_OK) {
            CHECK_EQ(opw_branch(&c->arm.opw, robot.rear_joint), m.target.branch);
        }
    }
    CHECK(other > 50 && refused > 5 && refused < 195);
    /* Beyond a limit: named, with numbers. */
    struct robot_move m = { .kind = ROBOT_JOINTS, .share = 1.0, .target.by_joints = true };
    struct robot_refusal why;
    const double home[OPW_JOINTS] = { 0 };
    robot_start(&robot, c, home);
    m.target.joint[4] = 121 * DEGREE;
    CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OUTSIDE);
    CHECK(why.which == 4 && why.value == 121 * DEGREE && why.limit == c->arm.joint[4].high);
    m.share = 0.0;
    CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_PARAMETER);
}

/* A start beyond a limit: back only. */
static void beyond(const struct robot_config *c)
{
    struct robot_move m = { .kind = ROBOT_JOINTS, .share = 1.0, .target.by_joints = true };
    struct robot_refusal why;
    struct rig_watch w = { 0 };
    const double out[OPW_JOINTS] = { 0, 0, 0, 0, 2.2, 0 }; /* 126 degrees of 120 */
    const double way[6] = { 0, 0, 0, 0, 1, 0 }, back[6] = { 0, 0, 0, 0, -1, 0 };

    robot_start(&robot, c, out);
    memcpy(m.target.joint, out, sizeof out);
    m.target.joint[4] = 2.3;
    CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OUTSIDE);
    CHECK_EQ(robot_jog(&robot, c, ROBOT_IN_JOINTS, way, 0.5, 0.0, &why), ROBOT_OUTSIDE);
    CHECK(why.which == 4 && why.value == 2.2 && why.limit == c->arm.joint[4].high);
    CHECK_EQ(robot_jog(&robot, c, ROBOT_IN_JOINTS, back, 0.5, 0.1, &why), ROBOT_OK);
    rig_run(c, &w);
    CHECK_NEAR(robot.joint[4], 2.1, 1e-9);
    m.target.joint[4] = 2.0;
    CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OK);
    rig_run(c, &w);
    rig_kept(&w);
    CHECK_NEAR(robot.joint[4], 2.0, 1e-9);
}

/* Pulses of every slot: within half a pulse of the straight line between cycles, none lost. */
static void slots(const struct robot_config *c)
{
    struct robot_move m = { .kind = ROBOT_JOINTS, .share = 1.0, .target.by_joints = true };
    struct robot_refusal why;
    double from[OPW_JOINTS];
    int64_t sum[OPW_JOINTS];
    int32_t most = 0;

    for (int n = 0; n < 20; n++) {
        anywhere(c, from);
        anywhere(c, m.target.joint);
        robot_start(&robot, c, from);
        for (int i = 0; i < OPW_JOINTS; i++) {
            sum[i] = llround(from[i] * c->scale[i]);
        }
        CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OK);
        while (!robot_idle(&robot)) {
            double before[OPW_JOINTS], half = 0.0;
            memcpy(before, robot.joint, sizeof before);
            robot_cycle(&robot, c);
            for (int i = 0; i < OPW_JOINTS; i++) {
                int32_t pulses[20] = { 0 };
                slots_pulses(before[i], robot.joint[i], c->scale[i], 20, pulses);
                for (int32_t s = 0; s < 20; s++) {
                    const double part = (s + 1) / 20.0;
                    const double ideal = before[i] + (robot.joint[i] - before[i]) * part;
                    most = abs(pulses[s]) > most ? abs(pulses[s]) : most;
                    sum[i] += pulses[s];
                    half = fmax(half, fabs((double)sum[i] - ideal * c->scale[i]));
                }
            }
            CHECK(half <= 0.5 + 1e-6);
        }
        for (int i = 0; i < OPW_JOINTS; i++) {
            CHECK_EQ(sum[i], llround(robot.joint[i] * c->scale[i]));
        }
    }
    CHECK(most >= 1 && most <= 49);
    /* A card that takes few pulses makes the joints slower. */
    struct robot_config few = *c;
    few.slot_pulses = 1.2;
    const double zero[OPW_JOINTS] = { 0 }, turn[OPW_JOINTS] = { 1.0 };
    struct rig_watch w = { 0 };
    robot_start(&robot, &few, zero);
    memcpy(m.target.joint, turn, sizeof turn);
    CHECK_EQ(robot_move(&robot, &few, &m, &why), ROBOT_OK);
    rig_run(&few, &w);
    CHECK_NEAR(w.speed * c->arm.joint[0].speed * c->scale[0] * c->slot, 0.2, 1e-6);
}

/* On a line: held it stands on it and goes on; slower by override; aborted it rests on it. */
static void interrupted(const struct robot_config *c)
{
    const double a[3] = { 1100, -300, 350 }, b[3] = { 1100, 300, 350 }, down[3] = { 180, 0, 0 };
    const struct robot_move m = rig_line(b, down, 200);
    struct robot_refusal why;

    for (int kind = 0; kind < 3; kind++) {
        struct rig_watch w = { .slowest = 1e9 };
        memcpy(w.a, a, sizeof w.a);
        memcpy(w.b, b, sizeof w.b);
        rig_start(c, a, down);
        CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OK);
        CHECK(robot_ready(&robot));
        for (int n = 0; n < 10000; n++) {
            rig_cycle(c, &w);
        }
        CHECK_NEAR(robot.speed, 200.0, 1e-6);
        const double at = robot.pose.at[1];
        kind == 0   ? robot_hold(&robot, true)
        : kind == 1 ? robot_override(&robot, 0.1)
                    : robot_abort(&robot);
        CHECK(kind != 2 || robot_move(&robot, c, &m, &why) == ROBOT_BUSY);
        for (int n = 0; n < 3000; n++) {
            rig_cycle(c, &w);
        }
        if (kind == 1) {
            CHECK_NEAR(robot.speed, 20.0, 1e-6);
            robot_override(&robot, 1.0);
        } else {
            CHECK(robot.speed == 0.0 && robot_rests(&robot));
            CHECK_NEAR(robot.pose.at[1] - at, 200.0 * (200.0 / c->acc + c->smooth) / 2, 0.1);
        }
        CHECK_EQ(robot_idle(&robot), kind == 2);
        if (kind == 0) {
            robot_hold(&robot, false);
        }
        if (kind == 2) {
            CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OK);
        }
        rig_run(c, &w);
        rig_kept(&w);
        CHECK(w.path < 1e-9);
        CHECK_NEAR(robot.pose.at[1], 300.0, 1e-9);
    }
}

int main(void)
{
    const struct robot_config c = rig_config();

    moves(&c);
    targets(&c);
    beyond(&c);
    slots(&c);
    interrupted(&c);
    return check_result();
}
