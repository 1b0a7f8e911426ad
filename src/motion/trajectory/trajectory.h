/* trajectory - commands become the commanded positions of all axes over time: a point for each
 * interpolation cycle, of which a card's frame is made.
 *
 * Motion runs in continuous time. A command that ends inside a frame hands the rest of it to the
 * next one, so no time is lost between them. Four motions take turns:
 *
 *     mix      commands one by one, or two at a time by path mixing      mix.h
 *     chain    commands with a corner tolerance as one by look-ahead     lookahead.h
 *     curve    the same as one smooth curve                              curve.h
 *     axes     each joint for itself: by a command, or by orders         axes.h
 *
 * Unless commands are mixed or chained each ends at rest (exact stop). Commands that switch outputs
 * or stop the program wait until all motion before them has ended. Pulses are differences of the
 * rounded ideal position, so every joint is within half a pulse of it at every point and nothing
 * drifts.
 *
 * Mix, chain and curve move the tool, axes the joints. The mechanism turns one into the other where
 * a point becomes pulses; elsewhere they do not matter.
 */
#ifndef TRAJECTORY_H
#define TRAJECTORY_H

#include "curve.h"
#include "mix.h"
#include "queue.h"
#include "lookahead.h"

enum trajectory_motion { TRAJECTORY_MIX, TRAJECTORY_CHAIN, TRAJECTORY_AXES, TRAJECTORY_CURVE };

/* What a trajectory uses that is too large to be copied so that an earlier state can be put
 * back. */
struct trajectory_beside {
    struct ring *ring;
    struct lookahead_mean *mean;
    struct curve_plan *curve; /* NULL: what asks for a curve becomes a chain */
};

struct trajectory {
    enum trajectory_motion motion; /* the motion under way, or the latest */
    struct lookahead lookahead;    /* TRAJECTORY_CHAIN */
    struct curve curve;            /* TRAJECTORY_CURVE */
    double rest[AXES];             /* [mm] where nothing is under way */
    bool joints;                   /* `rest` is a place of joints */
    int32_t pulses[AXES];          /* [pulses] position of the latest point */
    double override[2];            /* overrides of lines and arcs, of point-to-point; 1 is 100 % */
    double adaptive;               /* share of the feed while OUTPUTS_ADAPTIVE; 1 at the start */
    uint32_t overrides;            /* enum outputs_overrides */
    bool hold;                     /* a hold is asked for; it acts unless OUTPUTS_HOLD_OFF */
    bool leave;                    /* ramp to rest, then drop the command under way */
    bool abort;                    /* ramp to rest, then drop everything */
    bool stopped;                  /* M0, M1: at rest until trajectory_continue */
    bool single;                   /* each block waits for trajectory_continue */
    bool allowed;                  /* the next block may begin nevertheless */
    int32_t block;                 /* line of the latest block */
    bool confirm;                  /* in-position check: a motion that ends at rest waits for it */
    bool confirming;               /* one waits now */
    bool untold;                   /* outputs or line have changed since the latest point */
    struct outputs outputs;
    struct outputs_surface surface; /* if it has a speed, outputs.spindle is the most */
    double end[AXES];               /* [mm] end of the latest command begun that takes time */
    int32_t started, line;          /* index and source line of the latest command begun */
    struct axes axes;               /* TRAJECTORY_AXES */
    struct mix mix; /* TRAJECTORY_MIX; in TRAJECTORY_AXES the command, none: by orders */
};

/* At rest at the origin, pulses 0. */
void trajectory_start(struct trajectory *p);

/* Copy what the motion under way uses, to go back to it later. */
void trajectory_copy(struct trajectory *to, const struct trajectory *from);

/* At rest with the tool at a place that the mechanism can reach; false, and nothing done, if it
 * cannot. */
bool trajectory_stand(struct trajectory *p, const struct mechanism *m, const double place[AXES]);

/* True if time alone changes nothing: no move under way that could go on, none to begin. */
bool trajectory_resting(const struct trajectory *p, const struct ring *r);

