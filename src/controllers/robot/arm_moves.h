/* course - what the coordinates of the motion core mean: the moves of the arm, one after another.
 *
 *     X Y Z   the tool's tip [mm]
 *     U V W   how far the moves 0 3 6 .., 1 4 7 .., 2 5 8 .. have turned the tool
 *
 * Each move turns the tool about its own axis, and two moves that follow one another have different
 * coordinates. So a corner between them fades the one turn out and the other in, as it does with
 * the ways, and no turn jumps. A coordinate counts LEVER times the angle: a tolerance of 1 mm is
 * one of 1/LEVER rad. A move of the joints has its share in its coordinate.
 */
#ifndef COURSE_H
#define COURSE_H

#include "manipulator.h"
#include "mechanism.h"

/* The moves whose commands are in the ring (256), their neighbours and what is planned. */
enum { COURSE_SIZE = 320 };

/* Length that an angle is measured at. [mm/rad] */
#define COURSE_LEVER 100.0

enum course_kind {
    COURSE_POSE,  /* tip and attitude */
    COURSE_WRIST, /* tip, joints 4 to 6 linear in the way */
    COURSE_JOINTS /* all joints linear in the way */
};

struct course_move {
    enum course_kind kind;
    double from, to;          /* of its coordinate; equal: the tool does not turn */
    double turn[4];           /* attitude at its start; of joints: at its end */
    double by[3];             /* [rad] rotation vector, base frame */
    double joint[OPW_JOINTS]; /* [rad] at its start */
    double step[OPW_JOINTS];  /* [rad] to its end */
};

struct course {
    struct course_move move[COURSE_SIZE];
    int32_t count; /* moves in all; the latest COURSE_SIZE are known */
    double at[3];  /* U V W at the end of the last */
};

/* What the kinematics of the motion core get. */
struct course_geometry {
    const struct manipulator *arm;
    const struct course *course;
};

/* No moves yet; the tool has an attitude. */
void course_start(struct course *c, const double turn[4]);

/* Add a move, whose coordinate goes on by `way` [mm]; its from and to are set here. */
void course_add(struct course *c, const struct course_move *move, double way);

/* The same as the latest one had not been added. */
void course_drop(struct course *c);

/* Coordinate of the latest move: 3 .. 5. */
int course_axis(const struct course *c);

/* Tip and attitude of a place; of a move by joints those of the joints. */
void course_pose(const struct course_geometry *g, const double place[AXES],
                 const double joint[AXES], struct pose *pose);

/* Whether a place belongs to a move by joints, which takes no inverse kinematics. */
bool course_by_joints(const struct course *c, const double place[AXES]);

/* Tells the motion core the joints [rad] of a place. */
struct kinematics course_kinematics(void);

#endif
