/* orders_job - the requests of a job as orders. */
#include "orders_parts.h"

static const double DEGREE = 0.017453292519943295, MM = 1e-3;
_Static_assert((int)EXTERNAL_TRACK == (int)ROBOT_JOB_BASE_AXIS
                   && (int)EXTERNAL_TABLE == (int)ROBOT_JOB_STATION_AXIS,
               "a kind is an axis of the language");
/* Flags of the inverse kinematics for BACK, DOWN, FLIP of a configuration. */
static const int FLAG[3] = { OPW_BACK, OPW_ELBOW, OPW_FLIP };

static struct pose frame_pose(const struct robot_job_frame *f)
{
    return pose_of(f->value, f->value + 3);
}

void orders_job_joints(const struct robot_job_point *p, const struct orders_config *c,
                       double joint[OPW_JOINTS])
{
    for (int i = 0; i < OPW_JOINTS; i++) {
        joint[i] = p->kind == ROBOT_JOB_PULSES ? p->value[i] / c->pulses[i]
                                               : p->value[i] * (c->slides[i] ? MM : DEGREE);
    }
}

/* A point becomes a target. What its configuration leaves open is what is nearest, or on a path
 * what the path leads to. */
static void target_of(struct robot_target *t, const struct robot_job_point *p,
                      const struct robot_job_frame *user, const struct orders_config *c)
{
    static const int TURNED[3] = { 0, 3, 5 };
    const int32_t said[3] = { p->shoulder, p->elbow, p->wrist };

    t->by_joints = p->kind != ROBOT_JOB_POSE;
    orders_job_joints(p, c, t->joint);
    for (int i = 0; i < OPW_JOINTS; i++) {
        t->turn[i] = ROBOT_ANY_TURN;
    }
    const struct pose frame = frame_pose(user), there = pose_of(p->value, p->value + 3);
    t->pose = pose_product(&frame, &there);
    for (int i = 0; i < 3; i++) {
        t->open |= said[i] == ROBOT_JOB_ANY || said[i] >= ROBOT_JOB_WRIST_NEAR ? FLAG[i] : 0;
        t->branch |= said[i] == 1 ? FLAG[i] : 0;
        if (p->turn[i] != ROBOT_JOB_ANY_TURN) {
            t->turned = true;
            t->turn[TURNED[i]] = p->turn[i];
        }
    }
}

double orders_job_outside(const struct robot_job_point *p, const struct external *e)
{
    return p->kind == ROBOT_JOB_PULSES ? p->external / e->scale : p->external * external_unit(e);
}

/* The axis outside the arm goes to the place of a point, if that has one. */
static void beside(struct robot_target *t, const struct robot_job_point *p,
                   const struct external *e)
{
    if (p->beside) {
        t->beside = e->kind;
        t->external = orders_job_outside(p, e);
    }
}

/* How far a shift goes in the base frame. */
static void shift_of(double shift[3], const double by[3], const struct robot_job_frame *user)
{
    struct pose frame = frame_pose(user);
    for (int i = 0; i < 3; i++) {
        frame.at[i] = 0.0;
    }
    pose_point(&frame, by, shift);
}

/* CCN 16: each tag of a move becomes its member. */
static void job_move(struct order *order, const struct robot_job_run *run,
                     const struct orders_config *c, const struct orders_text *t,
                     const struct robot_job_request *r)
{
    struct robot_move *m = &order->move;

    *m = (struct robot_move){ .line = r->line, .singular = c->singular, .share = 1.0 };
    m->kind = r->path == ROBOT_JOB_JOINT    ? ROBOT_JOINTS
              : r->path == ROBOT_JOB_LINE   ? ROBOT_LINE
              : r->path == ROBOT_JOB_CIRCLE ? ROBOT_CIRCLE
                                            : ROBOT_SPLINE;
    m->share = r->tag == ROBOT_JOB_VJ ? r->speed / 100.0 : 1.0;
    m->feed = r->tag == ROBOT_JOB_V ? r->speed : 0.0;
    m->spin = r->tag == ROBOT_JOB_VR ? r->speed * DEGREE : 0.0;
    m->acc = r->acc[0] / 100.0;
    m->dec = r->acc[1] / 100.0;
    m->zone = r->corner > 0.0 ? r->corner : c->zone[r->level];
    m->radius = r->corner;
    order->until = r->until + 1;
    order->until_on = r->until_on;
    const struct robot_job_point *p = robot_job_place(run, t->job, t->points, r->point);
    if (r->increment == ROBOT_JOB_NOT_BY) {
        target_of(&m->target, p, &t->points->user[r->user], c);
        beside(&m->target, p, &c->external);
        order->wrist = p->wrist >= ROBOT_JOB_WRIST_NEAR ? p->wrist : 0;
    } else {
        m->target.branch = ROBOT_ANY_BRANCH;
        order->goes_on = true;
        order->in_tool = r->increment == ROBOT_JOB_BY_TOOL;
        order->step = pose_of(p->value, p->value + 3);
        order->frame = frame_pose(&t->points->user[order->in_tool ? 0 : r->increment]);
    }
    if (r->beside >= 0) {
        beside(&m->target, robot_job_place(run, t->job, t->points, r->beside), &c->external);
    }
    if (r->shift >= 0) {
        shift_of(order->shift, r->shift_by, &t->points->user[r->shift_user]);
    }
    order->plain = r->tool == 0;
    order->tool = frame_pose(&t->points->tool[r->tool]);
    if (m->kind == ROBOT_CIRCLE) {
        target_of(&order->via, robot_job_place(run, t->job, t->points, r->via),
                  &t->points->user[r->user], c);
    }
    m->goes_on = m->kind == ROBOT_SPLINE && r->next >= 0;
    if (m->goes_on) {
        target_of(&order->via, robot_job_place(run, t->job, t->points, r->next),
                  &t->points->user[r->next_user], c);
    }
}

void orders_job_next(struct orders *o, const struct orders_config *c, const struct orders_text *t,
                     const struct robot_job_inputs *in, struct order *order)
{
    struct robot_job_request r;

    robot_job_next(&o->job, t->job, t->points, in, c->lines, &r);
    order->line = r.line;
    order->job = r.job;
    order->after = o->moves = o->job.moves;
    o->waits = r.answer == ROBOT_JOB_WAIT;
    switch (r.answer) {
    case ROBOT_JOB_MOVE:
        order->kind = ORDER_MOVE;
        job_move(order, &o->job, c, t, &r);
        break;
    case ROBOT_JOB_DOUT:
        order->kind = ORDER_OUT;
        order->mask = (r.count == ROBOT_JOB_GROUP ? (1u << ROBOT_JOB_GROUP) - 1u : 1u) << r.index;
        order->value = (uint32_t)r.on << r.index;
        order->pulse = (double)r.time * 1e-9;
        order->after = r.after;
        break;
    case ROBOT_JOB_AOUT:
        order->kind = ORDER_ANALOG;
        order->index = r.index;
        order->amount = r.volt;
        order->after = r.after;
        break;
    case ROBOT_JOB_PAUSE: order->kind = ORDER_PAUSE; break;
    case ROBOT_JOB_END:   order->kind = ORDER_END; break;
    case ROBOT_JOB_FAULT: order->kind = ORDER_FAULT; break;
    default:              order->kind = ORDER_NONE;
    }
}
