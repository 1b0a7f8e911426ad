/* robot_move - a move becomes a path of the tool: where it leads, how fast it may be, why it is
 * refused. */
#include "robot.h"

#include "robot_plan.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"
#include "elementary.h"

static const double TURN = 6.283185307179586;

/* Corners between segments of one path are none, whatever the tolerance. [mm] */
static const double WIDE = 1e9;

/* Two orientations that are the same; joints on a branch that is not certain. [rad] */
static const double SAME = 1e-12, DOUBTFUL = 1e-9;

/* A path of the tip shorter than this share of its turning counts as none. */
static const double STILL = 1e-3;

/* The external axis counts so much of its coordinate. [mm/m] [mm/rad] */
static const double METRE = 1000.0;

/* A path this short is rounding. [mm] */
static const double NOWHERE = 1e-9;

/* Sine of joint 5 from which on its direction is certain; how far joint 4 may jump. [rad] */
static const double BENT = 1e-7, JUMP = 1e-8;

/* The start of an arc is in its plane, its normal of length 1, but for what programs round: no arm
 * shows as much. [mm], 1 */
static const double PLANE = 1e-6, UNIT_LENGTH = 1e-9;

static bool all_sound(const double *x, int n)
{
    bool good = true;
    for (int i = 0; i < n; i++) {
        good = good && fabs(x[i]) <= ROBOT_MOST;
    }
    return good;
}

/* Index of the axis of the base that a unit vector is; -1: it is none. */
static int axis_of(const double v[3])
{
    for (int i = 0; i < 3; i++) {
        if (fabs(v[i]) == 1.0) {
            return i;
        }
    }
    return -1;
}

static bool all_from_0(const double *x, int n)
{
    bool good = true;
    for (int i = 0; i < n; i++) {
        good = good && x[i] >= 0.0 && isfinite(x[i]);
    }
    return good;
}

/* CCN 23: a row of limits that all must hold. */
static bool sound(const struct robot_move *m)
{
    const struct robot_target *t = &m->target;
    const double from_0[] = { m->feed, m->spin, m->acc, m->dec, m->zone, m->radius, m->part };
    return all_sound(t->joint, OPW_JOINTS) && all_sound(&t->external, 1) && all_sound(t->pose.at, 3)
           && all_sound(t->pose.turn, 4) && all_sound(m->via, 3) && all_sound(m->centre, 3)
           && all_sound(m->normal, 3)
           && (!m->goes_on || (all_sound(m->next.at, 3) && all_sound(m->next.turn, 4)))
           && all_sound(&m->sweep, 1) && all_sound(&m->rise, 1)
           && (m->rise == 0.0 || axis_of(m->normal) >= 0)
           && all_from_0(from_0, sizeof from_0 / sizeof *from_0) && m->part <= 0.5 && m->acc <= 1.0
           && m->dec <= 1.0 && (m->kind != ROBOT_JOINTS || (m->share > 0.0 && m->share <= 1.0))
           && t->branch >= ROBOT_ANY_BRANCH && t->branch < OPW_BRANCHES;
}

/* An arc about an axis becomes a helix. */
static void wind(struct path *p, int axis, double rise)
{
    const enum path_plane plane = (enum path_plane)axis;
    const int a = path_first(plane), b = path_second(plane);

    p->plane = plane;
    p->centre[0] = p->middle[a];
    p->centre[1] = p->middle[b];
    p->angle = el_atan2(p->start[b] - p->centre[1], p->start[a] - p->centre[0]);
    p->sweep *= p->normal[axis];
    p->length = el_hypot(p->length, rise);
}

/* Path of the tip; U V W go on to where those of the latest move of the arm end. */
static enum robot_status draw(struct robot *r, const struct robot_move *move,
                              const double target[3])
{
    const int axis = arm_moves_axis(&r->moves);
    struct path *p = &r->tool_path.path;
    double end[AXES], middle[3], normal[3], sweep = move->sweep;

    memcpy(end, r->rear, sizeof end);
    memcpy(end, target, 3 * sizeof *target);
    end[axis] = r->moves.at[axis - 3];
    if (move->kind == ROBOT_LINE) {
        path_line(p, r->rear, end);
        return ROBOT_OK;
    }
    memcpy(middle, move->centre, sizeof middle);
    memcpy(normal, move->normal, sizeof normal);
    if (move->kind == ROBOT_CIRCLE
        && path_tilted_by_point(r->rear, move->via, end, middle, normal, &sweep) != PATH_OK) {
        return ROBOT_NO_CIRCLE;
    }
    if (path_tilted(p, r->rear, end, middle, normal, sweep) != PATH_OK) {
        return ROBOT_NO_CIRCLE;
    }
    memcpy(p->end, end, sizeof end);
    if (move->rise != 0.0) {
        wind(p, axis_of(normal), move->rise);
    }
    return ROBOT_OK;
}

