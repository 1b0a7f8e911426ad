/* robot_plan - how moves and jogs are planned, for the files of the robot core alone. */
#ifndef ROBOT_PLAN_H
#define ROBOT_PLAN_H

#include "robot.h"

/* Commands that a move needs beside its segments: an exact stop, a turn of joint 4 before it. */
enum { ROBOT_ROOM = 4 };

/* What the kinematics of the moves need; *arm becomes the config's arm with the tool in force. */
struct arm_geometry robot_geometry(const struct robot *r, struct manipulator *arm);

/* While nothing is under way: let the next move begin where the arm is. */
void robot_settle(struct robot *r, const struct robot_config *c);

/* Plan a move. If there is a pose, it leads along a path to it, turned by the rotation vector `by`
 * [rad]. */
enum robot_status robot_plan(struct robot *r, const struct robot_config *c,
                             const struct robot_move *move, const struct pose *pose,
                             const double by[3], struct robot_refusal *why);

/* Speed that a joint may have: its own, or what a slot's pulses are. [rad/s] */
double robot_joint_speed(const struct robot_config *c, int joint);

/* The same of the external axis. [m/s] [rad/s] */
double robot_external_speed(const struct robot_config *c);

/* How far a move takes the external axis. [m] [rad] */
double robot_travel(const struct robot *r, const struct robot_move *move);

/* Share that 0 or a number stands for. */
static inline double robot_share(double share)
{
    return share > 0.0 ? share : 1.0;
}

/* A move of the joints to target angles [rad], of the external axis by `travel`, at a share 0..1 of
 * their limits, becomes the latest of the arm, and its command. */
void robot_plan_joints(struct robot *r, const struct robot_config *c,
                       const double target[OPW_JOINTS], double travel, double share);

/* Plan a move of the joints to its target: angles, or a pose. */
enum robot_status robot_to_joints(struct robot *r, const struct robot_config *c,
                                  const struct robot_move *move, struct robot_refusal *why);

/* Flags that a target leaves open: those that it says, and those that the arm has not. */
int robot_open_flags(const struct manipulator *arm, const struct robot_target *t);

/* Branches of the inverse kinematics that a target allows, a bit each. */
uint32_t robot_branches(const struct manipulator *arm, const struct robot_target *t);

/* Whether the arm has no joints that turn the tip to the orientation of a pose; *why says by how
 * much. */
bool robot_tilted(const struct manipulator *arm, const struct pose *pose,
                  struct robot_refusal *why);

/* Whether a move becomes part of the one curve of the joints. */
bool robot_flows(const struct robot *r, const struct robot_config *c,
                 const struct robot_move *move);

/* The joints go straight from one place to another [rad], at a share of their speeds; this flows
 * with the moves before. */
void robot_flow_line(struct robot *r, const struct robot_config *c, const struct robot_move *move,
                     const double from[OPW_JOINTS], const double to[OPW_JOINTS]);

/* So does the path of r->tool_path, which begins with these joints and has a feed [mm/s]; the arm
 * goes there from `turning` first, if that is given. [rad] False, and nothing done: it needs more
 * pieces than there are. */
bool robot_flow_path(struct robot *r, const struct robot_config *c, const struct robot_move *move,
                     const double *turning, const double from[OPW_JOINTS], double feed);

/* A spline joins the moves that flow. */
enum robot_status robot_to_spline(struct robot *r, const struct robot_config *c,
                                  const struct robot_move *move, struct robot_refusal *why);

/* Whether joints at the end of a path are those that its target asks for. */
enum robot_status robot_check_end(const struct manipulator *arm, const struct robot_target *t,
                                  const double end[OPW_JOINTS], struct robot_refusal *why);

/* What a curve of the joints may take at a feed of the tool [mm/s]. */
struct joint_curve_limits robot_flow_limits(const struct robot *r, const struct robot_config *c,
                                            double feed);

/* A move's pieces join those that flow. */
void robot_flow_pieces(struct robot *r, const struct robot_config *c, const struct robot_move *move,
                       int32_t count, const struct segment *piece);

/* Speed of the tool that a move asks for [mm/s], and of its turning [rad/s]. */
double robot_feed_of(const struct robot_config *c, const struct robot_move *move);
double robot_spin_of(const struct robot_config *c, const struct robot_move *move);

/* Put commands of the latest move into the ring, as many as it has room for. */
void robot_feed(struct robot *r);

#endif
