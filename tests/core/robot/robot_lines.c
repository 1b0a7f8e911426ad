/* Straight lines: the path, the limits of the joints, singular places. */
#include "robot_rig.h"

static const double DOWN[3] = { 180, 0, 0 }, AHEAD[3] = { 0, 90, 0 };

static struct rig_watch line(const struct robot_config *c, const double a[3], const double b[3],
                             const double abc[3], double feed, double noise)
{
    struct rig_watch w = { .slowest = 1e9, .noise = noise };
    struct robot_refusal why;
    const struct robot_move m = rig_line(b, abc, feed);

    memcpy(w.a, a, sizeof w.a);
    memcpy(w.b, b, sizeof w.b);
    rig_start(c, a, abc);
    CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OK);
    rig_run(c, &w);
    rig_kept(&w);
    CHECK(w.path < 1e-9);
    for (int i = 0; i < 3; i++) {
        CHECK_NEAR(robot.pose.at[i], b[i], 1e-9);
    }
    return w;
}

/* Far from singular places: one segment, ramps as the closed form has them, else the feed. */
static void plain(const struct robot_config *c)
{
    const double a[3] = { 1100, -450, 350 }, b[3] = { 1100, 450, 350 };
    for (double feed = 30.0; feed < 400.0; feed *= 3.0) {
        const struct rig_watch w = line(c, a, b, DOWN, feed, 0.0);
        CHECK_EQ(robot.tool_path.count, 1);
        CHECK_NEAR(w.slowest, feed, 1e-6 * feed);
        CHECK_NEAR(w.time, 900.0 / feed + feed / c->acc + c->smooth, 2.0 * CYCLE);
        CHECK_NEAR(robot.length, 900.0, 1e-6);
    }
}

/* A joint decides: no quicker than the fastest that any planner could be, and not much slower. */
static void fast(const struct robot_config *c)
{
    const struct rig_watch w =
        line(c, (double[]){ 1100, -450, 350 }, (double[]){ 1100, 450, 350 }, DOWN, 2500, 0.0);
    CHECK(w.time > 2.0 * sqrt(900.0 / c->acc) && w.time < 1.3 * 2.0 * sqrt(900.0 / c->acc) + 0.05);
}

/* Through the wrist's singular place and beside it. The least speed beside: joint 4 turns at
 * v / distance where the direction of the wrist goes by. */
static void wrist(struct robot_config c)
{
    static const double beside[] = { 0.0, 10.0, 0.1, 1e-3, 1e-5 };
    const double q[OPW_JOINTS] = { 0, 0.3, -0.3, 0, 0, 0 };
    const struct pose p = manipulator_pose(&c.arm, q);
    double all = 0.0;

    for (int k = 0; k < 5; k++) {
        const double a[3] = { p.at[0], -100, p.at[2] + beside[k] };
        const double b[3] = { p.at[0], 100, p.at[2] + beside[k] };
        const struct rig_watch w = line(&c, a, b, AHEAD, 100, k ? 0.0 : NOISE);
        printf("%g mm beside the wrist's singular place: %.3f s, %d segments, path %.1e mm, joints"
               " %.3f of their speeds, %.3f of their accelerations, slowest %.2g mm/s\n",
               beside[k], w.time, robot.tool_path.count, w.path, w.speed, w.acc, w.slowest);
        if (k == 0) {
            CHECK_EQ(robot.tool_path.count, 1);
            CHECK_NEAR(w.slowest, 100.0, 1e-3);
            CHECK_EQ(opw_branch(&c.arm.opw, robot.joint) & OPW_FLIP, OPW_FLIP);
            all = w.time;
        } else {
            CHECK_EQ(opw_branch(&c.arm.opw, robot.joint) & OPW_FLIP, 0);
            CHECK(w.time > all && w.time < all + 3.0 && robot.tool_path.count < 200);
            CHECK(k == 1 || (w.slowest > 0.0 && w.slowest < beside[k] * 7.6));
            CHECK(w.acc > 0.5);
        }
    }
    /* Asked to, it is refused before anything moves, with the place and the factor. */
    struct robot_refusal why;
    const double a[3] = { p.at[0], -100, p.at[2] + 0.1 }, b[3] = { p.at[0], 100, p.at[2] + 0.1 };
    struct robot_move m = rig_line(b, AHEAD, 100);
    m.singular = ROBOT_REFUSE;
    rig_start(&c, a, AHEAD);
    const struct robot before = robot;
    CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_SINGULAR);
    CHECK_EQ(why.which, 2);
    CHECK(fabs(why.value) < 0.05 && fabs(why.place[1]) < 50.0);
    CHECK_NEAR(why.place[2], a[2], 1e-9);
    CHECK_NEAR(why.place[1], -100.0 + 200.0 * why.part, 1e-9);
    CHECK(robot_idle(&robot) && memcmp(&before.rear, &robot.rear, sizeof robot.rear) == 0
          && before.moves.count == robot.moves.count);
    m.feed = 0.5; /* the joints can follow that */
    CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_OK);

    /* By the wrist: the tip keeps its path and its speed, the attitude goes its own way. */
    rig_start(&c, a, AHEAD);
    m.singular = ROBOT_WRIST;
    m.feed = 100.0;
    struct rig_watch w = { .slowest = 1e9 };
    memcpy(w.a, a, sizeof w.a);
    memcpy(w.b, b, sizeof w.b);
    const double from = robot.joint[3];
    CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_OK);
    const double to = robot.rear_joint[3];
    double uneven = 0.0;
    while (!robot_idle(&robot)) {
        const double part = (robot.pose.at[1] + 100.0) / 200.0;
        uneven = fmax(uneven, fabs(robot.joint[3] - from - part * (to - from)));
        rig_cycle(&c, &w);
    }
    rig_kept(&w);
    CHECK(w.path < 1e-6 && w.slowest > 99.9 && uneven < 1e-9);
    CHECK_NEAR(w.time, all, 1e-3);
    const struct pose end = pose_of(b, AHEAD), now = manipulator_pose(&c.arm, robot.joint);
    double off[4];
    quaternion_inverse(now.turn, off);
    quaternion_product(end.turn, off, off);
    CHECK(fabs(fabs(off[0]) - 1.0) < 1e-12);
}

