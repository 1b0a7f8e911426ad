/* Arms of four joints, a SCARA, palletizers whose linkage keeps the tool level, a gantry: lines,
 * arcs, moves of joints, jogs at random, by formulas of their own. Every joint keeps speed,
 * acceleration and range in every cycle, the tip its way; places that are not there stay 0; an
 * attitude that the arm has not is refused with its tilt. */
#include "bounds.h"
#include "robot_rig.h"

enum { FOUR = 4, MOVES = 36, PARTS = 45, PLACES = 24 };

/* What a cycle may exceed a limit by. */
static const double SHARE = 1e-6, RANGE = 1e-9;

static const double TURN = 6.283185307179586;

static uint64_t seed = 4;

/* Where the tip is [mm], and how far it is turned about z [rad], for joints [rad] [m]. */
typedef void tip_of(const double q[FOUR], double at[3], double *turn);

/* Its joints, near to others. False: out of reach. */
typedef bool joints_of(const double at[3], double turn, double q[FOUR]);

struct arm {
    const char *name;
    struct chain chain;
    double low[FOUR], high[FOUR], speed[FOUR], acc[FOUR]; /* [rad] [m] */
    tip_of *tip;
    joints_of *joints;
};

/* The tool hangs so far beside axis 4 and below. [mm] */
static const double ASIDE = 40.0, BELOW = 120.0;

/* Links of the SCARA; of the palletizer axis 2 from axis 1, upper arm, forearm, pivot to flange. */
static const double SCARA_1 = 325.0, SCARA_2 = 275.0, OUT = 260.0, UPPER = 900.0, FORE = 1100.0,
                    HAND = 200.0; /* [mm] */
static const double HIGH_1 = 300.0, HIGH_2 = 800.0;

static void tool_at(double turn, double at[3])
{
    at[0] += ASIDE * cos(turn);
    at[1] += ASIDE * sin(turn);
    at[2] -= BELOW;
}

static void scara_tip(const double q[FOUR], double at[3], double *turn)
{
    at[0] = SCARA_1 * cos(q[0]) + SCARA_2 * cos(q[0] + q[1]);
    at[1] = SCARA_1 * sin(q[0]) + SCARA_2 * sin(q[0] + q[1]);
    at[2] = HIGH_1 + 1e3 * q[2];
    *turn = q[0] + q[1] - q[3];
    tool_at(*turn, at);
}

static void near_turn(double *q, double near)
{
    *q += TURN * round((near - *q) / (TURN));
}

static bool scara_joints(const double at[3], double turn, double q[FOUR])
{
    const double x = at[0] - ASIDE * cos(turn), y = at[1] - ASIDE * sin(turn);
    const double cosine =
        (x * x + y * y - SCARA_1 * SCARA_1 - SCARA_2 * SCARA_2) / (2.0 * SCARA_1 * SCARA_2);
    const double near[FOUR] = { q[0], q[1], q[2], q[3] };
    if (fabs(cosine) > 1.0) {
        return false;
    }
    q[1] = copysign(acos(cosine), near[1]);
    q[0] = atan2(y, x) - atan2(SCARA_2 * sin(q[1]), SCARA_1 + SCARA_2 * cosine);
    near_turn(&q[0], near[0]);
    q[2] = 1e-3 * (at[2] + BELOW - HIGH_1);
    q[3] = q[0] + q[1] - turn;
    near_turn(&q[3], near[3]);
    return true;
}

static void palletizer_tip(const double q[FOUR], double at[3], double *turn)
{
    const double out = OUT + UPPER * sin(q[1]) + FORE * cos(q[1] + q[2]);
    at[0] = out * cos(q[0]);
    at[1] = out * sin(q[0]);
    at[2] = HIGH_2 + UPPER * cos(q[1]) - FORE * sin(q[1] + q[2]) - HAND;
    *turn = q[0] + q[3];
    tool_at(*turn, at);
}

