/* robot_job_values - what a program that runs counts with: numbers, and positions that change. */
#ifndef ROBOT_JOB_VALUES_H
#define ROBOT_JOB_VALUES_H

#include "robot_job_run.h"

#define GROUP_MASK ((1u << ROBOT_JOB_GROUP) - 1u)

/* The number that an operand stands for; an element that is none is a fault of the run. */
double robot_job_value(struct robot_job_run *run, const struct robot_job_inputs *in,
                       const struct robot_job_operand *o);

/* Set a variable to a result; variables of whole numbers take its whole part. */
enum robot_job_fault robot_job_store(struct robot_job_run *run, const struct robot_job_operand *o,
                                     double x);

/* The number of an element: the one that stands there, or a variable's value within 0 .. most - 1.
 * Else a fault of the run, and 0. */
int32_t robot_job_element(struct robot_job_run *run, const struct robot_job_by *by, int32_t number,
                          int32_t most);

/* Which position is meant, by the number that a request has; a fault if it has no value. */
enum robot_job_fault robot_job_which(struct robot_job_run *run, const struct robot_job_program *p,
                                     const struct robot_job_points *points, int32_t number,
                                     const struct robot_job_by *by, int32_t *which);

/* SET ADD SUB of positions, SETE, GETE, GETS, CNVRT, MSHIFT. */
enum robot_job_fault robot_job_change(struct robot_job_run *run, const struct robot_job_program *p,
                                      const struct robot_job_points *points,
                                      const struct robot_job_inputs *in,
                                      const struct robot_job_instruction *c);

#endif
