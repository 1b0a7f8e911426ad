/* A track under the arm and a table beside it, at random: moves of joints, lines, turns, moves by
 * the wrist, arcs, with holds, overrides, aborts. In every cycle the arm and the axis keep their
 * speeds and accelerations, the tip is on its line in the world, which is computed here by itself,
 * and in a move of the joints each has gone the same part of its way. What is refused is said, and
 * jogs end at the range. */
#include "robot_rig.h"

static uint64_t seed = 1;

static double draw(double low, double high)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(seed >> 11) * 0x1p-53;
}

static bool chance(double share)
{
    return draw(0.0, 1.0) < share;
}

/* A track of 4 m on a slope, 1600 pulses a mm. */
static struct robot_config track(void)
{
    struct robot_config c = rig_config();
    c.external =
        (struct external){ EXTERNAL_TRACK, -2.0, 2.0, 1.5, 2.5, { 0.6, -0.64, 0.48 }, 1.6e6 };
    return c;
}

static struct robot_config table(void)
{
    struct robot_config c = rig_config();
    c.external = (struct external){
        .kind = EXTERNAL_TABLE, .low = -3.0, .high = 3.0, .speed = 2.0, .acc = 5.0, .scale = 1e5
    };
    return c;
}

/* The tip in the world by the joints and the axis alone. */
static void tip(const struct robot_config *c, double at[3])
{
    struct manipulator arm = c->arm;
    arm.tool = robot.tool;
    const struct pose p = manipulator_pose(&arm, robot.joint);
    for (int i = 0; i < 3; i++) {
        const double shift = 1000.0 * robot.external * c->external.along[i];
        at[i] = p.at[i] + (c->external.kind == EXTERNAL_TRACK ? shift : 0.0);
    }
}

/* Shares of the axis's limits since they were set to 0; the joints and the axis in each cycle. */
static struct {
    double speed, acc, before, was;
    int cycles;
} seen;

enum { CYCLES = 200000 };
static double place[CYCLES][OPW_JOINTS + 1];

static void watch(const struct robot_config *c, struct rig_watch *w)
{
    rig_cycle(c, w);
    const double rate = (robot.external - seen.was) / CYCLE;
    double at[3];
    seen.speed = fmax(seen.speed, fabs(rate) / c->external.speed);
    seen.acc = fmax(seen.acc, fabs(rate - seen.before) / CYCLE / c->external.acc);
    CHECK_NEAR(robot.external_rate, rate, 1e-12);
    seen.before = rate;
    seen.was = robot.external;
    if (seen.cycles < CYCLES) {
        memcpy(place[seen.cycles], robot.joint, sizeof robot.joint);
        place[seen.cycles++][OPW_JOINTS] = robot.external;
    }
    tip(c, at);
    for (int i = 0; i < 3; i++) {
        CHECK_NEAR(robot.pose.at[i], at[i], 1e-6);
    }
}

/* Every joint and the axis have gone the same part of their ways, in every cycle. */
static void in_step(const double from[OPW_JOINTS + 1])
{
    const double *to = place[seen.cycles - 1];
    int most = 0;

    CHECK(seen.cycles < CYCLES);
    for (int i = 1; i <= OPW_JOINTS; i++) {
        most = fabs(to[i] - from[i]) > fabs(to[most] - from[most]) ? i : most;
    }
    for (int n = 0; n < seen.cycles; n++) {
        const double part = (place[n][most] - from[most]) / (to[most] - from[most]);
        for (int i = 0; i <= OPW_JOINTS; i++) {
            CHECK_NEAR(place[n][i], from[i] + part * (to[i] - from[i]), 1e-9);
        }
    }
}

/* Run to rest, with what an operator does. Whether it was aborted. */
static bool ride(const struct robot_config *c, struct rig_watch *w)
{
    const bool quiet = chance(0.5);
    bool aborted = false;

    robot_override(&robot, 1.0);
    for (int n = 0; n < 2000000 && !robot_idle(&robot); n++) {
        if (!quiet && n % 997 == 0) {
            robot_hold(&robot, chance(0.3));
            robot_override(&robot, draw(0.05, 1.0));
        }
        if (!quiet && !aborted && n > 0 && chance(5e-5)) {
            robot_abort(&robot);
            aborted = true;
        }
        watch(c, w);
    }
    robot_hold(&robot, false);
    CHECK(robot_idle(&robot) && !robot.lost);
    return aborted;
}