/* Orientation at the end of the latest move. */
static void rear_turn(const struct robot *r, const struct manipulator *arm, double turn[4])
{
    const struct arm_geometry g = { arm, &r->moves };
    struct pose rear;

    arm_moves_pose(&g, r->rear, r->rear_joint, &rear);
    memcpy(turn, rear.turn, sizeof rear.turn);
}

/* The move of the arm from the rear to a pose, turned by a vector [rad]. */
static enum robot_status enter(struct robot *r, const struct manipulator *arm,
                               const struct robot_move *move, const struct pose *pose,
                               const double by[3])
{
    const double travel = robot_travel(r, move);
    struct arm_move m = { .kind = ARM_MOVE_POSE,
                          .external = { r->rear_external, r->rear_external + travel } };
    double way = ARM_MOVES_LEVER * sqrt(by[0] * by[0] + by[1] * by[1] + by[2] * by[2]);

    rear_turn(r, arm, m.turn);
    if (move->singular == ROBOT_WRIST) {
        double end[OPW_JOINTS];
        memcpy(end, r->rear_joint, sizeof end);
        if (!manipulator_joints(arm, pose, end)) {
            return ROBOT_FAR;
        }
        m.kind = ARM_MOVE_WRIST;
        memcpy(m.turn, pose->turn, sizeof m.turn);
        way = 1.0; /* its coordinate moves in any case */
        for (int i = 0; i < OPW_JOINTS; i++) {
            m.joint[i] = r->rear_joint[i];
            m.step[i] = end[i] - r->rear_joint[i];
            way = i > 2 ? el_max(way, ARM_MOVES_LEVER * fabs(m.step[i])) : way;
        }
    } else if (way > ARM_MOVES_LEVER * SAME) {
        memcpy(m.by, by, sizeof m.by);
    } else {
        way = 0.0;
    }
    way = el_max(way, METRE * fabs(travel));
    arm_moves_add(&r->moves, &m, way);
    const enum robot_status status = draw(r, move, pose->at);
    r->tool_path.path.length =
        r->tool_path.path.length < STILL * way ? way : r->tool_path.path.length;
    return status;
}

/* At the rear axes of the wrist are in line, so one joint is free; the path needs it elsewhere:
 * joints with which it begins. */
static bool turns_first(const struct robot *r, const struct manipulator *arm,
                        const struct pose *rear, double joint[OPW_JOINTS])
{
    const struct arm_geometry g = { arm, &r->moves };
    double place[AXES], slope[AXES], q[OPW_JOINTS], factor[3];
    const int open = manipulator_open(arm);

    manipulator_factors(arm, r->rear_joint, factor);
    if (fabs(factor[2]) > DOUBTFUL) {
        return false;
    }
    for (double part = 0x1p-44; part <= 1.0; part *= 2.0) {
        path_at(&r->tool_path.path, part * r->tool_path.path.length, place, slope);
        memcpy(q, r->rear_joint, sizeof q);
        if (!arm_moves_kinematics().joints(&g, place, q)) {
            return false;
        }
        manipulator_factors(arm, q, factor);
        if (fabs(factor[2]) > BENT) {
            memcpy(joint, r->rear_joint, sizeof q);
            joint[open] = q[open];
            return fabs(q[open] - r->rear_joint[open]) > JUMP
                   && manipulator_joints(arm, rear, joint);
        }
    }
    return false;
}

