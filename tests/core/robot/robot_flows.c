/* Moves that flow, at random: joints, lines, circles, splines, turns of the tool in a row, with
 * zones, stops and shares of accelerations, given at once or late, with holds, overrides, jogs and
 * aborts. In every cycle each joint keeps its speed, acceleration and jerk (a jog, which does not
 * flow, its speed and acceleration), and the tip is within the zone of the ways that were
 * programmed, which are computed here by themselves.
 *
 *     robot_flows [first number]
 */
#include <stdlib.h>

#include "robot_rig.h"

enum { MOVES = 12, WAYS = MOVES + 4, STEPS = 800, CYCLES = 600000, FAR = 8, STRIDE = 61 };

static uint64_t seed;

static double draw(double low, double high)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(seed >> 11) * 0x1p-53;
}

static bool chance(double share)
{
    return draw(0.0, 1.0) < share;
}

/* The ways as programmed, as points of the tip, and the zone at the start of each; how many. */
static double way[WAYS][STEPS + 1][3], zone_of[WAYS + 1];
static int ways;

/* Joints in every cycle so far. */
static double q[CYCLES][OPW_JOINTS];
static int cycles;

/* Cycles of jogs: their number up to each cycle. */
static int jogs[CYCLES];
static bool jogging;

static void tip(const struct robot_config *c, const double joint[OPW_JOINTS], double at[3])
{
    const struct pose p = manipulator_pose(&c->arm, joint);
    memcpy(at, p.at, sizeof p.at);
}

static void cycle(const struct robot_config *c)
{
    robot_cycle(&robot, c);
    CHECK(cycles < CYCLES);
    if (cycles < CYCLES) {
        memcpy(q[cycles], robot.joint, sizeof q[0]);
        jogs[cycles] = (cycles > 0 ? jogs[cycles - 1] : 0) + jogging;
        cycles++;
    }
}

/* Whether a jog was under way in one of the cycles that a third difference spans. */
static bool jogged(int n)
{
    const int last = n < cycles ? n : cycles - 1, first = n - 3 * FAR - 2;
    return jogs[last] > jogs[first < 0 ? 0 : first < cycles ? first : cycles - 1];
}

/* What rounding of a pose may do to a joint whose jog comes by a singular place, as robot_random
 * has it. [rad] */
static double rounding(const struct robot_config *c, int n, int joint)
{
    double most = 0.0, factor[3];

    for (int k = n - 2; k <= n; k++) {
        opw_factors(&c->arm.opw, q[k < 0 ? 0 : k < cycles ? k : cycles - 1], factor);
        const double arm = 1e-15 / fmin(fabs(factor[1]), fmin(1.0, fabs(factor[0])));
        most = fmax(most, joint > 2 ? arm / fabs(factor[2]) : arm);
    }
    return fmin(2e-5, most);
}

static const double *at_cycle(int n)
{
    return q[n < 0 ? 0 : n < cycles ? n : cycles - 1];
}

/* Largest share of speed, acceleration, jerk. The third difference is over FAR cycles: a joint is
 * known to some 1e-15 rad, which over one cycle would be 1e-3 rad/s^3. */
static double most_taken(const struct robot_config *c)
{
    const double far = FAR * CYCLE;
    double most = 0.0;

    for (int n = 0; n < cycles + 3 * FAR; n++) {
        for (int i = 0; i < OPW_JOINTS; i++) {
            const struct manipulator_joint *l = &c->arm.joint[i];
            const double x = at_cycle(n)[i], before = at_cycle(n - 1)[i];
            const double v = (x - before) / CYCLE;
            const double a = (x - 2.0 * before + at_cycle(n - 2)[i]) / CYCLE / CYCLE;
            const double j = (x - 3.0 * at_cycle(n - FAR)[i] + 3.0 * at_cycle(n - 2 * FAR)[i]
                              - at_cycle(n - 3 * FAR)[i])
                             / far / far / far;
            if (jogged(n)) {
                const double noise = rounding(c, n, i) / CYCLE;
                most = fmax(most, (fabs(v) - 2.0 * noise) / l->speed);
                most = fmax(most, (fabs(a) - 4.0 * noise / CYCLE) / l->acc);
                continue;
            }
            most = fmax(most, fmax(fabs(v) / l->speed, fabs(a) / l->acc));
            most = fmax(most, c->smooth > 0.0 ? fabs(j) * c->smooth / l->acc : 0.0);
        }
    }
    return most;
}