static struct robot_move random_move(const struct robot_config *c)
{
    const double xyz[3] = { draw(700.0, 1100.0), draw(-400.0, 400.0), draw(300.0, 800.0) };
    const double abc[3] = { draw(150.0, 210.0), draw(-20.0, 20.0), draw(-60.0, 60.0) };
    struct robot_move m = rig_line(xyz, abc, draw(50.0, 2500.0));

    m.kind = chance(0.3) ? ROBOT_JOINTS : ROBOT_LINE;
    m.share = draw(0.1, 1.0);
    m.zone = chance(0.3) ? 20.0 : 0.0;
    m.acc = chance(0.3) ? 0.5 : 0.0;
    m.singular = chance(0.1) ? ROBOT_WRIST : ROBOT_SLOW;
    m.target.beside = chance(0.85) ? c->external.kind : EXTERNAL_NONE;
    m.target.external = draw(c->external.low, c->external.high);
    const double end = m.target.beside ? m.target.external : robot_end_external(&robot);
    external_to_world(&c->external, end, m.target.pose.at);
    if (chance(0.1)) { /* the tip stays where it is in the world, or nearly */
        memcpy(m.target.pose.at, robot.pose.at, sizeof m.target.pose.at);
    }
    return m;
}

static void rides(const struct robot_config *c, int moves)
{
    static const double start[3] = { 900.0, 0.0, 500.0 }, down[3] = { 180.0, 0.0, 0.0 };
    struct robot_refusal why;
    int done = 0, lines = 0, aborted = 0;

    rig_start(c, start, down);
    robot_place(&robot, c, draw(-1.0, 1.0));
    for (int n = 0; n < moves; n++) {
        struct rig_watch w = { .noise = 2.0 * NOISE };
        const struct robot_move m = random_move(c);
        const struct pose from = robot.pose;
        const double way = m.target.external - robot.external;
        double before[OPW_JOINTS + 1];
        memcpy(before, robot.joint, sizeof robot.joint);
        before[OPW_JOINTS] = robot.external;
        const enum robot_status status = robot_move(&robot, c, &m, &why);
        if (status != ROBOT_OK) {
            CHECK(status == ROBOT_FAR || status == ROBOT_OUTSIDE || status == ROBOT_SINGULAR);
            CHECK(robot_idle(&robot));
            continue;
        }
        memset(&seen, 0, sizeof seen);
        seen.was = robot.external;
        const bool line = m.kind == ROBOT_LINE && m.singular != ROBOT_WRIST;
        double off = 0.0, part;
        for (int i = 0; i < 3; i++) {
            off += (m.target.pose.at[i] - from.at[i]) * (m.target.pose.at[i] - from.at[i]);
        }
        if (line && off > 1.0) { /* along the way of the world */
            robot_override(&robot, draw(0.3, 1.0));
            while (!robot_idle(&robot)) {
                watch(c, &w);
                CHECK_NEAR(rig_off(robot.pose.at, from.at, m.target.pose.at, &part), 0.0, 1e-6);
                CHECK(robot.speed <= m.feed * (1.0 + 1e-9));
                if (m.target.beside && fabs(way) > 0.1) { /* the track goes in step */
                    CHECK_NEAR((robot.external - (m.target.external - way)) / way, part, 1e-6);
                }
            }
            lines++;
        } else if (ride(c, &w)) {
            aborted++;
            CHECK(seen.speed <= 1.0 + 1e-9 && seen.acc <= 1.0 + 1e-3);
            continue;
        }
        CHECK(seen.speed <= 1.0 + 1e-9 && seen.acc <= 1.0 + 1e-3);
        CHECK(w.speed <= 1.0 && w.acc <= 1.0 + 1e-3);
        CHECK_NEAR(robot.external, m.target.beside ? m.target.external : seen.was, 1e-12);
        for (int i = 0; i < 3; i++) {
            CHECK_NEAR(robot.pose.at[i], m.target.pose.at[i], 1e-6);
        }
        if (m.kind == ROBOT_JOINTS) {
            in_step(before);
        }
        done++;
    }
    printf("%d moves, %d lines, %d aborted\n", done, lines, aborted);
    CHECK(done > moves / 2 && lines > moves / 8 && aborted > 0);
}

