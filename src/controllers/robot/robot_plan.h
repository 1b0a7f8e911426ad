/* robot_plan - how moves and jogs are planned; of robot only. */
#ifndef ROBOT_PLAN_H
#define ROBOT_PLAN_H

#include "robot.h"

/* Commands that a move needs beside its segments: an exact stop, a turn of joint 4 before it. */
enum { ROBOT_ROOM = 4 };

/* Geometry of the moves; *arm becomes the config's with the tool in force. */
struct arm_geometry robot_geometry(const struct robot *r, struct manipulator *arm);

/* Nothing being under way, moves begin where the arm is. */
void robot_settle(struct robot *r, const struct robot_config *c);

/* Plan a move; along a path to a pose, turned by a vector [rad], if there is a pose. */
enum robot_status robot_plan(struct robot *r, const struct robot_config *c,
                             const struct robot_move *move, const struct pose *pose,
                             const double by[3], struct robot_refusal *why);

/* Speed that a joint may have: its own, or what a slot's pulses are. [rad/s] */
double robot_joint_speed(const struct robot_config *c, int joint);

/* A move of the joints to target angles [rad], at a share 0..1 of their limits, becomes the latest
 * of the arm, and its command. */
void robot_plan_joints(struct robot *r, const struct robot_config *c,
                       const double target[OPW_JOINTS], double share);

/* Plan a move of the joints to its target: angles, or a pose. */
enum robot_status robot_to_joints(struct robot *r, const struct robot_config *c,
                                  const struct robot_move *move, struct robot_refusal *why);

/* Branches that a target allows, a bit each. */
uint32_t robot_branches(const struct robot_target *t);

/* Commands into the ring. */
void robot_feed(struct robot *r);

#endif