/* Distance from a way. [mm] */
static double off_way(const double at[3], const double (*w)[3])
{
    double least = INFINITY;

    for (int k = 0; k < STEPS; k++) {
        const double *a = w[k], *b = w[k + 1];
        double ab = 0.0, dot = 0.0, off = 0.0;
        for (int i = 0; i < 3; i++) {
            ab += (b[i] - a[i]) * (b[i] - a[i]);
            dot += (at[i] - a[i]) * (b[i] - a[i]);
        }
        const double part = ab > 0.0 ? fmin(1.0, fmax(0.0, dot / ab)) : 0.0;
        for (int i = 0; i < 3; i++) {
            off += (at[i] - a[i] - part * (b[i] - a[i])) * (at[i] - a[i] - part * (b[i] - a[i]));
        }
        least = fmin(least, off);
    }
    return sqrt(least);
}

/* How far the chords of a way leave its arc: an eighth of the largest second difference of its
 * points. [mm] */
static double sag(const double (*w)[3])
{
    double most = 0.0;

    for (int k = 1; k < STEPS; k++) {
        double square = 0.0;
        for (int i = 0; i < 3; i++) {
            const double d = w[k + 1][i] - 2.0 * w[k][i] + w[k - 1][i];
            square += d * d;
        }
        most = fmax(most, square);
    }
    return sqrt(most) / 8.0;
}

/* Largest share of the zones, besides what a curve may leave its path by and the chords' sag.
 * Ways are looked at from the last one on, until one is nearer than the largest share so far. */
static double most_off(const struct robot_config *c)
{
    static const double FIT = 1e-4;
    double most = 0.0, allowed[WAYS];
    int m = 0;

    for (int k = 0; k < ways; k++) {
        allowed[k] = fmax(zone_of[k], zone_of[k + 1]) + FIT + sag((const double(*)[3])way[k]);
    }

    for (int n = 0; n < cycles && ways > 0; n += STRIDE) {
        double at[3], off = INFINITY;
        tip(c, q[n], at);
        for (int k = 0; k < ways && off > most; k++) {
            m = k > 0 ? (m + 1) % ways : m;
            off = fmin(off, off_way(at, (const double(*)[3])way[m]) / allowed[m]);
        }
        most = fmax(most, off);
    }
    return most;
}

static struct robot_move some_move(const struct robot_config *c, const double from[OPW_JOINTS])
{
    const struct pose start = manipulator_pose(&c->arm, from);
    struct robot_move m = { .kind = (enum robot_kind)draw(0.0, 3.0), .share = draw(0.3, 1.0) };
    const bool turns = chance(0.1);

    m.feed = chance(0.5) ? draw(150.0, 2500.0) : 0.0;
    m.zone = chance(0.2) ? 0.0 : chance(0.1) ? 500.0 : draw(0.2, 60.0);
    m.part = chance(0.3) ? draw(0.01, 0.5) : 0.0;
    m.acc = chance(0.2) ? draw(0.2, 1.0) : 0.0;
    m.dec = chance(0.2) ? draw(0.2, 1.0) : 0.0;
    m.target.branch = ROBOT_ANY_BRANCH;
    m.target.pose = start;
    const double by[3] = { draw(-0.5, 0.5), draw(-0.5, 0.5), draw(-0.5, 0.5) };
    quaternion_by_vector(by, m.target.pose.turn);
    quaternion_product(m.target.pose.turn, start.turn, m.target.pose.turn);
    for (int i = 0; i < 3; i++) {
        m.target.pose.at[i] += turns ? 0.0 : draw(-300.0, 300.0);
        m.via[i] = start.at[i] + draw(-150.0, 150.0);
    }
    if (m.kind == ROBOT_JOINTS) {
        m.target.by_joints = true;
        for (int i = 0; i < OPW_JOINTS; i++) {
            const struct manipulator_joint *j = &c->arm.joint[i];
            m.target.joint[i] = fmin(j->high, fmax(j->low, from[i] + draw(-0.6, 0.6)));
        }
    }
    return m;
}

/* The points of the tip that a move programs: by straight joints, a straight line, or a circle
 * through three points, as the sum of a start and two vectors across. */
