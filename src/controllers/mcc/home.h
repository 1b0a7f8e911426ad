/* home - search of an axis' origin, in the phases of the source document.
 *
 *     1 search   at high speed in the direction of bit 0, until the home sensor is ON
 *     2 leave    at low speed in the direction of bit 1, until it is OFF
 *     3 index    at low speed in the direction of bit 2, until the index latches the encoder
 *       go       to the latched place plus the offset: this is the origin
 *
 * The axis comes to rest between the phases. An axis that stands on its sensor begins with phase 2.
 * If the search meets a limit switch first it turns, passes the sensor, and searches once more, so
 * that the sensor is always met from the same side. The limit switch itself can be the sensor.
 * There may be no index, then the edge of phase 2 is the place, or no sensor, then only phase 3 is
 * run.
 */
#ifndef HOME_H
#define HOME_H

#include <stdbool.h>
#include <stdint.h>

enum home_mode {
    HOME_SENSOR_INDEX,
    HOME_SENSOR,
    HOME_INDEX,
    HOME_LIMIT_INDEX, /* the limit switch of direction bit 0 is the sensor */
    HOME_LIMIT
};

struct home_config {
    enum home_mode mode;
    uint32_t direction; /* home_dir: bits 0, 1, 2 of phase 1, 2, 3; 0 positive, 1 negative */
    bool sensor_on;     /* logic state of the home sensor when ON */
    double high_speed;  /* [mm/s] > 0 */
    double low_speed;   /* [mm/s] > 0 */
    double offset;      /* [mm] from the place found to the origin */
    double search;      /* [mm] > 0 longest way of phase 1, and of phase 2 */
    double index_way;   /* [mm] > 0 longest way of phase 3: beyond one index distance */
};

enum home_phase {
    HOME_IDLE,
    HOME_SEARCH,
    HOME_TURN,
    HOME_LEAVE,
    HOME_LATCH,
    HOME_GO,
    HOME_DONE,
    HOME_FAILED
};

enum home_fault {
    HOME_OK,
    HOME_NO_SENSOR, /* phase 1 found none within `search`, or between both limits */
    HOME_STUCK,     /* phase 2 did not leave the sensor, or meet it again, in `search` */
    HOME_NO_INDEX,  /* phase 3 met none within `index_way` */
    HOME_ON_LIMIT   /* phase 2, 3 or the last way ran onto a limit switch */
};

/* What the axis shows. */
struct home_inputs {
    bool sensor;       /* logic state of the home sensor */
    bool upper, lower; /* limit switches, true when run onto */
    bool rest;         /* the axis has come to rest */
    double position;   /* [mm] commanded */
    bool latched;      /* the latch armed last has its index */
    double latch;      /* [mm] where */
};

/* What the axis shall do until the next call. */
struct home_order {
    enum { HOME_STAND, HOME_RUN, HOME_MOVE } what;
    double speed;  /* [mm/s] run: signed; move: largest */
    double target; /* [mm] move */
    bool arm;      /* arm the latch for the next index, once */
};

struct home {
    enum home_phase phase;
    enum home_fault fault;
    bool stopping; /* found; the axis comes to rest before the next phase */
    bool turned;   /* met a limit in phase 1 */
    bool passed;   /* was on the sensor since the phase began, in turn and leave */
    bool armed;
    double begin; /* [mm] where the phase began */
    double place; /* [mm] what was found */
};

/* True if every value lies in its range and is finite. */
bool home_valid(const struct home_config *c);

/* Begin. */
void home_start(struct home *h, const struct home_config *c, const struct home_inputs *in);

/* One cycle. In HOME_DONE and HOME_FAILED the order is to stand; done, `place` is the origin in the
 * coordinates the search was made in. */
struct home_order home_step(struct home *h, const struct home_config *c,
                            const struct home_inputs *in);

#endif