static bool palletizer_joints(const double at[3], double turn, double q[FOUR])
{
    const double x = at[0] - ASIDE * cos(turn), y = at[1] - ASIDE * sin(turn);
    const double out = hypot(x, y) - OUT, up = at[2] + BELOW + HAND - HIGH_2;
    const double sine = (UPPER * UPPER + FORE * FORE - out * out - up * up) / (2.0 * UPPER * FORE);
    const double near[FOUR] = { q[0], q[1], q[2], q[3] };
    if (fabs(sine) > 1.0) {
        return false;
    }
    q[0] = atan2(y, x);
    near_turn(&q[0], near[0]);
    q[2] = asin(sine); /* the forearm square to the upper arm, at most a quarter of a turn off */
    const double along = UPPER - FORE * sin(q[2]), across = FORE * cos(q[2]);
    q[1] = atan2(out * along - up * across, out * across + up * along);
    near_turn(&q[1], near[1]);
    q[3] = turn - q[0];
    near_turn(&q[3], near[3]);
    return true;
}

/* The same with a forearm that a rod turns from the base: joint 3 is its own tilt, upwards. */
static void driven_tip(const double q[FOUR], double at[3], double *turn)
{
    const double serial[FOUR] = { q[0], q[1], -q[2] - q[1], q[3] };
    palletizer_tip(serial, at, turn);
}

static bool driven_joints(const double at[3], double turn, double q[FOUR])
{
    q[2] = -q[2] - q[1];
    const bool there = palletizer_joints(at, turn, q);
    q[2] = -q[2] - q[1];
    return there;
}

static void gantry_tip(const double q[FOUR], double at[3], double *turn)
{
    for (int i = 0; i < 3; i++) {
        at[i] = 1e3 * q[i];
    }
    at[2] += HIGH_1;
    *turn = q[3];
    tool_at(*turn, at);
}

static bool gantry_joints(const double at[3], double turn, double q[FOUR])
{
    q[0] = 1e-3 * (at[0] - ASIDE * cos(turn));
    q[1] = 1e-3 * (at[1] - ASIDE * sin(turn));
    q[2] = 1e-3 * (at[2] + BELOW - HIGH_1);
    near_turn(&turn, q[3]);
    q[3] = turn;
    return true;
}

static const struct arm ARMS[] = {
    { "scara",
      { .joints = FOUR,
        .joint = { { .origin = { 0, 0, .3 }, .axis = { 0, 0, 1 } },
                   { .origin = { .325, 0, 0 }, .axis = { 0, 0, 1 } },
                   { .origin = { .275, 0, .1 }, .axis = { 0, 0, 1 }, .slides = true },
                   { .origin = { 0, 0, -.05 }, .axis = { 0, 0, -1 } } },
        .flange = { { 0, 0, -.05 }, { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } } },
      { -2.3, -2.5, -.2, -6.28 },
      { 2.3, 2.5, 0, 6.28 },
      { 7, 12, 1.1, 35 },
      { 40, 60, 15, 200 },
      scara_tip,
      scara_joints },
    { "palletizer",
      { .joints = FOUR,
        .joint = { { .origin = { 0, 0, .5 }, .axis = { 0, 0, 1 } },
                   { .origin = { .26, 0, .3 }, .axis = { 0, 1, 0 } },
                   { .origin = { 0, 0, .9 }, .axis = { 0, 1, 0 } },
                   { .origin = { 1.1, 0, 0 }, .axis = { 0, 0, 1 }, .level = 2 } },
        .flange = { { 0, 0, -.2 }, { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } } },
      { -3, -.7, -1.2, -6.28 },
      { 3, 1.3, 1.2, 6.28 },
      { 2.4, 2.0, 2.2, 6 },
      { 6, 5, 6, 25 },
      palletizer_tip,
      palletizer_joints },
    { "palletizer driven from the base",
      { .joints = FOUR,
        .joint = { { .origin = { 0, 0, .5 }, .axis = { 0, 0, 1 } },
                   { .origin = { .26, 0, .3 }, .axis = { 0, 1, 0 } },
                   { .origin = { 0, 0, .9 }, .axis = { 0, -1, 0 }, .level = 1 },
                   { .origin = { 1.1, 0, 0 }, .axis = { 0, 0, 1 }, .level = 2 } },
        .flange = { { 0, 0, -.2 }, { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } } },
      { -3, -.3, -.7, -6.28 },
      { 3, .6, .5, 6.28 },
      { 2.4, 2.0, 2.2, 6 },
      { 6, 5, 6, 25 },
      driven_tip,
      driven_joints },
    { "gantry",
      { .joints = FOUR,
        .joint = { { .origin = { 0, 0, .2 }, .axis = { 1, 0, 0 }, .slides = true },
                   { .origin = { 0, 0, .1 }, .axis = { 0, 1, 0 }, .slides = true },
                   { .axis = { 0, 0, 1 }, .slides = true },
                   { .axis = { 0, 0, 1 } } },
        .flange = { { 0, 0, 0 }, { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } } },
      { -1, -.6, -.5, -6.28 },
      { 1, .6, 0, 6.28 },
      { 1.5, 1.2, .8, 8 },
      { 4, 5, 6, 60 },
      gantry_tip,
      gantry_joints },
};

