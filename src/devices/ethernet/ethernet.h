/* ethernet - the link between a card and its host: a connection of two streams that comes about
 * when both want it, and is cut at times or behind bytes.
 *
 * Each end shows words and counts as byte_ring.h has it, all 0 while there is no connection. A cut
 * takes what is on its way; the next connection comes once both ends show counts of 0 again.
 */
#ifndef ETHERNET_H
#define ETHERNET_H

#include "byte_ring.h"
#include "ether_pipe.h"

enum { ETHERNET_CUTS = 8, ETHERNET_ENDS = 2 };
enum ethernet_end { ETHERNET_CARD, ETHERNET_HOST };

struct ethernet_config {
    struct ether_config pipe;
    uint64_t seed;
    int64_t connect;                                  /* [ns] for a connection to come about */
    int64_t away;                                     /* [ns] none comes about after a cut */
    int64_t cut_at[ETHERNET_CUTS];                    /* [ns] 0: none */
    int64_t cut_behind[ETHERNET_ENDS][ETHERNET_CUTS]; /* [byte] that this end got; 0: none */
};

/* What an end shows. */
struct ethernet_seen {
    int32_t tx_words[BYTE_RING_WORDS];
    int32_t tx_count, rx_taken;
    bool wants; /* a connection */
};

/* What it is shown. */
struct ethernet_shown {
    int32_t rx_words[BYTE_RING_WORDS];
    int32_t rx_count, tx_taken;
};

struct ethernet {
    struct ethernet_config config;
    int32_t connection; /* number; 0 none */
    int32_t connections;
    int64_t wanted;                        /* [ns] since when both ends want one; -1 not */
    int64_t blocked;                       /* [ns] end of the latest cut */
    int64_t instant;                       /* [ns] latest one; -1 before the first */
    uint32_t cuts, faults;                 /* faults: an end showed counts that cannot be */
    struct ether_pipe pipe[ETHERNET_ENDS]; /* to this end */
    struct ethernet_shown shown[ETHERNET_ENDS];
};

void ethernet_start(struct ethernet *e, const struct ethernet_config *c);

/* An instant at which both ends are read; the next one is at `next` [ns]. */
void ethernet_instant(struct ethernet *e, int64_t now, int64_t next,
                      const struct ethernet_seen seen[ETHERNET_ENDS]);

#endif
