/* way - a path of the tool and what its joints allow on it: pieces with a speed and an acceleration
 * of their own, as many as it needs, which look-ahead then joins.
 *
 *   v ^ ──────┐          ┌─────  Far from singular places one piece has it all. Near one, pieces
 *     |       └─┐      ┌─┘       are halved until the joints' limits hardly change in one.
 *     |         └─┐┌┐┌─┘
 *     +-----------++++-------> way
 */
#ifndef WAY_H
#define WAY_H

#include "course.h"

/* A path has no more pieces than these. */
enum { WAY_PIECES = 512 };

struct way_limits {
    double feed;              /* [mm/s] along the path */
    double acc;               /* [mm/s^2] along it */
    double speed[OPW_JOINTS]; /* [rad/s] */
    double turn[OPW_JOINTS];  /* [rad/s^2] */
    double smooth;            /* [s] time of the mean of the look-ahead; 0 none */
    bool corner[2];           /* a corner may follow its start, precede its end */
    bool refuse;              /* where the joints do not allow the feed */
};

struct way_piece {
    double until; /* part of the path at its end, 0 .. 1 */
    double cap;   /* [mm/s] */
    double acc;   /* [mm/s^2] */
};

struct way {
    struct path path;
    int32_t count, next; /* pieces; the first that is not yet a command */
    double smooth;       /* [s] of its commands: 0 if its joints make it slow */
    struct way_piece piece[WAY_PIECES];
};

enum way_status {
    WAY_OK,
    WAY_FAR,     /* out of reach */
    WAY_OUTSIDE, /* beyond the limit of a joint */
    WAY_SINGULAR /* the joints cannot follow: they would jump, or asked to refuse, hurry */
};

struct way_fault {
    double part;              /* of the path, 0 .. 1 */
    double joint[OPW_JOINTS]; /* [rad] there, or the last known */
    int which;                /* OUTSIDE: joint */
};

/* Pieces of w->path, its move being the latest of the course. joint[] holds those of its start, and
 * gets those of its end. Refused, joint[] is as it was. */
enum way_status way_plan(struct way *w, const struct course_geometry *g, const struct way_limits *l,
                         double joint[OPW_JOINTS], struct way_fault *fault);

/* Path of the next piece. Pieces of an arc have the very same radius and bend. */
void way_piece_path(const struct way *w, struct path *piece);

#endif
