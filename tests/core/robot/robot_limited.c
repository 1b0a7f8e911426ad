/* What limits a robot's motion, by closed forms: time at speed, on ramps, on the way to rest. */
#include "robot_rig.h"

static struct robot_refusal why;

/* Time [s] for which each limit counts until the arm rests, and the axis of the last one told. */
struct told {
    double by[LIMITED_WAIT + 1];
    int32_t axis[LIMITED_WAIT + 1];
    double all;
};

static struct told watch(const struct robot_config *c, double feed, double most)
{
    struct told t = { 0 };

    while (!robot_idle(&robot) && t.all < most) {
        robot_cycle(&robot, c);
        const struct limited l = robot_limited(&robot, c, feed);
        CHECK(l.by >= LIMITED_FEED && l.by <= LIMITED_WAIT && l.feed == feed);
        t.by[l.by] += CYCLE;
        t.axis[l.by] = l.axis;
        t.all += CYCLE;
    }
    return t;
}

/* Begin a turn of joint 2 by 2.5 rad at a share of its speed; the arm's ramps come up at once. */
static void begin_turn(const struct robot_config *c, double share, double override)
{
    static const double from[OPW_JOINTS] = { 0, -1.25, 0, 0, 1.5, 0 };
    struct robot_move m = { .kind = ROBOT_JOINTS, .share = share };

    memcpy(m.target.joint, from, sizeof from);
    m.target.joint[1] = 1.25;
    m.target.by_joints = true;
    robot_start(&robot, c, from);
    CHECK(robot_rests(&robot));
    robot_override(&robot, override);
    CHECK_EQ(robot_move(&robot, c, &m, &why), ROBOT_OK);
}

static struct told turn(const struct robot_config *c, double share, double override)
{
    begin_turn(c, share, override);
    return watch(c, 0.0, INFINITY);
}

/* Highest speed of joint 2, by the motor or by the pulses of a slot [rad/s]. */
static double fastest(const struct robot_config *c)
{
    return fmin(c->arm.joint[1].speed, 48.0 / (c->scale[1] * c->slot));
}

static void joints(void)
{
    struct robot_config c = rig_config();
    c.smooth = 0.0;
    const double most = fastest(&c), acc = c.arm.joint[1].acc;

    struct told t = turn(&c, 1.0, 1.0);
    CHECK_NEAR(t.by[LIMITED_SPEED], 2.5 / most - most / acc, 3 * CYCLE);
    CHECK_NEAR(t.by[LIMITED_ACCELERATION], most / acc, 3 * CYCLE);
    CHECK_NEAR(t.by[LIMITED_STOP], most / acc, 3 * CYCLE);
    CHECK_EQ(t.axis[LIMITED_SPEED], 2);
    t = turn(&c, 0.5, 1.0); /* as asked */
    CHECK_NEAR(t.by[LIMITED_FEED], 5.0 / most - 0.5 * most / acc, 3 * CYCLE);
    CHECK(t.by[LIMITED_SPEED] == 0.0);
    t = turn(&c, 1.0, 0.5); /* as the override asks */
    CHECK_NEAR(t.by[LIMITED_FEED], 5.0 / most - 0.5 * most / acc, 3 * CYCLE);
    CHECK(t.by[LIMITED_SPEED] == 0.0);
}

/* A line of 200 mm with a feed that the joints bear, and with one that they do not. */
static void lines(void)
{
    struct robot_config c = rig_config();
    struct robot_move m = { .kind = ROBOT_LINE, .feed = 100.0, .share = 1.0 };
    const double from[OPW_JOINTS] = { 0, 0, 0, 0, 1.5, 0 };

    c.smooth = 0.0;
    for (int n = 0; n < 2; n++) {
        c.arm.joint[0].speed *= n == 0 ? 1.0 : 0.005; /* 0.0153 rad/s at 1.18 m */
        robot_start(&robot, &c, from);
        m.target.pose = robot.pose;
        m.target.branch = ROBOT_ANY_BRANCH;
        m.target.pose.at[1] += 200.0;
        CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_OK);
        const struct told t = watch(&c, m.feed, INFINITY);
        if (n == 0) {
            CHECK_NEAR(t.by[LIMITED_FEED], 200.0 / 100.0 - 100.0 / c.acc, 5 * CYCLE);
            CHECK_NEAR(t.by[LIMITED_ACCELERATION], 100.0 / c.acc, 5 * CYCLE);
        } else {
            CHECK(t.by[LIMITED_FEED] == 0.0 && t.axis[LIMITED_SPEED] == 1);
            CHECK(t.by[LIMITED_SPEED] > 0.95 * t.all);
        }
        CHECK_NEAR(t.by[LIMITED_FEED] + t.by[LIMITED_SPEED] + t.by[LIMITED_ACCELERATION]
                       + t.by[LIMITED_STOP] + t.by[LIMITED_CORNER],
                   t.all, 1e-9);
    }
}

