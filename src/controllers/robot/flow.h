/* flow - moves in a row as one curve of the joints, driven as fast as these are allowed to.
 *
 *     move ──joint_curve──> pieces ──> corners ──> speed profile ──> joints of a cycle
 *                           as they are  within zones   speed, acceleration, jerk of each joint
 *
 * A move keeps its way but for the zone at its end, in which a quintic leads into the next one; its
 * second half waits until that is known. Without a zone, or if no move follows in time, the arm
 * rests at its end.
 */
#ifndef FLOW_H
#define FLOW_H

#include "joint_curve.h"
#include "speed_profile.h"

enum { FLOW_PIECES = 1024 };

/* Where a corner may leave the way: the nearer of both. */
struct flow_zone {
    double off;  /* [mm] most that the tip leaves its path by; 0: an exact stop */
    double part; /* 0..0.5 most of a move that a corner takes */
};

struct flow_piece {
    struct segment curve; /* of the joints [mm], joint_curve.h */
    int32_t line;         /* of the program */
    bool solved;          /* it took inverse kinematics */
};

struct flow {
    struct speed_profile profile;
    int64_t made;   /* pieces since the start */
    int64_t joined; /* of them the speed profile has had so many */
    int64_t at;     /* the one of the arm */
    int64_t held;   /* they wait from this one on, if `open` */
    bool open;      /* the latest move has a zone, and the next one is not known */
    struct flow_zone zone;
    double room;  /* [mm] most of the end of the latest move that a corner may take */
    double base;  /* [mm] where the arm's piece begins, from where it rested last */
    int32_t idle; /* cycles since the latest move came */
    struct flow_piece piece[FLOW_PIECES];
};

/* No moves, at rest. */
void flow_clear(struct flow *f);

/* Whether moves are not done; whether a move with as many pieces as there can be finds room. */
bool flow_busy(const struct flow *f);
bool flow_room(const struct flow *f);

/* What all pieces of a move have in common. */
struct flow_move {
    struct flow_zone zone; /* at its end */
    int32_t line;
    bool solved;
};

/* A move of such pieces joins, with the corner before it; `l` are the limits of the joints [mm],
 * from the next rest on. */
void flow_add(struct flow *f, const struct manipulator *arm, const struct speed_limits *l,
              const struct flow_move *move, int32_t count, const struct segment *piece);

/* Let up to dt seconds pass under an override, 0: to rest. Returns the time left: above 0 only at
 * the end of all moves. */
double flow_advance(struct flow *f, double override, double dt);

/* Joints where the motion is [rad], and the piece it is on. */
const struct flow_piece *flow_joints(struct flow *f, double joint[OPW_JOINTS]);

/* Whether it stands. */
bool flow_rests(const struct flow *f);

#endif
