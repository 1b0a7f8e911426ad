/* Arms that are known by their axes: the motion of a UR5e, and of an IRB 2600 against opw's. Bounds
 * of the joints' derivatives hold all over a part of a path, and every cycle of lines, arcs and
 * jogs keeps to the joints' limits. */
#include "bounds.h"
#include "robot_rig.h"

enum { PARTS = 120, PLACES = 32, MOVES = 36, JOGS = 12 };

static uint64_t seed = 36;

/* Six turning joints: origins [m] and axes at zero. */
struct arm_axes {
    double origin[OPW_JOINTS][3], axis[OPW_JOINTS][3];
};

static const struct arm_axes UR5E = {
    { { 0, 0, .1625 },
      { 0, 0, 0 },
      { -.425, 0, 0 },
      { -.3922, -.1333, 0 },
      { 0, 0, -.0997 },
      { 0, -.0996, 0 } },
    { { 0, 0, 1 }, { 0, -1, 0 }, { 0, -1, 0 }, { 0, -1, 0 }, { 0, 0, -1 }, { 0, -1, 0 } }
};

static const struct arm_axes IRB = {
    { { 0, 0, .445 }, { .15, 0, 0 }, { 0, 0, .7 }, { 0, 0, .115 }, { .795, 0, 0 }, { .085, 0, 0 } },
    { { 0, 0, 1 }, { 0, 1, 0 }, { 0, 1, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 0, 0 } }
};

static const double ALONG_X[3][3] = { { 0, 0, 1 }, { 0, 1, 0 }, { -1, 0, 0 } };
static const double ALONG_Y[3][3] = { { 1, 0, 0 }, { 0, 0, -1 }, { 0, 1, 0 } };

static void by_axes(struct manipulator *m, const struct arm_axes *a, const double flange[3][3])
{
    struct chain c = { .joints = OPW_JOINTS };

    for (int i = 0; i < OPW_JOINTS; i++) {
        memcpy(c.joint[i].origin, a->origin[i], sizeof c.joint[i].origin);
        memcpy(c.joint[i].axis, a->axis[i], sizeof c.joint[i].axis);
    }
    memcpy(c.flange.turn, flange, sizeof c.flange.turn);
    CHECK(chain_good(&c));
    chain_form_of(&c, CHAIN_NONE, &m->axes);
    m->by_axes = true;
}

static struct robot_config ur5e(void)
{
    struct robot_config c = rig_config();

    by_axes(&c.arm, &UR5E, ALONG_Y);
    CHECK_EQ(c.arm.axes.kind, CHAIN_THREE_PARALLEL);
    for (int i = 0; i < OPW_JOINTS; i++) {
        c.arm.joint[i] =
            (struct manipulator_joint){ -360 * DEGREE, 360 * DEGREE, 180 * DEGREE, 800 * DEGREE };
    }
    return c;
}

static void anywhere(const struct robot_config *c, double joint[OPW_JOINTS])
{
    double factor[3];

    do {
        for (int i = 0; i < OPW_JOINTS; i++) {
            joint[i] = check_real(&seed, -2.5, 2.5);
        }
        manipulator_factors(&c->arm, joint, factor);
    } while (fabs(factor[0]) < 0.1 || fabs(factor[1]) < 0.2 || fabs(factor[2]) < 0.2);
}

/* A line or an arc from anywhere, up to half a radian of each joint long. */
static struct robot_move some_move(const struct robot_config *c, int n)
{
    struct robot_move m = { .kind = n % 3 == 1   ? ROBOT_CIRCLE
                                    : n % 3 == 2 ? ROBOT_ARC
                                                 : ROBOT_LINE,
                            .share = 1.0,
                            .feed = pow(10.0, check_real(&seed, 1.5, 3.0)),
                            .target.branch = ROBOT_ANY_BRANCH };
    double joint[OPW_JOINTS], end[OPW_JOINTS];

    anywhere(c, joint);
    for (int i = 0; i < OPW_JOINTS; i++) {
        end[i] = joint[i] + check_real(&seed, -0.5, 0.5);
        m.normal[i % 3] = check_real(&seed, -1.0, 1.0);
    }
    robot_start(&robot, c, joint);
    m.target.pose = manipulator_pose(&c->arm, end);
    const double *at = robot.pose.at, *to = m.target.pose.at, *z = m.normal;
    const double size = sqrt(z[0] * z[0] + z[1] * z[1] + z[2] * z[2]);
    for (int i = 0; i < 3; i++) {
        m.via[i] = 0.5 * (at[i] + to[i]) + check_real(&seed, -50.0, 50.0);
        m.normal[i] /= size;
    }
    const double radius = check_real(&seed, 5.0, 80.0);
    m.centre[0] = at[0] - radius * z[1]; /* across the normal */
    m.centre[1] = at[1] + radius * z[0];
    m.centre[2] = at[2];
    m.sweep = check_real(&seed, -6.0, 6.0);
    return m;
}