/* CCN 17: a target says the end by joints, by a branch, by turns, or leaves it open. */
enum robot_status robot_check_end(const struct manipulator *arm, const struct robot_target *t,
                                  const double end[OPW_JOINTS], struct robot_refusal *why)
{
    const int branch = t->by_joints ? manipulator_branch(arm, t->joint) : t->branch;
    double factor[3];

    manipulator_factors(arm, end, factor);
    for (int i = 0; i < 3 && branch != ROBOT_ANY_BRANCH; i++) {
        const int flag = (i == 0   ? OPW_BACK
                          : i == 1 ? OPW_ELBOW
                                   : OPW_FLIP)
                         & ~robot_open_flags(arm, t);
        if (fabs(factor[i]) > DOUBTFUL && ((branch ^ manipulator_branch(arm, end)) & flag)) {
            why->which = flag;
            why->value = factor[i];
            return ROBOT_OTHER_BRANCH;
        }
    }
    for (int i = 0; i < OPW_JOINTS && (t->by_joints || t->turned); i++) {
        if (manipulator_slides(arm, i) || (!t->by_joints && t->turn[i] == ROBOT_ANY_TURN)) {
            continue;
        }
        const double off = t->by_joints ? end[i] - t->joint[i] : end[i] - TURN * t->turn[i];
        if (fabs(off) > 0.5 * TURN + DOUBTFUL) {
            why->which = i;
            why->value = end[i];
            why->limit = t->by_joints ? t->joint[i] : TURN * t->turn[i];
            return ROBOT_OTHER_TURN;
        }
    }
    return ROBOT_OK;
}

static enum robot_status told(const struct manipulator *arm, enum tool_path_status status,
                              const struct tool_path_fault *fault, struct robot_refusal *why)
{
    const struct manipulator_joint *j = &arm->joint[fault->which];

    why->part = fault->part;
    why->which = fault->which;
    switch (status) {
    case TOOL_PATH_OK: return ROBOT_OK;
    case TOOL_PATH_OUTSIDE:
        why->value = fault->joint[fault->which];
        why->limit = why->value > j->high ? j->high : j->low;
        why->slides = manipulator_slides(arm, fault->which);
        return ROBOT_OUTSIDE;
    default:
        why->which = manipulator_factor(arm, fault->joint, &why->value);
        return status == TOOL_PATH_FAR ? ROBOT_FAR : ROBOT_SINGULAR;
    }
}

double robot_feed_of(const struct robot_config *c, const struct robot_move *move)
{
    return move->feed > 0.0 ? el_min(move->feed, c->feed) : c->feed;
}

double robot_spin_of(const struct robot_config *c, const struct robot_move *move)
{
    return move->spin > 0.0 ? el_min(move->spin, c->spin) : c->spin;
}

/* Speed along the path that feed and turning allow. */
static double feed_of(const struct robot *r, const struct robot_config *c,
                      const struct robot_move *move, const double by[3])
{
    const double angle = sqrt(by[0] * by[0] + by[1] * by[1] + by[2] * by[2]);
    const double feed = robot_feed_of(c, move), spin = robot_spin_of(c, move);
    const double length = r->tool_path.path.length;

    if (!(angle > SAME) || move->singular == ROBOT_WRIST) {
        return feed;
    }
    const double turning = spin * length / angle;
    return length == ARM_MOVES_LEVER * angle ? turning : el_min(feed, turning); /* it turns only */
}

/* Limits of a path on which the external axis goes evenly, by `travel`; feed and acceleration are
 * those of the tip in the world, where the way of a line is another one. */
static void share_path(const struct robot *r, const struct robot_config *c,
                       const struct robot_move *move, const double by[3], double travel,
                       struct tool_path_limits *l)
{
    const struct path *p = &r->tool_path.path;
    const double angle = sqrt(by[0] * by[0] + by[1] * by[1] + by[2] * by[2]);
    double from[3], to[3], square = 0.0;

    memcpy(from, p->start, sizeof from);
    memcpy(to, p->end, sizeof to);
    external_to_world(&c->external, r->rear_external, from);
    external_to_world(&c->external, r->rear_external + travel, to);
    for (int i = 0; i < 3; i++) {
        square += (to[i] - from[i]) * (to[i] - from[i]);
    }
    const double way = move->kind == ROBOT_LINE ? sqrt(square) : p->length;
    const double per = p->length / way, each = p->length / fabs(travel); /* infinite: it rests */
    l->feed = el_min(robot_feed_of(c, move) * per, robot_external_speed(c) * each);
    l->acc = el_min(c->acc * per, c->external.acc * each);
    if (angle > SAME && move->singular != ROBOT_WRIST) {
        l->feed = el_min(l->feed, robot_spin_of(c, move) * p->length / angle);
    }
}

