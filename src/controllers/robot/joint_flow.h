/* joint_flow - moves in a row as one curve of the joints, driven as fast as these are allowed to.
 *
 *     move ──joint_curve──> pieces ──> corners ──> speed profile ──> joints of a cycle
 *                           as they are  within zones   speed, acceleration, jerk of each joint
 *
 * A move keeps its way but for the zone at its end, in which a quintic leads into the next one; its
 * second half waits until that is known. Without a zone, or if no move follows in time, the arm
 * rests at its end.
 */
#ifndef JOINT_FLOW_H
#define JOINT_FLOW_H

#include "joint_curve.h"
#include "speed_profile.h"

enum { JOINT_FLOW_PIECES = 1024 };

/* How far a corner leaves the way, the least of what is asked. */
struct joint_flow_zone {
    double off; /* [mm] most that the tip leaves its path by; 0, without a radius: an exact stop */
    double radius; /* [mm] instead: as far as an arc of this radius between both paths; 0: none */
    double part;   /* 0..0.5 most of a move that a corner takes */
};

struct joint_flow_piece {
    struct segment curve; /* of the joints [mm], joint_curve.h */
    int32_t line;         /* of the program */
    bool solved;          /* it took inverse kinematics */
};

struct joint_flow {
    struct speed_profile profile;
    int64_t made;   /* pieces since the start */
    int64_t joined; /* of them the speed profile has had so many */
    int64_t at;     /* the one of the arm */
    int64_t held;   /* they wait from this one on, if `open` */
    bool open;      /* the latest move has a zone, and the next one is not known */
    struct joint_flow_zone zone;
    double room;  /* [mm] most of the end of the latest move that a corner may take */
    double base;  /* [mm] where the arm's piece begins, from where it rested last */
    int32_t idle; /* cycles since the latest move came */
    struct joint_flow_piece piece[JOINT_FLOW_PIECES];
};

/* No moves, at rest. */
void joint_flow_clear(struct joint_flow *f);

/* Whether moves are not done; whether a move with as many pieces as there can be finds room. */
bool joint_flow_busy(const struct joint_flow *f);
bool joint_flow_room(const struct joint_flow *f);

/* What all pieces of a move have in common. */
struct joint_flow_move {
    struct joint_flow_zone zone; /* at its end */
    double share[2];             /* of the joints' accelerations, see struct segment */
    bool goes_on;                /* without a corner: the next move begins as this one ends */
    int32_t line;
    bool solved;
};

/* A move of such pieces joins, with the corner before it; `l` are the limits of the joints [mm],
 * from the next rest on. */
void joint_flow_add(struct joint_flow *f, const struct manipulator *arm,
                    const struct speed_limits *l, const struct joint_flow_move *move, int32_t count,
                    const struct segment *piece);

/* Let up to dt seconds pass under an override, 0: to rest. Returns the time left: above 0 only at
 * the end of all moves. */
double joint_flow_advance(struct joint_flow *f, double override, double dt);

/* Joints where the motion is [rad], and the piece it is on. */
const struct joint_flow_piece *joint_flow_joints(struct joint_flow *f, double joint[OPW_JOINTS]);

/* Whether it goes at this share of the programmed feed, or faster. */
bool joint_flow_feeds(const struct joint_flow *f, double share);

/* Whether it stands. */
bool joint_flow_rests(const struct joint_flow *f);

#endif
