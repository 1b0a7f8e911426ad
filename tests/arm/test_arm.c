/* The arm draws lines: joint speeds, the line, pulses, what is refused, ramps near a bound. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "arm.h"
#include "check.h"
#include "links.h"
#include "reach.h"

static const double TURN = 6.283185307179586, FRAME = 2e-3, SCALE = 1e4; /* [s], [pulses/deg] */
static const struct links LINKS = { 3.0, 2.5 };          /* 30 degrees per millimetre */
static const double SPEED[ARM_JOINTS] = { 90.0, 150.0 }; /* [deg/s] */
static struct motion_limits limits = {
    .feed = 1e6, .rapid = 1.0, .up = { .acc = 200.0 }, .down = { .acc = 200.0 }
};

static struct arm arm;
static struct kinematics kinematics;
static uint64_t seed = 11;

static struct mechanism machine(void)
{
    static const double elbow[AXES] = { 0.0, -90.0 };
    struct mechanism m = { .kinematics = &kinematics, .geometry = &LINKS, .near = elbow };
    for (int i = 0; i < ARM_JOINTS; i++) {
        m.axis[i] = true;
        m.joint[i] = (struct joint){ .used = true, .scale = SCALE, .speed = SPEED[i] };
    }
    return m;
}

static double random_number(double low, double high)
{
    return low + (high - low) * (double)check_random(&seed, 0, 1000000) / 1e6;
}

/* Tool by the pulses of the joints. */
static void tool_at(const int64_t pulses[ARM_JOINTS], double at[2])
{
    const double q = (double)pulses[0] / SCALE * TURN / 360.0;
    const double p = q + (double)pulses[1] / SCALE * TURN / 360.0;
    at[0] = LINKS.upper * cos(q) + LINKS.fore * cos(p);
    at[1] = LINKS.upper * sin(q) + LINKS.fore * sin(p);
}

/* A line the joints can just follow, in the plane's right half; its highest feed. */
static struct command line(const struct mechanism *m, const double start[AXES],
                           const double end[AXES], double tolerance)
{
    struct command c = { .tolerance = tolerance, .blend = true };
    struct command_refusal why;
    path_line(&c.path, start, end);
    CHECK(command_move(&c, m, &limits, COMMAND_LINE, 1e3, &why) == COMMAND_FAST);
    CHECK(why.value > 1.0 && why.limit == 1.0);
    const double feed = 1e3 / why.value * (1.0 - 1e-12);
    CHECK(command_move(&c, m, &limits, COMMAND_LINE, feed, &why) == COMMAND_OK);
    c.index = 1;
    return c;
}

static void somewhere(double at[AXES])
{
    memset(at, 0, AXES * sizeof *at);
    const double r = random_number(1.5, 5.0), a = random_number(-1.2, 1.2);
    at[0] = r * cos(a);
    at[1] = r * sin(a);
}

/* One line from rest to rest, looked at in every frame. Returns the highest share of its speed that
 * a joint has had: less than 1 where that is at an end, which is ramped. */
static double draw(void)
{
    const struct mechanism m = machine();
    double start[AXES], end[AXES], fastest = 0.0, before = 0.0;
    int64_t pulses[ARM_JOINTS], counts[DDA_CHANNELS_MAX];
    int64_t clock = 0, moving = 0, waiting = 0;

    do {
        somewhere(start);
        somewhere(end);
    } while (hypot(end[0] - start[0], end[1] - start[1]) < 1.0);
    CHECK(arm_start(&arm, &m, start));
    for (int i = 0; i < ARM_JOINTS; i++) {
        pulses[i] = arm.trajectory.pulses[i];
    }
    const struct command c = line(&m, start, end, 0.0);
    ring_push(&arm.ring, &c);
    do {
        clock += ARM_TICKS;
        arm_run(&arm, &m, clock + 1);
        double at[2];
        bool moves = false;
        for (int i = 0; i < ARM_JOINTS; i++) {
            const double most = SPEED[i] * SCALE * FRAME; /* [pulses] in a frame */
            const int32_t frame = arm.dda.command[i];
            CHECK(abs(frame) <= most + 1.0); /* both ends are rounded */
            fastest = fmax(fastest, abs(frame) / most);
            moves = moves || frame != 0;
            pulses[i] += frame;
        }
        tool_at(pulses, at);
        const double x = (end[0] - start[0]) / c.path.length;
        const double y = (end[1] - start[1]) / c.path.length;
        const double along = (at[0] - start[0]) * x + (at[1] - start[1]) * y;
        CHECK(fabs((at[0] - start[0]) * y - (at[1] - start[1]) * x) < 2e-5); /* [mm] */
        CHECK(along >= before - 2e-5);
        before = along;
        waiting += moving > 0 && !moves && along < c.path.length - 2e-5;
        moving += moves;
    } while (!(trajectory_resting(&arm.trajectory, &arm.ring) && arm.fifo[0].stock == 0)
             && clock < 1 << 30);
    arm_run(&arm, &m, clock + ARM_TICKS + 1);
    CHECK(fabs(before - c.path.length) < 2e-5);
    CHECK(moving > 20 && waiting == 0);
    dda_counts(&arm.dda, clock + ARM_TICKS, counts);
    for (int i = 0; i < ARM_JOINTS; i++) {
        CHECK_EQ(counts[i], arm.trajectory.pulses[i] - (pulses[i] - counts[i]));
        CHECK_EQ(pulses[i], arm.trajectory.pulses[i]);
    }
    CHECK(kernel_busy(&arm.kernel, 0) >= moving * 20000 && kernel_idle(&arm.kernel) > 0);
    return fastest;
}