/* What the path of a move may take; `chained`: a corner joins it with the move before. */
static struct tool_path_limits limits_of(const struct robot *r, const struct robot_config *c,
                                         const struct robot_move *move, const double by[3],
                                         bool chained)
{
    const double travel = robot_travel(r, move);
    const bool joined = move->singular != ROBOT_WRIST && !robot_flows(r, c, move) && travel == 0.0;
    struct tool_path_limits l = { .feed = feed_of(r, c, move, by),
                                  .acc = c->acc,
                                  .smooth = c->smooth,
                                  .zone = { chained ? r->rear_zone : 0.0,
                                            joined ? move->zone : 0.0 },
                                  .refuse = move->singular == ROBOT_REFUSE };

    for (int i = 0; i < OPW_JOINTS; i++) {
        l.speed[i] = robot_joint_speed(c, i);
        l.turn[i] = c->arm.joint[i].acc;
    }
    if (travel != 0.0) {
        share_path(r, c, move, by, travel, &l);
    }
    return l;
}

bool robot_tilted(const struct manipulator *arm, const struct pose *pose, struct robot_refusal *why)
{
    const double tilt = manipulator_tilt(arm, pose);

    if (tilt <= DOUBTFUL) {
        return false;
    }
    why->value = tilt;
    memcpy(why->place, pose->at, sizeof why->place);
    return true;
}

/* Whether a path that turns the tool by a vector would tilt it as the arm cannot. A whole turn
 * comes back to where it began, so of large ones the first radian is looked at. */
static bool turns_over(const struct robot *r, const struct manipulator *arm,
                       const struct pose *pose, const double by[3], struct robot_refusal *why)
{
    const double angle = sqrt(by[0] * by[0] + by[1] * by[1] + by[2] * by[2]);
    struct pose p = *pose;
    double q[4];

    if (robot_tilted(arm, pose, why)) {
        return true;
    }
    if (angle > 1.0) {
        const double part[3] = { by[0] / angle, by[1] / angle, by[2] / angle };
        quaternion_by_vector(part, q);
        rear_turn(r, arm, p.turn);
        quaternion_product(q, p.turn, p.turn);
    }
    return angle > 1.0 && robot_tilted(arm, &p, why);
}

/* CCN 25: a move that turns first is two moves, which are accepted together or refused together; at
 * its ends corners and stops are told apart. */
static enum robot_status along(struct robot *r, const struct robot_config *c,
                               const struct robot_move *move, const struct pose *pose,
                               const double by[3], struct robot_refusal *why)
{
    struct manipulator arm = c->arm;
    const struct arm_geometry g = robot_geometry(r, &arm);
    struct command first = { .index = 0 };
    double joint[OPW_JOINTS], began[OPW_JOINTS], start[OPW_JOINTS];
    struct tool_path_fault fault = { 0 };
    const bool flows = robot_flows(r, c, move);
    struct pose rear;

    if (turns_over(r, &arm, pose, by, why)) {
        return ROBOT_TILTED;
    }
    memcpy(began, r->rear_joint, sizeof began);
    memcpy(rear.at, r->rear, sizeof rear.at);
    rear_turn(r, &arm, rear.turn);
    bool chained = r->rear_kind == ARM_MOVE_POSE && r->rear_zone > 0.0
                   && move->singular != ROBOT_WRIST && robot_travel(r, move) == 0.0;
    enum robot_status status = enter(r, &arm, move, pose, by);
    if (status == ROBOT_OK && r->tool_path.path.length >= NOWHERE && move->singular != ROBOT_WRIST
        && turns_first(r, &arm, &rear, joint)) {
        arm_moves_drop(&r->moves);
        robot_plan_joints(r, c, joint, 0.0, 1.0);
        first = r->command;
        tool_path_next(&r->tool_path, &first.path);
        first.feed = first.cap = r->tool_path.segment[0].cap;
        first.index = r->index + 1;
        first.line = move->line;
        chained = false;
        status = enter(r, &arm, move, pose, by);
    }
    if (status != ROBOT_OK) {
        return status;
    }
    r->tool_path.count = r->tool_path.next = 0;
    if (r->tool_path.path.length < NOWHERE) {
        arm_moves_drop(&r->moves);
        return robot_check_end(&arm, &move->target, r->rear_joint, why);
    }
    const struct tool_path_limits l = limits_of(r, c, move, by, chained);
    memcpy(joint, r->rear_joint, sizeof joint);
    memcpy(start, joint, sizeof start);
    status = told(&arm, tool_path_plan(&r->tool_path, &g, &l, joint, &fault), &fault, why);
    if (status == ROBOT_OK && !r->jogging) {
        why->part = 1.0;
        status = robot_check_end(&arm, &move->target, joint, why);
    }
    if (status != ROBOT_OK) {
        double slope[AXES], place[AXES];
        path_at(&r->tool_path.path, why->part * r->tool_path.path.length, place, slope);
        memcpy(why->place, place, sizeof why->place);
        return status;
    }
    if (flows && !robot_flow_path(r, c, move, first.index > 0 ? began : NULL, start, l.feed)) {
        why->which = manipulator_factor(&arm, start, &why->value);
        return ROBOT_SINGULAR;
    }
    if (!flows && first.index > 0) {
        ring_push(&r->ring, &first);
        r->index++;
    }
    memset(&r->command, 0, sizeof r->command);
    r->command.type = r->tool_path.path.arc ? COMMAND_CCW_ARC : COMMAND_LINE;
    r->command.blend = true;
    r->command.tolerance = WIDE;
    r->command.smooth = r->tool_path.smooth;
    r->stop = !chained || r->tool_path.stop[0];
    memcpy(r->rear, r->tool_path.path.end, sizeof r->rear);
    memcpy(r->rear_joint, joint, sizeof joint);
    r->rear_kind = move->singular == ROBOT_WRIST ? ARM_MOVE_WRIST : ARM_MOVE_POSE;
    r->rear_zone = r->tool_path.stop[1] || flows || robot_travel(r, move) != 0.0 ? 0.0 : move->zone;
    return ROBOT_OK;
}

