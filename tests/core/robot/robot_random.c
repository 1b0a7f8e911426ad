/* Moves of joints, lines, lines by the wrist, jogs and chains of lines and arcs with zones, drawn
 * at random from fixed seeds: every joint keeps speed, acceleration and range in every cycle. A
 * path is refused, and a jog ends, only where samples of another kind find no way on, either.
 *
 *     robot_random [FIRST COUNT]      COUNT seeds from FIRST on; 0 200 without
 */
#include <stdlib.h>

#include "robot_rig.h"

/* What a cycle may exceed a limit by; of a joint's range [rad]. */
static const double SHARE = 1e-6, RANGE = 1e-9;

/* Rounding of a pose, of its length of about a metre; joints have that over the factor of a
 * singular place, so wrist and arm both. None has more than MOST, at the place itself. [rad] */
static const double ROUNDING = 1e-15, MOST = 2e-5;

/* Seeds that have broken a limit: a wrist's move that begins where joint 5's sine is 1.3e-4. That
 * have ended too early: a jog that turns by 1800 rad while its tip goes by 1 mm. */
static const int32_t FOUND[] = { 548, 17883 };

/* Chains that have: one whose line by the wrist crawled for a corner that none could join. */
static const int32_t FOUND_CHAINS[] = { 7217 };

/* Even samples along a path; how often the way between two is halved: to 1e-14 of the path. */
enum { SAMPLES = 2000, FINEST = 36 };

/* A drawn speed passes its path in this time, if nothing slows it: standstill, ramps and slow
 * places are what finds faults, and an even speed has none of them. [s] */
static const double LONGEST = 2.0;

/* A jog that has ended cannot go on by this. [mm] or [rad] */
static const double BEYOND = 1e-5;

/* A jog that only turns goes no further. [rad] */
static const double TURNS = 12.566370614359172;

/* Joints that come to the same place by two ways. [rad] */
static const double SAME = 1e-6;

/* Share of the joints' ranges in which a move begins; in which a chain does, which is longer, and
 * how large its paths are: so that most can be driven. */
static const double ROOM = 0.9, CHAIN_ROOM = 0.6, CHAIN_SIZE = 0.6;

static uint64_t seed;

static double real(double low, double high)
{
    return check_real(&seed, low, high);
}

static bool chance(double share)
{
    return real(0.0, 1.0) < share;
}

static struct robot_config random_config(void)
{
    struct robot_config c = rig_config();

    c.smooth = chance(0.3) ? 0.0 : chance(0.3) ? 0.2 : c.smooth;
    const double weak = chance(0.3) ? 0.1 : 1.0; /* then joints decide, not the path */
    for (int i = 0; i < OPW_JOINTS; i++) {
        c.arm.joint[i].acc *= weak;
    }
    c.arm.tool.at[0] = chance(0.3) ? real(-200.0, 200.0) : 0.0;
    c.arm.tool.at[2] = chance(0.3) ? real(0.0, 400.0) : 150.0;
    return c;
}

