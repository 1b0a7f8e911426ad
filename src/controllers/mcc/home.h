/* home - the state machine that searches the origin of one axis, in the three phases of the EPCIO
 * card's document. Each cycle it sees switches and position and says how the axis shall move.
 *
 *     1 search   at high speed in the direction of bit 0, until the home sensor is ON
 *     2 leave    at low speed in the direction of bit 1, until the sensor is OFF
 *     3 index    at low speed in the direction of bit 2, until the index latches the encoder
 *       go       to the latched place plus the offset, which is the origin
 *
 * The axis comes to rest between the phases. An axis that stands on its sensor begins with phase 2.
 * If the search meets a limit switch first it turns, passes the sensor, and searches once more, so
 * that the sensor is always met from the same side. The limit switch itself can be the sensor.
 * Without an index the place is where phase 2 saw the sensor's edge; without a sensor only phase 3
 * is run.
 */
#ifndef HOME_H
#define HOME_H

#include <stdbool.h>
#include <stdint.h>

/* What marks the origin. */
enum home_mode {
    HOME_SENSOR_INDEX, /* the first index behind the edge of the home sensor */
    HOME_SENSOR,       /* the edge of the home sensor */
    HOME_INDEX,        /* the first index from where the axis stands */
    HOME_LIMIT_INDEX,  /* as HOME_SENSOR_INDEX, by the limit switch in the direction of bit 0 */
    HOME_LIMIT         /* the edge of that limit switch */
};

struct home_config {
    enum home_mode mode;
    uint32_t direction; /* home_dir: bits 0, 1, 2 for phase 1, 2, 3; 0 positive, 1 negative */
    bool sensor_on;     /* logic state of the home sensor when ON */
    double high_speed;  /* [mm/s] > 0 */
    double low_speed;   /* [mm/s] > 0 */
    double offset;      /* [mm] from the place found to the origin */
    double search;      /* [mm] > 0 longest travel in phase 1, and in phase 2 */
    double index_way;   /* [mm] > 0 longest travel in phase 3; more than from index to index */
};

enum home_phase {
    HOME_IDLE,   /* not begun */
    HOME_SEARCH, /* phase 1 */
    HOME_TURN,   /* back from the limit switch over the sensor, to search once more */
    HOME_LEAVE,  /* phase 2 */
    HOME_LATCH,  /* phase 3 */
    HOME_GO,     /* to the origin */
    HOME_DONE,   /* at the origin */
    HOME_FAILED  /* `fault` says why */
};

enum home_fault {
    HOME_OK,
    HOME_NO_SENSOR, /* phase 1 found no sensor within `search`, or between both limit switches */
    HOME_STUCK,     /* phase 2 did not come off the sensor within `search` */
    HOME_NO_INDEX,  /* phase 3 met no index within `index_way` */
    HOME_ON_LIMIT   /* phase 2, phase 3 or the last travel ran onto a limit switch */
};

/* What the search sees of the axis in a cycle. */
struct home_inputs {
    bool sensor;       /* logic state of the home sensor */
    bool upper, lower; /* limit switches; true: the axis is on the switch */
    bool rest;         /* the axis has come to rest */
    double position;   /* [mm] where the axis is */
    bool latched;      /* the index has come since the latch was armed */
    double latch;      /* [mm] position at that index */
};

/* What the axis shall do until the next call. */
struct home_order {
    enum { HOME_STAND, HOME_RUN, HOME_MOVE } what;
    double speed;  /* [mm/s] HOME_RUN: signed; HOME_MOVE: the highest */
    double target; /* [mm] of HOME_MOVE */
    bool arm;      /* arm the latch for the next index, once */
};

struct home {
    enum home_phase phase;
    enum home_fault fault;
    bool stopping; /* the phase has found its edge; the axis comes to rest before the next */
    bool turned;   /* phase 1 has met a limit switch */
    bool passed;   /* HOME_TURN, HOME_LEAVE: the axis was on the sensor since the phase began */
    bool armed;    /* HOME_LATCH: the latch has been armed */
    double begin;  /* [mm] position at which the phase began */
    double place;  /* [mm] of the edge or index found; from HOME_GO on, the origin */
};

/* True if every value lies in its range and is finite. */
bool home_valid(const struct home_config *c);

/* Begin a search: with phase 1, with phase 2 on the sensor, with phase 3 without a sensor. */
void home_start(struct home *h, const struct home_config *c, const struct home_inputs *in);

/* One cycle of the search. In HOME_DONE and HOME_FAILED the order is to stand. In HOME_DONE `place`
 * is the origin, in the coordinates of in->position. */
struct home_order home_step(struct home *h, const struct home_config *c,
                            const struct home_inputs *in);

#endif
