/* Paths with corners, circles in any plane, moves of the joints among them. */
#include "robot_rig.h"

static const double BENT[OPW_JOINTS] = { 0.1, 0.2, 0.1, 0.1, 1.0, 0.3 };
static uint64_t seed = 7;

/* Angle between two attitudes. [rad] */
static double turned(const double a[4], const double b[4])
{
    double q[4], v[3];
    quaternion_inverse(a, q);
    quaternion_product(q, b, q);
    quaternion_vector(q, v);
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* A polyline whose tool turns on each of its lines: within the zone of it, and in the limits of the
 * joints; with no zone it stops at each corner. */
static void polyline(const struct robot_config *c, int k)
{
    enum { LINES = 6 };
    struct rig_watch w = { 0 };
    struct robot_refusal why;
    double at[LINES + 1][3], abc[LINES + 1][3], far = 0.0, near[LINES + 1], jerked = 0.0;
    const double zone = k % 4 ? check_real(&seed, 0.5, 20) : 0.0;
    const double feed = check_real(&seed, 20, 800);
    int stops = 0;

    robot_start(&robot, c, BENT);
    memcpy(at[0], robot.pose.at, sizeof at[0]);
    quaternion_angles(robot.pose.turn, abc[0]);
    for (int n = 1; n <= LINES; n++) {
        const int turns = k % 3 == 1 || (k % 3 == 2 && n % 2); /* all lines, or each other one */
        for (int i = 0; i < 3; i++) {
            at[n][i] = at[0][i] + check_real(&seed, -150, 150);
            abc[n][i] = abc[0][i] + check_real(&seed, -20, 20) * turns;
        }
        struct robot_move m = rig_line(at[n], abc[n], feed);
        m.zone = zone;
        m.line = n;
        CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OK);
        near[n] = INFINITY;
    }
    struct pose before = robot.pose;
    bool moved = false;
    while (!robot_idle(&robot)) {
        double best = INFINITY, part;
        rig_cycle(c, &w);
        for (int n = 0; n < LINES; n++) {
            const double off = rig_off(robot.pose.at, at[n], at[n + 1], &part);
            best = part > -1e-9 && part < 1.0 + 1e-9 ? fmin(best, off) : best;
            rig_off(robot.pose.at, at[n + 1], at[n], &part);
            double d[3];
            for (int i = 0; i < 3; i++) {
                d[i] = robot.pose.at[i] - at[n + 1][i];
            }
            near[n + 1] = fmin(near[n + 1], sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
        }
        far = fmax(far, best);
        const double turn = turned(before.turn, robot.pose.turn);
        jerked = fmax(jerked, turn / (c->spin * CYCLE));
        stops += moved && robot.speed < 2.0;
        moved = robot.speed > 5.0 || (moved && robot.speed >= 2.0);
        before = robot.pose;
    }
    rig_kept(&w);
    CHECK(far <= zone + 1e-9 && (zone == 0.0 || far > 0.1 * zone));
    CHECK(jerked <= 1.0 + 1e-3);
    CHECK_EQ(robot.line, LINES);
    for (int n = 1; n <= LINES; n++) {
        CHECK(near[n] <= zone + 1e-3 && (zone == 0.0 || n == LINES || near[n] > 1e-2 * zone));
    }
    CHECK(zone > 0.0 || stops >= LINES - 1);
    const struct pose end = pose_of(at[LINES], abc[LINES]);
    CHECK(turned(end.turn, robot.pose.turn) < 1e-9);
}

/* A circle in any plane: at its radius, through its point, at the feed. */
static void circles(const struct robot_config *c)
{
    for (int k = 0; k < 30; k += CHECK_EACH) {
        struct robot_refusal why;
        struct rig_watch w = { 0 };
        struct robot_move m = { .kind = k % 2 ? ROBOT_ARC : ROBOT_CIRCLE, .feed = 150.0 };
        double u[3], v[3], off = 0.0, missed = INFINITY, feed = 0.0, q[4];
        const double r = check_real(&seed, 30, 120), sweep = check_real(&seed, 0.5, 6.2);
        const double by[3] = { check_real(&seed, -2, 2), check_real(&seed, -2, 2),
                               check_real(&seed, -2, 2) };
        robot_start(&robot, c, BENT);
        quaternion_by_vector(by, q);
        quaternion_turn(q, (double[]){ 1, 0, 0 }, u);
        quaternion_turn(q, (double[]){ 0, 1, 0 }, v);
        quaternion_turn(q, (double[]){ 0, 0, 1 }, m.normal);
        for (int i = 0; i < 3; i++) {
            m.centre[i] = robot.pose.at[i] - r * u[i];
            m.via[i] = m.centre[i] + r * (u[i] * cos(0.4 * sweep) + v[i] * sin(0.4 * sweep));
            m.target.pose.at[i] = m.centre[i] + r * (u[i] * cos(sweep) + v[i] * sin(sweep));
        }
        m.sweep = sweep;
        m.target.branch = ROBOT_ANY_BRANCH;
        const double turn[3] = { 0.1, 0.2 * (k % 3), -0.1 };
        quaternion_by_vector(turn, q);
        quaternion_product(q, robot.pose.turn, m.target.pose.turn);
        CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OK);
        while (!robot_idle(&robot)) {
            double d[3], height = 0.0, to = 0.0, radius = 0.0;
            rig_cycle(c, &w);
            const struct pose p = manipulator_pose(&c->arm, robot.joint);
            for (int i = 0; i < 3; i++) {
                d[i] = p.at[i] - m.centre[i];
                height += d[i] * m.normal[i];
                radius += d[i] * d[i];
                to += (p.at[i] - m.via[i]) * (p.at[i] - m.via[i]);
            }
            off = fmax(off, hypot(height, sqrt(radius) - r));
            missed = fmin(missed, sqrt(to));
            feed = fmax(feed, robot.speed);
        }
        rig_kept(&w);
        CHECK(off < 1e-8 && missed < 150.0 * CYCLE && feed < 150.0 + 1e-6 && feed > 100.0);
        CHECK_NEAR(robot.length, r * sweep, 1e-3 * r * sweep);
        for (int i = 0; i < 3; i++) {
            CHECK_NEAR(robot.pose.at[i], m.target.pose.at[i], 1e-8);
        }
        CHECK(turned(m.target.pose.turn, robot.pose.turn) < 1e-9);
    }
    struct robot_move m = { .kind = ROBOT_CIRCLE };
    struct robot_refusal why;
    robot_start(&robot, c, BENT);
    m.target.pose = robot.pose;
    m.target.branch = ROBOT_ANY_BRANCH;
    memcpy(m.via, robot.pose.at, sizeof m.via);
    m.via[0] += 10.0;
    m.target.pose.at[0] += 20.0;
    CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_NO_CIRCLE);
}

