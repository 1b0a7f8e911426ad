/* ipo - trajectory planning: commands become points at the DDA boundaries.
 *
 * Motion runs in continuous time. A command that ends inside a DDA time hands the rest of it to the
 * next one, so no time is lost between them. With continuous path (G64) the next line or arc starts
 * when the current one begins to decelerate, and the tool moves by the sum of both:
 *
 *     point = A(s_A) + B(s_B) - B(0)          at most two commands at a time
 *
 * Commands with a corner tolerance (G64 P) are one motion by look-ahead: track.h.
 * Otherwise each command ends at rest (exact stop). Commands that switch outputs or stop the
 * program wait until all motion before them has ended. Pulses are differences of the rounded ideal
 * position, so every axis is within half a pulse of it at every boundary and nothing drifts.
 *
 * Point-to-point with independent axes is a command whose point comes from the axes mover. Between
 * commands the axes may also be set free: then they follow whatever orders the mover gets.
 */
#ifndef IPO_H
#define IPO_H

#include "track.h"
#include "queue.h"

struct ipo_move {
    struct command command;
    struct profile profile;
};

struct ipo {
    struct ipo_move move[2];    /* the older first */
    int32_t count;              /* moves under way */
    double  rest[AXES];         /* [mm] where the axes stand while count is 0 */
    bool    free;               /* no command: the axes follow orders, see ipo_free */
    struct axes axes;           /* while free, and of COMMAND_PTP_ASYN */
    int32_t pulses[AXES];       /* [pulses] of the latest point */
    double  override[2];        /* of lines and arcs, of point-to-point; 1 is 100 % */
    bool    hold;
    bool    abort;              /* ramp to rest, then drop everything */
    bool    stopped;            /* M0, M1: at rest until ipo_continue */
    bool    single;             /* each block waits for ipo_continue */
    bool    leave;              /* given for the next one */
    int32_t block;              /* line of the latest one */
    bool    confirm;            /* each motion that ends at rest waits to be confirmed, */
    bool    confirming;         /* as one does now: in-position check */
    bool    news;               /* outputs or line have changed since the latest point */
    struct outputs outputs;
    int32_t started, line;      /* index and source line of the latest command begun */
    struct track track;         /* chain under way by look-ahead; then count is 0 */
};

/* At rest at the origin, pulses 0. */
void ipo_start(struct ipo *p);

/* True if time alone changes nothing: no move under way that could go on, none to begin. */
bool ipo_resting(const struct ipo *p, const struct ring *r);

/* True while pulses are due: a line, arc or rapid under way that is not brought to rest. */
bool ipo_moving(const struct ipo *p);

/* Under way: a move, a chain, or free axes. */
bool ipo_busy(const struct ipo *p);

/* Set the axes free, count being 0: from now on p->axes may get orders. Hold, override and abort
 * act on them as on commands; abort binds them again. */
void ipo_free(struct ipo *p);

/* Back to commands; the axes rest. */
void ipo_bind(struct ipo *p);

/* Pause on the path, or go on. */
void ipo_hold(struct ipo *p, bool on);

/* The motion under way keeps to the paths of commands, else the axes are independent. */
bool ipo_follows_paths(const struct ipo *p);

/* *ramp becomes the ramp of an abort from here, no chain being under way: nothing is dropped, and
 * its clocks can be set to any time until it rests and back. [s] */
void ipo_ramp(const struct ipo *p, struct ipo *ramp);
void ipo_shift(struct ipo *ramp, double dt);
double ipo_left(const struct ipo *ramp);

/* Where the tool is [mm] and its velocity [mm/s]. */
void ipo_place(const struct ipo *p, const struct ring *r, double point[AXES],
               double velocity[AXES]);

/* Rest before each block (a line of the program, a call of the API), or no longer: what rests then
 * still waits for ipo_continue. */
void ipo_single(struct ipo *p, const struct ring *r, bool on);

/* True if the axes rest at a stop of the program or before a block. */
bool ipo_waits(const struct ipo *p, const struct ring *r);

/* The next command begins a block, and has leave to. */
void ipo_leave(struct ipo *p);

/* Go on behind a stop of the program, or with one block. */
void ipo_continue(struct ipo *p);

/* New overrides, from now on. A move that hands over to the next one keeps its deceleration. */
void ipo_override(struct ipo *p, double feed, double ptp);

/* Ramp to rest; when there, moves and ring are dropped, spindle and coolant go off. */
void ipo_abort(struct ipo *p, struct ring *r);

/* The same without a ramp, at the latest point. */
void ipo_stop(struct ipo *p, struct ring *r);

/* Let up to dt seconds pass. Stops early after it took a command from the ring, so that the caller
 * can refill it, and when the axes rest (ipo_resting); returns the time that is left. */
double ipo_advance(struct ipo *p, struct ring *r, double dt);

/* A DDA boundary: the point reached, with the outputs at that time; *point gets everything but its
 * frame, which is the way from p->pulses. `mean` is what a chain with S-shaped ramps remembers. */
void ipo_point(struct ipo *p, struct ring *r, const struct machine *m, struct track_mean *mean,
               struct point *point);

/* The point is taken. Until then an earlier *p can be put back: the chain keeps its commands. */
void ipo_accept(struct ipo *p, struct ring *r, const struct point *point);

#endif