static void joints_at(const struct arm_geometry *g, double part, double joint[OPW_JOINTS])
{
    double place[AXES], slope[AXES];

    path_at(&robot.tool_path.path, part * robot.tool_path.path.length, place, slope);
    CHECK(arm_moves_kinematics().joints(g, place, joint));
}

/* Differences of the joints at a part of the path, over 2 h of the way. */
static void differences(const struct arm_geometry *g, double part, double h,
                        const double near[OPW_JOINTS], double slope[OPW_JOINTS],
                        double bend[OPW_JOINTS])
{
    double q[3][OPW_JOINTS];

    for (int k = 0; k < 3; k++) {
        memcpy(q[k], near, sizeof q[k]);
        joints_at(g, part + (k - 1) * h / robot.tool_path.path.length, q[k]);
    }
    for (int i = 0; i < OPW_JOINTS; i++) {
        slope[i] = (q[2][i] - q[0][i]) / (2.0 * h);
        bend[i] = (q[2][i] - 2.0 * q[1][i] + q[0][i]) / (h * h);
    }
}

/* Nowhere on a part are bounds exceeded, and on a short one they are what the joints have. */
static void bounds(const struct robot_config *c)
{
    int moves = 0, known = 0, close = 0;

    for (int n = 0; n < PARTS; n += CHECK_EACH) {
        const struct robot_move m = some_move(c, n);
        struct robot_refusal why;
        if (robot_move(&robot, c, &m, &why) != ROBOT_OK || robot.tool_path.path.length < 1.0) {
            continue;
        }
        struct manipulator arm = c->arm;
        const struct arm_geometry g = { &arm, &robot.moves };
        const double size = pow(2.0, -floor(check_real(&seed, 3.0, 9.0)));
        const double from = size * floor(check_real(&seed, 0.0, 1.0 / size));
        const double length = robot.tool_path.path.length, h = 0.02;
        double middle[OPW_JOINTS], slope[OPW_JOINTS], bend[OPW_JOINTS];
        struct bounds b;
        moves++;
        memcpy(middle, robot.joint, sizeof middle);
        for (int k = 1; k <= 256; k++) {
            joints_at(&g, (from + 0.5 * size) * k / 256, middle);
        }
        if (!bounds_of(&g, &robot.tool_path.path, from, from + size, middle, &b)) {
            continue;
        }
        known++;
        for (int k = 0; k <= PLACES; k++) {
            const double room = h / length;
            const double part = fmax(room, fmin(1.0 - room, from + size * k / PLACES));
            differences(&g, part, h, middle, slope, bend);
            for (int i = 0; i < OPW_JOINTS; i++) { /* 1e-9: rounding of the differences */
                CHECK(fabs(slope[i]) <= b.most.slope[i] * (1.0 + 1e-4) + 1e-9);
                CHECK(fabs(bend[i]) <= b.most.bend[i] * (1.0 + 1e-2) + 1e-8);
            }
        }
        const double at = from + 0.5 * size, half = fmin(at, 0.01 / length);
        if (at + half <= 1.0
            && bounds_of(&g, &robot.tool_path.path, at - half, at + half, middle, &b)) {
            differences(&g, at, h, middle, slope, bend);
            bool all = true;
            for (int i = 0; i < OPW_JOINTS; i++) {
                all = all && b.most.slope[i] <= fabs(slope[i]) * 1.02 + 1e-6
                      && b.most.bend[i] <= fabs(bend[i]) * 1.2 + 1e-6;
                CHECK_NEAR(b.middle.slope[i], fabs(slope[i]), 1e-4 * fabs(slope[i]) + 1e-8);
                CHECK_NEAR(b.middle.bend[i], fabs(bend[i]), 1e-2 * fabs(bend[i]) + 1e-7);
            }
            close += all;
        }
    }
    printf("%d moves, %d with bounds, %d close\n", moves, known, close);
    CHECK(moves > PARTS / CHECK_EACH / 3 && known > moves / 2 && close > known / 2);
}

/* Each move keeps to the limits of the joints in every cycle, and leads to where it should. */
static void moves(const struct robot_config *c)
{
    int done = 0;
    int64_t segments = 0;

    for (int n = 0; n < MOVES; n += CHECK_EACH) {
        const struct robot_move m = some_move(c, n);
        struct robot_refusal why;
        struct rig_watch w = { .slowest = INFINITY };
        const struct pose start = robot.pose;
        if (robot_move(&robot, c, &m, &why) != ROBOT_OK) {
            CHECK(why.part >= 0.0 && why.part <= 1.0);
            continue;
        }
        segments += robot.tool_path.count;
        if (m.kind == ROBOT_LINE) {
            memcpy(w.a, start.at, sizeof w.a);
            memcpy(w.b, m.target.pose.at, sizeof w.b);
        }
        rig_run(c, &w);
        CHECK(w.speed <= 1.0 + 1e-6 && w.acc <= 1.0 + 1e-3 && w.path < 1e-6);
        if (m.kind != ROBOT_ARC) {
            for (int i = 0; i < 3; i++) {
                CHECK_NEAR(robot.pose.at[i], m.target.pose.at[i], 1e-6);
            }
        }
        const struct pose there = manipulator_pose(&c->arm, robot.joint);
        for (int i = 0; i < 3; i++) {
            CHECK_NEAR(there.at[i], robot.pose.at[i], 1e-6);
        }
        done++;
    }
    printf("%d moves done, %.1f segments each\n", done, (double)segments / done);
    CHECK(done > MOVES / CHECK_EACH / 2);
}