/* An arc whose centre is not in the plane through its start would be no circle. */
static void no_arcs(const struct robot_config *c)
{
    static const double heights[] = { 5e-7, 2e-6, -0.1, 50.0, -1e8 };
    struct robot_refusal why;

    for (int n = 0; n < 5; n++) {
        for (int k = 0; k < 3; k++) {
            struct robot_move m = { .kind = ROBOT_ARC, .feed = 100.0, .sweep = 1.0 };
            robot_start(&robot, c, BENT);
            const struct robot before = robot;
            m.target.pose = robot.pose;
            m.target.branch = ROBOT_ANY_BRANCH;
            m.normal[k] = 1.0;
            memcpy(m.centre, robot.pose.at, sizeof m.centre);
            m.centre[k] -= heights[n];
            m.centre[(k + 1) % 3] += 40.0;
            CHECK_EQ(robot_move(&robot, c, &m, &why), n == 0 ? ROBOT_OK : ROBOT_OFF_PLANE);
            if (n > 0) {
                CHECK_NEAR(why.value, heights[n], 1e-9 + 1e-12 * fabs(heights[n]));
                CHECK(why.limit > 0.0 && why.limit < fabs(why.value));
                CHECK(memcmp(&before, &robot, sizeof robot) == 0);
            }
            m.centre[k] = robot.pose.at[k];
            m.normal[k] = 1.01;
            robot_start(&robot, c, BENT);
            CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_NO_UNIT);
            CHECK(why.value == 1.01 && why.limit == 1.0);
        }
    }
}

/* Joints, a line, a circle, wrist, joints in a row, given as they fit: each ends where it should */
static void mixed(const struct robot_config *c)
{
    struct robot_refusal why;
    struct rig_watch w = { 0 };
    robot_start(&robot, c, BENT);
    const struct pose home = robot.pose;
    for (int n = 0; n < 12; n++) {
        struct robot_move m = {
            .feed = 300.0, .share = 0.5, .zone = n % 2 ? 3.0 : 0.0, .line = n + 1
        };
        m.target.branch = ROBOT_ANY_BRANCH;
        m.target.pose = home;
        m.target.pose.at[n % 3] += 20.0 + 5.0 * n;
        for (int i = 0; i < 3; i++) {
            m.via[i] = home.at[i] - 30.0 * (i == 1) + 11.0 * n * (i == 2);
        }
        m.kind = n % 4 == 0 ? ROBOT_JOINTS : n % 4 == 2 ? ROBOT_CIRCLE : ROBOT_LINE;
        m.singular = n % 6 == 5 ? ROBOT_WRIST : ROBOT_SLOW;
        while (!robot_ready(&robot)) {
            rig_cycle(c, &w);
        }
        CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OK);
        double end[OPW_JOINTS];
        robot_end(&robot, end);
        const struct pose p = manipulator_pose(&c->arm, end);
        for (int i = 0; i < 3; i++) {
            CHECK_NEAR(p.at[i], m.target.pose.at[i], 1e-8);
        }
        CHECK(turned(m.target.pose.turn, p.turn) < 1e-8);
    }
    rig_run(c, &w);
    rig_kept(&w);
    CHECK_EQ(robot.line, 12);
}

