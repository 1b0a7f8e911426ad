#include "robot_job_values.h"

#include <math.h>

static int32_t whole_of(const struct robot_job_run *run, enum robot_job_operand_kind kind,
                        int32_t index)
{
    return kind >= ROBOT_JOB_LB ? run->frame[run->depth].whole[kind - ROBOT_JOB_LB][index]
                                : run->whole[kind - ROBOT_JOB_B][index];
}

int32_t robot_job_element(struct robot_job_run *run, const struct robot_job_by *by, int32_t number,
                          int32_t most)
{
    if (by->kind == ROBOT_JOB_NOTHING) {
        return number;
    }
    const int32_t n = whole_of(run, by->kind, by->index);
    if (n >= 0 && n < most) {
        return n;
    }
    run->fault = ROBOT_JOB_BAD_ELEMENT;
    return 0;
}

static int32_t element_of(struct robot_job_run *run, const struct robot_job_operand *o)
{
    return robot_job_element(run, &o->by, o->index,
                             o->kind >= ROBOT_JOB_LB ? ROBOT_JOB_LOCALS : ROBOT_JOB_VARIABLES);
}

/* CCN 16: a case for each kind. */
double robot_job_value(struct robot_job_run *run, const struct robot_job_inputs *in,
                       const struct robot_job_operand *o)
{
    switch (o->kind) {
    case ROBOT_JOB_B:
    case ROBOT_JOB_I:
    case ROBOT_JOB_D:
    case ROBOT_JOB_LB:
    case ROBOT_JOB_LI:
    case ROBOT_JOB_LD:       return whole_of(run, o->kind, element_of(run, o));
    case ROBOT_JOB_R:        return run->real[element_of(run, o)];
    case ROBOT_JOB_LR:       return run->frame[run->depth].real[element_of(run, o)];
    case ROBOT_JOB_IN:       return in->di >> o->index & 1u;
    case ROBOT_JOB_OT:       return run->out >> o->index & 1u;
    case ROBOT_JOB_AI:       return in->ai[o->index];
    case ROBOT_JOB_IG:       return in->di >> ROBOT_JOB_GROUP * o->index & GROUP_MASK;
    case ROBOT_JOB_OG:       return run->out >> ROBOT_JOB_GROUP * o->index & GROUP_MASK;
    case ROBOT_JOB_CONSTANT:
    case ROBOT_JOB_NOTHING:  break;
    }
    return o->number;
}

enum robot_job_fault robot_job_store(struct robot_job_run *run, const struct robot_job_operand *o,
                                     double x)
{
    struct robot_job_call *frame = &run->frame[run->depth];
    const int32_t n = element_of(run, o);
    x = o->kind == ROBOT_JOB_R || o->kind == ROBOT_JOB_LR ? x : trunc(x);
    if (run->fault != ROBOT_JOB_OK) {
        return run->fault;
    }
    if (!(x >= robot_job_low(o->kind) && x <= robot_job_high(o->kind))) {
        return ROBOT_JOB_BAD_RANGE;
    }
    if (o->kind == ROBOT_JOB_R) {
        run->real[n] = x;
    } else if (o->kind == ROBOT_JOB_LR) {
        frame->real[n] = x;
    } else if (o->kind >= ROBOT_JOB_LB) {
        frame->whole[o->kind - ROBOT_JOB_LB][n] = (int32_t)x;
    } else {
        run->whole[o->kind - ROBOT_JOB_B][n] = (int32_t)x;
    }
    return ROBOT_JOB_OK;
}
