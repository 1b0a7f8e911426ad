/* player - the FPGA of the network card: it plays the frames of a FIFO as direction and pulses of
 * four axes, at a rate that slows down and speeds up for a pause on the path.
 *
 * Time is the clock of 20 ns, an integer. A frame is played in a period of M ticks by a DDA for
 * each axis (see dda.h: a command is put out evenly and in full). A tick is an overflow of the
 * rate's accumulator, to which the rate is added each clock: at the full rate, 2^24, each clock is
 * a tick; at half of it each second clock. So the rate stretches the time of all axes alike and
 * does not change the path: the counts are a function of the ticks. The remainder in the
 * accumulator at the end of a frame is carried into the next one.
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
 * but not before `hold` after the end of its last pulse; its first pulse comes at least `setup`
 * later. If the pulses leave too little time for that, dead clocks are inserted before the frame,
 * in which no axis moves.
 *
 * A period for which there is no frame passes without a pulse and is counted (underflow), unless
 * player_whole has said that no more frames come. No function loops over clocks or pulses. */
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
    int32_t depth; /* [frames] depth of the FIFO, 1 .. FRAME_FIFO_LARGEST */
    int32_t width; /* [clocks] that a pulse is high, 1 or more, and low at least as long */
    int32_t setup; /* [clocks] from a change of direction to the next pulse, 0 or more */
    int32_t hold;  /* [clocks] from the end of a pulse to a change of direction */
};

/* Properties of a job: the frames of a drawing, with the limits of its plan. */
struct player_job {
    int32_t period;           /* [clocks] M, length of a frame, 2 .. PLAYER_PERIOD_LONGEST */
    double reserve;           /* share of acc and jerk that the plan leaves free */
    double speed[FRAME_AXES]; /* [pulses/s] largest planned speed; 0: not known */
    double acc[FRAME_AXES];   /* [pulses/s^2] limit; 0: this axis does not limit the rate */
    double jerk[FRAME_AXES];  /* [pulses/s^3] limit; 0: only acceleration limits the rate */
};

enum player_status {
    PLAYER_OK = 0,
    PLAYER_FULL, /* no room in the FIFO: the frame is refused (overflow) */
    PLAYER_RANGE /* a command beyond player_largest, no such event, a job out of range, or
                  * a frame after player_whole */
};

/* What the player reports, a bit each. */
enum player_tells {
    PLAYER_HALF = 1,        /* the stock fell to half the depth */
    PLAYER_DRY = 2,         /* a period began without a frame, the first of a row */
    PLAYER_ENDED = 4,       /* the last frame of the job is over */
    PLAYER_REST = 8,        /* the rate has become 0 */
    PLAYER_FULL_SPEED = 16, /* the rate has become full */
    PLAYER_EVENT = 32,      /* a frame with an event began */
    PLAYER_TELLS = 6        /* number of these bits */
};

/* Reports since they were last taken. */
struct player_told {
    uint32_t what;               /* bits of player_tells */
    uint32_t events;             /* bit n: event n came, 1 .. PLAYER_EVENT_LARGEST */
    int64_t clock[PLAYER_TELLS]; /* [clock] of the latest report of each bit */
};

struct player {
    struct player_config config;
    struct player_job job;
    struct frame_fifo fifo;
    struct frame frame;         /* frame in progress; zeros if there is none */
    bool fresh;                 /* a job has begun, but not its first period */
    bool begun;                 /* a period is in progress */
    bool playing;               /* that period has a frame */
    bool whole;                 /* no more frames come */
    int64_t clock;              /* [20 ns] all events up to and including it have happened */
    int64_t base;               /* [clock] from which the phase grows, behind dead clocks */
    int64_t phase;              /* [ticks/PLAYER_FULL_RATE] of the period, at base */
    int32_t rate;               /* 0 .. PLAYER_FULL_RATE */
    int64_t end;                /* [clock] of the period's end; INT64_MAX: none, or the rate is 0 */
    int64_t before[FRAME_AXES]; /* [pulses] of all frames before this one */
    int64_t last[FRAME_AXES];   /* [clock] of the latest pulse up to base; -1 none yet */
    bool backward[FRAME_AXES];  /* direction, from `turned` on */
    int64_t turned[FRAME_AXES]; /* [clock] at which the direction line changes to it */
    int32_t target;             /* rate that is wanted, 0 or 1 */
    bool ramping, braking;      /* a ramp is in progress; it ends between 0 and 1, to turn back */
    int64_t ramp_begin, ramp_step; /* [clock] of the ramp's begin; of the next step of its grid */
    struct rate_bounds bounds;
    struct rate_ramp ramp;
    struct player_told told;
    int64_t frames;  /* number of frames begun since the job began */
    int64_t dry;     /* number of periods without a frame, of all jobs */
    int64_t refused; /* number of frames refused, of all jobs */
    int64_t dead;    /* [clocks] inserted for changes of direction */
};

/* Power on: all counts 0, nothing moves. False if the configuration is out of range. */
bool player_start(struct player *p, const struct player_config *config);

/* Power on again, maybe with another configuration: nothing moves, the counts stay. False, and
 * nothing changed, if the configuration is out of range. */
bool player_power(struct player *p, const struct player_config *config);

/* Largest |command| [pulses] of a frame at this period, which leaves room for pulses of full
 * width. */
int32_t player_largest(const struct player *p, int32_t period);

/* Begin a job at `clock`: the FIFO is empty, the rate 0, reports are cleared. Counts stay. */
enum player_status player_begin(struct player *p, const struct player_job *job, int64_t clock);

/* Append a frame to the FIFO at the player's clock. */
enum player_status player_push(struct player *p, const struct frame *frame);

/* No more frames come: the job ends when those in the FIFO have been played. */
void player_whole(struct player *p);

/* Bring the rate to 0 or to 1 by a ramp. */
void player_set_target(struct player *p, int32_t target);

/* Drop the frames in the FIFO and the rest of the frame in progress; the rate becomes 0. At rest
 * this ends a job; in motion it stops all pulses at once. A pulse that is high keeps its width. */
void player_clear(struct player *p);

/* Next clock at which a period ends or the rate changes; INT64_MAX: never. */
int64_t player_next(const struct player *p);

/* Let time pass up to and including a clock. */
void player_advance(struct player *p, int64_t clock);

/* Return the reports and clear them. To get each at its clock, advance from player_next to
 * player_next. */
struct player_told player_take(struct player *p);

/* Whether nothing moves: the rate is 0 or no period is in progress. */
bool player_at_rest(const struct player *p);

/* The following are for clocks from that of the player up to player_next, that one excluded. */

/* Pulses of each axis since power on up to `clock`, forward minus backward. A pulse counts from the
 * clock on at which its line becomes high. */
void player_counts(const struct player *p, int64_t clock, int64_t counts[FRAME_AXES]);

/* Levels of an axis' lines at `clock`: a is the pulse, b the direction, high is backward. */
struct lines player_lines(const struct player *p, int axis, int64_t clock);

/* Clock of an axis' first pulse behind `after`; INT64_MAX if there is none up to player_next. */
int64_t player_edge(const struct player *p, int axis, int64_t after);

/* The rate, 0 .. 1; the speed of an axis at this rate in the frame in progress [pulses/s]. */
double player_rate(const struct player *p);
double player_velocity(const struct player *p, int axis);

#endif