static struct robot_config config_of(const struct arm *a)
{
    struct robot_config c = rig_config();

    CHECK(chain_good(&a->chain));
    chain_form_of(&a->chain, CHAIN_NONE, &c.arm.axes);
    CHECK(c.arm.axes.kind != CHAIN_ITERATED);
    c.arm.by_axes = true;
    for (int i = 0; i < FOUR; i++) {
        c.arm.joint[i] =
            (struct manipulator_joint){ a->low[i], a->high[i], a->speed[i], a->acc[i] };
        c.scale[i] = 50000.0;
    }
    c.arm.tool = pose_none();
    c.arm.tool.at[0] = ASIDE;
    c.arm.tool.at[2] = -BELOW;
    return c;
}

static void anywhere(const struct arm *a, double joint[OPW_JOINTS])
{
    memset(joint, 0, OPW_JOINTS * sizeof *joint);
    do {
        for (int i = 0; i < FOUR; i++) {
            joint[i] = check_real(&seed, 0.9 * a->low[i] + 0.1 * a->high[i],
                                  0.1 * a->low[i] + 0.9 * a->high[i]);
        }
    } while (a->tip == scara_tip && fabs(joint[1]) < 0.1);
}

/* The tip by the arm's own formula is where the robot says that it is. */
static void placed(const struct arm *a)
{
    double at[3], turn, by[3];

    a->tip(robot.joint, at, &turn);
    quaternion_vector(robot.pose.turn, by);
    near_turn(&turn, by[2]);
    CHECK_NEAR(by[0], 0.0, 1e-9);
    CHECK_NEAR(by[1], 0.0, 1e-9);
    CHECK(fabs(turn - by[2]) < 1e-9 || fabs(fabs(turn - by[2]) - TURN) < 1e-9);
    for (int i = 0; i < 3; i++) {
        CHECK_NEAR(robot.pose.at[i], at[i], 1e-8);
    }
}

/* Drive to rest; joints' rates and accelerations are differences of where they are. A tip on a line
 * a - b has to stay there. */
