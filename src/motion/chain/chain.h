/* chain - an arm as a row of joints, one behind another: where it is for given joints, and how that
 * changes with them.
 *
 *     base ──origin 1──> joint 1 ──origin 2──> joint 2 .. joint n ──flange──> flange
 *
 * At zero all frames are parallel to the base. A joint turns what is behind it about its axis, or
 * slides it along, and a linkage may keep its own link level.
 */
#ifndef CHAIN_H
#define CHAIN_H

#include <stdbool.h>
#include <stdint.h>

enum { CHAIN_JOINTS = 7 };

/* A frame in the base frame. */
struct chain_pose {
    double at[3];      /* [m] */
    double turn[3][3]; /* rotation matrix */
};

struct chain_joint {
    double origin[3]; /* [m] at zero: from the origin of the joint before it, or of the base */
    double axis[3];   /* unit vector at zero */
    bool slides;      /* along its axis, [m]; false: it turns about it, [rad] */
    int32_t level;    /* so many joints before it do not tilt its link, which a parallelogram
                       * carries on a pivot in its origin: 2 of a palletizer's last one, 1 of its
                       * forearm if that is driven from the base; 0 elsewhere */
};

struct chain {
    int32_t joints; /* 1 .. CHAIN_JOINTS */
    struct chain_joint joint[CHAIN_JOINTS];
    struct chain_pose flange; /* at zero, its origin from that of the last joint */
};

/* Whether there are numbers of an arm: finite, axes of length 1, a flange turned by a rotation,
 * levels of joints that are there. */
bool chain_good(const struct chain *c);

/* Pose of the flange for joints [rad], [m]. */
void chain_forward(const struct chain *c, const double joint[CHAIN_JOINTS],
                   struct chain_pose *pose);

/* Where the axes are, base frame. */
struct chain_axes {
    double origin[CHAIN_JOINTS][3]; /* [m] of the joints */
    double axis[CHAIN_JOINTS][3];
};

/* The same with the axes. */
void chain_axes_at(const struct chain *c, const double joint[CHAIN_JOINTS], struct chain_axes *axes,
                   struct chain_pose *pose);

/* Motion of a place [m] that the flange carries, for a unit rate of joint k: its velocity [m] or,
 * of a sliding joint, [1], and its turning [1], base frame. */
void chain_column(const struct chain *c, const struct chain_axes *axes, int k, const double at[3],
                  double column[6]);

/* The joint (0 ..) whose link a linkage keeps from being tilted by joint k; -1: none does. */
int chain_levelled(const struct chain *c, int k);

/* The same with the motion of the flange for a unit rate of each joint: its velocity [m] or, of a
 * sliding joint, [1], and its turning [1], base frame. */
void chain_jacobian(const struct chain *c, const double joint[CHAIN_JOINTS],
                    struct chain_pose *pose, double column[CHAIN_JOINTS][6]);

#endif
