/* Many poses in one call, for test_robot.py. */
#include "robot.h"

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

void robot_batch_slerp(int64_t count, const double (*a)[4], const double (*b)[4],
                       const double *part, double (*c)[4])
{
    for (int64_t n = 0; n < count; n++) {
        quaternion_slerp(a[n], b[n], part[n], c[n]);
    }
}

void robot_batch_angles(int64_t count, const double (*abc)[3], double (*turn)[4])
{
    for (int64_t n = 0; n < count; n++) {
        quaternion_by_angles(abc[n], turn[n]);
    }
}

/* Planned durations [s] of moves of the joints at a share of their speeds; limits: low, high,
 * speed, acceleration of each. */
void robot_batch_moves(const struct opw *o, const double (*limits)[4], double smooth, double share,
                       int64_t count, const double (*from)[OPW_JOINTS],
                       const double (*to)[OPW_JOINTS], double *time)
{
    static struct robot robot;
    struct robot_config c = { .arm.opw = *o,
                              .arm.tool = pose_none(),
                              .feed = 1e3,
                              .acc = 1e3,
                              .spin = 1.0,
                              .smooth = smooth,
                              .cycle = 1e-4,
                              .slot = 5e-6,
                              .slot_pulses = 49.0 };
    struct robot_refusal why;

    for (int i = 0; i < OPW_JOINTS; i++) {
        c.arm.joint[i] =
            (struct manipulator_joint){ limits[i][0], limits[i][1], limits[i][2], limits[i][3] };
        c.scale[i] = 1e4;
    }
    for (int64_t n = 0; n < count; n++) {
        struct robot_move m = { .kind = ROBOT_JOINTS, .share = share, .target.by_joints = true };
        robot_start(&robot, &c, from[n]);
        for (int i = 0; i < OPW_JOINTS; i++) {
            m.target.joint[i] = to[n][i];
        }
        const bool good = robot_move(&robot, &c, &m, &why) == ROBOT_OK;
        robot_cycle(&robot, &c);
        time[n] = good ? robot.trajectory.mix.move[0].profile.total : -1.0;
    }
}