static void driven(const struct arm *a, const struct robot_config *c, const double *from,
                   const double *to)
{
    double before[OPW_JOINTS], rate[OPW_JOINTS] = { 0.0 }, part, at[3], turn;
    bool good = true;

    memcpy(before, robot.joint, sizeof before);
    for (int n = 0; n < 600000 && !robot_idle(&robot); n++) {
        robot_cycle(&robot, c);
        for (int i = 0; i < FOUR; i++) {
            const double now = (robot.joint[i] - before[i]) / CYCLE;
            /* rounding of a joint in two differences */
            const double noise = 4e-16 * fmax(1.0, fabs(robot.joint[i])) / CYCLE;
            good = good && fabs(now) <= a->speed[i] * (1.0 + SHARE) + noise;
            good = good && fabs(now - rate[i]) <= a->acc[i] * CYCLE * (1.0 + SHARE) + 2.0 * noise;
            good =
                good && robot.joint[i] <= a->high[i] + RANGE && robot.joint[i] >= a->low[i] - RANGE;
            rate[i] = now;
            before[i] = robot.joint[i];
        }
        good = good && robot.joint[4] == 0.0 && robot.joint[5] == 0.0;
        if (from) {
            a->tip(robot.joint, at, &turn);
            good = good && rig_off(at, from, to, &part) < 1e-6;
        }
    }
    CHECK(good);
    CHECK(robot_idle(&robot) && !robot.lost);
    placed(a);
}

/* A line or an arc from anywhere to anywhere. */
static struct robot_move some_path(const struct arm *a, const struct robot_config *c, int n,
                                   double share)
{
    struct robot_move m = { .kind = n % 3 ? ROBOT_LINE : ROBOT_CIRCLE,
                            .share = 1.0,
                            .feed = pow(10.0, check_real(&seed, 1.7, 3.4)),
                            .target.branch = ROBOT_ANY_BRANCH };
    double joint[OPW_JOINTS], end[OPW_JOINTS];

    anywhere(a, joint);
    anywhere(a, end);
    for (int i = 0; i < FOUR; i++) {
        end[i] = joint[i] + share * (end[i] - joint[i]);
    }
    robot_start(&robot, c, joint);
    m.target.pose = manipulator_pose(&c->arm, end);
    for (int i = 0; i < 3; i++) {
        m.via[i] = 0.5 * (robot.pose.at[i] + m.target.pose.at[i]) + check_real(&seed, -60.0, 60.0);
    }
    return m;
}

/* Whether samples with the arm's own formulas find a way along a line, far within its limits. */
static bool possible(const struct arm *a, const struct robot_move *m)
{
    double q[FOUR], from[3], at[3], before, after, by[3];

    memcpy(q, robot.joint, sizeof q);
    a->tip(q, from, &before);
    quaternion_vector(m->target.pose.turn, by);
    after = by[2];
    near_turn(&after, before);
    for (int n = 0; n <= 400; n++) {
        double last[FOUR];
        memcpy(last, q, sizeof last);
        for (int i = 0; i < 3; i++) {
            at[i] = from[i] + n / 400.0 * (m->target.pose.at[i] - from[i]);
        }
        if (!a->joints(at, before + n / 400.0 * (after - before), q)) {
            return false;
        }
        for (int i = 0; i < FOUR; i++) {
            if (q[i] > a->high[i] - 0.01 || q[i] < a->low[i] + 0.01 || fabs(q[i] - last[i]) > 0.1) {
                return false;
            }
        }
    }
    return true;
}

static void paths(const struct arm *a, const struct robot_config *c)
{
    int done = 0, refused = 0;

    for (int n = 0; n < MOVES; n += CHECK_EACH) {
        const struct robot_move m = some_path(a, c, n, n % 2 ? 0.3 : 1.0);
        const struct pose start = robot.pose;
        struct robot_refusal why;
        const bool line = m.kind == ROBOT_LINE, could = line && possible(a, &m);
        if (robot_move(&robot, c, &m, &why) != ROBOT_OK) {
            CHECK(!could);
            refused++;
            continue;
        }
        driven(a, c, line ? start.at : NULL, m.target.pose.at);
        for (int i = 0; i < 3; i++) {
            CHECK_NEAR(robot.pose.at[i], m.target.pose.at[i], 1e-7);
        }
        done++;
    }
    printf("%s: %d paths, %d refused\n", a->name, done, refused);
    CHECK(done > MOVES / CHECK_EACH / 3);
}

