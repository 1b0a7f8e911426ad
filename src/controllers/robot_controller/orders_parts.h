/* orders_parts - the languages of orders, one file each. */
#ifndef ORDERS_PARTS_H
#define ORDERS_PARTS_H

#include "orders.h"

/* A part program: it begins at a pose of the tip; its next order. */
void orders_gcode_start(struct interpreter *in, const struct orders_config *c,
                        const struct pose *at);
void orders_gcode_next(struct orders *o, const struct orders_config *c, const struct orders_text *t,
                       const struct robot_job_inputs *in, struct order *order);

/* A program in the robot language: its next order. */
void orders_job_next(struct orders *o, const struct orders_config *c, const struct orders_text *t,
                     const struct robot_job_inputs *in, struct order *order);

#endif