static void refusals(void)
{
    struct mechanism m = machine();
    const double near[AXES] = { 0.6, 1.0 }, across[AXES] = { 0.6, -0.7 };
    const double far[AXES] = { 5.6, 0.0 }, right[AXES] = { 4.0, 0.0 };
    struct command c = { .tolerance = 0.0 };
    struct command_refusal why;

    path_line(&c.path, right, far);
    CHECK(command_move(&c, &m, &limits, COMMAND_LINE, 0.1, &why) == COMMAND_FAR);
    path_line(&c.path, near, (double[AXES]){ 0.2, -0.3 }); /* inside of the inner circle */
    CHECK(command_move(&c, &m, &limits, COMMAND_LINE, 0.1, &why) == COMMAND_FAR);
    path_line(&c.path, near, across);
    CHECK(command_move(&c, &m, &limits, COMMAND_LINE, 0.1, &why) == COMMAND_OK);
    /* The elbow is bent most where the line is nearest to the shoulder, between two places that
     * are looked at. */
    const double bent = -acos((0.36 - 9.0 - 6.25) / 15.0) * 360.0 / TURN;
    m.joint[1].bounded = true;
    m.joint[1].high = 0.0;
    m.joint[1].low = bent - 2.0 / SCALE;
    CHECK(command_move(&c, &m, &limits, COMMAND_LINE, 0.1, &why) == COMMAND_OK);
    m.joint[1].low = bent + 2.0 / SCALE;
    CHECK(command_move(&c, &m, &limits, COMMAND_LINE, 0.1, &why) == COMMAND_OUTSIDE);
    CHECK(why.joint == 1 && fabs(why.value - bent) < 1.0 / SCALE && why.limit == m.joint[1].low);
    CHECK(!arm_start(&arm, &m, far));
    /* It is bent least at the end of a way out. */
    const double straight = -acos((16.0 - 9.0 - 6.25) / 15.0) * 360.0 / TURN;
    path_line(&c.path, near, right);
    m.joint[1].low = -1e3;
    m.joint[1].high = straight + 1.0 / SCALE;
    CHECK(command_move(&c, &m, &limits, COMMAND_LINE, 0.1, &why) == COMMAND_OK);
    m.joint[1].high = straight - 1.0 / SCALE;
    CHECK(command_move(&c, &m, &limits, COMMAND_LINE, 0.1, &why) == COMMAND_OUTSIDE);
    CHECK(why.joint == 1 && fabs(why.value - straight) < 1e-9);
}

/* Highest joint places of the ramp from here. [pulses] */
static void drive_ramp(const struct arm *now, const struct mechanism *m, int32_t high[AXES])
{
    static struct arm a;
    struct point p;

    const struct trajectory_beside beside = arm_beside(&a);
    a = *now;
    memcpy(high, a.trajectory.pulses, AXES * sizeof *high);
    trajectory_abort(&a.trajectory, &a.ring);
    for (bool rests = false; !rests;) {
        rests = trajectory_resting(&a.trajectory, &a.ring);
        trajectory_advance(&a.trajectory, &beside, FRAME);
        CHECK(trajectory_point(&a.trajectory, &beside, m, FRAME, &p));
        trajectory_accept(&a.trajectory, &beside, &p);
        for (int i = 0; i < ARM_JOINTS; i++) {
            high[i] = p.pulses[i] > high[i] ? p.pulses[i] : high[i];
        }
    }
}

