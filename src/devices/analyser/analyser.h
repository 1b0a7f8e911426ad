/* Logic analyser: makes edges at random phases and measures when they are answered.
 *
 *     input     ______|````````````````````````|_________      edge, made known before its clock
 *     response  ______________|```````````````````````|__      the same level, seen afterwards
 *                     <------->   <- pause ->  <------>
 *                     reaction                 reaction
 *
 * Wires are read at instants k * period. At an instant the analyser says which edges come behind
 * the next instant and not behind the one after it: a reader of that next instant knows them all.
 */
#ifndef ANALYSER_H
#define ANALYSER_H

#include <stdbool.h>
#include <stdint.h>

enum { ANALYSER_CHANNELS = 32 };

struct analyser_config {
    uint32_t enabled; /* channels, a bit each */
    int32_t seed;
    int64_t period;                     /* [clocks] of the wires */
    int64_t least[ANALYSER_CHANNELS];   /* [clocks] pause, uniform: least */
    int64_t most[ANALYSER_CHANNELS];    /* and most */
    int64_t timeout[ANALYSER_CHANNELS]; /* [clocks] after which an edge counts as unanswered */
};

struct analyser_channel {
    uint64_t random;
    int64_t edge; /* [clock] that is to come, or waits for its answer */
    bool waits;   /* it has been made known */
    bool level;
    int64_t shown; /* [clock] of the latest edge made known */
    int32_t edges, responses, timeouts;
    int32_t strays;              /* changes of the response that answer no edge */
    int64_t latest, least, most; /* [clocks] reactions */
    int64_t sum;                 /* [clocks] of all of them */
};

struct analyser {
    struct analyser_config config;
    struct analyser_channel channel[ANALYSER_CHANNELS];
    uint32_t levels;   /* of all channels, as made known */
    uint32_t response; /* as read last */
};

/* An edge that has been answered or not. */
struct analyser_event {
    int32_t channel;
    int64_t edge;     /* [clock] */
    int64_t response; /* [clock], -1 none */
};

/* All levels low; first edges one pause behind the first instant on which they can be known. Each
 * channel has a random sequence of its own. */
void analyser_reset(struct analyser *a, const struct analyser_config *config);

/* Read the responses, their levels and the clocks of their latest changes, at an instant. Returns
 * how many edges were done with: their events, at most one a channel. An answer is a response at
 * the edge's level whose change is not before the edge. */
int32_t analyser_instant(struct analyser *a, int64_t instant, uint32_t response,
                         const double clock[ANALYSER_CHANNELS],
                         struct analyser_event event[ANALYSER_CHANNELS]);

#endif
