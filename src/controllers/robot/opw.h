/* opw - kinematics of six joints with a spherical wrist and axes 2 and 3 in parallel, in closed
 * form (Brandstoetter, Angerer, Hofbaur, Austrian Robotics Workshop 2014).
 *
 *                    axis 4, 5, 6 meet          a1  axis 1 to axis 2, x
 *         a2 ┌────c3────o──c4──> flange         a2  elbow to the forearm's axis
 *            o elbow                            b   lateral
 *           c2                                  c1  base to axis 2, z
 *      a1   │                                   c2  upper arm
 *     ┌─────o axis 2                            c3  forearm to wrist centre
 *     c1    b                                   c4  wrist centre to flange
 *     │ base
 *
 * At the inner zero the arm points straight up; the joints of the maker are turned and shifted.
 */
#ifndef OPW_H
#define OPW_H

#include <stdbool.h>
#include <stdint.h>

enum { OPW_JOINTS = 6, OPW_BRANCHES = 8 };

struct opw {
    double a1, a2, b, c1, c2, c3, c4; /* [m] */
    double offset[OPW_JOINTS];        /* [rad] inner angle = sign * joint - offset */
    double sign[OPW_JOINTS];          /* +1 or -1 */
};

/* The flange in the base frame; its z axis is that of joint 6. */
struct opw_pose {
    double at[3];      /* [m] */
    double turn[3][3]; /* rotation matrix */
};

/* Flags of a branch of the inverse kinematics, which is a sum of these. */
enum opw_flag {
    OPW_FLIP = 1,  /* wrist: joint 5 on its other side, 4 and 6 half a turn away */
    OPW_ELBOW = 2, /* the other elbow */
    OPW_BACK = 4   /* shoulder: the wrist centre lies behind axis 1 */
};

/* Pose of the flange for joints [rad]. */
void opw_forward(const struct opw *o, const double joint[OPW_JOINTS], struct opw_pose *pose);

/* Joints of all branches that reach a pose, each within half a turn of 0. [rad] Returns a bit for
 * each branch that is there. Where axes 4 and 6 are in line joint 4 stays as in `near`. */
uint32_t opw_inverse(const struct opw *o, const struct opw_pose *pose,
                     const double near[OPW_JOINTS], double joint[OPW_BRANCHES][OPW_JOINTS]);

/* The same for the wanted branches alone, a bit each. */
uint32_t opw_inverse_of(const struct opw *o, const struct opw_pose *pose,
                        const double near[OPW_JOINTS], uint32_t wanted,
                        double joint[OPW_BRANCHES][OPW_JOINTS]);

/* The branch whose joints, by whole turns and within their limits, are nearest to `near` in the
 * joint that differs most; its joints. -1: none is within the limits. [rad] */
int opw_nearest(uint32_t branches, const double all[OPW_BRANCHES][OPW_JOINTS],
                const double near[OPW_JOINTS], const double low[OPW_JOINTS],
                const double high[OPW_JOINTS], double joint[OPW_JOINTS]);

/* The branch that joints belong to: a sum of enum opw_flag. */
int opw_branch(const struct opw *o, const double joint[OPW_JOINTS]);

/* How far from singular: wrist centre from axis 1, signed [m]; sine of the elbow from stretched;
 * sine of joint 5. The determinant of the flange's velocities by the joints' is, but for its sign,
 * c2 hypot(a2, c3) times their product. [m^3] Returns opw_branch, the signs of the factors. */
int opw_factors(const struct opw *o, const double joint[OPW_JOINTS], double factor[3]);

/* The second factor, the elbow's, alone. */
double opw_elbow(const struct opw *o, const double joint[OPW_JOINTS]);

#endif
