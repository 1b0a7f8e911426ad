/* robot - an arm of up to six joints that moves: lines, circles, moves of the joints, jogging.
 *
 *     robot_move, robot_jog ──> tool_path ──> ring ──> trajectory ──> robot_cycle: joints
 *     refused before          segments       look-ahead         each cycle
 *     anything moves
 *
 * Poses are those of the tool's tip in the base frame of the robot; a user's frame is a
 * pose_product before. With a track that frame is the world's: the base with the track at 0. A
 * call that is refused changes nothing. Joints are in rad, sliding ones in m
 * wherever rad is said of joints here; those that the arm has not stand at 0.
 */
#ifndef ROBOT_H
#define ROBOT_H

#include "external.h"
#include "joint_flow.h"
#include "trajectory.h"

/* A target that says nothing of its branch; of the whole turns of a joint. */
enum { ROBOT_ANY_BRANCH = -1, ROBOT_ANY_TURN = MANIPULATOR_ANY_TURN };

/* No place, angle or direction of a move is larger, in its unit: squares stay numbers and a path is
 * halved a hundred times at most. */
#define ROBOT_MOST 1e9

struct robot_config {
    struct manipulator arm;   /* with the tool it starts with */
    struct external external; /* beside it */
    double scale[OPW_JOINTS]; /* [pulses/rad] */
    double feed;              /* [mm/s] highest of the tool's tip */
    double acc;               /* [mm/s^2] of it, along and across */
    double spin;              /* [rad/s] highest of the tool's turning */
    double smooth;            /* [s] in which an acceleration comes up; 0 at once */
    bool flow;                /* moves flow, except by the wrist; without it splines alone do */
    double cycle;             /* [s] */
    double slot;              /* [s] of the pulses */
    double slot_pulses;       /* highest number of pulses in a slot */
};

/* Where a move leads to. */
struct robot_target {
    bool by_joints;           /* joint[] is the target, else pose is */
    double joint[OPW_JOINTS]; /* [rad] */
    struct pose pose;
    int branch;                /* of a pose: sum of opw_flag, or ROBOT_ANY_BRANCH */
    int open;                  /* sum of the opw_flags that branch leaves open */
    bool turned;               /* of a pose: turn[] is asked for, but for ROBOT_ANY_TURN */
    int turn[OPW_JOINTS];      /* whole turns: joint n is within half a turn of so many */
    enum external_kind beside; /* an external axis of this kind goes to external; NONE: it stays */
    double external;           /* [m] [rad] */
};

enum robot_kind {
    ROBOT_JOINTS, /* all joints start and end together, the slowest decides */
    ROBOT_LINE,
    ROBOT_CIRCLE, /* through via.at to the target */
    ROBOT_ARC,    /* about a centre; target.pose gives the orientation at its end only */
    ROBOT_SPLINE  /* of a row of poses as one smooth curve (tool_spline.h); it flows */
};

enum robot_singular {
    ROBOT_SLOW,   /* the tool slows so that the joints keep their limits */
    ROBOT_REFUSE, /* the move is refused if it had to */
    ROBOT_WRIST   /* joints 4 to 6 go straight, the tip keeps its path, not the orientation */
};

struct robot_move {
    enum robot_kind kind;
    struct robot_target target;
    double via[3]; /* [mm] of a circle */
    bool goes_on;  /* a spline passes its target, towards next */
    struct pose next;
    double centre[3], normal[3]; /* [mm], unit vector of an arc */
    double rise;                 /* [mm] of an arc along its normal, then an axis of the base */
    double sweep;                /* [rad] of an arc, counter-clockwise about the normal */
    double feed;                 /* [mm/s] of the tip; 0 the highest */
    double spin;                 /* [rad/s] of the tool's turning; 0 the highest */
    double share;                /* > 0..1 of the joints' speeds; of a move of joints */
    double acc, dec;             /* 0..1 share of the accelerations with which it speeds up, slows
                                  * down; 0 is 1 */
    double zone;                 /* [mm] tolerance of the corner with the next move; 0 exact stop */
    double radius;               /* [mm] instead: of the corner, if moves flow; 0: by the zone */
    double part;                 /* 0..0.5 most of either move that the corner takes if moves flow;
                                  * 0 is 0.5 */
    enum robot_singular singular;
    int32_t line; /* of the program */
};

enum robot_status {
    ROBOT_OK,
    ROBOT_BUSY,         /* not now: the move before is not all in the ring, or the arm moves */
    ROBOT_PARAMETER,    /* beyond ROBOT_MOST, no number, of the wrong sign; by the wrist
                        * of an arm by its axes */
    ROBOT_FAR,          /* out of reach, at a part of the path */
    ROBOT_OUTSIDE,      /* a joint would leave its limits */
    ROBOT_SINGULAR,     /* a factor is too small */
    ROBOT_OTHER_BRANCH, /* a path that keeps the branch does not lead to that of the target */
    ROBOT_OTHER_TURN,   /* nor to its whole turns of a joint */
    ROBOT_NO_CIRCLE,    /* start, via and end are on one line, or the start is on the axis */
    ROBOT_OFF_PLANE,    /* an arc's start is not in the plane of its centre across its normal */
    ROBOT_NO_UNIT,      /* an arc's normal is no unit vector */
    ROBOT_NO_SPLINE,    /* two poses in a row are the same */
    ROBOT_TILTED,       /* the arm's joints do not turn the tool to such an orientation */
    ROBOT_NO_JOINT,     /* the arm has no such joint, 6: no external axis */
    ROBOT_BESIDE        /* a track goes with joints and lines, a table with arcs, too */
};