static double norm3(const double a[3])
{
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

static double apart(const double a[3], const double b[3])
{
    const double d[3] = { a[0] - b[0], a[1] - b[1], a[2] - b[2] };

    return norm3(d);
}

/* A line of any speed whose ends are up to a radian apart in each joint, times `size`. */
static struct robot_move random_line(const struct robot_config *c, const double from[OPW_JOINTS],
                                     double size)
{
    struct robot_move m = { .kind = ROBOT_LINE,
                            .share = 1.0,
                            .feed = pow(10.0, real(1.0, 3.4)),
                            .singular = chance(0.2) ? ROBOT_WRIST : ROBOT_SLOW,
                            .target.branch = ROBOT_ANY_BRANCH };
    const struct pose start = manipulator_pose(&c->arm, from);
    double to[OPW_JOINTS];

    size *= pow(10.0, real(-1.5, 0.0));
    for (int i = 0; i < OPW_JOINTS; i++) {
        to[i] = from[i] + size * real(-1.0, 1.0);
    }
    to[5] += chance(0.3) ? real(-2.0, 2.0) : 0.0;
    m.target.pose = manipulator_pose(&c->arm, to);
    m.feed = fmax(m.feed, apart(start.at, m.target.pose.at) / LONGEST);
    return m;
}

/* A path by itself: its tip from the start along a line, or about a centre as an arc does. */
struct drawn {
    struct pose start, to;
    bool arc;
    double centre[3], normal[3], sweep;
    double first[OPW_JOINTS]; /* [rad] joints at its start, */
    double last[OPW_JOINTS];  /* and to which those of the wrist go straight */
    bool by_wrist;
};

static struct pose drawn_at(const struct drawn *d, double part)
{
    struct pose p;
    double by[3], q[4], out[3];

    for (int i = 0; i < 3; i++) {
        p.at[i] = d->start.at[i] + part * (d->to.at[i] - d->start.at[i]);
        by[i] = part * d->sweep * d->normal[i];
        out[i] = d->start.at[i] - d->centre[i];
    }
    if (d->arc) {
        quaternion_by_vector(by, q);
        quaternion_turn(q, out, out);
        for (int i = 0; i < 3; i++) {
            p.at[i] = d->centre[i] + out[i];
        }
    }
    quaternion_slerp(d->start.turn, d->to.turn, part, p.turn);
    return p;
}

/* Joints at a part of a path, coming from those in joint[]. */
static bool joints_at(const struct robot_config *c, const struct drawn *d, double part,
                      double joint[OPW_JOINTS])
{
    const struct pose p = drawn_at(d, part);

    if (!d->by_wrist) {
        return manipulator_joints(&c->arm, &p, joint);
    }
    for (int i = 3; i < OPW_JOINTS; i++) {
        joint[i] = d->first[i] + part * (d->last[i] - d->first[i]);
    }
    return manipulator_arm(&c->arm, p.at, joint);
}

/* Whether joints follow a part of a path within all limits, without a leap and on one side of each
 * singular place: so do both halves, where it leaps or changes sides. What is left of a leap after
 * FINEST halves is one. */
static bool follows(const struct robot_config *c, const struct drawn *d, double from, double to,
                    int halves, double joint[OPW_JOINTS])
{
    double end[OPW_JOINTS];
    bool leap = false;

    memcpy(end, joint, sizeof end);
    const bool there = joints_at(c, d, to, end);
    for (int i = 0; i < OPW_JOINTS; i++) {
        leap = leap || !there || fabs(end[i] - joint[i]) > 0.05;
    }
    const bool sides = opw_branch(&c->arm.opw, end) != opw_branch(&c->arm.opw, joint);
    if ((leap || sides) && halves < FINEST) {
        const double middle = 0.5 * (from + to);
        return follows(c, d, from, middle, halves + 1, joint)
               && follows(c, d, middle, to, halves + 1, joint);
    }
    memcpy(joint, end, sizeof end);
    return !leap && manipulator_outside(&c->arm, d->first, joint) < 0;
}

/* Whether evenly spread poses, closer where joints are quick, lead along a path. One by the wrist
 * may come to its place with another elbow, so in another attitude: that is no way. */
static bool possible(const struct robot_config *c, const struct drawn *d)
{
    double joint[OPW_JOINTS];
    bool good = true;

    memcpy(joint, d->first, sizeof joint);
    for (int n = 0; n < SAMPLES && good; n++) {
        good = follows(c, d, (double)n / SAMPLES, (n + 1.0) / SAMPLES, 0, joint);
    }
    for (int i = 0; i < 3; i++) {
        good = good && (!d->by_wrist || fabs(joint[i] - d->last[i]) < SAME);
    }
    return good;
}

/* What rounding may move joints 1 to 3, 4 to 6 by at joints. [rad] */
static void rounding(const struct robot_config *c, const double joint[OPW_JOINTS], double noise[2])
{
    double factor[3];

    opw_factors(&c->arm.opw, joint, factor);
    noise[0] = ROUNDING / fmin(fabs(factor[1]), fmin(1.0, fabs(factor[0])));
    noise[1] = fmin(MOST, noise[0] / fabs(factor[2]));
    noise[0] = fmin(MOST, noise[0]);
}

/* What rounding may have done to a speed: it is in both joints of a difference. [rad/s] */
static double noise_of(const struct robot_config *c, const double late[3][OPW_JOINTS], int joint)
{
    double most = 0.0;

    for (int n = 0; n < 3; n++) {
        double noise[2];
        rounding(c, late[n], noise);
        most = fmax(most, noise[joint > 2]);
    }
    return 2.0 * most / CYCLE;
}

/* Run until it rests; whether all limits were kept. A difference of two cycles has what rounding
 * did in both and in the one before. */
static bool kept(const struct robot_config *c)
{
    double before[OPW_JOINTS] = { 0 }, late[3][OPW_JOINTS];
    bool good = true;

    for (int n = 0; n < 3; n++) {
        memcpy(late[n], robot.joint, sizeof late[n]);
    }
    for (int n = 1; n < 4000000 && !robot_idle(&robot); n++) {
        robot_cycle(&robot, c);
        memcpy(late[n % 3], robot.joint, sizeof late[n % 3]);
        for (int i = 0; i < OPW_JOINTS; i++) {
            const struct manipulator_joint *j = &c->arm.joint[i];
            const double speed = fabs(robot.rate[i]) - j->speed * (1.0 + SHARE);
            const double change = fabs(robot.rate[i] - before[i]) - j->acc * (1.0 + SHARE) * CYCLE;
            if (speed > 0.0 || change > 0.0) {
                const double noise = noise_of(c, (const double(*)[OPW_JOINTS])late, i);
                good = good && speed <= noise && change <= 2.0 * noise;
            }
            good = good && robot.joint[i] <= j->high + RANGE && robot.joint[i] >= j->low - RANGE;
            before[i] = robot.rate[i];
        }
    }
    return good && robot_idle(&robot) && !robot.lost;
}

enum outcome { DRIVEN, REFUSED, UNKEPT, WRONGLY_REFUSED, OUTCOMES };

static int32_t all[OUTCOMES];

static void count(int32_t number, const char *what, enum outcome o)
{
    all[o]++;
    if (o == UNKEPT || o == WRONGLY_REFUSED) {
        printf("seed %d, %s: %s\n", (int)number, what,
               o == UNKEPT ? "a limit is not kept" : "refused, but possible");
        fflush(stdout);
    }
}

/* Config and joints of a number. */
static struct robot_config begin(int32_t number, uint64_t salt, double room,
                                 double from[OPW_JOINTS])
{
    seed = 0x9e3779b97f4a7c15u * (uint64_t)(number + 1) + salt;
    for (int i = 0; i < 10; i++) {
        real(0.0, 1.0);
    }
    const struct robot_config c = random_config();
    for (int i = 0; i < OPW_JOINTS; i++) {
        from[i] = room * real(c.arm.joint[i].low, c.arm.joint[i].high);
    }
    from[4] = chance(0.3) ? real(-0.05, 0.05) : from[4];
    robot_start(&robot, &c, from);
    return c;
}

/* A move of any kind from joints; whether it is refused rightly. */
static enum outcome planned(const struct robot_config *c, const double from[OPW_JOINTS],
                            const struct robot_move *m, struct drawn *d)
{
    struct robot_refusal why;

    if (robot_move(&robot, c, m, &why) == ROBOT_OK) {
        return DRIVEN;
    }
    if (m->kind == ROBOT_JOINTS) { /* between two joints within their limits */
        return WRONGLY_REFUSED;
    }
    memcpy(d->first, from, sizeof d->first);
    memcpy(d->last, from, sizeof d->last);
    d->by_wrist = m->singular == ROBOT_WRIST;
    if (d->by_wrist && !manipulator_joints(&c->arm, &d->to, d->last)) {
        return REFUSED;
    }
    return possible(c, d) ? WRONGLY_REFUSED : REFUSED;
}

/* An arc from the end of the moves so far, by its centre or through a place. */
static struct robot_move random_arc(const struct robot_config *c, const double from[OPW_JOINTS],
                                    double size, struct drawn *d)
{
    struct robot_move m = random_line(c, from, size);
    const double r = size * pow(10.0, real(0.0, 2.3));
    const double by[3] = { real(-2, 2), real(-2, 2), real(-2, 2) };
    double u[3], q[4];

    m.singular = ROBOT_SLOW;
    m.kind = chance(0.5) ? ROBOT_ARC : ROBOT_CIRCLE;
    d->arc = true;
    d->sweep = m.sweep = real(0.2, 6.2);
    m.feed = fmax(m.feed, r * m.sweep / LONGEST);
    quaternion_by_vector(by, q);
    quaternion_turn(q, (double[]){ 1, 0, 0 }, u);
    quaternion_turn(q, (double[]){ 0, 0, 1 }, m.normal);
    memcpy(d->normal, m.normal, sizeof m.normal);
    for (int i = 0; i < 3; i++) {
        m.centre[i] = d->centre[i] = d->start.at[i] - r * u[i];
    }
    d->to = m.target.pose;
    memcpy(m.via, drawn_at(d, 0.4).at, sizeof m.via);
    memcpy(m.target.pose.at, drawn_at(d, 1.0).at, sizeof m.via);
    return m;
}

/* Up to four lines and arcs that their zones join. One that is refused is drawn again, half as
 * large: what was refused has left nothing behind. */
static void chain(int32_t number)
{
    double from[OPW_JOINTS], size = CHAIN_SIZE;
    const struct robot_config c = begin(number, 0x5bd1e995, CHAIN_ROOM, from);
    const int most = 2 + (int)real(0.0, 3.0);
    int driven = 0;

    for (int n = 0; n < 2 * most && driven < most && robot_ready(&robot); n++) {
        robot_end(&robot, from);
        struct drawn d = { .start = manipulator_pose(&c.arm, from) };
        struct robot_move m =
            chance(0.5) ? random_arc(&c, from, size, &d) : random_line(&c, from, size);
        m.zone = chance(0.2) ? 0.0 : pow(10.0, real(-1.0, 1.5));
        d.to = m.target.pose;
        const enum outcome o = planned(&c, from, &m, &d);
        size = o == DRIVEN ? CHAIN_SIZE : 0.5 * size;
        driven += o == DRIVEN;
        if (o != DRIVEN) {
            count(number, "of a chain", o);
        }
    }
    if (!kept(&c)) {
        count(number, "a chain", UNKEPT);
    }
    all[DRIVEN] += driven;
}

struct jog {
    enum robot_frame frame;
    double way[6], share, far;
    double velocity[3], turn[3]; /* in the base frame */
};

static struct jog random_jog(enum robot_frame frame)
{
    struct jog j = { .frame = frame };

    for (int i = 0; i < 6; i++) {
        j.way[i] = chance(0.5) ? 0.0 : real(-1.0, 1.0);
    }
    j.way[0] += j.way[0] == 0.0 && j.way[3] == 0.0 ? 1.0 : 0.0;
    if (chance(0.6)) { /* an increment; whole turns are what samples mistake for none */
        const double turns = 6.283185307179586 * floor(real(1.0, 20.0));
        j.far = frame == ROBOT_IN_JOINTS ? real(0.0, 4.0) : chance(0.3) ? turns : real(0.0, 300.0);
    }
    j.share = real(0.02, 1.0);
    j.share = j.far > 0.0 && frame != ROBOT_IN_JOINTS ? j.share : fmax(j.share, 1.0 / LONGEST);
    memcpy(j.velocity, j.way, sizeof j.velocity);
    memcpy(j.turn, j.way + 3, sizeof j.turn);
    if (frame == ROBOT_IN_TOOL) {
        quaternion_turn(robot.pose.turn, j.velocity, j.velocity);
        quaternion_turn(robot.pose.turn, j.turn, j.turn);
    }
    return j;
}

/* Whether a jog of joints that stands at some could go on: none that moves is at its limit. */
static bool room(const struct robot_config *c, const struct jog *j, const double joint[OPW_JOINTS])
{
    bool found = true;

    for (int i = 0; i < OPW_JOINTS; i++) {
        const struct manipulator_joint *k = &c->arm.joint[i];
        const double left = j->way[i] > 0.0 ? k->high - joint[i] : joint[i] - k->low;
        found = found && (j->way[i] == 0.0 || left > RANGE);
    }
    return found;
}

/* Whether a jog could go on from joints, until tip or turn has gone by BEYOND: a turn beyond half
 * of one is mistaken for what leads to its end the other way round. */
static bool goes_on(const struct robot_config *c, const struct jog *j,
                    const double joint[OPW_JOINTS])
{
    struct drawn d = { .start = manipulator_pose(&c->arm, joint) };
    const double per = BEYOND / fmax(norm3(j->velocity), norm3(j->turn));
    double by[3], q[4];

    if (j->frame == ROBOT_IN_JOINTS) {
        return room(c, j, joint);
    }
    for (int i = 0; i < 3; i++) {
        d.to.at[i] = d.start.at[i] + per * j->velocity[i];
        by[i] = per * j->turn[i];
    }
    quaternion_by_vector(by, q);
    quaternion_product(q, d.start.turn, d.to.turn);
    memcpy(d.first, joint, sizeof d.first);
    return possible(c, &d);
}

/* Whether the way that is planned is all that a jog asked for. */
static bool whole(const struct jog *j, const double from[OPW_JOINTS], const struct pose *start)
{
    const bool turns = norm3(j->velocity) == 0.0;
    const double far = j->far > 0.0 ? j->far : turns ? TURNS : INFINITY;
    double went =
        turns ? robot.tool_path.path.length / ARM_MOVES_LEVER : apart(robot.rear, start->at);

    for (int i = 0; i < OPW_JOINTS && j->frame == ROBOT_IN_JOINTS; i++) {
        went = fmax(i > 0 ? went : 0.0, fabs(robot.rear_joint[i] - from[i]));
    }
    return went > far - RANGE;
}

/* A jog from joints to where it ends: there, and where it is refused, it cannot go on. */
static enum outcome jogged(const struct robot_config *c, const struct jog *j,
                           const double from[OPW_JOINTS])
{
    const struct pose start = robot.pose;
    struct robot_refusal why;

    if (robot_jog(&robot, c, j->frame, j->way, j->share, j->far, &why) != ROBOT_OK) {
        return goes_on(c, j, from) ? WRONGLY_REFUSED : REFUSED;
    }
    if (!whole(j, from, &start) && goes_on(c, j, robot.rear_joint)) {
        return WRONGLY_REFUSED;
    }
    return kept(c) ? DRIVEN : UNKEPT;
}

static void one(int32_t number)
{
    double from[OPW_JOINTS];
    const struct robot_config c = begin(number, 0, ROOM, from);
    const int kind = (int)real(0.0, 6.0);
    struct robot_move m = { .kind = ROBOT_JOINTS, .target.by_joints = true };
    struct drawn d = { .start = robot.pose };

    if (kind < 3) {
        const struct jog j = random_jog((enum robot_frame)kind);
        count(number, "a jog", jogged(&c, &j, from));
        return;
    }
    if (kind < 5) {
        m = random_line(&c, from, 1.0);
    } else {
        m.share = fmax(real(0.05, 1.0), 1.0 / LONGEST);
        for (int i = 0; i < OPW_JOINTS; i++) {
            m.target.joint[i] = ROOM * real(c.arm.joint[i].low, c.arm.joint[i].high);
        }
    }
    d.to = m.target.pose;
    const enum outcome o = planned(&c, from, &m, &d);
    count(number, "a move", o != DRIVEN || kept(&c) ? o : UNKEPT);
}

int main(int argc, char **argv)
{
    const int32_t first = argc > 2 ? atoi(argv[1]) : 0, number = argc > 2 ? atoi(argv[2]) : 200;

    for (size_t n = 0; n < sizeof FOUND / sizeof *FOUND && argc < 3; n++) {
        one(FOUND[n]);
    }
    for (size_t n = 0; n < sizeof FOUND_CHAINS / sizeof *FOUND_CHAINS && argc < 3; n++) {
        chain(FOUND_CHAINS[n]);
    }
    for (int32_t n = first; n < first + number; n += argc > 2 ? 1 : CHECK_EACH) {
        one(n);
        if (argc > 2 || n % 4 == 0) {
            chain(n);
        }
    }
    printf("%d driven, %d refused; limits not kept: %d; %d refused wrongly\n", (int)all[DRIVEN],
           (int)all[REFUSED], (int)all[UNKEPT], (int)all[WRONGLY_REFUSED]);
    CHECK(all[DRIVEN] > 8 * all[REFUSED]);
    CHECK_EQ(all[UNKEPT], 0);
    CHECK_EQ(all[WRONGLY_REFUSED], 0);
    return check_result();
}