static void points_of(const struct robot_config *c, const struct robot_move *m,
                      const double from[OPW_JOINTS], double (*w)[3])
{
    double a[3], middle[3], normal[3], sweep = 0.0, joint[OPW_JOINTS];

    tip(c, from, a);
    if (m->kind == ROBOT_CIRCLE) {
        CHECK_EQ(path_tilted_by_point(a, m->via, m->target.pose.at, middle, normal, &sweep),
                 PATH_OK);
    }
    for (int k = 0; k <= STEPS; k++) {
        const double part = (double)k / STEPS;
        for (int i = 0; i < OPW_JOINTS && m->kind == ROBOT_JOINTS; i++) {
            joint[i] = from[i] + part * (m->target.joint[i] - from[i]);
        }
        if (m->kind == ROBOT_JOINTS) {
            tip(c, joint, w[k]);
            continue;
        }
        for (int i = 0; i < 3; i++) {
            const int u = (i + 1) % 3, v = (i + 2) % 3;
            const double r = a[i] - middle[i];
            const double across = normal[u] * (a[v] - middle[v]) - normal[v] * (a[u] - middle[u]);
            w[k][i] = m->kind == ROBOT_LINE
                          ? a[i] + part * (m->target.pose.at[i] - a[i])
                          : middle[i] + r * cos(part * sweep) + across * sin(part * sweep);
        }
    }
}

/* Holds, overrides and an abort, at random times; whether it is aborted. */
static bool meddle(bool aborts)
{
    if (chance(2e-4)) {
        robot_hold(&robot, true);
    } else if (chance(2e-3)) {
        robot_hold(&robot, false);
    }
    if (chance(2e-4)) {
        robot_override(&robot, chance(0.2) ? 0.0 : draw(0.05, 1.0));
    } else if (chance(1e-3)) {
        robot_override(&robot, 1.0);
    }
    if (aborts && chance(3e-4)) {
        robot_abort(&robot);
        return true;
    }
    return false;
}

/* Distance from pose to pose as a spline counts it: a radian is 100 mm. [mm] */
static double apart(const struct pose *a, const struct pose *b)
{
    double dot = 0.0, square = 0.0;

    for (int i = 0; i < 4; i++) {
        dot += a->turn[i] * b->turn[i];
    }
    const double angle = 2.0 * acos(fmin(1.0, fabs(dot)));
    for (int i = 0; i < 3; i++) {
        square += (b->at[i] - a->at[i]) * (b->at[i] - a->at[i]);
    }
    return sqrt(square + 1e4 * angle * angle);
}

/* A coordinate of the parabola through three points by Lagrange. */
static double lagrange(const double t[3], const double x[3], double at)
{
    double sum = 0.0;

    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        sum += x[k] * (at - t[i]) * (at - t[j]) / ((t[k] - t[i]) * (t[k] - t[j]));
    }
    return sum;
}

/* The points of the tip between poses 1 and 2 of four, of which the first and the last may be
 * missing. */
static void spline_points(const struct pose *const p[4], double (*w)[3])
{
    double t[4] = { 0.0, 0.0, 0.0, 0.0 }, x[4];

    t[2] = apart(p[1], p[2]);
    t[0] = p[0] ? -apart(p[0], p[1]) : 0.0;
    t[3] = p[3] ? t[2] + apart(p[2], p[3]) : 0.0;
    for (int k = 0; k <= STEPS; k++) {
        const double part = (double)k / STEPS, at = part * t[2];
        const double share = pow(part, 3) * (10.0 - 15.0 * part + 6.0 * part * part);
        for (int i = 0; i < 3; i++) {
            for (int n = 0; n < 4; n++) {
                x[n] = p[n] ? p[n]->at[i] : 0.0;
            }
            const double straight = x[1] + part * (x[2] - x[1]);
            const double first = p[0] ? lagrange(t, x, at) : 0.0;
            const double second = p[3] ? lagrange(t + 1, x + 1, at) : 0.0;
            w[k][i] = p[0] && p[3] ? first + share * (second - first)
                      : p[0]       ? first
                      : p[3]       ? second
                                   : straight;
        }
    }
}

static struct robot_config flowing(double smooth)
{
    struct robot_config c = rig_config();
    c.flow = true;
    c.smooth = smooth;
    return c;
}