/* Moves of joints: to joints, and to poses in each branch. */
static void joint_moves(const struct arm *a, const struct robot_config *c)
{
    for (int n = 0; n < MOVES / 4; n += CHECK_EACH) {
        struct robot_move m = { .kind = ROBOT_JOINTS, .share = check_real(&seed, 0.2, 1.0) };
        double joint[OPW_JOINTS];
        struct robot_refusal why;
        anywhere(a, joint);
        robot_start(&robot, c, joint);
        anywhere(a, m.target.joint);
        m.target.by_joints = n % 2 == 0;
        m.target.pose = manipulator_pose(&c->arm, m.target.joint);
        m.target.branch = manipulator_branch(&c->arm, m.target.joint);
        CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OK);
        driven(a, c, NULL, NULL);
        for (int i = 0; i < FOUR && m.target.by_joints; i++) {
            CHECK_NEAR(robot.joint[i], m.target.joint[i], 1e-12);
        }
        for (int i = 0; i < 3; i++) {
            CHECK_NEAR(robot.pose.at[i], m.target.pose.at[i], 1e-7);
        }
    }
}

static void jogs(const struct arm *a, const struct robot_config *c)
{
    int done = 0;

    for (int n = 0; n < MOVES / 2; n += CHECK_EACH) {
        static const int OF[4] = { 0, 1, 2, 5 }; /* the coordinates that such an arm has */
        const enum robot_frame frame = (enum robot_frame)(n % 3);
        double joint[OPW_JOINTS], direction[6] = { 0.0 };
        struct robot_refusal why;
        anywhere(a, joint);
        robot_start(&robot, c, joint);
        direction[frame == ROBOT_IN_JOINTS ? n / 3 % 4 : OF[n / 3 % 4]] = n % 2 ? 1.0 : -1.0;
        if (robot_jog(&robot, c, frame, direction, 1.0, 0.0, &why) == ROBOT_OK) {
            driven(a, c, NULL, NULL);
            done++;
        }
        direction[4] = 1.0;
        CHECK_EQ(robot_jog(&robot, c, frame, direction, 1.0, 0.0, &why),
                 frame == ROBOT_IN_JOINTS ? ROBOT_NO_JOINT : ROBOT_TILTED);
        CHECK(robot_idle(&robot));
    }
    CHECK(done > MOVES / CHECK_EACH / 3);
}

/* What the arm has not is refused, and says what that is. */
static void refused(const struct arm *a, const struct robot_config *c)
{
    static const double TILT = 0.02;
    struct robot_move m = { .kind = ROBOT_LINE, .share = 1.0, .target.branch = ROBOT_ANY_BRANCH };
    double joint[OPW_JOINTS] = { 0.3, 0.4, -0.1, 0.2 }, by[3] = { 0.0, TILT, 0.0 }, q[4];
    struct robot_refusal why;

    robot_start(&robot, c, joint);
    m.target.pose = robot.pose;
    quaternion_by_vector(by, q);
    quaternion_product(q, m.target.pose.turn, m.target.pose.turn);
    for (int kind = 0; kind < 2; kind++) {
        m.kind = kind ? ROBOT_LINE : ROBOT_JOINTS;
        CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_TILTED);
        CHECK_NEAR(why.value, TILT, 1e-12);
    }
    m.target = (struct robot_target){ .by_joints = true };
    m.target.joint[4] = 0.1;
    CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_NO_JOINT);
    CHECK(why.which == 4 && why.limit == FOUR);
    m.target.joint[4] = 0.0;
    m.target.joint[2] = 5.0;
    m.kind = ROBOT_JOINTS;
    CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OUTSIDE);
    CHECK(why.which == 2 && why.value == 5.0 && why.slides == a->chain.joint[2].slides);
    /* A flag of a branch that the arm has not says nothing. */
    m.kind = ROBOT_LINE;
    m.target = (struct robot_target){ .pose = robot.pose };
    m.target.branch = manipulator_branch(&c->arm, joint) | OPW_FLIP;
    m.target.pose.at[0] -= 10.0;
    CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OK);
}

