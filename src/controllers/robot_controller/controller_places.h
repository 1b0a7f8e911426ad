/* controller_places - positions of a job by the arm's kinematics: where the arm is, a position as a
 * pose in a frame, what leads from one to another. */
#ifndef CONTROLLER_PLACES_H
#define CONTROLLER_PLACES_H

#include "controller.h"

/* Whose arm a job asks for. */
struct controller_places {
    const struct controller *s;
    const struct controller_config *c;
    const struct orders_text *t;
};

/* The functions of struct robot_job_inputs: `places` is a struct controller_places. */
void controller_places_here(const void *places, struct robot_job_point here[2]);
void controller_places_convert(const void *places, const struct robot_job_point *from,
                               struct robot_job_point *pose);
void controller_places_shift(const void *places, const struct robot_job_point *from,
                             const struct robot_job_point *to, int32_t frame, double by[6]);

#endif