/* Time of a move of joint 1 from rest to rest without a limit of jerk. [s] */
static double ramps(const struct robot_config *c, double way)
{
    const double v = c->arm.joint[0].speed, a = c->arm.joint[0].acc;
    return way > v * v / a ? way / v + v / a : 2.0 * sqrt(way / a);
}

/* A spline that goes on, but whose next move was refused: where its latest one began. */
static struct pose hanging;
static bool hangs;

/* A spline of up to four poses, each a draw from the one before; `end` becomes where it leads. Its
 * ways are kept with those of all moves. */
static void some_spline(const struct robot_config *c, double end[OPW_JOINTS], bool late)
{
    const int number = (int)draw(1.0, 5.0);
    struct pose pose[6];
    struct robot_refusal why;

    pose[0] = manipulator_pose(&c->arm, end);
    for (int k = 1; k <= number; k++) {
        struct robot_move m = some_move(c, end);
        while (m.kind == ROBOT_JOINTS) {
            m = some_move(c, end);
        }
        pose[k] = m.target.pose;
        for (int i = 0; i < 3; i++) {
            pose[k].at[i] += pose[k - 1].at[i] - pose[0].at[i];
        }
    }
    for (int k = 1; k <= number; k++) {
        struct robot_move m = some_move(c, end);
        m.kind = ROBOT_SPLINE;
        m.target.by_joints = false;
        m.target.pose = pose[k];
        m.goes_on = k < number;
        m.next = pose[k < number ? k + 1 : k];
        const struct pose *const p[4] = { k > 1   ? &pose[k - 2]
                                          : hangs ? &hanging
                                                  : NULL,
                                          &pose[k - 1], &pose[k], m.goes_on ? &pose[k + 1] : NULL };
        if (robot_move(&robot, c, &m, &why) != ROBOT_OK) {
            return;
        }
        spline_points(p, way[ways]);
        hangs = m.goes_on;
        hanging = pose[k - 1];
        zone_of[++ways] = m.goes_on ? 0.0 : m.zone;
        robot_end(&robot, end);
        for (int n = late && chance(0.3) ? (int)draw(0.0, 8000.0) : 0; n > 0; n--) {
            cycle(c);
        }
    }
}

/* A jog from rest, of the joints or in the base, and the way of it. */
static void some_jog(const struct robot_config *c, double end[OPW_JOINTS])
{
    double direction[6] = { 0.0 }, from[OPW_JOINTS];
    struct robot_refusal why;
    const enum robot_frame frame = chance(0.5) ? ROBOT_IN_JOINTS : ROBOT_IN_BASE;

    for (int n = 0; !robot_idle(&robot) && n < CYCLES; n++) {
        cycle(c);
    }
    direction[(int)draw(0.0, 6.0)] = chance(0.5) ? 1.0 : -1.0;
    memcpy(from, robot.joint, sizeof from);
    if (robot_jog(&robot, c, frame, direction, draw(0.05, 1.0), 0.0, &why) != ROBOT_OK) {
        return;
    }
    jogging = true;
    hangs = false;
    for (int n = (int)draw(1.0, 6000.0); n > 0; n--) {
        cycle(c);
    }
    robot_release(&robot);
    for (int n = 0; !robot_idle(&robot) && n < CYCLES; n++) {
        cycle(c);
    }
    jogging = false;
    robot_end(&robot, end);
    for (int k = 0; k <= STEPS; k++) {
        const double part = (double)k / STEPS;
        double joint[OPW_JOINTS], a[3], b[3];
        for (int i = 0; i < OPW_JOINTS; i++) {
            joint[i] = from[i] + part * (end[i] - from[i]);
        }
        tip(c, frame == ROBOT_IN_JOINTS ? joint : from, a);
        tip(c, frame == ROBOT_IN_JOINTS ? joint : end, b);
        for (int i = 0; i < 3; i++) {
            way[ways][k][i] = a[i] + part * (b[i] - a[i]);
        }
    }
    zone_of[++ways] = 0.0;
}

struct outcome {
    int moves, aborted;
    double taken, off, time;
};

static struct outcome sequence(int32_t number)
{
    static const double SMOOTH[] = { 0.05, 0.05, 0.02, 0.0 };
    struct robot_config c = flowing(0.0);
    struct outcome o = { .time = 0.0 };
    struct robot_refusal why;
    double end[OPW_JOINTS];
    bool aborted = false;

