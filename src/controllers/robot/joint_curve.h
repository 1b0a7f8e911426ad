/* joint_curve - the joints along a move as pieces of a smooth curve, by their own length.
 *
 *     tool's path ──inverse kinematics──> places, slopes, bends at nodes ──> quintics between them
 *
 * A radian counts as JOINT_CURVE_LEVER mm, so the six joints are coordinates of the smooth core and
 * the parameter of a piece is the length of the joints' way. Neighbours have the same r, r' and
 * r''. Pieces are halved until the quintic is where the inverse kinematics are.
 */
#ifndef JOINT_CURVE_H
#define JOINT_CURVE_H

#include "segment.h"
#include "tool_path.h"
#include "tool_spline.h"

/* A radian counts as so many mm. [mm/rad] */
#define JOINT_CURVE_LEVER 1000.0

/* The most pieces of a move. */
enum { JOINT_CURVE_PIECES = 256 };

struct joint_curve_limits {
    double feed;              /* [mm/s] most speed of the tool along its path */
    double spin;              /* [rad/s] of its turning; of a spline */
    double speed[OPW_JOINTS]; /* [rad/s] of the joints */
    double off;               /* [rad] farthest that a joint may be from the inverse kinematics */
};

/* The way of a move of the joints [rad], which is straight, at a share 0..1 of their speeds: 0 or 1
 * piece. */
int32_t joint_curve_line(const double from[OPW_JOINTS], const double to[OPW_JOINTS], double share,
                         const double speed[OPW_JOINTS], struct segment *piece);

/* The joints along the path of the arm's latest move, which tool_path_plan has accepted with these
 * joints at its start [rad]. The number of pieces; 0: more would be needed than there are. */
int32_t joint_curve_path(const struct tool_path *w, const struct arm_geometry *g,
                         const double start[OPW_JOINTS], const struct joint_curve_limits *l,
                         struct segment piece[JOINT_CURVE_PIECES]);

/* The joints at a place of a tool's way, with their derivatives by it. */
struct joint_curve_node {
    double part;             /* 0..1 of the way */
    double r[OPW_JOINTS];    /* [mm] */
    double d[2][OPW_JOINTS]; /* [1] [1/mm] */
};

/* What becomes of a spline. */
struct joint_curve_spline {
    int32_t count; /* of pieces; 0: there are none */
    struct segment piece[JOINT_CURVE_PIECES];
    double until[JOINT_CURVE_PIECES]; /* 0..1 of the way at the end of each piece */
    struct joint_curve_node end;
    bool lost; /* why there are none: out of reach; else joints would jump, or there are too many */
    double at; /* 0..1 of the way where that is */
    double
        slow; /* 0..1 of the way where a joint's speed is below what the feed asks for; -1: none */
};

/* The joints along a spline from a node where it starts; without derivatives (part -1) these are
 * found. */
void joint_curve_spline(const struct tool_spline *s, const struct manipulator *arm,
                        const struct joint_curve_node *start, const struct joint_curve_limits *l,
                        struct joint_curve_spline *c);

#endif
