/* robot_jog - a jog is a move to the last place that it may reach; letting go aborts it. */
#include "robot.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"
#include "robot_plan.h"

/* Farthest that a jog goes that only turns the tool. [rad] */
static const double TURNS = 12.566370614359172;

/* Before a place that is not reached a jog ends by so much of its way and of its turn at most; one
 * shorter than that is none. [mm] and [rad] */
static const double SHORT = 1e-6;

/* Times that the path of a jog is made shorter. */
enum { TRIES = 8 };

static double norm3(const double a[3])
{
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

/* Move the joints along a direction, up to the first limit. */
static enum robot_status jog_joints(struct robot *r, const struct robot_config *c,
                                    const double direction[OPW_JOINTS], double way,
                                    struct robot_move *move, struct robot_refusal *why)
{
    double most = 0.0, room = way > 0.0 ? way : INFINITY;

    for (int i = 0; i < OPW_JOINTS; i++) {
        most = el_max(most, fabs(direction[i]));
        if (direction[i] != 0.0 && i >= manipulator_joints_of(&c->arm)) {
            why->which = i;
            why->limit = manipulator_joints_of(&c->arm);
            return ROBOT_NO_JOINT;
        }
    }
    for (int i = 0; i < OPW_JOINTS; i++) {
        const double d = direction[i] / most;
        const struct manipulator_joint *j = &c->arm.joint[i];
        const double limit = d > 0.0 ? j->high : j->low;
        const double left = d != 0.0 ? el_max(0.0, (limit - r->joint[i]) / d) : INFINITY;
        if (left < room) {
            room = left;
            why->which = i;
            why->value = r->joint[i];
            why->limit = limit;
            why->slides = manipulator_slides(&c->arm, i);
        }
    }
    if (!(room > 0.0)) {
        return ROBOT_OUTSIDE;
    }
    move->kind = ROBOT_JOINTS;
    move->target.by_joints = true;
    for (int i = 0; i < OPW_JOINTS; i++) {
        move->target.joint[i] = r->joint[i] + room * direction[i] / most;
    }
    return robot_plan(r, c, move, NULL, NULL, why);
}

/* Move the tip along one direction while it turns about another, up to the first place out of
 * reach. */
static enum robot_status jog_tip(struct robot *r, const struct robot_config *c,
                                 const double velocity[3], const double turn[3], double way,
                                 struct robot_move *move, struct robot_refusal *why)
{
    const double reach = manipulator_reach(&c->arm) + norm3(r->tool.at);
    const double v = norm3(velocity), w = norm3(turn);
    const double least = v > 0.0 ? SHORT * (v / el_max(v, w)) : SHORT;
    double length = way > 0.0 ? way : v > 0.0 ? 2.0 * reach : TURNS;
    enum robot_status status = ROBOT_FAR;

    if (v > 0.0) { /* where the tip hardly goes, the turn is a number, too */
        length = el_min(length, v * (ROBOT_MOST / w));
    }
    for (int n = 0; n < TRIES && length > least; n++) {
        struct pose pose = r->pose;
        double by[3], q[4];
        external_to_arm(&c->external, r->external, pose.at);
        for (int i = 0; i < 3; i++) {
            pose.at[i] += v > 0.0 ? velocity[i] / v * length : 0.0;
            by[i] = turn[i] * (v > 0.0 ? length / v : w > 0.0 ? length / w : 0.0);
        }
        quaternion_by_vector(by, q);
        quaternion_product(q, pose.turn, pose.turn);
        status = robot_plan(r, c, move, &pose, by, why);
        if (status == ROBOT_OK) {
            break;
        }
        length = el_max(0.0, length * why->part - least);
    }
    return status;
}

/* Move the external axis, as far as it goes. */
static enum robot_status jog_external(struct robot *r, const struct robot_config *c, double way,
                                      double sign, struct robot_move *move,
                                      struct robot_refusal *why)
{
    const double limit = sign > 0.0 ? c->external.high : c->external.low;
    const double left = sign * (limit - r->external);

    why->which = OPW_JOINTS;
    if (c->external.kind == EXTERNAL_NONE) {
        why->limit = manipulator_joints_of(&c->arm);
        return ROBOT_NO_JOINT;
    }
    if (!(left > 0.0)) {
        why->value = r->external;
        why->limit = limit;
        why->slides = c->external.kind == EXTERNAL_TRACK;
        return ROBOT_OUTSIDE;
    }
    move->kind = ROBOT_JOINTS;
    move->target.by_joints = true;
    move->target.beside = c->external.kind;
    memcpy(move->target.joint, r->joint, sizeof r->joint);
    move->target.external = r->external + sign * (way > 0.0 ? el_min(way, left) : left);
    return robot_plan(r, c, move, NULL, NULL, why);
}

/* Whether the jog asked for is the one under way. */
static bool same(const struct robot *r, enum robot_frame frame, const double direction[6])
{
    return r->jogging && r->jog_held && r->jog_frame == frame
           && memcmp(r->jog_direction, direction, sizeof r->jog_direction) == 0;
}

/* CCN 18: what a jog asks for is looked at, number by number, before one of three is planned. */
enum robot_status robot_jog(struct robot *r, const struct robot_config *c, enum robot_frame frame,
                            const double direction[6], double share, double way,
                            struct robot_refusal *why)
{
    struct robot_move move = { .kind = ROBOT_LINE,
                               .share = share,
                               .feed = share * c->feed,
                               .spin = share * c->spin,
                               .target.branch = ROBOT_ANY_BRANCH };
    double velocity[3], turn[3], most = 0.0;

    memset(why, 0, sizeof *why);
    for (int i = 0; i < 6; i++) {
        most = el_max(most, fabs(direction[i]));
    }
    if (!(most > 0.0 && most <= ROBOT_MOST && share > 0.0 && share <= 1.0 && way >= 0.0
          && way <= ROBOT_MOST && (frame != ROBOT_IN_EXTERNAL || direction[0] != 0.0))) {
        return ROBOT_PARAMETER;
    }
    if (same(r, frame, direction)) {
        return ROBOT_OK;
    }
    if (!robot_idle(r) || r->trajectory.abort || r->trajectory.hold) {
        return ROBOT_BUSY;
    }
    robot_settle(r, c);
    r->jogging = true; /* its end need not be a target's */
    memcpy(velocity, direction, sizeof velocity);
    memcpy(turn, direction + 3, sizeof turn);
    if (frame == ROBOT_IN_TOOL) {
        quaternion_turn(r->pose.turn, velocity, velocity);
        quaternion_turn(r->pose.turn, turn, turn);
    }
    const double sign = direction[0] > 0.0 ? 1.0 : -1.0;
    const enum robot_status status =
        frame == ROBOT_IN_EXTERNAL ? jog_external(r, c, way, sign, &move, why)
        : frame == ROBOT_IN_JOINTS ? jog_joints(r, c, direction, way, &move, why)
                                   : jog_tip(r, c, velocity, turn, way, &move, why);
    r->jogging = r->jog_held = status == ROBOT_OK;
    r->jog_frame = frame;
    memcpy(r->jog_direction, direction, sizeof r->jog_direction);
    return status;
}

void robot_release(struct robot *r)
{
    if (r->jogging && r->jog_held) {
        r->jog_held = false;
        robot_abort(r);
    }
}
