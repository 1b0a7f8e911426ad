/* orders_parts - the languages of orders, one file each. */
#ifndef ORDERS_PARTS_H
#define ORDERS_PARTS_H

#include "orders.h"

/* A part program: begin it at a pose of the tip; give its next order. */
void orders_gcode_start(struct interpreter *in, const struct orders_config *c,
                        const struct pose *at);
void orders_gcode_next(struct orders *o, const struct orders_config *c, const struct orders_text *t,
                       const struct robot_job_inputs *in, struct order *order);

/* A job: give its next order. */
void orders_job_next(struct orders *o, const struct orders_config *c, const struct orders_text *t,
                     const struct robot_job_inputs *in, struct order *order);

/* Joints [rad], [m] of a job's position given by its joints or pulses, not as a pose. */
void orders_job_joints(const struct robot_job_point *p, const struct orders_config *c,
                       double joint[OPW_JOINTS]);

/* Place [m] [rad] of the axis outside the arm of a position that has one. */
double orders_job_outside(const struct robot_job_point *p, const struct external *e);

#endif
