/* home_cycle - search of the axes' origins, a frame for each DDA period.
 *
 * Axes go in the order of their numbers, those of one number together. Each axis
 *
 *     1 search   fast towards the switch, until its origin shows
 *       turn     met a limit switch first: back over the switch, then search once more
 *     2 back     fast off the switch, and `back` pulses further
 *     3 edge     slowly towards the switch: the place at which the origin shows
 *     4 offset   to that place plus the offset: there the position is 0
 *
 * and rests between the phases until it has not been moved for `settle` periods. An axis that
 * stands on its switch begins with phase 2. Ramps are trapezoids within speed and acceleration.
 *
 * Trigger: of an edge the hardware keeps the count at its clock (`latched`, `latch`); a level is
 * seen by the program, once each period. Rising edge and high level: the switch is on when its
 * level is high; the others: when it is low. */
#ifndef HOME_CYCLE_H
#define HOME_CYCLE_H

#include <stdbool.h>
#include <stdint.h>

#include "card_settings.h"
#include "frame_fifo.h"
#include "home_motion.h"

struct home_axis {
    int32_t order; /* 1 .. 4; 0: the axis is not homed */
    enum card_trigger trigger;
    bool plus;         /* it looks for its origin upwards */
    double fast, slow; /* [pulses/s] > 0 */
    double acc;        /* [pulses/s^2] > 0 */
    double start;      /* [pulses/s] at which it may start and stop at once, 0 or more */
    int32_t back;      /* [pulses] > 0 */
    int32_t travel;    /* [pulses] > 0 longest way of any phase */
    int32_t offset;    /* [pulses] */
};

struct home_cycle_config {
    double period;  /* [s] DDA period > 0 */
    int32_t settle; /* [periods] of rest between phases, 1 or more */
    struct home_axis axis[CARD_AXES];
};

enum home_cycle_phase {
    HOME_CYCLE_NONE,
    HOME_CYCLE_SEARCH,
    HOME_CYCLE_TURN,
    HOME_CYCLE_BACK,
    HOME_CYCLE_EDGE,
    HOME_CYCLE_OFFSET,
    HOME_CYCLE_DONE
};

/* Why it failed. */
enum home_cycle_fault {
    HOME_CYCLE_OK,
    HOME_CYCLE_NO_ORIGIN, /* none within the travel or between the limit switches */
    HOME_CYCLE_STUCK,     /* the switch stays on */
    HOME_CYCLE_LIMIT      /* a limit switch stood in the way of phase 2, 3 or 4 */
};

enum home_cycle_state {
    HOME_CYCLE_IDLE,
    HOME_CYCLE_RUNNING,
    HOME_CYCLE_STOPPING,
    HOME_CYCLE_ENDED,
    HOME_CYCLE_STOPPED,
    HOME_CYCLE_FAILED
};

/* What the search sees of the axes, once each period. */
struct home_cycle_input {
    int64_t position[CARD_AXES]; /* [pulses] put out so far, any zero */
    uint32_t origin;             /* levels of the switches, a bit each axis */
    uint32_t plus, minus;        /* limit switches that are met */
    uint32_t latched;            /* an edge of the trigger's kind came since the last call, */
    int64_t latch[CARD_AXES];    /* [pulses] the position at its clock, the latest */
};

struct home_search {
    enum home_cycle_phase phase;
    bool stopping;       /* found; it comes to rest */
    bool turned, passed; /* met a limit in the search; was on the switch in this phase */
    bool off;            /* phase 2: has left the switch, goes on; 3: was seen off it */
    int64_t begin;       /* [pulses] commanded, where the phase began */
    int64_t place;       /* [pulses] what was found, or the target */
    struct home_motion motion;
};

struct home_cycle {
    struct home_cycle_config config;
    enum home_cycle_state state;
    enum home_cycle_fault fault;
    int32_t fault_axis; /* -1 none */
    uint32_t mask;      /* axes to be homed */
    int32_t order;      /* of those that go now */
    struct home_search axis[CARD_AXES];
};

/* Whether every value lies in its range and is finite. */
bool home_cycle_valid(const struct home_cycle_config *c);

/* Begin with the axes of a mask that have an order; the others stand. */
void home_cycle_begin(struct home_cycle *h, const struct home_cycle_config *config, uint32_t mask,
                      const struct home_cycle_input *in);

/* One period: the frame to play next. It stands when the state is neither RUNNING nor STOPPING. */
struct frame home_cycle_step(struct home_cycle *h, const struct home_cycle_input *in);

/* Come to rest: STOPPING, then STOPPED. */
void home_cycle_stop(struct home_cycle *h);

/* ENDED: count of an axis that is position 0 from now on [pulses]. */
int64_t home_cycle_zero(const struct home_cycle *h, int axis);

/* Level of a switch that is on; an edge to that level sets `latched`. */
bool home_cycle_on_level(enum card_trigger trigger);

#endif
