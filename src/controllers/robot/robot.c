#include "robot.h"

#include "el_extremes.h"
#include "robot_plan.h"

#include <math.h>
#include <string.h>

static const double TURN = 6.283185307179586;

/* Feeds that differ by less than such a share are the same. */
static const double SAME = 1e-6;

/* A joint at more than this share of its speed has been asked for no less. */
static const double WHOLE = 0.99;

/* The trajectory gets places and no joints: pulses come from the joints at the end of the cycle. */
static const struct mechanism PLACES;

struct arm_geometry robot_geometry(const struct robot *r, struct manipulator *arm)
{
    arm->tool = r->tool;
    return (struct arm_geometry){ arm, &r->moves };
}

static void come_to_rest(struct robot *r, const struct robot_config *c)
{
    struct manipulator arm = c->arm;

    arm.tool = r->tool;
    r->pose = manipulator_pose(&arm, r->joint);
    arm_moves_start(&r->moves, r->pose.turn, r->external);
    memset(r->rear, 0, sizeof r->rear);
    memcpy(r->rear, r->pose.at, sizeof r->pose.at);
    external_to_world(&c->external, r->external, r->pose.at);
    memcpy(r->rear_joint, r->joint, sizeof r->joint);
    r->rear_external = r->external;
    r->rear_kind = ARM_MOVE_POSE;
    r->rear_zone = 0.0;
    r->tool_path.count = r->tool_path.next = 0;
    r->jogging = r->lost = false;
    joint_flow_clear(&r->flow);
    trajectory_stand(&r->trajectory, &PLACES, r->rear);
}

void robot_start(struct robot *r, const struct robot_config *c, const double joint[OPW_JOINTS])
{
    memset(r, 0, sizeof *r);
    trajectory_start(&r->trajectory);
    r->tool = c->arm.tool;
    memcpy(r->joint, joint, sizeof r->joint);
    come_to_rest(r, c);
}

void robot_place(struct robot *r, const struct robot_config *c, double external)
{
    r->external = external;
    come_to_rest(r, c);
}

bool robot_idle(const struct robot *r)
{
    return !trajectory_busy(&r->trajectory) && r->ring.count == 0
           && r->tool_path.next >= r->tool_path.count && !joint_flow_busy(&r->flow);
}

/* Whether the moves that flow stand, and go on by nothing but a hold's or an override's end. */
static bool flow_halts(const struct robot *r)
{
    return joint_flow_busy(&r->flow) && (r->trajectory.hold || r->trajectory.override[0] <= 0.0)
           && !r->trajectory.abort && joint_flow_rests(&r->flow);
}

bool robot_rests(const struct robot *r)
{
    if (joint_flow_busy(&r->flow)) {
        return flow_halts(r);
    }
    return trajectory_resting(&r->trajectory, &r->ring)
           && (r->tool_path.next >= r->tool_path.count || r->trajectory.hold);
}

bool robot_ready(const struct robot *r)
{
    return r->tool_path.next >= r->tool_path.count && !r->trajectory.abort
           && (!r->jogging || robot_idle(r)) && r->ring.count < RING_SIZE - ROBOT_ROOM
           && joint_flow_room(&r->flow);
}

int robot_open_flags(const struct manipulator *arm, const struct robot_target *t)
{
    return t->open | ~manipulator_flags(arm);
}

uint32_t robot_branches(const struct manipulator *arm, const struct robot_target *t)
{
    const int open = robot_open_flags(arm, t);
    uint32_t set = 0;

    for (int n = 0; n < OPW_BRANCHES; n++) {
        const bool good = t->branch == ROBOT_ANY_BRANCH || ((n ^ t->branch) & ~open) == 0;
        set |= (uint32_t)good << n;
    }
    return set;
}

void robot_settle(struct robot *r, const struct robot_config *c)
{
    if (robot_idle(r)) {
        come_to_rest(r, c);
    }
}

void robot_feed(struct robot *r)
{
    struct tool_path *w = &r->tool_path;

    while (w->next < w->count && r->ring.count < RING_SIZE - 1) {
        struct command c = r->command;
        const struct tool_path_segment *p = &w->segment[w->next];
        if (r->stop) {
            command_delay(&c, w->path.start, 0.0);
            r->stop = false;
            c.index = ++r->index;
            ring_push(&r->ring, &c);
            continue;
        }
        tool_path_next(w, &c.path);
        c.index = ++r->index;
        c.feed = c.cap = p->cap;
        if (c.tolerance > 0.0) {
            c.ramp = (struct ramp_limits){ robot_share(r->move.acc) * p->acc,
                                           robot_share(r->move.dec) * p->acc, 0.0, 0.0 };
            c.tolerance =
                w->next + 1 == w->count && r->move.zone > 0.0 ? r->move.zone : c.tolerance;
        }
        ring_push(&r->ring, &c);
        w->next++;
    }
}