/* From a pose whose wrist is in line joint 4 first turns to where the line needs it. */
static void from_in_line(const struct robot_config *c)
{
    const double home[OPW_JOINTS] = { 0 };
    for (int k = 0; k < 8; k++) {
        struct rig_watch w = { .slowest = 1e9, .noise = NOISE };
        struct robot_refusal why;
        robot_start(&robot, c, home);
        const double angle = k * 0.7854;
        const double a[3] = { robot.pose.at[0], robot.pose.at[1], robot.pose.at[2] };
        const double b[3] = { a[0] - 200, a[1] + 100 * cos(angle), a[2] + 100 * sin(angle) };
        const struct robot_move m = rig_line(b, AHEAD, 200);
        memcpy(w.a, a, sizeof w.a);
        memcpy(w.b, b, sizeof w.b);
        CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OK);
        rig_run(c, &w);
        rig_kept(&w);
        CHECK(w.path < 1e-6);
        CHECK_NEAR(robot.pose.at[1], b[1], 1e-9);
    }
}

/* Why lines are refused, and where. */
static void refusals(const struct robot_config *c)
{
    struct robot_refusal why;
    const double a[3] = { 1100, 0, 350 };
    rig_start(c, a, DOWN);

    struct robot_move m = rig_line((double[]){ 2100, 0, 350 }, DOWN, 100);
    CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_FAR);
    /* The arm is stretched: the wrist centre from axis 2 as far as both its parts are long. */
    const double k = hypot(115.0, 795.0) + 700.0, z = 350.0 + 150.0 + 85.0 - 445.0;
    const double edge = 150.0 + sqrt(k * k - z * z);
    CHECK_EQ(why.which, 1);
    CHECK_NEAR(why.place[0], edge, 1e-5);
    CHECK(fabs(why.value) < 1e-2);

    m = rig_line((double[]){ 1100, 0, 350 }, DOWN, 100);
    m.target.turned = true;
    m.target.turn[5] = 2;
    CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OTHER_TURN); /* nothing would move */
    m.target.pose.at[1] = 10.0;
    CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OTHER_TURN);
    CHECK_EQ(why.which, 5);
    m.target.turned = false;
    for (int branch = 0; branch < OPW_BRANCHES; branch++) {
        rig_start(c, a, DOWN);
        m.target.branch = branch;
        CHECK_EQ(robot_move(&robot, c, &m, &why), branch ? ROBOT_OTHER_BRANCH : ROBOT_OK);
        CHECK_EQ(branch ? why.which & branch : why.which, why.which);
    }
    /* Joint 1 reaches its limit on the line. */
    struct robot_config narrow = *c;
    narrow.arm.joint[0].high = 0.2;
    rig_start(&narrow, a, DOWN);
    m = rig_line((double[]){ 1100, 400, 350 }, DOWN, 100);
    CHECK_EQ(robot_move(&robot, &narrow, &m, &why), ROBOT_OUTSIDE);
    CHECK_EQ(why.which, 0);
    CHECK_NEAR(why.place[1], 1100.0 * tan(0.2), 1e-4);
    CHECK(why.limit == 0.2 && why.value > 0.2 && why.value < 0.2 + 1e-6);
    m.feed = NAN;
    CHECK_EQ(robot_move(&robot, &narrow, &m, &why), ROBOT_PARAMETER);
}

int main(void)
{
    const struct robot_config c = rig_config();

    plain(&c);
    fast(&c);
    wrist(c);
    from_in_line(&c);
    refusals(&c);
    return check_result();
}
