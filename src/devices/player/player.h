/* player - the FPGA's part of the card: frames of a FIFO become direction and pulses of four axes.
 *
 * Its time is the clock of 20 ns, a whole number. A frame is played in a period of M ticks by a DDA
 * for each axis (see dda.h: a command is put out evenly and in full). A tick is an overflow of the
 * rate's accumulator, to which the rate is added each clock: at the full rate, 2^24, each clock is
 * a tick; at half of it each second clock. So the rate stretches the time of all axes alike and
 * leaves the path as it is: the counts are a function of the ticks. What is left in the accumulator
 * at the end of a frame goes over into the next one.
 *
 * The rate changes on a grid of PLAYER_GRID clocks that begins with its ramp. It follows a
 * rate_ramp whose bounds come from the frames in stock and the limits of the job.
 *
 *     fresh --target 1--> full rate at once (a job begins at rest)
 *     full  --target 0--> ramp down --> REST told, the frame in progress waits half played
 *           --target 1--> ramp up   --> FULL told
 *
 * A target that turns round within a ramp first ends the change of the rate, then ramps back.
 *
 * Direction: an axis changes its direction at the begin of the first frame that goes the other way,
 * but at the earliest `hold` behind the end of its last pulse; its first pulse follows after
 * `setup` or later. Where the pulses themselves do not leave that room, dead clocks are put before
 * the frame, in which no axis moves.
 *
 * A period for which there is no frame passes without a pulse and is counted (underflow), unless
 * the job was told to be whole. Nothing in here loops over clocks or pulses. */
#ifndef PLAYER_H
#define PLAYER_H

#include <stdbool.h>
#include <stdint.h>

#include "frame_fifo.h"
#include "lines.h"
#include "rate_ramp.h"

enum {
    PLAYER_CLOCK_NS = 20,
    PLAYER_FULL_RATE = 1 << 24,
    PLAYER_GRID = 1000,             /* [clocks] between steps of the rate: 20 us */
    PLAYER_PERIOD_LONGEST = 500000, /* [clocks] 10 ms */
    PLAYER_EVENT_LARGEST = 31
};

struct player_config {
    int32_t depth; /* of the FIFO [frames] 1 .. FRAME_FIFO_LARGEST */
    int32_t width; /* [clocks] a pulse is high, 1 or more, and low at least as long */
    int32_t setup; /* [clocks] from a change of direction to the next pulse, 0 or more */
    int32_t hold;  /* [clocks] from the end of a pulse to a change of direction */
};

/* What a job brings. */
struct player_job {
    int32_t period;           /* [clocks] M, 2 .. PLAYER_PERIOD_LONGEST */
    double reserve;           /* share of acc and jerk that its plan leaves free */
    double speed[FRAME_AXES]; /* [pulses/s] largest planned; 0 not known */
    double acc[FRAME_AXES];   /* [pulses/s^2]; 0: this axis has no say in the rate */
    double jerk[FRAME_AXES];  /* [pulses/s^3]; 0: only its acceleration does */
};

enum player_status {
    PLAYER_OK = 0,
    PLAYER_FULL, /* no room in the FIFO: the frame is refused (overflow) */
    PLAYER_RANGE /* a command beyond player_largest, no such event, a job without sense,
                  * a frame behind the last one */
};

/* What it tells, a bit each. */
enum player_tells {
    PLAYER_HALF = 1,        /* the stock fell to half the depth */
    PLAYER_DRY = 2,         /* a period began without a frame, the first of a row */
    PLAYER_ENDED = 4,       /* the last frame of the job is over */
    PLAYER_REST = 8,        /* the rate is 0 */
    PLAYER_FULL_SPEED = 16, /* the rate is full again */
    PLAYER_EVENT = 32,      /* a frame with an event began */
    PLAYER_TELLS = 6
};

/* Told since it was last taken. */
struct player_told {
    uint32_t what;
    uint32_t events;             /* bit n: event n, 1 .. PLAYER_EVENT_LARGEST */
    int64_t clock[PLAYER_TELLS]; /* of each bit, the latest */
};

