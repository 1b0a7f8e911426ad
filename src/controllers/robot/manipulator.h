/* manipulator - an arm with its tool and the limits of its joints.
 *
 *     tool tip in the base frame  <->  flange  <->  joints
 *     [mm], quaternion             opw or axes      [rad]
 */
#ifndef MANIPULATOR_H
#define MANIPULATOR_H

#include "chain_inverse.h"
#include "opw.h"
#include "pose.h"

/* Joints are in rad, sliding ones in m, wherever rad is said here. */
struct manipulator_joint {
    double low, high; /* [rad] */
    double speed;     /* [rad/s] highest */
    double acc;       /* [rad/s^2] highest */
};

struct manipulator {
    struct opw opw;
    bool by_axes; /* the arm is not opw but axes */
    struct manipulator_joint joint[OPW_JOINTS];
    struct pose tool;       /* pose of its tip in the flange's frame */
    struct chain_form axes; /* up to six joints, the others stand at 0; last, as it is large */
};

/* Number of joints that are there; whether one of them slides. */
int manipulator_joints_of(const struct manipulator *m);
bool manipulator_slides(const struct manipulator *m, int joint);

/* What people give a joint in: [rad] of a degree, [m] of a mm. */
double manipulator_unit(const struct manipulator *m, int joint);

/* Angle by which an arm of few joints misses the orientation of a pose of the tip [rad], wherever
 * that is: all that turns its flange are axes in parallel. 0 of other arms. */
double manipulator_tilt(const struct manipulator *m, const struct pose *pose);

/* Sum of the flags (manipulator_branch) that branches of the arm have. */
int manipulator_flags(const struct manipulator *m);

/* The arm with another tool; axes are copied if it is by them. */
void manipulator_with(const struct manipulator *m, const struct pose *tool,
                      struct manipulator *arm);

/* Pose of the flange for joints [rad]; joints of all wanted branches of one, as opw_inverse_of
 * gives them. */
void manipulator_flange(const struct manipulator *m, const double joint[OPW_JOINTS],
                        struct opw_pose *flange);
uint32_t manipulator_branches(const struct manipulator *m, const struct opw_pose *flange,
                              const double near[OPW_JOINTS], uint32_t wanted,
                              double all[OPW_BRANCHES][OPW_JOINTS]);

/* The branch nearest to joints, within limits, as of opw_nearest; a joint that slides has no
 * turns. */
int manipulator_nearest(const struct manipulator *m, uint32_t there,
                        const double all[OPW_BRANCHES][OPW_JOINTS], const double near[OPW_JOINTS],
                        const double low[OPW_JOINTS], const double high[OPW_JOINTS],
                        double joint[OPW_JOINTS]);

/* Pose of the tool tip for joints [rad]. */
struct pose manipulator_pose(const struct manipulator *m, const double joint[OPW_JOINTS]);

/* Joints of the next pose of a path, which joint[] leads to: the nearest branch on the same side of
 * the elbow, whole turns counted, whatever the limits. So joint 5, or the wrist centre over axis 1,
 * goes smoothly through a singular place that the path meets exactly. False, and joint[] as it was:
 * the pose is out of reach. */
bool manipulator_joints(const struct manipulator *m, const struct pose *pose,
                        double joint[OPW_JOINTS]);

/* The same with joints 4 to 6 given in joint[]: joints 1 to 3 bring the tip to its place [mm]. Of
 * an arm by axes: false. */
bool manipulator_arm(const struct manipulator *m, const double at[3], double joint[OPW_JOINTS]);

/* Number of whole turns of a joint that stands for: the nearest. */
enum { MANIPULATOR_ANY_TURN = 1000 };

/* Why there are no joints for a pose. */
enum manipulator_status {
    MANIPULATOR_OK,
    MANIPULATOR_FAR,    /* out of reach, or not in that branch */
    MANIPULATOR_OUTSIDE /* of the limits of a joint */
};

/* Joints of a pose within their limits (where those in joint[] are beyond, within these): those of
 * the nearest branch of a set, a bit each; by the whole turns of turn[], or with NULL the nearest.
 * OUTSIDE: joint[] becomes what it would be, *which the joint. */
enum manipulator_status manipulator_solve(const struct manipulator *m, const struct pose *pose,
                                          uint32_t branches, const int *turn,
                                          double joint[OPW_JOINTS], int *which);

/* Motion of the tip for a unit rate of each joint: velocity [mm/rad] and turn [1], base frame. */
void manipulator_jacobian(const struct manipulator *m, const double joint[OPW_JOINTS],
                          double column[OPW_JOINTS][6]);

/* Rates of the joints [rad/s] for a motion of the tip: velocity [mm/s], turn [rad/s]. False: the
 * place is singular. */
bool manipulator_rates(const struct manipulator *m, const double joint[OPW_JOINTS],
                       const double motion[6], double rate[OPW_JOINTS]);

/* First joint that is beyond its limits and further out than in `from`, by more than rounding; -1:
 * none. */
int manipulator_outside(const struct manipulator *m, const double from[OPW_JOINTS],
                        const double joint[OPW_JOINTS]);

/* The branch that joints belong to: a sum of enum opw_flag, or of enum chain_flag, whose numbers
 * are the same. */
int manipulator_branch(const struct manipulator *m, const double joint[OPW_JOINTS]);

/* How far from singular: shoulder [m], elbow, wrist (opw.h, chain_inverse.h). Returns
 * manipulator_branch. */
int manipulator_factors(const struct manipulator *m, const double joint[OPW_JOINTS],
                        double factor[3]);

/* The joint, from 0, that is free where axes of the wrist are in line. */
int manipulator_open(const struct manipulator *m);

/* No place of the flange is further from the base. [mm] */
double manipulator_reach(const struct manipulator *m);

/* Which of the factors is nearest to 0, the shoulder's counted in lengths of the arm. */
int manipulator_factor(const struct manipulator *m, const double joint[OPW_JOINTS], double *value);

#endif