static void held(void)
{
    struct robot_config c = rig_config();
    struct robot_move m = { .kind = ROBOT_LINE, .feed = 100.0, .share = 1.0 };
    const double from[OPW_JOINTS] = { 0, 0, 0, 0, 1.5, 0 };

    robot_start(&robot, &c, from);
    CHECK_EQ(robot_limited(&robot, &c, 0.0).by, LIMITED_STOP);
    m.target.pose = robot.pose;
    m.target.branch = ROBOT_ANY_BRANCH;
    m.target.pose.at[1] += 200.0;
    CHECK_EQ(robot_move(&robot, &c, &m, &why), ROBOT_OK);
    watch(&c, 100.0, 1.0);
    robot_hold(&robot, true);
    const struct told t = watch(&c, 100.0, 1.0);
    CHECK_NEAR(t.by[LIMITED_WAIT], 1.0, 5 * CYCLE);
}

/* The turn as a move that flows: what is neither speed, feed nor acceleration is jerk. A speed
 * within 1 % counts as the whole one, and the time is at most 0.2 % above the closed form. */
static void flows(void)
{
    struct robot_config c = rig_config();
    c.flow = true;
    const double most = fastest(&c), acc = c.arm.joint[1].acc;

    for (int smooth = 0; smooth < 2; smooth++) {
        c.smooth = 0.1 * smooth;
        for (int n = 0; n < 3; n++) { /* whole, half as asked, half by override */
            const struct told t = turn(&c, n == 1 ? 0.5 : 1.0, n == 2 ? 0.5 : 1.0);
            const double part = n == 0 ? 1.0 : 0.5, ramp = part * most / acc;
            const double steady = 2.5 / (part * most) - ramp - c.smooth;
            const double whole = t.by[n == 0 ? LIMITED_SPEED : LIMITED_FEED];
            CHECK(whole >= steady && whole <= steady + (smooth ? 0.06 : 0.03 * ramp));
            CHECK_NEAR(t.by[LIMITED_JERK], 4.0 * c.smooth, 0.3 * c.smooth);
            CHECK_NEAR(whole + t.by[LIMITED_ACCELERATION] + t.by[LIMITED_JERK], t.all, 2 * CYCLE);
            CHECK_NEAR(t.all, 1.001 * (steady + 2.0 * (ramp + c.smooth)), 0.001 * t.all);
            CHECK_EQ(t.axis[LIMITED_ACCELERATION], 2);
            CHECK_EQ(t.axis[LIMITED_SPEED], n == 0 ? 2 : 0);
        }
    }
}

/* A hold of moves that flow: they rest once they stand, and until it ends or an abort does. */
static void flow_held(void)
{
    struct robot_config c = rig_config();

    c.flow = true;
    for (int aborts = 0; aborts < 2; aborts++) {
        begin_turn(&c, 1.0, 1.0);
        CHECK(!robot_rests(&robot));
        watch(&c, 0.0, 0.5);
        CHECK(robot.rate[1] > 0.5);
        robot_hold(&robot, true);
        int n = 0;
        for (; n < 10000 && !robot_rests(&robot); n++) {
            CHECK(robot.rate[1] > 0.0);
            robot_cycle(&robot, &c);
            CHECK_EQ(robot_limited(&robot, &c, 0.0).by, LIMITED_WAIT);
        }
        CHECK(n > 10 && n < 10000 && robot.rate[1] < 1e-6 && !robot_idle(&robot));
        const double at = robot.joint[1];
        if (aborts) {
            robot_abort(&robot);
            robot_cycle(&robot, &c);
        } else {
            CHECK_NEAR(watch(&c, 0.0, 0.2).by[LIMITED_WAIT], 0.2, 2 * CYCLE);
            CHECK(robot_rests(&robot) && robot.joint[1] == at);
            robot_hold(&robot, false);
            CHECK(!robot_rests(&robot));
            watch(&c, 0.0, INFINITY);
        }
        CHECK(robot_rests(&robot) && robot_idle(&robot));
        CHECK_NEAR(robot.joint[1], aborts ? at : 1.25, 1e-12);
    }
}

int main(void)
{
    joints();
    lines();
    held();
    flows();
    flow_held();
    return check_result();
}
