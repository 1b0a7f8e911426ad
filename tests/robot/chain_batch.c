/* Arms of any kind, many poses in one call, for test_chain.py. */
#include "chain_inverse.h"
#include "chain_iterate.h"

/* One arm: its numbers are those of struct chain; `held` is a joint of seven, or what an enum says
 * it is. */
static struct chain_form form;

int chain_batch_arm(int joints, const double (*origin)[3], const double (*axis)[3],
                    const int32_t *slides, const int32_t *level, const struct chain_pose *flange,
                    int held, double *deviation)
{
    struct chain c = { .joints = joints, .flange = *flange };

    for (int i = 0; i < joints; i++) {
        for (int k = 0; k < 3; k++) {
            c.joint[i].origin[k] = origin[i][k];
            c.joint[i].axis[k] = axis[i][k];
        }
        c.joint[i].slides = slides[i];
        c.joint[i].level = level[i];
    }
    if (!chain_good(&c)) {
        return -1;
    }
    chain_form_of(&c, held, &form);
    *deviation = form.deviation;
    return (int)form.kind + 100 * form.reversed;
}

void chain_batch_forward(int64_t count, const double (*joint)[CHAIN_JOINTS],
                         struct chain_pose *pose)
{
    for (int64_t n = 0; n < count; n++) {
        chain_forward(&form.chain, joint[n], &pose[n]);
    }
}

void chain_batch_jacobian(int64_t count, const double (*joint)[CHAIN_JOINTS],
                          double (*column)[CHAIN_JOINTS][6])
{
    struct chain_pose pose;

    for (int64_t n = 0; n < count; n++) {
        chain_jacobian(&form.chain, joint[n], &pose, column[n]);
    }
}

void chain_batch_inverse(int64_t count, const struct chain_pose *pose,
                         const double (*near)[CHAIN_JOINTS],
                         double (*joint)[CHAIN_BRANCHES][CHAIN_JOINTS], uint32_t *there)
{
    for (int64_t n = 0; n < count; n++) {
        there[n] = chain_inverse(&form, &pose[n], near[n], 0xff, joint[n]);
    }
}

void chain_batch_held(int64_t count, const struct chain_pose *pose,
                      const double (*near)[CHAIN_JOINTS], const double *value,
                      double (*joint)[CHAIN_BRANCHES][CHAIN_JOINTS], uint32_t *there)
{
    for (int64_t n = 0; n < count; n++) {
        there[n] = chain_inverse_held(&form, &pose[n], near[n], value[n], 0xff, joint[n]);
    }
}

void chain_batch_branches(int64_t count, const double (*joint)[CHAIN_JOINTS], double (*factor)[3],
                          int32_t *branch, double *angle)
{
    for (int64_t n = 0; n < count; n++) {
        chain_factors(&form, joint[n], factor[n]);
        branch[n] = chain_branch(&form, joint[n]);
        angle[n] = form.held == CHAIN_ARM_ANGLE ? chain_arm_angle(&form, joint[n]) : 0.0;
    }
}

void chain_batch_iterate(int64_t count, const struct chain_pose *pose,
                         double (*joint)[CHAIN_JOINTS], int32_t *status)
{
    for (int64_t n = 0; n < count; n++) {
        status[n] = chain_iterate(&form.chain, form.held, form.size, &pose[n], joint[n]);
    }
}
