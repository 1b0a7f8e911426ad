/* Jogging: three frames, limits, singular places and the way back out of them, increments. */
#include "robot_rig.h"

static const double HOME[OPW_JOINTS] = { 0 }; /* axes 4 and 6 in line */
static const double BENT[OPW_JOINTS] = { 0.1, 0.2, 0.1, 0.1, 1.0, 0.3 };

/* Run until the jog ends by itself: nothing but its coordinate moves. */
static void run(const struct robot_config *c, enum robot_frame frame, const double way[6],
                struct rig_watch *w)
{
    const struct pose from = robot.pose;
    double joint[OPW_JOINTS], off = 0.0, d[3], base[3];
    memcpy(joint, robot.joint, sizeof joint);
    memcpy(base, way, sizeof base);
    if (frame == ROBOT_IN_TOOL) {
        quaternion_turn(from.turn, way, base);
    }
    while (!robot_idle(&robot) && w->time < 200.0) {
        rig_cycle(c, w);
        double along = 0.0, far = 0.0;
        for (int i = 0; i < 3; i++) {
            d[i] = robot.pose.at[i] - from.at[i];
            along += d[i] * base[i];
            far += d[i] * d[i];
        }
        off = frame == ROBOT_IN_JOINTS ? 0.0 : fmax(off, fabs(far - along * along));
        for (int i = 0; i < OPW_JOINTS && frame == ROBOT_IN_JOINTS; i++) {
            off = fmax(off, way[i] == 0.0 ? fabs(robot.joint[i] - joint[i]) : 0.0);
        }
    }
    CHECK(robot_idle(&robot) && !robot.lost && off < 1e-4); /* [mm^2] */
}

/* As far as the arm goes, and some of the way back, from a pose. */
static void there_and_back(const struct robot_config *c, const double from[OPW_JOINTS],
                           double noise)
{
    for (int n = 0; n < 36; n += CHECK_EACH) {
        const enum robot_frame frame = (enum robot_frame)(n / 12);
        struct rig_watch w = { .noise = noise };
        struct robot_refusal why;
        double way[6] = { 0 }, end[OPW_JOINTS];
        way[n % 12 / 2] = n % 2 ? 1.0 : -1.0;
        robot_start(&robot, c, from);
        CHECK_EQ(robot_jog(&robot, c, frame, way, 0.5, 0.0, &why), ROBOT_OK);
        run(c, frame, way, &w);
        memcpy(end, robot.joint, sizeof end);
        /* No further; it says why. */
        const enum robot_status s = robot_jog(&robot, c, frame, way, 0.5, 0.0, &why);
        if (s == ROBOT_OK) {
            rig_run(c, &w);
            double moved = 0.0;
            for (int i = 0; i < OPW_JOINTS; i++) {
                moved = fmax(moved, fabs(robot.joint[i] - end[i]));
            }
            CHECK(moved < 1e-2);
        } else {
            CHECK(s == ROBOT_OUTSIDE || s == ROBOT_FAR || s == ROBOT_SINGULAR);
        }
        way[n % 12 / 2] *= -1.0;
        const bool along = frame != ROBOT_IN_JOINTS && n % 12 < 6;
        const double back = along ? 100.0 : 0.5; /* [mm] or [rad] */
        CHECK_EQ(robot_jog(&robot, c, frame, way, 0.5, back, &why), ROBOT_OK);
        run(c, frame, way, &w);
        rig_kept(&w);
    }
}

/* While its key is down it goes at its speed, let go it ramps to rest; another one waits. */
static void keys(const struct robot_config *c)
{
    const double x[6] = { 1 }, z[6] = { 0, 0, 1 }, turn[6] = { 0, 0, 0, 0, 0, 1 };
    struct robot_refusal why;
    struct rig_watch w = { 0 };

    robot_start(&robot, c, BENT);
    const struct pose from = robot.pose;
    for (int n = 0; n < 3000; n++) {
        CHECK_EQ(robot_jog(&robot, c, ROBOT_IN_BASE, x, 0.04, 0.0, &why), ROBOT_OK);
        rig_cycle(c, &w);
    }
    CHECK_NEAR(robot.speed, 100.0, 1e-6);
    CHECK_EQ(robot_jog(&robot, c, ROBOT_IN_BASE, z, 0.04, 0.0, &why), ROBOT_BUSY);
    struct robot_move m = { .kind = ROBOT_JOINTS, .share = 1.0, .target.by_joints = true };
    CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_BUSY);
    robot_release(&robot);
    const double at = robot.pose.at[0];
    rig_run(c, &w);
    const double ramp = robot.pose.at[0] - at;
    CHECK(ramp > 100.0 * 100.0 / c->acc / 2.0 && ramp < 4.0);
    CHECK_NEAR(robot.pose.at[1], from.at[1], 1e-9);
    CHECK_EQ(robot_jog(&robot, c, ROBOT_IN_BASE, z, 0.04, 0.0, &why), ROBOT_OK);
    rig_run(c, &w);
    /* Increments end where they should, one after the other. */
    robot_start(&robot, c, BENT);
    for (int n = 0; n < 5; n++) {
        CHECK_EQ(robot_jog(&robot, c, ROBOT_IN_TOOL, z, 0.1, 2.0, &why), ROBOT_OK);
        rig_run(c, &w);
        CHECK_EQ(robot_jog(&robot, c, ROBOT_IN_TOOL, turn, 0.1, 0.01, &why), ROBOT_OK);
        rig_run(c, &w);
    }
    double down[3], by[4], v[3];
    quaternion_turn(from.turn, z, down);
    for (int i = 0; i < 3; i++) {
        CHECK_NEAR(robot.pose.at[i], from.at[i] + 10.0 * down[i], 1e-8);
    }
    quaternion_inverse(from.turn, by);
    quaternion_product(by, robot.pose.turn, by);
    quaternion_vector(by, v);
    CHECK_NEAR(v[2], 0.05, 1e-9);
    rig_kept(&w);
    CHECK_EQ(robot_jog(&robot, c, ROBOT_IN_TOOL, HOME, 0.1, 2.0, &why), ROBOT_PARAMETER);
    CHECK_EQ(robot_jog(&robot, c, ROBOT_IN_TOOL, z, 0.0, 2.0, &why), ROBOT_PARAMETER);
}

