/* robot_spline - a spline of the tool joins the moves that flow. */
#include "robot.h"

#include <string.h>

#include "robot_plan.h"

/* Joints nearer than that are the same. [rad] */
static const double SAME = 1e-9;

/* Places of a piece where its joints are held against their ranges, if its control points say
 * nothing. */
enum { PLACES = 64 };

/* Whether the joints are where the latest spline leads on from. */
static bool continues(const struct robot *r)
{
    bool good = r->spline.goes_on;

    for (int i = 0; i < OPW_JOINTS; i++) {
        const double off = r->spline.end.r[i] / JOINT_CURVE_LEVER - r->rear_joint[i];
        good = good && off <= SAME && off >= -SAME;
    }
    return good;
}

/* Whether control points keep the joints within their ranges. */
static bool inside(const struct manipulator *arm, const struct segment *p)
{
    bool good = true;

    for (int i = 0; i < OPW_JOINTS; i++) {
        const double low = JOINT_CURVE_LEVER * arm->joint[i].low;
        const double high = JOINT_CURVE_LEVER * arm->joint[i].high;
        for (int k = 0; k < SEGMENT_POINTS; k++) {
            const double x = p->origin[i] + p->control[k][i];
            good = good && x >= low && x <= high;
        }
    }
    return good;
}

/* The part of the way where a joint is beyond its range, further than where it started; -1:
 * none. */
static double beyond(const struct manipulator *arm, const struct joint_curve_spline *s,
                     const double start[OPW_JOINTS], double joint[OPW_JOINTS])
{
    struct segment_state state;

    for (int32_t n = 0; n < s->count; n++) {
        const struct segment *p = &s->piece[n];
        const double from = n > 0 ? s->until[n - 1] : 0.0;
        for (int k = 1; k <= PLACES && !inside(arm, p); k++) {
            segment_at(p, p->length * k / PLACES, &state);
            for (int i = 0; i < OPW_JOINTS; i++) {
                joint[i] = state.point[i] / JOINT_CURVE_LEVER;
            }
            if (manipulator_outside(arm, start, joint) >= 0) {
                return from + (s->until[n] - from) * k / PLACES;
            }
        }
    }
    return -1.0;
}

/* Why a spline is refused, by what its joints would do. */
static enum robot_status judge(const struct robot *r, const struct manipulator *arm,
                               const struct robot_move *move, const struct joint_curve_spline *s,
                               struct robot_refusal *why)
{
    double joint[OPW_JOINTS];

    memcpy(joint, r->rear_joint, sizeof joint);
    if (s->count == 0) {
        why->part = s->at;
        why->which = manipulator_factor(arm, joint, &why->value);
        return s->lost ? ROBOT_FAR : ROBOT_SINGULAR;
    }
    if (move->singular == ROBOT_REFUSE && s->slow >= 0.0) {
        why->part = s->slow;
        why->which = manipulator_factor(arm, joint, &why->value);
        return ROBOT_SINGULAR;
    }
    why->part = beyond(arm, s, r->rear_joint, joint);
    if (why->part >= 0.0) {
        why->which = manipulator_outside(arm, r->rear_joint, joint);
        const struct manipulator_joint *j = &arm->joint[why->which];
        why->value = joint[why->which];
        why->limit = why->value > j->high ? j->high : j->low;
        why->slides = manipulator_slides(arm, why->which);
        return ROBOT_OUTSIDE;
    }
    for (int i = 0; i < OPW_JOINTS; i++) {
        joint[i] = s->end.r[i] / JOINT_CURVE_LEVER;
    }
    why->part = 1.0;
    return robot_check_end(arm, &move->target, joint, why);
}

enum robot_status robot_to_spline(struct robot *r, const struct robot_config *c,
                                  const struct robot_move *move, struct robot_refusal *why)
{
    struct manipulator arm;
    struct tool_spline way;
    struct joint_curve_spline s;
    struct joint_curve_node start = { .part = -1.0 };
    struct pose target = move->target.pose, next = move->next;

    manipulator_with(&c->arm, &r->tool, &arm);
    const struct pose from = manipulator_pose(&arm, r->rear_joint);
    struct joint_curve_limits l = robot_flow_limits(r, c, robot_feed_of(c, move));
    const bool goes = continues(r);

    l.spin = robot_spin_of(c, move);
    if (move->target.by_joints) {
        target = manipulator_pose(&arm, move->target.joint);
    }
    quaternion_normalise(target.turn);
    quaternion_normalise(next.turn);
    if (robot_tilted(&arm, &target, why) || (move->goes_on && robot_tilted(&arm, &next, why))) {
        return ROBOT_TILTED;
    }
    for (int i = 0; i < OPW_JOINTS; i++) {
        start.r[i] = JOINT_CURVE_LEVER * r->rear_joint[i];
    }
    if (goes) {
        start = r->spline.end;
        start.part = 0.0;
    }
    if (!tool_spline_make(&way, goes ? &r->spline.start : NULL, &from, &target,
                          move->goes_on ? &next : NULL)) {
        memcpy(why->place, target.at, sizeof why->place);
        return ROBOT_NO_SPLINE;
    }
    joint_curve_spline(&way, &arm, &start, &l, &s);
    const enum robot_status status = judge(r, &arm, move, &s, why);
    if (status != ROBOT_OK) {
        const struct pose at = tool_spline_pose(&way, TOOL_SPLINE_WAY, why->part);
        memcpy(why->place, at.at, sizeof why->place);
        return status;
    }
    double end[OPW_JOINTS];
    for (int i = 0; i < OPW_JOINTS; i++) {
        end[i] = s.end.r[i] / JOINT_CURVE_LEVER;
    }
    robot_plan_joints(r, c, end, 0.0, 1.0);
    robot_flow_pieces(r, c, move, s.count, s.piece);
    r->spline.start = from;
    r->spline.end = s.end;
    return ROBOT_OK;
}