    seed = (uint64_t)number * 2654435761u + 17u;
    (void)draw(0.0, 1.0);
    c.smooth = SMOOTH[(int)draw(0.0, 4.0)];
    const bool meddles = chance(0.4), aborts = meddles && chance(0.5), late = chance(0.3);
    for (int i = 0; i < OPW_JOINTS; i++) {
        end[i] = 0.5 * draw(c.arm.joint[i].low, c.arm.joint[i].high);
    }
    robot_start(&robot, &c, end);
    ways = cycles = 0;
    memcpy(q[cycles++], end, sizeof end);
    jogs[0] = 0;
    hangs = false;
    zone_of[0] = 0.0;
    for (int tries = 0; ways < MOVES && tries < 3 * MOVES && !aborted; tries++) {
        if (chance(0.15)) {
            some_spline(&c, end, late);
            continue;
        }
        if (!meddles && chance(0.05)) {
            some_jog(&c, end);
            continue;
        }
        const struct robot_move m = some_move(&c, end);
        if (robot_move(&robot, &c, &m, &why) == ROBOT_OK) {
            hangs = false;
            points_of(&c, &m, end, way[ways]);
            zone_of[++ways] = m.zone;
            robot_end(&robot, end);
        }
        for (int n = late && chance(0.5) ? (int)draw(0.0, 8000.0) : 0; n > 0; n--) {
            cycle(&c);
            aborted = (meddles && meddle(aborts)) || aborted;
        }
    }
    while (!robot_idle(&robot) && cycles < CYCLES) {
        cycle(&c);
        aborted = (meddles && meddle(aborts)) || aborted;
    }
    cycle(&c);
    CHECK(!robot.lost);
    for (int i = 0; i < OPW_JOINTS && !aborted; i++) {
        CHECK_NEAR(robot.joint[i], end[i], 1e-9);
    }
    o.moves = ways;
    o.aborted = aborted;
    o.taken = most_taken(&c);
    o.off = most_off(&c);
    o.time = cycles * CYCLE;
    if (!(o.taken <= 1.0 + 1e-6 && o.off <= 1.0)) {
        printf("sequence %d: %.9f of a limit, %.6f of a zone, smooth %g\n", (int)number, o.taken,
               o.off, c.smooth);
    }
    return o;
}

/* Two moves of joint 1, the second of which goes on as the first does, take the time of one; with a
 * stop between them that of two. */
static void straight_on(void)
{
    const struct robot_config c = flowing(0.0);
    struct robot_refusal why;

    for (int n = 0; n < 2; n++) {
        struct robot_move m = { .kind = ROBOT_JOINTS, .share = 1.0, .zone = n == 0 ? 1.0 : 0.0 };
        double time = 0.0;
        robot_start(&robot, &c, (double[OPW_JOINTS]){ 0.0, 0.0, 0.0, 0.0, 1.0, 0.0 });
        m.target.by_joints = true;
        m.target.joint[4] = 1.0;
        for (int k = 1; k <= 2; k++) {
            m.target.joint[0] = 0.5 * k;
            CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_OK);
        }
        for (; !robot_idle(&robot); time += CYCLE) {
            robot_cycle(&robot, &c);
        }
        CHECK_NEAR(robot.joint[0], 1.0, 1e-12);
        CHECK_NEAR(time, n == 0 ? ramps(&c, 1.0) : 2.0 * ramps(&c, 0.5), 1e-3 * time + 2.0 * CYCLE);
    }
}

/* Share of the speed that is reached with any share of the acceleration. */
static const double SLOW = 0.4;

/* Largest acceleration of joint 1 that speeds it up, and slows it down, on a move there from rest,
 * over its own limit, with these shares. Returns its time. [s] */
static double shared(const struct robot_config *c, double way, double acc, double dec,
                     double most[2])
{
    struct robot_move m = { .kind = ROBOT_JOINTS, .share = SLOW, .acc = acc, .dec = dec };
    struct robot_refusal why;
    double time = 0.0;

    most[0] = most[1] = 0.0;
    robot_start(&robot, c, (double[OPW_JOINTS]){ 0.0, 0.0, 0.0, 0.0, 1.0, 0.0 });
    m.target.by_joints = true;
    m.target.joint[0] = way;
    m.target.joint[4] = 1.0;
    CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OK);
    for (; !robot_idle(&robot); time += CYCLE) {
        robot_cycle(&robot, c);
        const double share = robot.gain[0] / c->arm.joint[0].acc;
        most[share < 0.0] = fmax(most[share < 0.0], fabs(share));
    }
    CHECK_NEAR(robot.joint[0], way, 1e-12);
    return time;
}

