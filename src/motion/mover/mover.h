/* mover - trajectory planning: commands become points at equal times, the frames of the pulses.
 *
 * Motion runs in continuous time. A command that ends inside a frame hands the rest of it to the
 * next one, so no time is lost between them. Four motions take turns:
 *
 *     mix      commands one by one, or two at a time by path mixing      mix.h
 *     chain    commands with a corner tolerance as one by look-ahead     track.h
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
#ifndef MOVER_H
#define MOVER_H

#include "curve.h"
#include "mix.h"
#include "queue.h"
#include "track.h"

enum mover_motion { MOVER_MIX, MOVER_CHAIN, MOVER_AXES, MOVER_CURVE };

/* What a mover uses that is too large to be put back with it. */
struct mover_beside {
    struct ring *ring;
    struct track_mean *mean;
    struct curve_plan *curve; /* NULL: what asks for a curve becomes a chain */
};

struct mover {
    enum mover_motion motion; /* the motion under way, or the latest */
    struct mix mix;           /* MOVER_MIX; in MOVER_AXES the command, none: by orders */
    struct track track;       /* MOVER_CHAIN */
    struct curve curve;       /* MOVER_CURVE */
    struct axes axes;         /* MOVER_AXES */
    double rest[AXES];        /* [mm] where nothing is under way */
    bool joints;              /* `rest` is a place of joints */
    int32_t pulses[AXES];     /* [pulses] position of the latest point */
    double override[2];       /* overrides of lines and arcs, of point-to-point; 1 is 100 % */
    double adaptive;          /* share of the feed while OUTPUTS_ADAPTIVE; 1 at the start */
    uint32_t overrides;       /* enum outputs_overrides */
    bool hold;                /* a hold is asked for; it acts unless OUTPUTS_HOLD_OFF */
    bool leave;               /* ramp to rest, then drop the command under way */
    bool abort;               /* ramp to rest, then drop everything */
    bool stopped;             /* M0, M1: at rest until mover_continue */
    bool single;              /* each block waits for mover_continue */
    bool allowed;             /* the next block may begin nevertheless */
    int32_t block;            /* line of the latest block */
    bool confirm;             /* in-position check: a motion that ends at rest waits for it */
    bool confirming;          /* one waits now */
    bool untold;              /* outputs or line have changed since the latest point */
    struct outputs outputs;
    struct outputs_surface surface; /* if it has a speed, outputs.spindle is the most */
    int32_t started, line;          /* index and source line of the latest command begun */
};

/* At rest at the origin, pulses 0. */
void mover_start(struct mover *p);

/* At rest with the tool at a place that the mechanism can reach; false, and nothing done, if it
 * cannot. */
bool mover_stand(struct mover *p, const struct mechanism *m, const double place[AXES]);

/* True if time alone changes nothing: no move under way that could go on, none to begin. */
bool mover_resting(const struct mover *p, const struct ring *r);

/* True while pulses are due: a line, arc or rapid under way that is not brought to rest. */
bool mover_moving(const struct mover *p);

/* Whether a command or a chain is under way, or the axes follow orders. */
bool mover_busy(const struct mover *p);

/* Let the axes follow orders, nothing being under way: from now on p->axes may get them. Hold,
 * override and abort act on them as on commands; abort ends it. False: the joints are not known. */
bool mover_order(struct mover *p, const struct mechanism *m);

/* Whether the axes follow orders. */
bool mover_ordered(const struct mover *p);

/* Back to commands; the axes rest. */
void mover_bind(struct mover *p);

/* Pause on the path, or go on. */
void mover_hold(struct mover *p, bool on);

/* Whether the place is one of joints, else of the tool. */
bool mover_in_joints(const struct mover *p);

/* Joints of a place of the mover; joint[] holds those nearby. False: out of reach. */
bool mover_joints(const struct mover *p, const struct mechanism *m, const double place[AXES],
                  double joint[AXES]);

/* *ramp becomes the ramp of an abort from here, no chain being under way: nothing is dropped, and
 * its clocks can be set to any time until it rests and back. [s] */
void mover_ramp(const struct mover *p, struct mover *ramp);
void mover_shift(struct mover *ramp, double dt);
double mover_left(const struct mover *ramp);

/* Where the tool is, or the joints (mover_in_joints) [mm], and the velocity [mm/s]. */
void mover_place(const struct mover *p, const struct ring *r, double point[AXES],
                 double velocity[AXES]);

/* Rest before each block (a line of the program, a call), or no longer: what rests then still
 * waits for mover_continue. */
void mover_single(struct mover *p, const struct mover_beside *b, bool on);

/* True if the axes rest at a stop of the program or before a block. */
bool mover_waits(const struct mover *p, const struct ring *r);

/* The next command begins a block, and may. */
void mover_allow(struct mover *p);

/* Go on behind a stop of the program, or with one block. */
void mover_continue(struct mover *p);

/* Whether a hold acts. */
bool mover_held(const struct mover *p);

/* The adaptive feed: a share of the feed, which counts while a program lets it. */
void mover_adapt(struct mover *p, double share);

/* New overrides, from now on. A move that hands over to the next one keeps its deceleration. */
void mover_override(struct mover *p, double feed, double ptp);

/* Ramp to rest and drop what is left of the command under way, which is alone; the ring stays. */
void mover_leave(struct mover *p, const struct ring *r);

/* Ramp to rest; when there, moves and ring are dropped, spindle and coolant go off. */
void mover_abort(struct mover *p, struct ring *r);

/* Abort without a ramp, at the latest point. */
void mover_stop(struct mover *p, struct ring *r);

/* Let up to dt seconds pass. Stops early after it took a command from the ring, so that the caller
 * can refill it, and when the axes rest (mover_resting); returns the time that is left. */
double mover_advance(struct mover *p, const struct mover_beside *b, double dt);

/* The end of a frame of dt seconds: the point reached, with the outputs at that time; *point gets
 * everything but its frame, which is the way from p->pulses. False, and no pulses in *point: the
 * mechanism cannot reach it. */
bool mover_point(struct mover *p, const struct mover_beside *b, const struct mechanism *m,
                 double dt, struct point *point);

/* The point is taken. Until then an earlier *p can be put back: chain and curve keep what they
 * need. */
void mover_accept(struct mover *p, const struct mover_beside *b, const struct point *point);

#endif