/* A thousand short lines: the ring is full, moves wait, look-ahead keeps the speed. */
static void many(const struct robot_config *c)
{
    struct robot_refusal why;
    struct rig_watch w = { 0 };
    int given = 0, full = 0;
    robot_start(&robot, c, BENT);
    const struct pose home = robot.pose;
    while (given < 1000 || !robot_idle(&robot)) {
        while (given < 1000 && robot_ready(&robot)) {
            struct robot_move m = { .kind = ROBOT_LINE, .feed = 100.0, .zone = 0.05 };
            const double angle = 6.283185307179586 * ++given / 500.0;
            m.line = given;
            m.target.branch = ROBOT_ANY_BRANCH;
            m.target.pose = home;
            m.target.pose.at[0] += 50.0 * (1.0 - cos(angle));
            m.target.pose.at[1] += 50.0 * sin(angle);
            CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OK);
        }
        full += given < 1000;
        rig_cycle(c, &w);
        const double r = hypot(robot.pose.at[0] - home.at[0] - 50.0, robot.pose.at[1] - home.at[1]);
        CHECK(fabs(r - 50.0) < 0.051);
    }
    rig_kept(&w);
    CHECK(full > 1000);
    CHECK_NEAR(robot.length, 628.3, 0.1);
    CHECK(w.time > 628.3 / 100.0 && w.time < 1.4 * 628.3 / 100.0);
}

/* Two lines whose corner is where joint 5 stands at an angle: the time they take with a zone there,
 * and with a stop. [s] */
static double time_by_a_corner(double fifth, enum robot_singular singular, double zone)
{
    const double from[] = { 0.1, 0.2, 0.1, 0.0, 0.6, 0.0 }, to[] = { 0.3, 0.3, 0.2, 0.1, 0.5, 0.0 };
    const double corner[] = { 0.2, 0.3, 0.0, 0.0, fifth, 0.0 };
    const struct robot_config c = rig_config();
    struct rig_watch w = { .slowest = 1e9, .noise = NOISE };
    struct robot_refusal why;

    robot_start(&robot, &c, from);
    for (int n = 0; n < 2; n++) {
        struct robot_move m = { .kind = ROBOT_LINE,
                                .feed = 300.0,
                                .share = 1.0,
                                .zone = n == 0 ? zone : 0.0,
                                .singular = n == 0 ? singular : ROBOT_SLOW };
        m.target.pose = manipulator_pose(&c.arm, n == 0 ? corner : to);
        m.target.branch = ROBOT_ANY_BRANCH;
        CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_OK);
    }
    rig_run(&c, &w);
    CHECK(w.speed <= 1.0 + 1e-6 && w.acc <= 1.0 + 1e-3);
    return w.time;
}

/* A corner's acceleration may have any direction, and beside a singular place the joints leave next
 * to none of it: the path slows down at its end only, and stops there if it would crawl. A line by
 * the wrist joins none behind it, so its zone asks for nothing. */
static void corners_beside_the_wrist(void)
{
    static const double FIFTH[] = { 0.3, 0.03, 3e-3, 3e-4, 3e-5 };

    for (size_t k = 0; k < sizeof FIFTH / sizeof *FIFTH; k++) {
        for (int by_wrist = 0; by_wrist < 2; by_wrist++) {
            const enum robot_singular singular = by_wrist ? ROBOT_WRIST : ROBOT_SLOW;
            const double rest = time_by_a_corner(FIFTH[k], singular, 0.0);
            const double zone = time_by_a_corner(FIFTH[k], singular, 1.0);
            CHECK(zone <= 1.6 * rest);
        }
    }
}

int main(void)
{
    const struct robot_config c = rig_config();

    struct robot_config weak = c; /* its joints decide in corners */
    for (int i = 0; i < OPW_JOINTS; i++) {
        weak.arm.joint[i].acc *= 0.2;
    }
    weak.smooth = 0.0;
    for (int k = 0; k < 16; k += CHECK_EACH) {
        polyline(&c, k);
        polyline(&weak, k);
    }
    circles(&c);
    no_arcs(&c);
    mixed(&c);
    many(&c);
    corners_beside_the_wrist();
    return check_result();
}