/* Shares of the accelerations, by look-ahead and as moves flow: each ramp has its own, and takes as
 * much longer; on a curve the joints' start and end have them, too. */
static void accelerations(void)
{
    static const double SHARE[][2] = { { 1.0, 1.0 }, { 0.5, 0.0 }, { 0.0, 0.3 }, { 0.2, 0.7 } };

    for (int n = 0; n < 16; n++) {
        const double *share = SHARE[n / 4];
        struct robot_config c = flowing(n & 1 ? 0.05 : 0.0);
        c.flow = (n & 2) != 0;
        const double v = SLOW * c.arm.joint[0].speed, a = c.arm.joint[0].acc, way = 2.0;
        const double acc = share[0] > 0.0 ? share[0] : 1.0, dec = share[1] > 0.0 ? share[1] : 1.0;
        /* a ramp takes v / a and, with a limit of jerk, as long as that takes to a */
        const double rises = c.smooth * (acc + dec);
        const double time = way / v + 0.5 * (v / acc + v / dec) / a + 0.5 * rises;
        double most[2];
        CHECK_NEAR(shared(&c, way, share[0], share[1], most), time, 2e-3 * time);
        CHECK_NEAR(most[0], acc, 2e-3);
        CHECK_NEAR(most[1], dec, 2e-3);
    }
}

/* Lines with shares: what the tool, or where moves flow the joints, take from rest and to it. */
static void lines_shared(void)
{
    static const double from[] = { 900.0, -300.0, 800.0 }, to[] = { 900.0, 300.0, 800.0 },
                        abc[] = { 180.0, 0.0, 180.0 };
    struct robot_refusal why;

    for (int flow = 0; flow < 2; flow++) {
        double most[2] = { 0.0, 0.0 }, before = 0.0;
        struct robot_config c = flowing(0.02);
        struct robot_move m = rig_line(to, abc, 200.0);
        c.flow = flow == 1;
        c.acc = 1000.0;
        m.acc = 0.25;
        m.dec = 0.6;
        rig_start(&c, from, abc);
        CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_OK);
        while (!robot_idle(&robot)) {
            robot_cycle(&robot, &c);
            const bool ends = robot.pose.at[1] > 0.0;
            double share = fabs(robot.speed - before) / CYCLE / c.acc;
            for (int i = 0; flow && i < OPW_JOINTS; i++) {
                const double a = fabs(robot.gain[i]) / c.arm.joint[i].acc;
                share = i == 0 ? a : fmax(share, a);
            }
            before = robot.speed;
            most[ends] = fmax(most[ends], share);
        }
        /* 200 mm/s bend the joints' ways a little, and bounds count with the worst of a part */
        CHECK(most[0] <= 0.25 * 1.02 && most[0] >= 0.25 * 0.93);
        CHECK(most[1] <= 0.6 * 1.02 && most[1] >= 0.6 * 0.93);
    }
}

/* A square corner of two lines leaves them as an arc of its radius does, and by no more than its
 * part of the shorter one; the curve is off by so much where it is nearest to the corner. */
static void radius(void)
{
    const struct robot_config c = flowing(0.02);
    static const double from[] = { 900.0, 0.0, 800.0 }, abc[] = { 180.0, 0.0, 180.0 };
    static const double to[2][3] = { { 1100.0, 0.0, 800.0 }, { 1100.0, 150.0, 800.0 } };
    struct robot_refusal why;

    for (int n = 0; n < 3; n++) {
        const double r = n == 0 ? 30.0 : 20.0, part = n == 2 ? 0.1 : 0.0;
        double off = 1e9;
        rig_start(&c, from, abc);
        for (int k = 0; k < 2; k++) {
            struct robot_move m = rig_line(to[k], abc, 0.0);
            m.zone = m.radius = k == 0 ? r : 0.0;
            m.part = part;
            CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_OK);
        }
        while (!robot_idle(&robot)) {
            robot_cycle(&robot, &c);
            const double x = robot.pose.at[0] - 1100.0, y = robot.pose.at[1];
            off = fmin(off, hypot(x, y));
            CHECK(n < 2 || (x > -20.0 || fabs(y) < 1e-3));
        }
        /* on the bisector an arc is r (sqrt 2 - 1) from the corner */
        CHECK(n == 2 ? off < 5.0 : fabs(off - r * (sqrt(2.0) - 1.0)) < 0.02 * r);
    }
}

