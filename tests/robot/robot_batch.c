/* Many poses in one call, for test_robot.py. */
#include "opw.h"

void robot_batch_forward(const struct opw *o, int64_t count, const double (*joint)[OPW_JOINTS],
                         struct opw_pose *pose)
{
    for (int64_t n = 0; n < count; n++) {
        opw_forward(o, joint[n], &pose[n]);
    }
}

void robot_batch_inverse(const struct opw *o, int64_t count, const struct opw_pose *pose,
                         const double (*near)[OPW_JOINTS],
                         double (*joint)[OPW_BRANCHES][OPW_JOINTS], uint32_t *there)
{
    for (int64_t n = 0; n < count; n++) {
        there[n] = opw_inverse(o, &pose[n], near[n], joint[n]);
    }
}