/* What the axis alone takes for its way: trapezoid and S ramps, by the closed form. */
static void alone(void)
{
    const struct robot_config c = track();
    static const double joint[OPW_JOINTS] = { 0.0, 0.0, 0.0, 0.0, 0.5, 0.0 };
    struct robot_move m = { .kind = ROBOT_JOINTS, .share = 1.0, .target.by_joints = true };
    struct robot_refusal why;
    struct rig_watch w = { 0 };

    robot_start(&robot, &c, joint);
    memcpy(m.target.joint, joint, sizeof joint);
    m.target.beside = c.external.kind;
    m.target.external = 2.0;
    memset(&seen, 0, sizeof seen);
    CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_OK);
    while (!robot_idle(&robot)) {
        watch(&c, &w);
    }
    CHECK_NEAR(w.time, 2.0 / 1.5 + 1.5 / 2.5 + c.smooth, 2.0 * CYCLE);
    CHECK(seen.speed > 0.999 && seen.acc > 0.999);
    for (int i = 0; i < OPW_JOINTS; i++) {
        CHECK(robot.joint[i] == joint[i]);
    }

    /* A line along with the track: the arm stands, the tip keeps its feed. */
    struct robot_move along = { .kind = ROBOT_LINE, .feed = 500.0, .target.pose = robot.pose };
    along.target.branch = ROBOT_ANY_BRANCH;
    along.target.beside = c.external.kind;
    along.target.external = 0.5;
    external_to_world(&c.external, -1.5, along.target.pose.at);
    memset(&w, 0, sizeof w);
    memset(&seen, 0, sizeof seen);
    seen.was = robot.external;
    CHECK_EQ(robot_move(&robot, &c, &along, &why), ROBOT_OK);
    while (!robot_idle(&robot)) {
        watch(&c, &w);
    }
    CHECK_NEAR(w.time, 1500.0 / 500.0 + 0.5 / 2.5 + c.smooth, 2.0 * CYCLE);
    for (int i = 0; i < OPW_JOINTS; i++) {
        CHECK_NEAR(robot.joint[i], joint[i], 1e-9);
    }
}

/* What is refused, and that nothing moves then. */
static void refused(void)
{
    struct robot_config c = track();
    const double joint[OPW_JOINTS] = { 0.0, 0.0, 0.0, 0.0, 0.5, 0.0 };
    struct robot_move m = { .kind = ROBOT_JOINTS, .share = 1.0, .target.by_joints = true };
    struct robot_refusal why;

    robot_start(&robot, &c, joint);
    memcpy(m.target.joint, joint, sizeof joint);
    m.target.beside = c.external.kind;
    m.target.external = -2.25;
    CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_OUTSIDE);
    CHECK(why.which == OPW_JOINTS && why.slides && why.value == -2.25 && why.limit == -2.0);
    m.target.external = NAN;
    CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_PARAMETER);

    struct robot_move arc = { .kind = ROBOT_ARC, .centre = { 0.0, 0.0, 0.0 }, .sweep = 1.0 };
    memcpy(arc.centre, robot.pose.at, sizeof arc.centre);
    arc.centre[0] -= 100.0;
    arc.normal[2] = 1.0;
    arc.target.pose = robot.pose;
    arc.target.branch = ROBOT_ANY_BRANCH;
    arc.target.beside = c.external.kind;
    arc.target.external = 0.25;
    CHECK_EQ(robot_move(&robot, &c, &arc, &why), ROBOT_BESIDE);
    arc.target.external = 0.0;
    CHECK_EQ(robot_move(&robot, &c, &arc, &why), ROBOT_OK);
    robot_stop(&robot);

    c = table();
    robot_start(&robot, &c, joint);
    arc.target.beside = c.external.kind;
    arc.target.external = 0.25;
    CHECK_EQ(robot_move(&robot, &c, &arc, &why), ROBOT_OK);
    struct rig_watch w = { 0 };
    double off = 0.0;
    while (!robot_idle(&robot)) {
        rig_cycle(&c, &w);
        const double x = robot.pose.at[0] - arc.centre[0], y = robot.pose.at[1] - arc.centre[1];
        off = fmax(off, fabs(sqrt(x * x + y * y) - 100.0));
    }
    CHECK(off < 1e-6 && w.speed <= 1.0 && w.acc <= 1.0 + 1e-3);
    CHECK_NEAR(robot.external, 0.25, 1e-12);

    m.target.external = 0.0;
    CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_NO_JOINT); /* a table is no track */
    c = rig_config();
    robot_start(&robot, &c, joint);
    CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_NO_JOINT);
    CHECK(why.which == OPW_JOINTS && why.limit == 6.0);
}