/* Whether an arc's numbers are those of a circle through the rear. */
static enum robot_status round_arc(const struct robot *r, const struct robot_move *move,
                                   struct robot_refusal *why)
{
    double height = 0.0, square = 0.0;

    for (int i = 0; i < 3; i++) {
        height += (r->rear[i] - move->centre[i]) * move->normal[i];
        square += move->normal[i] * move->normal[i];
    }
    why->value = sqrt(square);
    why->limit = 1.0;
    if (!(fabs(why->value - 1.0) <= UNIT_LENGTH)) {
        return ROBOT_NO_UNIT;
    }
    why->value = height;
    why->limit = PLANE;
    return fabs(height) <= PLANE ? ROBOT_OK : ROBOT_OFF_PLANE;
}

/* Pose of the tip at the end of a move's path. */
static enum robot_status aim(const struct robot *r, const struct manipulator *arm,
                             const struct robot_move *move, struct pose *pose,
                             struct robot_refusal *why)
{
    struct path p;

    *pose = move->target.by_joints ? manipulator_pose(arm, move->target.joint) : move->target.pose;
    quaternion_normalise(pose->turn);
    if (move->kind == ROBOT_ARC) {
        const enum robot_status status = round_arc(r, move, why);
        if (status != ROBOT_OK) {
            memcpy(why->place, r->rear, sizeof why->place);
            return status;
        }
        memset(why, 0, sizeof *why);
        if (path_tilted(&p, r->rear, r->rear, move->centre, move->normal, move->sweep) != PATH_OK) {
            return ROBOT_NO_CIRCLE;
        }
        for (int i = 0; i < 3; i++) {
            pose->at[i] = p.end[i] + move->rise * move->normal[i];
        }
    }
    return ROBOT_OK;
}

static enum robot_status along_path(struct robot *r, const struct robot_config *c,
                                    const struct robot_move *move, struct robot_refusal *why)
{
    struct manipulator arm = c->arm;
    struct pose pose;
    double turn[4], by[3];

    arm.tool = r->tool;
    const enum robot_status status = aim(r, &arm, move, &pose, why);
    if (status != ROBOT_OK) {
        return status;
    }
    rear_turn(r, &arm, turn);
    quaternion_inverse(turn, turn);
    quaternion_product(pose.turn, turn, turn);
    quaternion_vector(turn, by);
    return along(r, c, move, &pose, by, why);
}

struct rear {
    double place[AXES], joint[OPW_JOINTS], at[3];
    enum arm_move_kind kind;
    double zone;
    int32_t count;
};

static struct rear keep(const struct robot *r)
{
    struct rear k = { .kind = r->rear_kind, .zone = r->rear_zone, .count = r->moves.count };
    memcpy(k.place, r->rear, sizeof k.place);
    memcpy(k.joint, r->rear_joint, sizeof k.joint);
    memcpy(k.at, r->moves.at, sizeof k.at);
    return k;
}

static void put_back(struct robot *r, const struct rear *k)
{
    r->rear_kind = k->kind;
    r->rear_zone = k->zone;
    r->moves.count = k->count;
    r->tool_path.count = r->tool_path.next = 0;
    memcpy(r->rear, k->place, sizeof k->place);
    memcpy(r->rear_joint, k->joint, sizeof k->joint);
    memcpy(r->moves.at, k->at, sizeof k->at);
}