/* Joints at a part of the path by the arm's own formulas. */
static void own_joints(const struct arm *a, const struct arm_geometry *g, double part,
                       double q[FOUR])
{
    double place[AXES], slope[AXES], none[AXES] = { 0.0 }, by[3];
    struct pose pose;

    path_at(&robot.tool_path.path, part * robot.tool_path.path.length, place, slope);
    arm_moves_pose(g, place, none, &pose);
    quaternion_vector(pose.turn, by);
    CHECK(a->joints(pose.at, by[2], q));
}

/* Nowhere on a part are the bounds exceeded, and on a short one they are what the joints have. */
static void bounds(const struct arm *a, const struct robot_config *c)
{
    static const double H = 0.02; /* [mm] */
    int known = 0, close = 0, paths = 0;

    for (int n = 0; n < PARTS; n += CHECK_EACH) {
        const struct robot_move m = some_path(a, c, n, 0.3);
        struct robot_refusal why;
        if (robot_move(&robot, c, &m, &why) != ROBOT_OK || robot.tool_path.path.length < 1.0) {
            continue;
        }
        const struct arm_geometry g = { &c->arm, &robot.moves };
        const double length = robot.tool_path.path.length, room = 1.5 * H / length;
        const double size = pow(2.0, -floor(check_real(&seed, 3.0, 9.0)));
        const double from = size * floor(check_real(&seed, 0.0, 1.0 / size));
        double q[OPW_JOINTS], middle[OPW_JOINTS] = { 0.0 };
        struct bounds b, narrow;
        paths++;
        memcpy(q, robot.joint, sizeof q);
        for (int k = 0; k <= 256; k++) {
            own_joints(a, &g, (from + 0.5 * size) * k / 256, q);
        }
        memcpy(middle, q, FOUR * sizeof *q);
        const double at = fmax(room, fmin(1.0 - room, from + 0.5 * size)), tiny = 0.01 / length;
        const bool short_one =
            bounds_of(&g, &robot.tool_path.path, at - tiny, at + tiny, middle, &narrow);
        if (!bounds_of(&g, &robot.tool_path.path, from, from + size, middle, &b)) {
            continue;
        }
        known++;
        bool all = short_one;
        for (int k = 0; k <= PLACES; k++) {
            const double part = k < PLACES ? from + size * k / (PLACES - 1) : at;
            const double place = fmax(room, fmin(1.0 - room, part));
            double s[3][FOUR];
            for (int j = 0; j < 3; j++) {
                memcpy(s[j], middle, sizeof s[j]);
                own_joints(a, &g, place + (j - 1) * H / length, s[j]);
            }
            for (int i = 0; i < FOUR; i++) { /* 1e-9: rounding of the differences */
                const double slope = fabs(s[2][i] - s[0][i]) / (2.0 * H);
                const double bend = fabs(s[2][i] - 2.0 * s[1][i] + s[0][i]) / (H * H);
                CHECK(slope <= b.most.slope[i] * (1.0 + 1e-4) + 1e-9);
                CHECK(bend <= b.most.bend[i] * (1.0 + 1e-2) + 1e-8);
                all = all
                      && (k < PLACES
                          || (narrow.most.slope[i] <= slope * 1.02 + 1e-6
                              && narrow.most.bend[i] <= bend * 1.2 + 1e-6));
            }
        }
        CHECK(b.most.slope[4] == 0.0 && b.most.bend[5] == 0.0);
        close += all;
    }
    printf("%s: %d paths, %d with bounds, %d close\n", a->name, paths, known, close);
    CHECK(known > paths / 2 && close > known / 2 && paths > PARTS / CHECK_EACH / 3);
}

int main(void)
{
    for (size_t n = 0; n < sizeof ARMS / sizeof *ARMS; n++) {
        const struct robot_config c = config_of(&ARMS[n]);
        bounds(&ARMS[n], &c);
        paths(&ARMS[n], &c);
        joint_moves(&ARMS[n], &c);
        jogs(&ARMS[n], &c);
        refused(&ARMS[n], &c);
    }
    return check_result();
}
