/* Segments of a way: what corners leave the joints in any direction, what a mean mixes. */
#include "robot_rig.h"

static const double BENT[OPW_JOINTS] = { 0.1, 0.2, 0.1, 0.1, 1.0, 0.3 };

/* [mm] of a difference of joints. */
static const double STEP = 1e-2;

static uint64_t seed = 3;

/* Whether joints bear an acceleration of the tip in a direction, by poses a step apart. */
static bool bears(const struct robot_config *c, const double joint[OPW_JOINTS], const double way[3],
                  double acc)
{
    struct pose p = manipulator_pose(&c->arm, joint);
    double q[OPW_JOINTS];
    bool good = true;

    memcpy(q, joint, sizeof q);
    for (int i = 0; i < 3; i++) {
        p.at[i] += STEP * way[i];
    }
    CHECK(manipulator_joints(&c->arm, &p, q));
    for (int i = 0; i < OPW_JOINTS; i++) {
        good = good && fabs(q[i] - joint[i]) / STEP * acc <= c->arm.joint[i].acc;
    }
    return good;
}

/* Lines with a corner at their end, or at both ends: their first and last accelerations are borne
 * in any direction there. */
static void corners(void)
{
    for (int k = 0; k < 40; k++) {
        struct robot_config c = rig_config();
        struct robot_refusal why;
        double from[OPW_JOINTS], to[OPW_JOINTS];

        for (int i = 0; i < OPW_JOINTS; i++) {
            c.arm.joint[i].acc *= 0.1;
        }
        robot_start(&robot, &c, BENT);
        for (int n = 0; n < 2; n++) {
            double xyz[3], abc[3];
            robot_end(&robot, from);
            memcpy(xyz, robot.rear, sizeof xyz);
            quaternion_angles(robot.pose.turn, abc);
            for (int i = 0; i < 3; i++) {
                xyz[i] += check_real(&seed, -100.0, 100.0);
            }
            struct robot_move m = rig_line(xyz, abc, 500.0);
            m.zone = 5.0;
            CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_OK);
            robot_end(&robot, to);
            for (int d = 0; d < 50; d++) {
                double way[3], square = 0.0;
                for (int i = 0; i < 3; i++) {
                    way[i] = check_real(&seed, -1.0, 1.0);
                    square += way[i] * way[i];
                }
                for (int i = 0; i < 3; i++) {
                    way[i] /= sqrt(square);
                }
                CHECK(bears(&c, to, way, robot.tool_path.segment[robot.tool_path.count - 1].acc));
                CHECK(n == 0 || bears(&c, from, way, robot.tool_path.segment[0].acc));
            }
        }
    }
}

/* A line past the wrist's singular place, planned for a mean over a time. */
static struct tool_path planned(struct robot_config *c, double smooth, const double to[3])
{
    static const double ahead[OPW_JOINTS] = { 0.0, 0.2, 0.1, 0.3, 0.35, 0.0 };
    struct robot_refusal why;

    c->smooth = smooth;
    robot_start(&robot, c, ahead);
    struct robot_move m = { .kind = ROBOT_LINE, .feed = 60.0, .target.pose = robot.pose };
    m.target.branch = ROBOT_ANY_BRANCH;
    for (int i = 0; i < 3; i++) {
        m.target.pose.at[i] += to[i];
    }
    CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OK);
    return robot.tool_path;
}

/* An acceleration is the least of the segments that a mean over a time mixes with it. */
static void mixed(void)
{
    int lower = 0;

    for (int k = 0; k < 60; k++) {
        struct robot_config c = rig_config();
        const double to[3] = { check_real(&seed, -100.0, 100.0), check_real(&seed, -150.0, 150.0),
                               check_real(&seed, -300.0, 300.0) };
        for (int i = 0; i < OPW_JOINTS; i++) {
            c.arm.joint[i].acc *= 0.1;
        }
        const struct tool_path plain = planned(&c, 0.0, to), w = planned(&c, 0.5, to);
        CHECK_EQ(w.count, plain.count);
        for (int n = 0; n < w.count && w.smooth > 0.0; n++) {
            double least = plain.segment[n].acc;
            for (int i = 0; i < w.count; i++) {
                const int first = i < n ? i : n, last = i < n ? n : i;
                const double gap =
                    first == last ? 0.0 : w.segment[last - 1].until - w.segment[first].until;
                if (gap * w.path.length < 0.5 * w.segment[i].cap) {
                    least = fmin(least, plain.segment[i].acc);
                }
            }
            CHECK(w.segment[n].acc <= least);
            lower += w.segment[n].acc < plain.segment[n].acc;
        }
    }
    CHECK(lower > 20);
}

int main(void)
{
    corners();
    mixed();
    return check_result();
}