static double apart(const double a[3], const double b[3])
{
    const double d[3] = { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
    return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

/* Set what the robot shows after a cycle. */
static void show(struct robot *r, const struct robot_config *c, const double joint[OPW_JOINTS],
                 double external, const struct pose *pose)
{
    const double way = apart(pose->at, r->pose.at);
    const double beside = (external - r->external) / c->cycle;

    r->external_gain = (beside - r->external_rate) / c->cycle;
    r->external_rate = beside;
    r->external = external;

    for (int i = 0; i < OPW_JOINTS; i++) {
        const double rate = (joint[i] - r->joint[i]) / c->cycle;
        r->gain[i] = (rate - r->rate[i]) / c->cycle;
        r->rate[i] = rate;
        r->joint[i] = joint[i];
    }
    r->pose = *pose;
    r->speed = way / c->cycle;
    r->length += way;
}

/* Joints near those of a place: they go on evenly with the way, as joint 4 does where it is free */
static void predict(const struct robot *r, const struct robot_config *c, const double place[AXES],
                    double joint[OPW_JOINTS])
{
    double at[3] = { r->pose.at[0], r->pose.at[1], r->pose.at[2] };
    external_to_arm(&c->external, r->external, at);
    const double before = r->speed * c->cycle, now = apart(place, at);
    const double ratio = before > 0.0 ? el_min(1.0, now / before) : 0.0;

    for (int i = 0; i < OPW_JOINTS; i++) {
        joint[i] = r->joint[i] + ratio * r->rate[i] * c->cycle;
    }
}

/* A cycle of moves that flow. */
static void flow_cycle(struct robot *r, const struct robot_config *c, const struct manipulator *arm)
{
    const struct trajectory *t = &r->trajectory;
    const double override = t->hold || t->abort ? 0.0 : t->override[0];
    const double left = joint_flow_advance(&r->flow, override, c->cycle);
    double joint[OPW_JOINTS];

    const struct joint_flow_piece *p = joint_flow_joints(&r->flow, joint);
    struct pose pose = manipulator_pose(arm, joint);
    external_to_world(&c->external, r->external, pose.at);
    show(r, c, joint, r->external, &pose);
    r->solved += p->solved ? r->speed * c->cycle : 0.0;
    r->line = p->line;
    if (left > 0.0) {
        joint_flow_clear(&r->flow);
    } else if (t->abort && joint_flow_rests(&r->flow)) {
        robot_stop(r);
    }
}

void robot_cycle(struct robot *r, const struct robot_config *c)
{
    struct manipulator arm;
    const struct arm_geometry g = { &arm, &r->moves };
    const struct kinematics kinematics = arm_moves_kinematics();
    const struct mechanism m = { .kinematics = &kinematics, .geometry = &g };
    double joint[OPW_JOINTS];
    struct pose pose = r->pose;
    const struct trajectory_beside beside = { &r->ring, &r->mean, NULL };
    struct point point;

    manipulator_with(&c->arm, &r->tool, &arm);
    memcpy(joint, r->joint, sizeof joint);
    if (robot_idle(r)) {
        show(r, c, joint, r->external, &pose);
        return;
    }
    if (joint_flow_busy(&r->flow)) {
        flow_cycle(r, c, &arm);
        return;
    }
    robot_feed(r);
    for (double left = c->cycle; left > 0.0 && !trajectory_resting(&r->trajectory, &r->ring);) {
        left = trajectory_advance(&r->trajectory, &beside, left);
        robot_feed(r);
    }
    trajectory_point(&r->trajectory, &beside, &PLACES, c->cycle, &point);
    predict(r, c, point.place, joint);
    if (!mechanism_joints(&m, point.place, joint)
        || manipulator_outside(&arm, r->joint, joint) >= 0) {
        memcpy(joint, r->joint, sizeof joint);
        r->lost = true;
        show(r, c, joint, r->external, &pose);
        robot_stop(r);
        return;
    }
    const double external = arm_moves_external(&r->moves, point.place);
    arm_moves_pose(&g, point.place, joint, &pose);
    external_to_world(&c->external, external, pose.at);
    show(r, c, joint, external, &pose);
    r->solved += arm_moves_by_joints(&r->moves, point.place) ? 0.0 : r->speed * c->cycle;
    r->line = point.line;
    trajectory_accept(&r->trajectory, &beside, &point);
}

/* Joints and the external axis. */
enum { DRIVEN = OPW_JOINTS + 1 };

/* Which of them takes the largest share of its limit, from 0. */
static int most_taken(const double share[DRIVEN])
{
    int most = 0;

    for (int i = 1; i < DRIVEN; i++) {
        most = share[i] > share[most] ? i : most;
    }
    return most;
}

/* Shares that they take of their speeds and accelerations. */
static void shares(const struct robot *r, const struct robot_config *c, double speed[DRIVEN],
                   double turn[DRIVEN])
{
    for (int i = 0; i < OPW_JOINTS; i++) {
        speed[i] = fabs(r->rate[i]) / robot_joint_speed(c, i);
        turn[i] = fabs(r->gain[i]) / c->arm.joint[i].acc;
    }
    const bool there = c->external.kind != EXTERNAL_NONE;
    speed[OPW_JOINTS] = there ? fabs(r->external_rate) / robot_external_speed(c) : 0.0;
    turn[OPW_JOINTS] = there ? fabs(r->external_gain) / c->external.acc : 0.0;
}

/* What limits moves that flow: what is neither speed, feed nor acceleration is jerk. */
static struct limited flow_limited(const struct robot *r, const struct robot_config *c, double feed)
{
    const struct trajectory *t = &r->trajectory;
    double speed[DRIVEN], turn[DRIVEN];

    shares(r, c, speed, turn);
    const int fast = most_taken(speed), bent = most_taken(turn);
    struct limited told = { .by = LIMITED_JERK, .axis = bent + 1 };

    if (t->hold || t->abort) {
        told = (struct limited){ .by = LIMITED_WAIT };
    } else if (speed[fast] > WHOLE) {
        told = (struct limited){ .by = LIMITED_SPEED, .axis = fast + 1 };
    } else if (joint_flow_feeds(&r->flow, WHOLE * t->override[0])) {
        told.by = LIMITED_FEED;
        told.axis = 0;
    } else if (turn[bent] > WHOLE || c->smooth <= 0.0) {
        told.by = LIMITED_ACCELERATION;
    }
    told.feed = feed;
    return told;
}

struct limited robot_limited(struct robot *r, const struct robot_config *c, double feed)
{
    const struct trajectory_beside beside = { &r->ring, &r->mean, NULL };
    struct limited told = { .by = LIMITED_STOP };
    double speed[DRIVEN], turn[DRIVEN];

    if (joint_flow_busy(&r->flow)) {
        return flow_limited(r, c, feed);
    }
    if (!robot_idle(r)) {
        told = trajectory_limited(&r->trajectory, &beside, &PLACES);
    }
    /* The joints have lowered the feed of the segment that is held: their speed, or the
     * acceleration that the bend of their paths takes. */
    const bool lowered = feed == 0.0 || told.feed < feed * (1.0 - SAME);
    if (told.by == LIMITED_FEED && lowered && r->trajectory.override[0] >= 1.0) {
        shares(r, c, speed, turn);
        const int fast = most_taken(speed), bent = most_taken(turn);
        const double whole = feed > 0.0 ? 1.0 / TOOL_PATH_UNEVEN : WHOLE;
        if (speed[fast] > whole) {
            told = (struct limited){ .by = LIMITED_SPEED, .axis = fast + 1 };
        } else if (feed > 0.0) {
            told = (struct limited){ .by = LIMITED_ACCELERATION, .axis = bent + 1 };
        }
    }
    told.feed = feed;
    return told;
}

void robot_hold(struct robot *r, bool on)
{
    trajectory_hold(&r->trajectory, on);
}

void robot_abort(struct robot *r)
{
    r->tool_path.next = r->tool_path.count;
    if (joint_flow_busy(&r->flow) && !joint_flow_rests(&r->flow)) {
        r->trajectory.abort = true;
        return;
    }
    joint_flow_clear(&r->flow);
    trajectory_abort(&r->trajectory, &r->ring);
}

void robot_stop(struct robot *r)
{
    r->tool_path.next = r->tool_path.count;
    joint_flow_clear(&r->flow);
    trajectory_stop(&r->trajectory, &r->ring);
}

void robot_override(struct robot *r, double share)
{
    const double s = el_max(0.0, el_min(1.0, share));
    trajectory_override(&r->trajectory, s, s);
}

void robot_end(const struct robot *r, double joint[OPW_JOINTS])
{
    memcpy(joint, robot_idle(r) ? r->joint : r->rear_joint, sizeof r->joint);
}

double robot_end_external(const struct robot *r)
{
    return robot_idle(r) ? r->external : r->rear_external;
}

enum robot_status robot_tool(struct robot *r, const struct robot_config *c, const struct pose *tool)
{
    if (!robot_idle(r)) {
        return ROBOT_BUSY;
    }
    r->tool = *tool;
    come_to_rest(r, c);
    return ROBOT_OK;
}

void robot_teach(const struct robot *r, const struct robot_config *c, struct robot_target *t)
{
    memset(t, 0, sizeof *t);
    t->by_joints = true;
    t->turned = true;
    t->pose = r->pose;
    t->branch = manipulator_branch(&c->arm, r->joint);
    t->beside = c->external.kind;
    t->external = r->external;
    memcpy(t->joint, r->joint, sizeof t->joint);
    for (int i = 0; i < OPW_JOINTS; i++) {
        const bool slides = manipulator_slides(&c->arm, i);
        t->turn[i] = slides ? ROBOT_ANY_TURN : (int)lround(r->joint[i] / TURN);
    }
}

int robot_factors(const struct robot *r, const struct robot_config *c, double factor[3])
{
    return manipulator_factors(&c->arm, r->joint, factor);
}
