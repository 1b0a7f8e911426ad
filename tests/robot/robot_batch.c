/* Many poses in one call, for robot_batch.py. */
#include <string.h>

#include "bounds.h"
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

/* A line of the tip that keeps its attitude, as it is planned: each segment's end, speed and
 * acceleration, the bounds of q' and q'' on so many equal parts, the joints at so many places.
 * Returns the number of segments, 0 if it is refused; a part without bounds has 0. [mm] [rad] */
int robot_batch_line(const struct opw *o, const double (*limits)[4], const double *joint,
                     const double *to, double feed, double acc, struct tool_path_segment *segment,
                     int64_t parts, double (*bound)[2][OPW_JOINTS], int64_t places,
                     double (*at)[OPW_JOINTS])
{
    static struct robot robot;
    struct robot_config c = { .arm.opw = *o,
                              .arm.tool = pose_none(),
                              .feed = feed,
                              .acc = acc,
                              .spin = 1.0,
                              .cycle = 1e-4,
                              .slot = 5e-6,
                              .slot_pulses = 49.0 };
    struct robot_move m = { .kind = ROBOT_LINE, .target.branch = ROBOT_ANY_BRANCH };
    struct robot_refusal why;
    double slope[AXES], place[AXES], q[OPW_JOINTS];

    for (int i = 0; i < OPW_JOINTS; i++) {
        c.arm.joint[i] =
            (struct manipulator_joint){ limits[i][0], limits[i][1], limits[i][2], limits[i][3] };
        c.scale[i] = 1e4;
    }
    robot_start(&robot, &c, joint);
    m.target.pose = manipulator_pose(&c.arm, joint);
    memcpy(m.target.pose.at, to, sizeof m.target.pose.at);
    if (robot_move(&robot, &c, &m, &why) != ROBOT_OK) {
        return 0;
    }
    const struct path *path = &robot.tool_path.path;
    const struct arm_geometry g = { &c.arm, &robot.moves };
    memcpy(segment, robot.tool_path.segment, (size_t)robot.tool_path.count * sizeof *segment);
    memcpy(q, joint, sizeof q);
    for (int64_t n = 0; n < places; n++) {
        path_at(path, path->length * (double)n / (double)(places - 1), place, slope);
        arm_moves_kinematics().joints(&g, place, q);
        memcpy(at[n], q, sizeof q);
    }
    memcpy(q, joint, sizeof q);
    for (int64_t n = 0; n < parts; n++) {
        const double from = (double)n / (double)parts, until = (double)(n + 1) / (double)parts;
        struct bounds b;
        path_at(path, 0.5 * (from + until) * path->length, place, slope);
        arm_moves_kinematics().joints(&g, place, q);
        memset(bound[n], 0, sizeof bound[n]);
        if (bounds_of(&g, path, from, until, q, &b)) {
            memcpy(bound[n][0], b.most.slope, sizeof b.most.slope);
            memcpy(bound[n][1], b.most.bend, sizeof b.most.bend);
        }
    }
    return robot.tool_path.count;
}