/* Poses of a row; a spline through those from `first` on, after a line to that, or from rest. */
enum { ROW = 6 };

static void row_of(struct pose pose[ROW])
{
    static const double xyz[ROW][3] = {
        { 900, -300, 700 }, { 1000, -180, 760 }, { 930, -60, 800 },
        { 980, 90, 700 },   { 900, 200, 720 },   { 850, 330, 800 }
    };
    static const double abc[ROW][3] = { { 180, 0, 180 },  { 180, 10, 170 }, { 170, 10, 180 },
                                        { 180, -5, 190 }, { 185, 0, 180 },  { 180, 0, 160 } };

    for (int k = 0; k < ROW; k++) {
        pose[k] = pose_of(xyz[k], abc[k]);
    }
}

static struct robot_move spline_to(const struct pose pose[ROW], int k, int last, double feed)
{
    struct robot_move m = { .kind = ROBOT_SPLINE, .share = 1.0, .feed = feed };

    m.target.branch = ROBOT_ANY_BRANCH;
    m.target.pose = pose[k];
    m.goes_on = k < last;
    m.next = pose[k < last ? k + 1 : k];
    return m;
}

/* A spline passes its poses, with their attitudes, without a stop between them, keeps its feed from
 * below, and has no corner: the tip's speed turns no quicker than its bends say. */
static void splines(void)
{
    struct robot_config c = flowing(0.02);
    struct pose pose[ROW];
    struct robot_refusal why;
    double off[ROW], turned[ROW], least = INFINITY, most = 0.0;

    row_of(pose);
    c.spin = 6.0;
    for (int k = 0; k < ROW; k++) {
        off[k] = turned[k] = INFINITY;
    }
    double joint[OPW_JOINTS] = { 0.0, 0.0, 0.0, 0.0, 0.5, 0.0 };
    int which;
    CHECK_EQ(manipulator_solve(&c.arm, &pose[0], 1, NULL, joint, &which), MANIPULATOR_OK);
    robot_start(&robot, &c, joint);
    ways = cycles = 0;
    zone_of[0] = 0.0;
    for (int k = 1; k < ROW; k++) {
        const struct robot_move m = spline_to(pose, k, ROW - 1, 80.0);
        const struct pose *const p[4] = { k > 1 ? &pose[k - 2] : NULL, &pose[k - 1], &pose[k],
                                          m.goes_on ? &pose[k + 1] : NULL };
        CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_OK);
        spline_points(p, way[ways]);
        zone_of[++ways] = 0.0;
    }
    while (!robot_idle(&robot)) {
        cycle(&c);
        for (int k = 0; k < ROW; k++) {
            double dot = 0.0, square = 0.0;
            for (int i = 0; i < 3; i++) {
                square += pow(robot.pose.at[i] - pose[k].at[i], 2);
            }
            for (int i = 0; i < 4; i++) {
                dot += robot.pose.turn[i] * pose[k].turn[i];
            }
            if (sqrt(square) < off[k]) {
                off[k] = sqrt(square);
                turned[k] = 2.0 * acos(fmin(1.0, fabs(dot)));
            }
        }
        if (off[0] < 1e-2 && off[1] < 0.02 && off[ROW - 1] > 100.0) {
            least = fmin(least, robot.speed);
        }
        most = fmax(most, robot.speed);
    }
    for (int k = 0; k < ROW; k++) {
        CHECK(off[k] < 0.02 && turned[k] < 1e-3); /* half a cycle's way beside it */
    }
    /* a piece has the feed of its slowest place, and from one to the next the jerk counts */
    CHECK(least >= 0.95 * 80.0 && most <= 80.0 * (1.0 + 1e-4));
    CHECK(most_taken(&c) <= 1.0 + 1e-6);
    CHECK(most_off(&c) <= 1.0);
}