enum robot_status robot_plan(struct robot *r, const struct robot_config *c,
                             const struct robot_move *move, const struct pose *pose,
                             const double by[3], struct robot_refusal *why)
{
    const struct rear before = keep(r);
    const enum robot_status status = move->kind == ROBOT_JOINTS   ? robot_to_joints(r, c, move, why)
                                     : move->kind == ROBOT_SPLINE ? robot_to_spline(r, c, move, why)
                                     : pose                       ? along(r, c, move, pose, by, why)
                                                                  : along_path(r, c, move, why);

    if (status != ROBOT_OK) {
        put_back(r, &before);
        return status;
    }
    r->rear_external += robot_travel(r, move);
    r->spline.goes_on = move->kind == ROBOT_SPLINE && move->goes_on;
    r->move = *move;
    r->command.line = move->line;
    r->command.ramp.acc *= robot_share(move->acc);
    r->command.ramp.dec *= robot_share(move->dec);
    robot_feed(r);
    return ROBOT_OK;
}

/* Whether a move's target says nothing of joints that the arm has not. */
static bool all_there(const struct manipulator *arm, const struct robot_target *t,
                      struct robot_refusal *why)
{
    why->limit = manipulator_joints_of(arm);
    for (int i = manipulator_joints_of(arm); i < OPW_JOINTS && t->by_joints; i++) {
        if (t->joint[i] != 0.0) {
            why->which = i;
            return false;
        }
    }
    why->limit = 0.0;
    return true;
}

/* Whether there is an external axis that can do its part of a move. */
static enum robot_status beside(const struct robot *r, const struct robot_config *c,
                                const struct robot_move *m, struct robot_refusal *why)
{
    const bool straight = m->kind == ROBOT_JOINTS || m->kind == ROBOT_LINE;
    const bool table = c->external.kind == EXTERNAL_TABLE && m->kind != ROBOT_SPLINE;

    if (m->target.beside == EXTERNAL_NONE) {
        return ROBOT_OK;
    }
    why->which = OPW_JOINTS;
    why->value = m->target.external;
    why->slides = c->external.kind == EXTERNAL_TRACK;
    if (m->target.beside != c->external.kind) {
        why->limit = manipulator_joints_of(&c->arm);
        return ROBOT_NO_JOINT;
    }
    if (external_outside(&c->external, robot_end_external(r), m->target.external, &why->limit)) {
        memcpy(why->place, r->pose.at, sizeof why->place);
        return ROBOT_OUTSIDE;
    }
    return straight || table || robot_travel(r, m) == 0.0 ? ROBOT_OK : ROBOT_BESIDE;
}

/* The move as the arm's base at its end sees it. */
static struct robot_move from_base(const struct robot *r, const struct robot_config *c,
                                   const struct robot_move *move)
{
    const double end = robot_end_external(r) + robot_travel(r, move);
    struct robot_move m = *move;

    external_to_arm(&c->external, end, m.target.pose.at);
    external_to_arm(&c->external, end, m.via);
    external_to_arm(&c->external, end, m.centre);
    external_to_arm(&c->external, end, m.next.at);
    return m;
}

enum robot_status robot_move(struct robot *r, const struct robot_config *c,
                             const struct robot_move *move, struct robot_refusal *why)
{
    memset(why, 0, sizeof *why);
    if (!robot_ready(r)) {
        return ROBOT_BUSY;
    }
    if (!sound(move) || (c->arm.by_axes && move->singular == ROBOT_WRIST)) {
        return ROBOT_PARAMETER;
    }
    if (!all_there(&c->arm, &move->target, why)) {
        return ROBOT_NO_JOINT;
    }
    const enum robot_status able = beside(r, c, move, why);
    if (able != ROBOT_OK) {
        return able;
    }
    memset(why, 0, sizeof *why);
    if (robot_flows(r, c, move) ? trajectory_busy(&r->trajectory) || r->ring.count > 0
                                : joint_flow_busy(&r->flow)) {
        return ROBOT_BUSY;
    }
    robot_settle(r, c);
    const struct robot_move m = from_base(r, c, move);
    const enum robot_status status = robot_plan(r, c, &m, NULL, NULL, why);
    if (status != ROBOT_OK) {
        const double at = r->rear_external + why->part * robot_travel(r, move);
        external_to_world(&c->external, at, why->place);
    }
    return status;
}