/* A joint move to a pose, in each branch that is there. */
static void to_branches(const struct robot_config *c)
{
    int done = 0;

    for (int n = 0; n < 4; n++) {
        double joint[OPW_JOINTS];
        anywhere(c, joint);
        const struct pose pose = manipulator_pose(&c->arm, joint);
        for (int branch = 0; branch < OPW_BRANCHES; branch++) {
            struct robot_move m = { .kind = ROBOT_JOINTS,
                                    .share = 1.0,
                                    .target = { .pose = pose, .branch = branch } };
            struct rig_watch w = { .slowest = INFINITY };
            struct robot_refusal why;
            robot_start(&robot, c, joint);
            if (robot_move(&robot, c, &m, &why) != ROBOT_OK) {
                continue;
            }
            rig_run(c, &w);
            CHECK(w.speed <= 1.0 + 1e-6 && w.acc <= 1.0 + 1e-6);
            CHECK_EQ(manipulator_branch(&c->arm, robot.joint), branch);
            const struct pose there = manipulator_pose(&c->arm, robot.joint);
            for (int i = 0; i < 3; i++) {
                CHECK_NEAR(there.at[i], pose.at[i], 1e-6);
            }
            done++;
        }
    }
    CHECK(done > 16);
}

/* A jog goes on until something ends it, within the limits. */
static void jogs(const struct robot_config *c)
{
    for (int n = 0; n < JOGS; n += CHECK_EACH) {
        double joint[OPW_JOINTS], direction[6] = { 0.0 };
        struct rig_watch w = { .slowest = INFINITY };
        struct robot_refusal why;
        anywhere(c, joint);
        robot_start(&robot, c, joint);
        direction[n % 6] = n % 4 < 2 ? 1.0 : -1.0;
        const enum robot_frame frame = n % 5 ? ROBOT_IN_TOOL : ROBOT_IN_BASE;
        CHECK_EQ(robot_jog(&robot, c, frame, direction, 0.5, n % 6 < 3 ? 60.0 : 0.3, &why),
                 ROBOT_OK);
        rig_run(c, &w);
        CHECK(w.speed <= 1.0 + 1e-6 && w.acc <= 1.0 + 1e-3);
    }
}

/* The same arm by its lengths and by its axes has the same joints at each place of a line. */
static void as_opw(void)
{
    struct robot_config c = rig_config(), axes = c;

    by_axes(&axes.arm, &IRB, ALONG_X);
    for (int n = 0; n < 12; n++) {
        double joint[OPW_JOINTS], end[OPW_JOINTS], a[OPW_JOINTS], b[OPW_JOINTS];
        for (int i = 0; i < OPW_JOINTS; i++) {
            joint[i] = 0.5 * check_real(&seed, c.arm.joint[i].low, c.arm.joint[i].high);
            end[i] = joint[i] + check_real(&seed, -0.2, 0.2);
        }
        joint[4] = end[4] = 0.9;
        struct robot_move m = {
            .kind = ROBOT_LINE, .share = 1.0, .feed = 200.0, .target.branch = ROBOT_ANY_BRANCH
        };
        struct rig_watch w = { .slowest = INFINITY };
        struct robot_refusal why;
        m.target.pose = manipulator_pose(&c.arm, end);
        robot_start(&robot, &c, joint);
        const enum robot_status status = robot_move(&robot, &c, &m, &why);
        if (status == ROBOT_OK) {
            rig_run(&c, &w);
        }
        memcpy(a, robot.joint, sizeof a);
        const double time = w.time;
        w = (struct rig_watch){ .slowest = INFINITY };
        robot_start(&robot, &axes, joint);
        CHECK_EQ(robot_move(&robot, &axes, &m, &why), status);
        if (status == ROBOT_OK) {
            rig_run(&axes, &w);
            rig_kept(&w);
            CHECK_NEAR(w.time, time, 0.03 * time);
        }
        memcpy(b, robot.joint, sizeof b);
        for (int i = 0; i < OPW_JOINTS; i++) {
            CHECK_NEAR(a[i], b[i], 1e-9);
        }
    }
}

int main(void)
{
    const struct robot_config c = ur5e();

    bounds(&c);
    moves(&c);
    to_branches(&c);
    jogs(&c);
    as_opw();
    return check_result();
}
