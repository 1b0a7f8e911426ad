/* joint_move - moves of the joints: straight from their angles to others. */
#include "robot.h"

#include "robot_plan.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

/* Time of a joints' move at full speed is its way. [mm/s] */
static const double UNIT = 1000.0;

double robot_joint_speed(const struct robot_config *c, int joint)
{
    /* Both ends of a slot are rounded. */
    return el_min(c->arm.joint[joint].speed, (c->slot_pulses - 1.0) / (c->scale[joint] * c->slot));
}

double robot_external_speed(const struct robot_config *c)
{
    return el_min(c->external.speed, (c->slot_pulses - 1.0) / (c->external.scale * c->slot));
}

double robot_travel(const struct robot *r, const struct robot_move *move)
{
    return move->target.beside != EXTERNAL_NONE ? move->target.external - robot_end_external(r)
                                                : 0.0;
}

void robot_plan_joints(struct robot *r, const struct robot_config *c,
                       const double target[OPW_JOINTS], double travel, double share)
{
    struct arm_move m = { .kind = ARM_MOVE_JOINTS,
                          .external = { r->rear_external, r->rear_external + travel } };
    struct manipulator arm = c->arm;
    double end[AXES], way = 0.0, acc = INFINITY;

    arm.tool = r->tool;
    for (int i = 0; i < OPW_JOINTS; i++) {
        m.joint[i] = r->rear_joint[i];
        m.step[i] = target[i] - r->rear_joint[i];
        way = el_max(way, UNIT * fabs(m.step[i]) / robot_joint_speed(c, i));
    }
    if (travel != 0.0) {
        way = el_max(way, UNIT * fabs(travel) / robot_external_speed(c));
        acc = c->external.acc * way / fabs(travel);
    }
    for (int i = 0; i < OPW_JOINTS; i++) {
        acc = el_min(acc, c->arm.joint[i].acc * way / fabs(m.step[i]));
    }
    const struct pose pose = manipulator_pose(&arm, target);
    memcpy(m.turn, pose.turn, sizeof m.turn);
    arm_moves_add(&r->moves, &m, way);
    memcpy(end, r->rear, sizeof end);
    memcpy(end, pose.at, sizeof pose.at);
    end[arm_moves_axis(&r->moves)] += way;
    struct tool_path *w = &r->tool_path;
    path_line(&w->path, r->rear, end);
    w->path.length = way;
    w->segment[0] = (struct tool_path_segment){ 1.0, UNIT * share, acc };
    w->count = way > 0.0;
    w->next = 0;
    const double jerk = c->smooth > 0.0 ? acc / c->smooth : 0.0;
    memset(&r->command, 0, sizeof r->command);
    r->command.type = COMMAND_LINE;
    r->command.ramp = (struct ramp_limits){ acc, acc, jerk, jerk };
    r->stop = false;
    memcpy(r->rear, end, sizeof end);
    memcpy(r->rear_joint, target, sizeof r->rear_joint);
    r->rear_kind = ARM_MOVE_JOINTS;
    r->rear_zone = 0.0;
}

enum robot_status robot_to_joints(struct robot *r, const struct robot_config *c,
                                  const struct robot_move *move, struct robot_refusal *why)
{
    const struct robot_target *t = &move->target;
    struct manipulator arm = c->arm;
    double target[OPW_JOINTS];
    enum manipulator_status status = MANIPULATOR_OK;

    arm.tool = r->tool;
    memcpy(target, t->by_joints ? t->joint : r->rear_joint, sizeof target);
    if (t->by_joints) {
        why->which = manipulator_outside(&arm, r->rear_joint, target);
        status = why->which < 0 ? MANIPULATOR_OK : MANIPULATOR_OUTSIDE;
    } else {
        if (robot_tilted(&arm, &t->pose, why)) {
            return ROBOT_TILTED;
        }
        status = manipulator_solve(&arm, &t->pose, robot_branches(&arm, t),
                                   t->turned ? t->turn : NULL, target, &why->which);
    }
    why->part = 1.0;
    if (status == MANIPULATOR_FAR) {
        memcpy(why->place, t->pose.at, sizeof why->place);
        return ROBOT_FAR;
    }
    if (status == MANIPULATOR_OUTSIDE) {
        const struct manipulator_joint *j = &arm.joint[why->which];
        const struct pose at = manipulator_pose(&arm, target);
        memcpy(why->place, at.at, sizeof why->place);
        why->value = target[why->which];
        why->limit = why->value > j->high ? j->high : j->low;
        why->slides = manipulator_slides(&arm, why->which);
        return ROBOT_OUTSIDE;
    }
    double from[OPW_JOINTS];
    memcpy(from, r->rear_joint, sizeof from);
    robot_plan_joints(r, c, target, robot_travel(r, move), move->share);
    if (robot_flows(r, c, move)) {
        robot_flow_line(r, c, move, from, target);
    }
    return ROBOT_OK;
}
