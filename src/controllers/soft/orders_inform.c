/* orders_inform - a program in the robot language as orders. */
#include "orders_parts.h"

static const double DEGREE = 0.017453292519943295;
/* Flags of a configuration: BACK, DOWN, FLIP. */
static const int FLAG[3] = { OPW_BACK, OPW_ELBOW, OPW_FLIP };

static struct pose frame_pose(const struct inform_frame *f)
{
    return pose_of(f->value, f->value + 3);
}

/* A point as a target. What it leaves open is nearest, or on a path what that leads to. */
static void target_of(struct robot_target *t, const struct inform_point *p,
                      const struct inform_frame *user)
{
    static const int TURNED[3] = { 0, 3, 5 };
    const int32_t said[3] = { p->shoulder, p->elbow, p->wrist };

    t->by_joints = p->kind == INFORM_JOINTS;
    for (int i = 0; i < OPW_JOINTS; i++) {
        t->joint[i] = p->value[i] * DEGREE;
        t->turn[i] = ROBOT_ANY_TURN;
    }
    const struct pose frame = frame_pose(user), there = pose_of(p->value, p->value + 3);
    t->pose = pose_product(&frame, &there);
    for (int i = 0; i < 3; i++) {
        t->open |= said[i] == INFORM_ANY ? FLAG[i] : 0;
        t->branch |= said[i] == 1 ? FLAG[i] : 0;
        if (p->turn[i] != INFORM_ANY_TURN) {
            t->turned = true;
            t->turn[TURNED[i]] = p->turn[i];
        }
    }
}

static void inform_move(struct order *order, const struct orders_config *c,
                        const struct orders_text *t, const struct inform_request *r)
{
    struct robot_move *m = &order->move;

    *m = (struct robot_move){ .line = r->line, .singular = c->singular, .share = 1.0 };
    m->kind = r->path == INFORM_JOINT  ? ROBOT_JOINTS
              : r->path == INFORM_LINE ? ROBOT_LINE
                                       : ROBOT_CIRCLE;
    m->share = r->tag == INFORM_VJ ? r->speed / 100.0 : 1.0;
    m->feed = r->tag == INFORM_V ? r->speed : 0.0;
    m->spin = r->tag == INFORM_VR ? r->speed * DEGREE : 0.0;
    m->zone = r->corner > 0.0 ? r->corner : c->zone[r->level];
    target_of(&m->target, &t->points->point[r->point], &t->points->user[r->user]);
    order->plain = r->tool == 0;
    order->tool = frame_pose(&t->points->tool[r->tool]);
    if (m->kind == ROBOT_CIRCLE) {
        target_of(&order->via, &t->points->point[r->via], &t->points->user[r->user]);
    }
}

void orders_inform_next(struct orders *o, const struct orders_config *c,
                        const struct orders_text *t, const struct inform_inputs *in,
                        struct order *order)
{
    struct inform_request r;

    inform_next(&o->inform, t->inform, t->points, in, c->lines, &r);
    order->line = r.line;
    order->after = o->moves = o->inform.moves;
    o->waits = r.answer == INFORM_WAIT;
    switch (r.answer) {
    case INFORM_MOVE:
        order->kind = ORDER_MOVE;
        inform_move(order, c, t, &r);
        break;
    case INFORM_DOUT:
        order->kind = ORDER_OUT;
        order->mask = 1u << r.index;
        order->value = r.on ? order->mask : 0;
        order->after = r.after;
        break;
    case INFORM_AOUT:
        order->kind = ORDER_ANALOG;
        order->index = r.index;
        order->amount = r.volt;
        order->after = r.after;
        break;
    case INFORM_PAUSE: order->kind = ORDER_PAUSE; break;
    case INFORM_END:   order->kind = ORDER_END; break;
    case INFORM_FAULT: order->kind = ORDER_FAULT; break;
    default:           order->kind = ORDER_NONE;
    }
}
