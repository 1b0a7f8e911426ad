/* arm_moves - the arm's planned moves, one after another, and the pose and joints that each gives
 * to a place of the core that drives them, whose coordinates are
 *
 *     X Y Z   the tool's tip [mm]
 *     U V W   how far the moves 0 3 6 .., 1 4 7 .., 2 5 8 .. have turned the tool
 *
 * Each move turns the tool about its own axis, and two moves that follow one another have different
 * coordinates. So a corner between them fades the one turn out and the other in, as it does with
 * the ways, and no turn jumps. A coordinate counts LEVER times the angle: a tolerance of 1 mm is
 * one of 1/LEVER rad. A move of the joints has its share in its coordinate.
 */
#ifndef ARM_MOVES_H
#define ARM_MOVES_H

#include "manipulator.h"
#include "mechanism.h"

/* The moves whose commands are in the ring (256), their neighbours and what is planned. */
enum { ARM_MOVES_SIZE = 320 };

/* Length that an angle is measured at. [mm/rad] */
#define ARM_MOVES_LEVER 100.0

enum arm_move_kind {
    ARM_MOVE_POSE,  /* tip and attitude */
    ARM_MOVE_WRIST, /* tip, joints 4 to 6 linear in the way */
    ARM_MOVE_JOINTS /* all joints linear in the way */
};

struct arm_move {
    enum arm_move_kind kind;
    double from, to;          /* of its coordinate; equal: the tool does not turn */
    double turn[4];           /* attitude at its start; of joints: at its end */
    double by[3];             /* [rad] rotation vector, base frame */
    double joint[OPW_JOINTS]; /* [rad] at its start */
    double step[OPW_JOINTS];  /* [rad] to its end */
};

struct arm_moves {
    struct arm_move move[ARM_MOVES_SIZE];
    int32_t count; /* moves in all; the latest ARM_MOVES_SIZE are known */
    double at[3];  /* U V W at the end of the last */
};

/* What the kinematics of the motion core get. */
struct arm_geometry {
    const struct manipulator *arm;
    const struct arm_moves *moves;
};

/* No moves yet; the tool has an attitude. */
void arm_moves_start(struct arm_moves *c, const double turn[4]);

/* Add a move, whose coordinate goes on by `way` [mm]; its from and to are set here. */
void arm_moves_add(struct arm_moves *c, const struct arm_move *move, double way);

/* The same as the latest one had not been added. */
void arm_moves_drop(struct arm_moves *c);

/* Coordinate of the latest move: 3 .. 5. */
int arm_moves_axis(const struct arm_moves *c);

/* Tip and attitude of a place; of a move by joints those of the joints. */
void arm_moves_pose(const struct arm_geometry *g, const double place[AXES],
                    const double joint[AXES], struct pose *pose);

/* Whether a place belongs to a move by joints, which takes no inverse kinematics. */
bool arm_moves_by_joints(const struct arm_moves *c, const double place[AXES]);

/* Tells the motion core the joints [rad] of a place. */
struct kinematics arm_moves_kinematics(void);

#endif
