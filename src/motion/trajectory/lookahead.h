/* lookahead - commands in a row that have a corner tolerance are one motion.
 *
 *   v ^     ____          ___         limits of the commands and of their corners; from the end of
 *     |    /    \   __   /   \        the last known command backwards, the speed at every border
 *     |   /      \_/  \_/     \       from which the rest can still be braked; forwards, as fast as
 *     +--+-----+--+----+---+---+> s   these allow. At the end of what is known the motion rests.
 *
 * The way along the chain is planned with constant accelerations. For S-shaped ramps it then passes
 * a mean over a time: the mean of a way within limits of speed and acceleration is within them too,
 * and its jerk is the change of acceleration over that time. Low limits are widened by the way that
 * the mean smears, so that they hold where the tool is.
 *
 * The commands stay in the ring until the tool has left them.
 */
#ifndef LOOKAHEAD_H
#define LOOKAHEAD_H

#include "limited.h"
#include "ring.h"

enum {
    LOOKAHEAD_MEAN = 2048, /* frames of the mean, and one more */
    LOOKAHEAD_CAPS = 8
};

/* A limit left behind that still holds for some way: the tool is behind the planned motion. */
struct lookahead_cap {
    double speed; /* [mm/s] */
    double until; /* [mm] on the chain */
};

struct lookahead_mean {
    double sample[LOOKAHEAD_MEAN]; /* [mm] way at the latest points */
};

struct lookahead {
    bool closed;     /* no further command joins */
    int32_t started; /* index of its first command */
    int32_t joined;  /* commands from the head of the ring that are in the chain */
    int32_t planned; /* how many of these the latest plan of the speeds knows */
    double override; /* override of that plan */
    double dec;      /* [mm/s^2] least deceleration of the commands not left behind */
    double smooth;   /* [s] time of the mean; 0 none */
    double end;      /* [mm] end of the joined commands on the chain */

    int32_t at;   /* command of the planned motion, from the head */
    bool turning; /* it is in the corner at that command's start */
    double base;  /* [mm] start of that command on the chain */
    double s, v;  /* [mm] place of the planned motion from there, [mm/s] */
    struct lookahead_cap cap[LOOKAHEAD_CAPS];
    int32_t caps;

    int32_t taps, next; /* samples of the mean, 0 before the first; place of the next */
    int32_t still;      /* samples since the planned motion moved */
    double sum, zero;   /* [mm] sum of the samples, each counted from `zero` */

    int32_t out;         /* command of the tool, from the head */
    int32_t begun;       /* number of commands of which lookahead_begun has told */
    double out_base;     /* [mm] start of the tool's command on the chain */
    double out_s, out_v; /* [mm] place of the tool from there, [mm/s] */
    double way;          /* [mm] the tool on the chain: base + s of the planned motion once it
                          * is there, which out_base + out_s need not round to */
};

/* Whether the first command of the ring begins a chain. */
bool lookahead_begins(const struct ring *r);

/* Begin one, at rest. */
void lookahead_start(struct lookahead *t, struct ring *r);

/* Join what the ring has, and let up to dt seconds pass on the planned motion under an override; 0
 * brings it to rest. Returns the time left: above 0 only at the end of the chain. */
double lookahead_advance(struct lookahead *t, struct ring *r, double override, double dt);

/* End with the first command in which the motion can still be brought to rest. */
void lookahead_close(struct lookahead *t, const struct ring *r);

/* A frame of dt seconds ends: the tool follows the planned motion. */
void lookahead_sample(struct lookahead *t, struct lookahead_mean *m, struct ring *r, double dt);

/* The next command that the tool has begun since it was asked last, or NULL; all of them once the
 * planned motion has ended. */
const struct command *lookahead_begun(struct lookahead *t, const struct ring *r);

/* Drop commands that the tool has left. */
void lookahead_drop(struct lookahead *t, struct ring *r);

/* Let the planned motion go to where an override of 0 brings it to rest. */
void lookahead_to_rest(struct lookahead *t, struct ring *r);

/* What limits the planned motion, an override being above 0. */
struct limited lookahead_limited(const struct lookahead *t, const struct ring *r,
                                 const struct mechanism *m, double override);

/* Half length of the corner at the start of a command of the chain; 0: it has none. [mm] */
double lookahead_half(const struct lookahead *t, const struct ring *r, int32_t i);

/* Whether the planned motion stands and the tool is there. */
bool lookahead_rests(const struct lookahead *t);

/* Whether the planned motion is at the end of what is joined. */
bool lookahead_at_end(const struct lookahead *t, const struct ring *r);

/* Whether the planned motion stands at the end of what is joined, and the tool is there. */
bool lookahead_done(const struct lookahead *t);

/* Move the tool to a place further on the chain. [mm] */
void lookahead_go(struct lookahead *t, const struct ring *r, double way);

/* Place of the tool [mm] and its velocity [mm/s]. */
void lookahead_place(const struct lookahead *t, const struct ring *r, double point[AXES],
                     double velocity[AXES]);

#endif