/* True while pulses are due: a line, arc or rapid under way that is not brought to rest. */
bool trajectory_moving(const struct trajectory *p);

/* Whether a command or a chain is under way, or the axes follow orders. */
bool trajectory_busy(const struct trajectory *p);

/* Let the axes follow orders, nothing being under way: from now on p->axes may get them. Hold,
 * override and abort act on them as on commands; abort ends it. False: the joints are not known. */
bool trajectory_order(struct trajectory *p, const struct mechanism *m);

/* Whether the axes follow orders. */
bool trajectory_ordered(const struct trajectory *p);

/* Back to commands; the axes rest. */
void trajectory_bind(struct trajectory *p);

/* Pause on the path, or go on. */
void trajectory_hold(struct trajectory *p, bool on);

/* Whether the place is one of joints, else of the tool. */
bool trajectory_in_joints(const struct trajectory *p);

/* Joints of a place as the trajectory has it; joint[] holds joints nearby. False: out of reach. */
bool trajectory_joints(const struct trajectory *p, const struct mechanism *m,
                       const double place[AXES], double joint[AXES]);

/* *ramp becomes the ramp of an abort from here, no chain being under way: nothing is dropped, and
 * its clocks can be set to any time until it rests and back. [s] */
void trajectory_ramp(const struct trajectory *p, struct trajectory *ramp);
void trajectory_shift(struct trajectory *ramp, double dt);
double trajectory_left(const struct trajectory *ramp);

/* Where the tool is, or the joints (trajectory_in_joints) [mm], and the velocity [mm/s]. */
void trajectory_place(const struct trajectory *p, const struct ring *r, double point[AXES],
                      double velocity[AXES]);

/* Rest before each block (a line of the program, a call), or no longer: what rests then still
 * waits for trajectory_continue. */
void trajectory_single(struct trajectory *p, const struct trajectory_beside *b, bool on);

/* True if the axes rest at a stop of the program or before a block. */
bool trajectory_waits(const struct trajectory *p, const struct ring *r);

/* The next command begins a block, and may. */
void trajectory_allow(struct trajectory *p);

/* Go on behind a stop of the program, or with one block. */
void trajectory_continue(struct trajectory *p);

/* Whether a hold acts. */
bool trajectory_held(const struct trajectory *p);

/* The adaptive feed: a share of the feed, which counts while a program lets it. */
void trajectory_adapt(struct trajectory *p, double share);

/* New overrides, from now on. A move that hands over to the next one keeps its deceleration. */
void trajectory_override(struct trajectory *p, double feed, double ptp);

/* Ramp to rest and drop what is left of the command under way, which is alone; the ring stays. */
void trajectory_leave(struct trajectory *p, const struct ring *r);

/* Ramp to rest; when there, moves and ring are dropped, spindle and coolant go off. */
void trajectory_abort(struct trajectory *p, struct ring *r);

/* Abort without a ramp, at the latest point. */
void trajectory_stop(struct trajectory *p, struct ring *r);

/* Let up to dt seconds pass. Stops early after it took a command from the ring, so that the caller
 * can refill it, and when the axes rest (trajectory_resting); returns the time that is left. */
double trajectory_advance(struct trajectory *p, const struct trajectory_beside *b, double dt);

/* The end of a frame of dt seconds: the point reached, with the outputs at that time; *point gets
 * everything but its frame, which is the way from p->pulses. False, and no pulses in *point: the
 * mechanism cannot reach it. */
bool trajectory_point(struct trajectory *p, const struct trajectory_beside *b,
                      const struct mechanism *m, double dt, struct point *point);

/* What limits the motion at the latest point; at rest, LIMITED_STOP. */
struct limited trajectory_limited(const struct trajectory *p, const struct trajectory_beside *b,
                                  const struct mechanism *m);

/* The point is taken. Until then an earlier *p can be put back: chain and curve keep what they
 * need. */
void trajectory_accept(struct trajectory *p, const struct trajectory_beside *b,
                       const struct point *point);

#endif
