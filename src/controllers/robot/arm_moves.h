/* arm_moves - the arm's planned moves, one after another, and the pose and joints that each gives
 * to a place of the core that drives them, whose coordinates are
 *
 *     X Y Z   the tool's tip [mm]
 *     U V W   how far the moves 0 3 6 .., 1 4 7 .., 2 5 8 .. have turned the tool
 *
 * Each move turns the tool about its own axis, and two moves that follow one another have different
 * coordinates. So a corner between them fades the one turn out and the other in, as it does with
 * the paths, and no turn jumps. A coordinate counts LEVER times the angle: a tolerance of 1 mm is
 * one of 1/LEVER rad. A move of the joints has its share in its coordinate.
 */
#ifndef ARM_MOVES_H
#define ARM_MOVES_H

#include "manipulator.h"
#include "mechanism.h"

/* Moves that are known: those whose commands are in the ring (256), their neighbours, those
 * planned. */
enum { ARM_MOVES_SIZE = 320 };

/* A radian counts as so many mm. [mm/rad] */
#define ARM_MOVES_LEVER 100.0

enum arm_move_kind {
    ARM_MOVE_POSE,  /* tip and orientation */
    ARM_MOVE_WRIST, /* tip; joints 4 to 6 are linear over the path */
    ARM_MOVE_JOINTS /* all joints are linear over the path */
};

struct arm_move {
    enum arm_move_kind kind;
    double from, to; /* [mm] its coordinate at its start and end; equal: the tool does not turn */
    double turn[4];  /* orientation at its start; of a move of the joints: at its end */
    double by[3];    /* [rad] rotation vector of its turn, base frame */
    double joint[OPW_JOINTS]; /* [rad] at its start */
    double step[OPW_JOINTS];  /* [rad] to its end */
    double external[2]; /* [m] [rad] external axis (external.h) at its start, its end; it goes with
                         * the coordinate, so that moves if this does */
};

struct arm_moves {
    struct arm_move move[ARM_MOVES_SIZE];
    int32_t count; /* moves in all; the latest ARM_MOVES_SIZE are known */
    double at[3];  /* [mm] U V W at the end of the last move */
};

/* What the kinematics of the trajectory are given. */
struct arm_geometry {
    const struct manipulator *arm;
    const struct arm_moves *moves;
};

/* Begin without moves, the tool having this orientation, the external axis being there. */
void arm_moves_start(struct arm_moves *c, const double turn[4], double external);

/* Append a move whose coordinate goes on by `way` [mm]; its from and to are set here. */
void arm_moves_add(struct arm_moves *c, const struct arm_move *move, double way);

/* Take the latest move back, as if it had not been added. */
void arm_moves_drop(struct arm_moves *c);

/* Index of the coordinate that the latest move turns the tool by: 3 .. 5. */
int arm_moves_axis(const struct arm_moves *c);

/* Pose of the tip at a place; on a move of the joints it follows from joint[]. */
void arm_moves_pose(const struct arm_geometry *g, const double place[AXES],
                    const double joint[AXES], struct pose *pose);

/* The external axis at a place. [m] [rad] */
double arm_moves_external(const struct arm_moves *c, const double place[AXES]);

/* Whether a place belongs to a move of the joints, which takes no inverse kinematics. */
bool arm_moves_by_joints(const struct arm_moves *c, const double place[AXES]);

/* The functions by which the trajectory gets the joints [rad] of a place. */
struct kinematics arm_moves_kinematics(void);

#endif
