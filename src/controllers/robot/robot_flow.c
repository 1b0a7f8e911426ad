/* robot_flow - the latest move joins those that flow. */
#include "robot.h"

#include "robot_plan.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

/* Farthest that the tip may be from where the inverse kinematics bring it. [mm] */
static const double OFF = 1e-4;

/* Share of a joint's limits that is used, the rest is for rounding. Without a limit of jerk a joint
 * that turns back at a rest in the middle of a cycle brakes to it by the last digits of a long
 * way. */
static const double USED = 1.0 - 1e-9, USED_AT_ONCE = 1.0 - 1e-3;

bool robot_flows(const struct robot *r, const struct robot_config *c, const struct robot_move *move)
{
    return move->kind == ROBOT_SPLINE
           || (c->flow && !r->jogging && robot_travel(r, move) == 0.0
               && move->singular != ROBOT_WRIST);
}

static struct speed_limits limits_of(const struct robot_config *c)
{
    struct speed_limits l;

    for (int i = 0; i < OPW_JOINTS; i++) {
        l.speed[i] = USED * JOINT_CURVE_LEVER * robot_joint_speed(c, i);
        l.acc[i] =
            (c->smooth > 0.0 ? USED : USED_AT_ONCE) * JOINT_CURVE_LEVER * c->arm.joint[i].acc;
        l.jerk[i] = c->smooth > 0.0 ? l.acc[i] / c->smooth : 0.0;
    }
    return l;
}

/* A share as a piece has it: all is no limit of its own. */
static double part_of(double share)
{
    return share < 1.0 ? share : 0.0;
}

/* The pieces join; the tool path, now among them, is done. */
static void add(struct robot *r, const struct robot_config *c, const struct robot_move *move,
                bool stop, bool solved, int32_t count, const struct segment *piece)
{
    const struct speed_limits l = limits_of(c);
    const double part = move->part > 0.0 ? move->part : 0.5;
    const struct joint_flow_zone none = { 0.0, 0.0, part },
                                 zone = { move->zone, move->radius, part };
    const struct joint_flow_move m = { stop ? none : zone,
                                       { part_of(move->acc), part_of(move->dec) },
                                       move->kind == ROBOT_SPLINE && move->goes_on,
                                       move->line,
                                       solved };
    struct manipulator arm;

    manipulator_with(&c->arm, &r->tool, &arm);
    if (count > 0) {
        joint_flow_add(&r->flow, &arm, &l, &m, count, piece);
    }
    r->tool_path.count = r->tool_path.next = 0;
}

/* The joints go straight to others, and stop there if that is said. */
static void go(struct robot *r, const struct robot_config *c, const struct robot_move *move,
               const double from[OPW_JOINTS], const double to[OPW_JOINTS], double share, bool stop)
{
    double speed[OPW_JOINTS];
    struct segment piece;

    for (int i = 0; i < OPW_JOINTS; i++) {
        speed[i] = robot_joint_speed(c, i);
    }
    const int32_t count = joint_curve_line(from, to, share, speed, &piece);
    add(r, c, move, stop, false, count, &piece);
}

void robot_flow_line(struct robot *r, const struct robot_config *c, const struct robot_move *move,
                     const double from[OPW_JOINTS], const double to[OPW_JOINTS])
{
    go(r, c, move, from, to, move->share, false);
}

struct joint_curve_limits robot_flow_limits(const struct robot *r, const struct robot_config *c,
                                            double feed)
{
    const double tool = sqrt(r->tool.at[0] * r->tool.at[0] + r->tool.at[1] * r->tool.at[1]
                             + r->tool.at[2] * r->tool.at[2]);
    struct joint_curve_limits l = { .feed = feed,
                                    .spin = c->spin,
                                    .off = OFF / (manipulator_reach(&c->arm) + tool) };

    for (int i = 0; i < OPW_JOINTS; i++) {
        l.speed[i] = robot_joint_speed(c, i);
    }
    return l;
}

bool robot_flow_path(struct robot *r, const struct robot_config *c, const struct robot_move *move,
                     const double *turning, const double from[OPW_JOINTS], double feed)
{
    struct segment piece[JOINT_CURVE_PIECES];
    struct manipulator arm;
    const struct joint_curve_limits l = robot_flow_limits(r, c, feed);

    manipulator_with(&c->arm, &r->tool, &arm);
    const struct arm_geometry g = { &arm, &r->moves };
    const int32_t count = joint_curve_path(&r->tool_path, &g, from, &l, piece);
    if (count == 0) {
        return false;
    }
    if (turning) {
        go(r, c, move, turning, from, 1.0, true);
    }
    add(r, c, move, false, true, count, piece);
    return true;
}

void robot_flow_pieces(struct robot *r, const struct robot_config *c, const struct robot_move *move,
                       int32_t count, const struct segment *piece)
{
    add(r, c, move, false, true, count, piece);
}
