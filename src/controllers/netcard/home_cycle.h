/* home_cycle - homing of the network card: the search of all axes' origins, which gives a frame for
 * each DDA period.
 *
 * Axes are homed in the order of their numbers, those of one number together. Each axis goes
 *
 *     1 search   fast towards the origin switch, until the switch triggers
 *       turn     if a limit switch comes first: back over the origin switch, then search again
 *     2 back     fast off the origin switch, and `back` pulses further
 *     3 edge     slowly towards the origin switch, to the place at which it triggers
 *     4 offset   to that place plus the offset, where the position is 0
 *
 * and rests between the phases until it has not been moved for `settle` periods. An axis that
 * stands on its switch begins with phase 2. Speed profiles are trapezoids.
 *
 * The trigger is an edge, at whose clock the hardware latches the count (`latched`, `latch`), or a
 * level, which the program sees once each period. With rising edge and high level the switch is on
 * when its level is high, with the others when it is low. */
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
    bool plus;         /* the axis looks for its origin in positive direction */
    double fast, slow; /* [pulses/s] > 0, speeds of phases 1, 2 and of phase 3 */
    double acc;        /* [pulses/s^2] > 0 */
    double start;      /* [pulses/s] speed at which it may start and stop at once, 0 or more */
    int32_t back;      /* [pulses] > 0 travel off the switch in phase 2 */
    int32_t travel;    /* [pulses] > 0 longest travel of any phase */
    int32_t offset;    /* [pulses] from the place found to position 0 */
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

/* Why homing has failed. */
enum home_cycle_fault {
    HOME_CYCLE_OK,
    HOME_CYCLE_NO_ORIGIN, /* no origin within the travel or between the limit switches */
    HOME_CYCLE_STUCK,     /* the origin switch stays on */
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
    int64_t position[CARD_AXES]; /* [pulses] put out so far, from any zero */
    uint32_t origin;             /* levels of the origin switches, a bit each axis, as all here */
    uint32_t plus, minus;        /* limit switches on which an axis is */
    uint32_t latched;            /* an edge of the trigger's kind came since the last call, */
    int64_t latch[CARD_AXES];    /* [pulses] and the position at the clock of the latest one */
};

/* The search of one axis. */
struct home_search {
    enum home_cycle_phase phase;
    bool stopping;       /* the phase has found its place; the axis comes to rest */
    bool turned, passed; /* phase 1 met a limit switch; this phase was on the origin switch */
    bool off;            /* phase 2: off the switch, going on; phase 3: was seen off the switch */
    int64_t begin;       /* [pulses] commanded position at which the phase began */
    int64_t place;       /* [pulses] of the trigger found, or target of the phase */
    struct home_motion motion;
};

struct home_cycle {
    struct home_cycle_config config;
    enum home_cycle_state state;
    enum home_cycle_fault fault;
    int32_t fault_axis; /* axis that failed; -1: none */
    uint32_t mask;      /* axes to be homed, a bit each */
    int32_t order;      /* number of those that are searching now */
    struct home_search axis[CARD_AXES];
};

/* Whether every value lies in its range and is finite. */
bool home_cycle_valid(const struct home_cycle_config *c);

/* Begin homing the axes of a mask that have an order; the others stand. */
void home_cycle_begin(struct home_cycle *h, const struct home_cycle_config *config, uint32_t mask,
                      const struct home_cycle_input *in);

/* One DDA period: returns the frame to be played next, which is one of standstill unless the state
 * is RUNNING or STOPPING. */
struct frame home_cycle_step(struct home_cycle *h, const struct home_cycle_input *in);

/* Let the axes come to rest: the state is STOPPING, then STOPPED. */
void home_cycle_stop(struct home_cycle *h);

/* In ENDED: the count of an axis at which its position is 0 from now on. [pulses] */
int64_t home_cycle_zero(const struct home_cycle *h, int axis);

/* Level of an origin switch that is on. An edge to that level sets `latched`. */
bool home_cycle_on_level(enum card_trigger trigger);

#endif