/* Why a move is refused. */
struct robot_refusal {
    double part;     /* 0..1 of the path */
    double place[3]; /* [mm] of the tip there */
    int which;       /* joint, 0 .. 5, 6 the external axis; factor 0 shoulder 1 elbow 2 wrist; flag
                      * (opw_flag) */
    bool slides;     /* the joint does, so value and limit of OUTSIDE are in m */
    double value;    /* joint, tilt [rad]; factor: [m], 1, 1; start off the plane [mm]; length */
    double limit;    /* [rad] [m] [mm]; of OTHER_TURN: what it should be within half a turn of; of
                      * NO_JOINT: number of joints */
};

enum robot_frame { ROBOT_IN_JOINTS, ROBOT_IN_BASE, ROBOT_IN_TOOL, ROBOT_IN_EXTERNAL };

/* The latest move, if it is a spline that goes on. */
struct robot_spline {
    bool goes_on;
    struct pose start;           /* where it began */
    struct joint_curve_node end; /* where the next one does */
};

struct robot {
    struct trajectory trajectory;
    struct ring ring;
    struct lookahead_mean mean;
    struct arm_moves moves;
    struct joint_flow flow;     /* if moves flow */
    struct pose tool;           /* in force */
    struct tool_path tool_path; /* of the latest move; its segments go into the ring one by one */
    struct robot_move move;     /* that move */
    struct robot_spline spline;
    struct command command;        /* what its segments have in common */
    bool stop;                     /* an exact stop before its first segment */
    double rear[AXES];             /* place at the end of the latest move, from the arm's base */
    double rear_joint[OPW_JOINTS]; /* [rad] there */
    double rear_external;          /* [m] [rad] there */
    enum arm_move_kind rear_kind;
    double rear_zone;
    int32_t index;          /* of the latest command */
    bool jogging, jog_held; /* the latest move is a jog; its key is still down */
    enum robot_frame jog_frame;
    double jog_direction[6];

    double joint[OPW_JOINTS]; /* [rad] ideal, at the end of the latest cycle */
    double rate[OPW_JOINTS];  /* [rad/s] mean of that cycle */
    double gain[OPW_JOINTS];  /* [rad/s^2] how much that is more than in the cycle before */
    double external, external_rate, external_gain; /* the same of the external axis */
    struct pose pose;                              /* of the tip there */
    double speed;                                  /* [mm/s] of the tip along its path */
    double length;                                 /* [mm] of its path so far, */
    double solved; /* and of what of it took inverse kinematics, no move of joints */
    int32_t line;  /* of the program */
    bool lost;     /* the path led out of reach: stopped on the spot; until the next */
};

/* At rest at joints [rad]. Any joints: out of its limits the arm moves back only. */
void robot_start(struct robot *r, const struct robot_config *c, const double joint[OPW_JOINTS]);

/* At rest, the external axis at another place. */
void robot_place(struct robot *r, const struct robot_config *c, double external);

/* Whether the next move may be given: all of the one before is in the ring. */
bool robot_ready(const struct robot *r);

/* Plan a move behind those given before. */
enum robot_status robot_move(struct robot *r, const struct robot_config *c,
                             const struct robot_move *move, struct robot_refusal *why);

/* A cycle passes: joint, rate, pose, speed, length, line are those at its end. */
void robot_cycle(struct robot *r, const struct robot_config *c);

/* What keeps the motion at the end of a cycle from being faster, whose move asked for a feed
 * [mm/s]; 0: of joints. `axis` is the joint at its limit, from 1, 7 the external axis. */
struct limited robot_limited(struct robot *r, const struct robot_config *c, double feed);

/* Nothing moves and nothing is left to do but what hold or override 0 keeps. */
bool robot_rests(const struct robot *r);

/* Whether all moves are done. */
bool robot_idle(const struct robot *r);

/* Pause on the path or go on; ramp to rest and drop all moves; drop them without a ramp; drive at a
 * share of all speeds, 0 or more. */
void robot_hold(struct robot *r, bool on);
void robot_abort(struct robot *r);
void robot_stop(struct robot *r);
void robot_override(struct robot *r, double share);

/* Joints at the end of the moves given so far, for the target of a next one. [rad] */
void robot_end(const struct robot *r, double joint[OPW_JOINTS]);

/* The external axis there. [m] [rad] */
double robot_end_external(const struct robot *r);

/* Take another tool; ROBOT_BUSY while moves are not done. */
enum robot_status robot_tool(struct robot *r, const struct robot_config *c,
                             const struct pose *tool);

/* Jog along a direction: of joints; or X Y Z and turns about them, of the base or of the tool's
 * frame, through the tip; or of the external axis, by the first number. Speed at the share 0..1 of
 * config's (feed, spin, joint speeds). `way` > 0 [mm] or [rad], of a track [m]: so far only; 0:
 * until robot_release, or as far as the arm goes. A jog goes on while the same one is asked for;
 * ROBOT_BUSY: another motion has to end. */
enum robot_status robot_jog(struct robot *r, const struct robot_config *c, enum robot_frame frame,
                            const double direction[6], double share, double way,
                            struct robot_refusal *why);
void robot_release(struct robot *r);

/* Where the arm is: pose of the tip, joints, branch, whole turns. */
void robot_teach(const struct robot *r, const struct robot_config *c, struct robot_target *t);

/* Factors (manipulator_factors) of the joints now. Returns their branch. */
int robot_factors(const struct robot *r, const struct robot_config *c, double factor[3]);

#endif
