#include "controller_places.h"

#include <math.h>
#include <string.h>

#include "orders_parts.h"

/* The number of the tool in force; those of a program are in its points. */
static int32_t tool_in_force(const struct controller *s, const struct controller_config *c,
                             const struct orders_text *t)
{
    int32_t n = 0;

    if (memcmp(&s->robot.tool, &c->robot.arm.tool, sizeof s->robot.tool) != 0) {
        for (n = ROBOT_JOB_FRAMES - 1; n > 0; n--) {
            const struct robot_job_frame *f = &t->points->tool[n];
            const struct pose tool = pose_of(f->value, f->value + 3);
            if (f->defined && memcmp(&tool, &s->robot.tool, sizeof tool) == 0) {
                break;
            }
        }
    }
    return n;
}

/* A pose by joints, with all of their configuration, but for turns that end just there, which are
 * then what is nearest. */
static void configure(const struct manipulator *arm, const double joint[OPW_JOINTS],
                      struct robot_job_point *q)
{
    static const double TURN = 6.283185307179586, EDGE = 1e-9;
    static const int TURNED[3] = { 0, 3, 5 };
    const int branch = manipulator_branch(arm, joint);

    q->shoulder = (branch & OPW_BACK) != 0;
    q->elbow = (branch & OPW_ELBOW) != 0;
    q->wrist = (branch & OPW_FLIP) != 0;
    for (int i = 0; i < 3; i++) {
        const double turns = joint[TURNED[i]] / TURN, whole = round(turns);
        q->turn[i] = fabs(turns - whole) < 0.5 - EDGE ? (int32_t)whole : ROBOT_JOB_ANY_TURN;
    }
}

static void write_pose(const struct pose *pose, double value[6])
{
    memcpy(value, pose->at, sizeof pose->at);
    quaternion_angles(pose->turn, value + 3);
}

void controller_places_here(const void *places, struct robot_job_point here[2])
{
    const struct controller_places *a = places;
    struct manipulator arm = a->c->robot.arm;
    const double *joint = a->s->robot.joint, place = a->s->robot.external;
    const struct external *external = &a->c->robot.external;

    arm.tool = a->s->robot.tool;
    struct pose pose = manipulator_pose(&arm, joint);
    external_to_world(external, place, pose.at);
    here[0] = here[1] = robot_job_point_open();
    here[0].kind = ROBOT_JOB_PULSES;
    here[0].tool = here[1].tool = tool_in_force(a->s, a->c, a->t);
    for (int i = 0; i < OPW_JOINTS; i++) {
        here[0].value[i] = joint[i] * a->c->orders.pulses[i];
    }
    if (external->kind != EXTERNAL_NONE) {
        here[0].beside = here[1].beside = true;
        here[0].external = place * external->scale;
        here[1].external = place / external_unit(external);
    }
    here[1].kind = ROBOT_JOB_POSE;
    here[1].user = 0;
    write_pose(&pose, here[1].value);
    configure(&arm, joint, &here[1]);
}

static struct pose tool_of(const struct controller_places *a, int32_t number)
{
    const double *f = a->t->points->tool[number].value;

    return number == 0 ? a->c->robot.arm.tool : pose_of(f, f + 3);
}

static struct pose user_of(const struct controller_places *a, int32_t number)
{
    const double *f = a->t->points->user[number].value;

    return pose_of(f, f + 3);
}

/* The pose of a position in the base that the arm has with a track at 0, with a tool. The one of
 * joints gets their configuration; without a place of the track it is for the one where that is. */
static struct pose pose_in_base(const struct controller_places *a, const struct robot_job_point *q,
                                int32_t tool, struct robot_job_point *made)
{
    struct manipulator arm = a->c->robot.arm;
    double joint[OPW_JOINTS];

    arm.tool = tool_of(a, tool);
    if (q->kind != ROBOT_JOB_POSE) {
        orders_job_joints(q, &a->c->orders, joint);
        configure(&arm, joint, made);
        struct pose pose = manipulator_pose(&arm, joint);
        external_to_world(&a->c->robot.external,
                          q->beside ? orders_job_outside(q, &a->c->robot.external)
                                    : a->s->robot.external,
                          pose.at);
        return pose;
    }
    const struct pose user = user_of(a, q->user), there = pose_of(q->value, q->value + 3);
    const struct pose pose = pose_product(&user, &there);
    if (q->tool == tool) {
        return pose;
    }
    const struct pose own = tool_of(a, q->tool), back = pose_inverse(&own);
    const struct pose flange = pose_product(&pose, &back);
    return pose_product(&flange, &arm.tool);
}

void controller_places_convert(const void *places, const struct robot_job_point *from,
                               struct robot_job_point *pose)
{
    const struct controller_places *a = places;

    pose->shoulder = from->shoulder;
    pose->elbow = from->elbow;
    pose->wrist = from->wrist;
    memcpy(pose->turn, from->turn, sizeof pose->turn);
    pose->beside = from->beside;
    if (from->beside) {
        const struct external *external = &a->c->robot.external;
        pose->external = orders_job_outside(from, external) / external_unit(external);
    }
    const struct pose there = pose_in_base(a, from, pose->tool, pose);
    const struct pose user = user_of(a, pose->user), back = pose_inverse(&user);
    const struct pose made = pose_product(&back, &there);
    write_pose(&made, pose->value);
}

void controller_places_shift(const void *places, const struct robot_job_point *from,
                             const struct robot_job_point *to, int32_t frame, double by[6])
{
    const struct controller_places *a = places;
    struct robot_job_point unused;
    const struct pose begin = pose_in_base(a, from, from->tool, &unused);
    const struct pose end = pose_in_base(a, to, to->tool, &unused);
    const struct pose frame_at = frame == ROBOT_JOB_BY_TOOL ? begin : user_of(a, frame);
    struct pose way;
    double back[4], undone[4], off[3];

    /* In the frame's axes F: F^-1 (b - a), and the turn F^-1 (B A^-1) F about them. */
    quaternion_inverse(frame_at.turn, back);
    for (int i = 0; i < 3; i++) {
        off[i] = end.at[i] - begin.at[i];
    }
    quaternion_turn(back, off, way.at);
    quaternion_inverse(begin.turn, undone);
    quaternion_product(end.turn, undone, way.turn);
    quaternion_product(back, way.turn, way.turn);
    quaternion_product(way.turn, frame_at.turn, way.turn);
    write_pose(&way, by);
}