struct player {
    struct player_config config;
    struct player_job job;
    struct frame_fifo fifo;
    struct frame frame;         /* in progress; zeros if there is none */
    bool fresh;                 /* a job has begun, its first period not */
    bool begun;                 /* a period is in progress */
    bool playing;               /* and it has a frame */
    bool whole;                 /* no more frames come */
    int64_t clock;              /* everything up to here is done */
    int64_t base;               /* [clock] from which the phase grows: behind dead clocks */
    int64_t phase;              /* [1/PLAYER_FULL_RATE ticks] at base, of the period */
    int32_t rate;               /* 0 .. PLAYER_FULL_RATE */
    int64_t before[FRAME_AXES]; /* [pulses] of the frames before */
    int64_t last[FRAME_AXES];   /* [clock] latest pulse up to base; -1 none yet */
    bool backward[FRAME_AXES];
    int64_t turned[FRAME_AXES];    /* [clock] from which it is so; until then the other way */
    int32_t target;                /* 0 or 1: where the rate is or goes */
    bool ramping, braking;         /* braking: the ramp ends between 0 and 1 */
    int64_t ramp_begin, ramp_step; /* [clock] begin, next step of its grid */
    struct rate_bounds bounds;
    struct rate_ramp ramp;
    struct player_told told;
    int64_t frames;  /* begun since the job began */
    int64_t dry;     /* periods without a frame, of all jobs */
    int64_t refused; /* frames, of all jobs */
    int64_t dead;    /* [clocks] put in for changes of direction */
};

/* Power on: all counts 0, nothing moves. False: no such configuration. */
bool player_start(struct player *p, const struct player_config *config);

/* Power on again, maybe with another configuration: nothing moves, the counts stay. False: no such
 * configuration, nothing changed. */
bool player_power(struct player *p, const struct player_config *config);

/* Largest |command| of a frame at this period: room for pulses of full width. [pulses] */
int32_t player_largest(const struct player *p, int32_t period);

/* A job begins at `clock`: the FIFO is empty, the rate 0, nothing has been told. Counts stay. */
enum player_status player_begin(struct player *p, const struct player_job *job, int64_t clock);

/* A frame, at `clock`, to which it must have been advanced. */
enum player_status player_push(struct player *p, const struct frame *frame);

/* No more frames come: when they are played the job has ended. */
void player_whole(struct player *p);

/* The rate shall go to 0 or to 1. */
void player_set_target(struct player *p, int32_t target);

/* Drop what is in the FIFO and the rest of the frame in progress; rate 0. At rest this ends a job;
 * while it moves it stops all pulses at once. A pulse that is high keeps its width. */
void player_clear(struct player *p);

/* Next clock at which the player does something by itself; INT64_MAX: never. */
int64_t player_next(const struct player *p);

/* Do all up to and including a clock. */
void player_advance(struct player *p, int64_t clock);

/* What was told since; it is forgotten. To know each thing at its clock, advance from player_next
 * to player_next. */
struct player_told player_take(struct player *p);

/* Nothing moves: rate 0 or no period in progress. */
bool player_at_rest(const struct player *p);

/* The following hold for a clock from that of the player up to player_next, that one excluded. */

/* Pulses put out since power on, forward less backward; the level of a pulse is high at its clock
 * already. */
void player_counts(const struct player *p, int64_t clock, int64_t counts[FRAME_AXES]);

/* Line a: pulse, line b: direction, high is backward. */
struct lines player_lines(const struct player *p, int axis, int64_t clock);

/* Clock of the first pulse of an axis behind `after`; INT64_MAX: none before player_next. */
int64_t player_edge(const struct player *p, int axis, int64_t after);

/* The rate, 0 .. 1, and what it makes of the frame's commands. [pulses/s] */
double player_rate(const struct player *p);
double player_velocity(const struct player *p, int axis);

#endif