/* Two lines, mixed or as a chain: a bound just beyond the ramp of an abort holds, one well inside
 * of it does not. */
static void ramps(double tolerance)
{
    const struct mechanism m = machine();
    static struct arm copy;
    const struct trajectory_beside beside = arm_beside(&arm), aside = arm_beside(&copy);
    double at[3][AXES];
    int32_t high[AXES];

    for (int i = 0; i < 3; i++) {
        somewhere(at[i]);
    }
    CHECK(arm_start(&arm, &m, at[0]));
    for (int i = 0; i < 2; i++) {
        const struct command c = line(&m, at[i], at[i + 1], tolerance);
        ring_push(&arm.ring, &c);
    }
    for (int n = 0; !trajectory_resting(&arm.trajectory, &arm.ring) && n < 5000; n++) {
        struct point p;
        for (double left = FRAME; left > 0.0 && !trajectory_resting(&arm.trajectory, &arm.ring);) {
            left = trajectory_advance(&arm.trajectory, &beside, left);
        }
        CHECK(trajectory_point(&arm.trajectory, &beside, &m, FRAME, &p));
        trajectory_accept(&arm.trajectory, &beside, &p);
        if (n % 16) {
            continue;
        }
        drive_ramp(&arm, &m, high);
        for (int i = 0; i < ARM_JOINTS; i++) {
            struct mechanism bounded = m;
            bounded.joint[i].bounded = true;
            bounded.joint[i].low = -1e4;
            bounded.joint[i].high = (high[i] + 60) / SCALE; /* within a frame near rest */
            copy = arm;
            CHECK_EQ(reach_beyond(&copy.trajectory, &aside, &bounded, FRAME), -1);
            bounded.joint[i].high = (high[i] - 60) / SCALE;
            if (high[i] - 60 > arm.trajectory.pulses[i]) {
                copy = arm;
                CHECK_EQ(reach_beyond(&copy.trajectory, &aside, &bounded, FRAME), i);
            }
        }
    }
}

/* Orders to a joint count in its degrees; the place of the tool follows. */
static void orders(void)
{
    const struct mechanism m = machine();
    const double start[AXES] = { 3.0, 2.5 };
    const struct axes_limits l = { 50.0, 90.0, 500.0, 500.0, 5000.0 };
    const struct trajectory_beside beside = arm_beside(&arm);
    struct point p;

    CHECK(arm_start(&arm, &m, start) && trajectory_order(&arm.trajectory, &m));
    const int32_t from = arm.trajectory.pulses[0], other = arm.trajectory.pulses[1];
    double joint[AXES] = { 0.0 };
    CHECK(mechanism_first(&m, start, joint));
    axes_go(&arm.trajectory.axes, 0, joint[0] + 10.0, &l);
    while (!trajectory_resting(&arm.trajectory, &arm.ring)) {
        trajectory_advance(&arm.trajectory, &beside, FRAME);
        CHECK(trajectory_point(&arm.trajectory, &beside, &m, FRAME, &p));
        const double r = hypot(p.place[0], p.place[1]);
        CHECK(fabs(r - hypot(3.0, 2.5)) < 1e-9 && p.pulses[1] == other);
        trajectory_accept(&arm.trajectory, &beside, &p);
    }
    CHECK(abs(arm.trajectory.pulses[0] - from - (int32_t)(10.0 * SCALE)) <= 1);
    trajectory_bind(&arm.trajectory);
    CHECK(trajectory_in_joints(&arm.trajectory)
          && fabs(arm.trajectory.rest[0] - joint[0] - 10.0) < 1e-9);
}

int main(void)
{
    double fastest = 0.0;

    kinematics = links_kinematics();
    for (int n = 0; n < 40; n++) {
        const double f = draw();
        CHECK(f > 0.9);
        fastest = fmax(fastest, f);
    }
    CHECK(fastest > 0.999);
    refusals();
    limits.down.acc = 10.0; /* long ramps, on which joints turn round */
    for (int n = 0; n < 20; n++) {
        ramps(0.0);
        ramps(0.01);
    }
    orders();
    return check_result();
}
