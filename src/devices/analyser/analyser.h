/* analyser - logic analyser with stimulus, 32 channels: it makes an edge at a random phase on each
 * input of a device under test and measures the reaction time of the response of the same number.
 *
 *     input     ______|````````````````````````|_________      edge, published before its clock
 *     response  ______________|```````````````````````|__      the same level, read afterwards
 *                     <------->   <- pause ->  <------>
 *                     reaction                 reaction
 *
 * Wires are read and written at instants k * period. At each instant the analyser publishes the
 * edges that come after the next instant and not after the one behind it, so that a device that
 * reads at the next instant knows all edges of the period that follows.
 */
#ifndef ANALYSER_H
#define ANALYSER_H

#include <stdbool.h>
#include <stdint.h>

enum { ANALYSER_CHANNELS = 32 };

struct analyser_config {
    uint32_t enabled;                   /* channels in use, a bit each */
    int32_t seed;                       /* of the random numbers */
    int64_t period;                     /* [clocks] between two instants */
    int64_t least[ANALYSER_CHANNELS];   /* [clocks] the pause before an edge is uniform in */
    int64_t most[ANALYSER_CHANNELS];    /* [clocks] least .. most */
    int64_t timeout[ANALYSER_CHANNELS]; /* [clocks] after which an edge counts as unanswered */
};

struct analyser_channel {
    uint64_t random;                    /* state of the channel's random sequence */
    int64_t edge;                       /* [clock] of the next edge, or of the one that `waits` */
    bool waits;                         /* the edge is published and not answered yet */
    bool level;                         /* level of the input after the latest published edge */
    int64_t shown;                      /* [clock] of the latest published edge */
    int32_t edges, responses, timeouts; /* number of edges published, answered, not answered */
    int32_t strays;                     /* number of changes of the response that answer no edge */
    int64_t latest, least, most;        /* [clocks] reaction times */
    int64_t sum;                        /* [clocks] sum of all reaction times */
};

struct analyser {
    struct analyser_config config;
    struct analyser_channel channel[ANALYSER_CHANNELS];
    uint32_t levels;   /* published levels of all inputs, a bit each */
    uint32_t response; /* levels of the responses as read last, a bit each */
};

/* An edge whose response has come or whose timeout is over. */
struct analyser_event {
    int32_t channel;
    int64_t edge;     /* [clock] */
    int64_t response; /* [clock], -1 none */
};

/* Set all levels low and schedule the first edges, one pause after `period`. Each channel has a
 * random sequence of its own. */
void analyser_reset(struct analyser *a, const struct analyser_config *config);

/* At an instant: take the levels of the responses and the clocks of their latest changes, publish
 * new edges. Returns the number of edges that were answered or timed out, at most one per channel,
 * and their events. An answer is a response that has the edge's level and changed at or after the
 * edge. */
int32_t analyser_instant(struct analyser *a, int64_t instant, uint32_t response,
                         const double clock[ANALYSER_CHANNELS],
                         struct analyser_event event[ANALYSER_CHANNELS]);

#endif
