/* robot_rig - for the tests of robot motions: an arm with its limits, and a watch that checks
 * position, speed and acceleration of the joints in every cycle. */
#ifndef ROBOT_RIG_H
#define ROBOT_RIG_H

#include <string.h>

#include "check.h"
#include "robot.h"

static const double DEGREE = 0.017453292519943295, CYCLE = 1e-4;

static struct robot robot;

/* IRB 2600-12/1.65 with a pen of 0.15 m; 2500 pulses a turn of motors at 100 .. 120. */
static inline struct robot_config rig_config(void)
{
    static const double low[] = { -180, -155, -155, -400, -120, -400 };
    static const double high[] = { 180, 95, 75, 400, 120, 400 };
    static const double speed[] = { 175, 175, 175, 360, 360, 500 };
    static const double acc[] = { 400, 400, 400, 1500, 1500, 2000 };
    static const double ratio[] = { 100, 120, 120, 100, 100, 80 };
    struct robot_config c = { .feed = 2500.0,
                              .acc = 4000.0,
                              .spin = 3.0,
                              .smooth = 0.05,
                              .cycle = CYCLE,
                              .slot = 5e-6,
                              .slot_pulses = 49.0 };
    c.arm.opw = (struct opw){ 0.150,
                              -0.115,
                              0.0,
                              0.445,
                              0.700,
                              0.795,
                              0.085,
                              { 0, 0, -1.5707963267948966 },
                              { 1, 1, 1, 1, 1, 1 } };
    for (int i = 0; i < OPW_JOINTS; i++) {
        c.arm.joint[i] = (struct manipulator_joint){ low[i] * DEGREE, high[i] * DEGREE,
                                                     speed[i] * DEGREE, acc[i] * DEGREE };
        c.scale[i] = 2500.0 * ratio[i] / 6.283185307179586;
    }
    c.arm.tool = pose_none();
    c.arm.tool.at[2] = 150.0;
    return c;
}

/* Extremes since the watch was set to 0. */
struct rig_watch {
    double speed, acc; /* largest share of a joint's limits */
    double path;       /* [mm] largest distance from the line a - b */
    double slowest;    /* [mm/s] lowest speed between its first and last tenth */
    double a[3], b[3];
    double time; /* [s] */
    double before[OPW_JOINTS];
    double noise; /* [rad] allowed for joints 4, 6 where the path meets the wrist singularity */
    int in_line;  /* it is there now, or was within the last two cycles */
};

/* Within IN_LINE [rad] of the wrist singularity, rounding leaves joints 4 and 6 an uncertainty of
 * NOISE [rad], less than a pulse. */
static const double IN_LINE = 1e-4, NOISE = 2e-5;

static inline double rig_off(const double at[3], const double a[3], const double b[3], double *part)
{
    double ab = 0.0, dot = 0.0, off = 0.0;
    for (int i = 0; i < 3; i++) {
        ab += (b[i] - a[i]) * (b[i] - a[i]);
        dot += (at[i] - a[i]) * (b[i] - a[i]);
    }
    *part = dot / ab;
    for (int i = 0; i < 3; i++) {
        const double d = at[i] - a[i] - *part * (b[i] - a[i]);
        off += d * d;
    }
    return sqrt(off);
}

/* Watch one cycle. If the tool centre point has to be on a line, it is computed from the joints. */
static inline void rig_cycle(const struct robot_config *c, struct rig_watch *w)
{
    struct manipulator arm = c->arm;
    double part;

    robot_cycle(&robot, c);
    w->in_line = fabs(sin(robot.joint[4])) < IN_LINE ? 3 : w->in_line - 1;
    w->time += CYCLE;
    for (int i = 0; i < OPW_JOINTS; i++) {
        const double noise = w->in_line > 0 && (i == 3 || i == 5) ? w->noise / CYCLE : 0.0;
        const double change = fmax(0.0, fabs(robot.rate[i] - w->before[i]) - noise);
        const double acc = change / CYCLE / c->arm.joint[i].acc;
        w->speed = fmax(w->speed, fabs(robot.rate[i]) / c->arm.joint[i].speed);
        w->acc = fmax(w->acc, acc);
        w->before[i] = robot.rate[i];
    }
    if (w->b[0] != w->a[0] || w->b[1] != w->a[1] || w->b[2] != w->a[2]) {
        arm.tool = robot.tool;
        const struct pose p = manipulator_pose(&arm, robot.joint);
        const double off = rig_off(p.at, w->a, w->b, &part);
        w->path = fmax(w->path, off);
        w->slowest = part > 0.1 && part < 0.9 ? fmin(w->slowest, robot.speed) : w->slowest;
    }
}

static inline void rig_run(const struct robot_config *c, struct rig_watch *w)
{
    for (int n = 0; n < 3000000 && !robot_idle(&robot); n++) {
        rig_cycle(c, w);
    }
    CHECK(robot_idle(&robot) && !robot.lost);
}

/* Check that speeds and accelerations of all joints have kept to their limits. */
static inline void rig_kept(const struct rig_watch *w)
{
    CHECK(w->speed <= 1.0 && w->acc <= 1.0 + 1e-3);
}

/* Start at rest at a pose, without flags for its branch. */
static inline void rig_start(const struct robot_config *c, const double xyz[3], const double abc[3])
{
    double joint[OPW_JOINTS] = { 0.0, 0.0, 0.0, 0.0, 0.5, 0.0 };
    const struct pose p = pose_of(xyz, abc);
    int which;

    CHECK_EQ(manipulator_solve(&c->arm, &p, 1, NULL, joint, &which), MANIPULATOR_OK);
    robot_start(&robot, c, joint);
}

static inline struct robot_move rig_line(const double xyz[3], const double abc[3], double feed)
{
    struct robot_move m = { .kind = ROBOT_LINE, .feed = feed, .share = 1.0 };
    m.target.pose = pose_of(xyz, abc);
    m.target.branch = ROBOT_ANY_BRANCH;
    return m;
}

#endif