/* From a stretched arm, which is the edge of reach, straight back. */
static void stretched(const struct robot_config *c)
{
    double q[OPW_JOINTS] = { 0, 0.9, 0, 0, 0.5, 0 }, factor[3];
    const double back[6] = { -1 }, out[6] = { 1 };
    struct robot_refusal why;
    struct rig_watch w = { 0 };

    q[2] = -1.5707963267948966 - atan2(-0.115, 0.795);
    robot_start(&robot, c, q);
    robot_factors(&robot, c, factor);
    CHECK(fabs(factor[1]) < 1e-12);
    CHECK(robot_jog(&robot, c, ROBOT_IN_BASE, out, 0.1, 50.0, &why) != ROBOT_OK);
    CHECK_EQ(robot_jog(&robot, c, ROBOT_IN_BASE, back, 0.1, 50.0, &why), ROBOT_OK);
    const double x = robot.pose.at[0];
    while (!robot_idle(&robot) && w.time < 100.0) {
        rig_cycle(c, &w);
    }
    CHECK(robot_idle(&robot));
    CHECK_NEAR(robot.pose.at[0], x - 50.0, 1e-6);
    printf("out of the stretched pose: %.2f s, %.3f of the joints' accelerations\n", w.time, w.acc);
    /* There a joint's way has no slope: it begins with 3e-3 rad/s. */
    CHECK(w.time < 2.0 && w.speed <= 1.0 && w.acc > 1.0 && w.acc < 5.0);
}

/* An increment of eight whole turns along with a way: samples at eight places see no turn. It goes
 * as far as joint 6 does, and no further. */
static void whole_turns(const struct robot_config *c)
{
    const double from[OPW_JOINTS] = { [4] = 1.5707963267948966 };
    const double turning[6] = { 1, [5] = 1 };

    for (int turns = 1; turns <= 16; turns++) {
        struct robot_refusal why;
        struct rig_watch w = { 0 };
        robot_start(&robot, c, from);
        CHECK_EQ(robot_jog(&robot, c, ROBOT_IN_BASE, turning, 0.3, 6.283185307179586 * turns, &why),
                 ROBOT_OK);
        rig_run(c, &w);
        rig_kept(&w);
        double most = 0.0;
        for (int i = 0; i < OPW_JOINTS; i++) {
            most = fmax(most, fabs(robot.joint[i]) / c->arm.joint[i].high);
        }
        CHECK(most <= 1.0 + 1e-9 && (turns == 1 || most > 0.999));
    }
}

/* Turning about the tool's y, and joint 5 to its limit. How far the tip goes a radian [mm] does not
 * decide how near to the limit that is, however little it is. */
static void hardly_along(const struct robot_config *c)
{
    static const double per[] = { 10.0, 1.0, 1e-3, 1e-6, 1e-9, 1e-160 };

    for (size_t n = 0; n < sizeof per / sizeof *per; n++) {
        const double turning[6] = { per[n], [4] = 1.0 };
        struct robot_refusal why;
        struct rig_watch w = { 0 };
        robot_start(&robot, c, BENT);
        CHECK_EQ(robot_jog(&robot, c, ROBOT_IN_TOOL, turning, 0.3, 0.0, &why), ROBOT_OK);
        rig_run(c, &w);
        rig_kept(&w);
        CHECK_NEAR(robot.joint[4], c->arm.joint[4].high, 2e-6);
    }
}

int main(void)
{
    const struct robot_config c = rig_config();

    there_and_back(&c, HOME, NOISE);
    there_and_back(&c, BENT, 0.0);
    keys(&c);
    whole_turns(&c);
    hardly_along(&c);
    stretched(&c);
    return check_result();
}