/* What a spline is refused for, and nothing has moved. */
static void splines_refused(void)
{
    struct robot_config c = flowing(0.02);
    struct pose pose[ROW];
    struct robot_refusal why;

    row_of(pose);
    struct robot_move m = spline_to(pose, 1, 2, 100.0);
    rig_start(&c, (double[3]){ 900, -300, 700 }, (double[3]){ 180, 0, 180 });
    m.next = m.target.pose;
    CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_NO_SPLINE);
    m = spline_to(pose, 0, 1, 100.0);
    CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_NO_SPLINE);
    m = spline_to(pose, 1, 2, 100.0);
    m.target.pose.at[2] = 2500.0;
    CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_FAR);
    CHECK(why.part > 0.1 && why.part < 1.0 && why.place[2] > 1000.0 && why.place[2] < 2500.0);
    m = spline_to(pose, 1, 2, 100.0);
    c.arm.joint[0].high = -0.25; /* 900, -300 is at -0.32, 1000, -180 at -0.18 */
    CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_OUTSIDE);
    CHECK(why.which == 0 && why.limit == -0.25 && why.value > -0.25 && why.value < -0.24);
    c = flowing(0.02);
    m.feed = 2500.0;
    m.singular = ROBOT_REFUSE;
    c.arm.joint[0].speed = 0.5;
    CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_SINGULAR);
    c = flowing(0.02);
    m = spline_to(pose, 1, 2, 100.0);
    m.target.branch = OPW_ELBOW;
    CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_OTHER_BRANCH);
    CHECK(robot_idle(&robot));
    m.target.branch = ROBOT_ANY_BRANCH;
    CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_OK);
}

/* A line keeps its feed from below within 2 %, once it is up to it, and the corner to a slower one
 * is as slow as that. */
static void feeds(void)
{
    const struct robot_config c = flowing(0.02);
    static const double from[] = { 500.0, -700.0, 600.0 }, abc[] = { 180.0, 0.0, 180.0 };
    static const double to[2][3] = { { 500.0, 700.0, 600.0 }, { 700.0, 700.0, 600.0 } };
    struct robot_refusal why;
    double least = INFINITY, most = 0.0, slow = 0.0;

    rig_start(&c, from, abc);
    for (int k = 0; k < 2; k++) {
        struct robot_move m = rig_line(to[k], abc, k == 0 ? 400.0 : 20.0);
        m.zone = k == 0 ? 20.0 : 0.0;
        CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_OK);
    }
    while (!robot_idle(&robot)) {
        robot_cycle(&robot, &c);
        double part;
        const double *at = robot.pose.at, off = rig_off(at, from, to[0], &part);
        const double second = rig_off(at, to[0], to[1], &part);
        if (off < 1e-3 && fabs(at[1]) < 500.0) {
            least = fmin(least, robot.speed);
            most = fmax(most, robot.speed);
        } else if (off > 0.1 && second > 0.1) { /* in the corner */
            slow = fmax(slow, robot.speed);
        }
    }
    CHECK(least >= 0.98 * 400.0 && most <= 400.0 * (1.0 + 1e-6));
    CHECK(slow > 10.0 && slow <= 20.4);
}

/* A corner from a joint move, whose way is bent, into a line: by the chords of that way it had left
 * it by 1.006 of its zone. */
enum { BENT = 44640 };

int main(int argc, char **argv)
{
    const int32_t first = argc > 2 ? atoi(argv[1]) : 0, number = argc > 2 ? atoi(argv[2]) : 16;
    struct outcome all = { .time = 0.0 };

    straight_on();
    accelerations();
    lines_shared();
    radius();
    feeds();
    splines();
    splines_refused();
    CHECK(sequence(BENT).off <= 1.0);
    for (int32_t n = first; n < first + number; n += argc > 2 ? 1 : CHECK_EACH) {
        const struct outcome o = sequence(n);
        all.moves += o.moves;
        all.aborted += o.aborted;
        all.taken = fmax(all.taken, o.taken);
        all.off = fmax(all.off, o.off);
        all.time += o.time;
    }
    printf("%d moves, %.1f s, %d aborted: at most %.9f of a limit, %.6f of a zone\n", all.moves,
           all.time, all.aborted, all.taken, all.off);
    CHECK(all.taken <= 1.0 + 1e-6);
    CHECK(all.off <= 1.0);
    return check_result();
}
