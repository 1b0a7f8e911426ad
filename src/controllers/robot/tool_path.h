/* tool_path - the tool's path of one move, cut where the joints need it: each segment becomes a
 * command with a speed and an acceleration of its own, and look-ahead joins them again.
 *
 *   v ^ ──────┐          ┌─────  Far from singular places the path is one segment. Near one it is
 *     |       └─┐      ┌─┘       halved, and halved again, until the joints' limits hardly change
 *     |         └─┐┌┐┌─┘         within a segment.
 *     +-----------++++-------> place on the path
 */
#ifndef TOOL_PATH_H
#define TOOL_PATH_H

#include "arm_moves.h"

/* The most segments of a path. */
enum { TOOL_PATH_SEGMENTS = 512 };

/* Largest ratio of the limits of speed within a segment of a path with room for its segments. */
#define TOOL_PATH_UNEVEN 1.3

struct tool_path_limits {
    double feed;              /* [mm/s] along the path */
    double acc;               /* [mm/s^2] along it */
    double speed[OPW_JOINTS]; /* [rad/s] */
    double turn[OPW_JOINTS];  /* [rad/s^2] */
    double smooth;            /* [s] time of the mean of the look-ahead; 0 none */
    double zone[2];           /* [mm] of a corner at its start, at its end; 0: a stop */
    bool refuse;              /* refuse the path where the joints do not allow the feed */
};

struct tool_path_segment {
    double until; /* 0..1 part of the path at its end */
    double cap;   /* [mm/s] most speed on it */
    double acc;   /* [mm/s^2] */
};

struct tool_path {
    struct path path;
    int32_t count, next; /* number of segments; the first that is not yet a command */
    double smooth;       /* [s] mean for its commands; 0 if its joints make it slow */
    bool stop[2];        /* no corner at its start, its end: the joints would make it crawl */
    struct tool_path_segment segment[TOOL_PATH_SEGMENTS];
};

enum tool_path_status {
    TOOL_PATH_OK,
    TOOL_PATH_FAR,     /* out of reach */
    TOOL_PATH_OUTSIDE, /* beyond the limit of a joint */
    TOOL_PATH_SINGULAR /* the joints cannot follow: they would jump, or asked to refuse, hurry */
};

struct tool_path_fault {
    double part;              /* of the path, 0 .. 1 */
    double joint[OPW_JOINTS]; /* [rad] the joints there, or the last ones known */
    int which;                /* OUTSIDE: joint */
};

/* Cut w->path, the path of the latest of the arm's moves, into segments. joint[] holds the joints
 * at its start [rad] and gets those at its end; if the path is refused, it stays as it was. */
enum tool_path_status tool_path_plan(struct tool_path *w, const struct arm_geometry *g,
                                     const struct tool_path_limits *l, double joint[OPW_JOINTS],
                                     struct tool_path_fault *fault);

/* *segment becomes the path of segment w->next. All segments of an arc have the very same radius
 * and bend. */
void tool_path_next(const struct tool_path *w, struct path *segment);

#endif