/* A jog of the axis goes as far as it can, an increment that far, and a jog of the tip from a place
 * of the track is as from any. */
static void jogs(void)
{
    const struct robot_config c = track();
    static const double joint[OPW_JOINTS] = { 0.0, 0.0, 0.0, 0.0, 0.5, 0.0 };
    static const double up[6] = { 1.0 }, down[6] = { -1.0 }, x[6] = { 1.0 };
    struct robot_refusal why;
    struct rig_watch w = { 0 };

    robot_start(&robot, &c, joint);
    robot_place(&robot, &c, 1.5);
    memset(&seen, 0, sizeof seen);
    seen.was = robot.external;
    CHECK_EQ(robot_jog(&robot, &c, ROBOT_IN_EXTERNAL, up, 1.0, 0.0, &why), ROBOT_OK);
    rig_run(&c, &w);
    CHECK_NEAR(robot.external, 2.0, 1e-12);
    robot_release(&robot);
    CHECK_EQ(robot_jog(&robot, &c, ROBOT_IN_EXTERNAL, up, 1.0, 0.0, &why), ROBOT_OUTSIDE);
    CHECK_EQ(robot_jog(&robot, &c, ROBOT_IN_EXTERNAL, down, 0.5, 0.25, &why), ROBOT_OK);
    rig_run(&c, &w);
    CHECK_NEAR(robot.external, 1.75, 1e-12);
    const struct pose from = robot.pose;
    CHECK_EQ(robot_jog(&robot, &c, ROBOT_IN_BASE, x, 0.5, 10.0, &why), ROBOT_OK);
    rig_run(&c, &w);
    CHECK_NEAR(robot.pose.at[0], from.at[0] + 10.0, 1e-6);
    CHECK_NEAR(robot.pose.at[1], from.at[1], 1e-6);
    CHECK_NEAR(robot.external, 1.75, 1e-12);
}

/* Moves that flow wait for one in which the track moves, and that for them. */
static void flows(void)
{
    struct robot_config c = track();
    static const double at[3] = { 900.0, 0.0, 500.0 }, turn[3] = { 180.0, 0.0, 0.0 };
    struct robot_refusal why;
    struct rig_watch w = { 0 };
    int given = 0;

    c.flow = true;
    rig_start(&c, at, turn);
    memset(&seen, 0, sizeof seen);
    for (int n = 0; n < 200000 && (given < 6 || !robot_idle(&robot)); n++) {
        const double to[3] = { 900.0 + 600.0 * (given / 2), 100.0 * (given % 2), 500.0 };
        struct robot_move m = rig_line(to, turn, 800.0);
        m.zone = 10.0;
        m.target.beside = c.external.kind;
        m.target.external = 1.0 * (given / 2 % 2);
        if (given < 6 && given / 2 < 2) {
            const enum robot_status status = robot_move(&robot, &c, &m, &why);
            CHECK(status == ROBOT_OK || status == ROBOT_BUSY);
            given += status == ROBOT_OK;
        } else if (given < 6) {
            given = 6;
        }
        watch(&c, &w);
    }
    CHECK(robot_idle(&robot) && !robot.lost && given == 6);
    CHECK_NEAR(robot.external, 1.0, 1e-12);
    CHECK_NEAR(robot.pose.at[0], 1500.0, 1e-4);
    CHECK_NEAR(robot.pose.at[1], 100.0, 1e-4);
    CHECK(w.speed <= 1.0 && w.acc <= 1.0 + 1e-3 && seen.speed <= 1.0 + 1e-9
          && seen.acc <= 1.0 + 1e-3);
}

int main(void)
{
    struct robot_config c = track();
    rides(&c, 60);
    c.smooth = 0.0;
    rides(&c, 30);
    c = table();
    rides(&c, 30);
    alone();
    refused();
    jogs();
    flows();
    return check_result();
}
