#include "orders_parts.h"

#include <string.h>

void orders_start(struct orders *o, const struct orders_config *c, const struct orders_text *t,
                  const struct pose *at)
{
    memset(o, 0, sizeof *o);
    o->on = t->gcode || t->job;
    if (t->gcode) {
        orders_gcode_start(&o->gcode, c, at);
    } else if (t->job) {
        robot_job_begin(&o->job, t->job, &c->start);
    }
}

void orders_next(struct orders *o, const struct orders_config *c, const struct orders_text *t,
                 const struct robot_job_inputs *in, struct order *order)
{
    memset(order, 0, sizeof *order);
    if (!o->on) {
        return;
    }
    if (t->gcode) {
        orders_gcode_next(o, c, t, in, order);
    } else {
        orders_job_next(o, c, t, in, order);
    }
    o->on = order->kind != ORDER_END && order->kind != ORDER_FAULT;
}
