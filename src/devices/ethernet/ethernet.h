/* ethernet - the network between a card and its host: a TCP connection of two byte streams, which
 * is established when both ends want it and is cut at given times or after given numbers of bytes.
 *
 * Each end shows words and counts of byte_ring.h, all 0 while there is no connection. A cut drops
 * the bytes on their way; the next connection can come once both ends show counts of 0 again.
 */
#ifndef ETHERNET_H
#define ETHERNET_H

#include "byte_ring.h"
#include "ether_pipe.h"

enum { ETHERNET_CUTS = 8, ETHERNET_ENDS = 2 };
enum ethernet_end { ETHERNET_CARD, ETHERNET_HOST };

struct ethernet_config {
    struct ether_config pipe;
    uint64_t seed;                                    /* of jitter and losses */
    int64_t connect;                                  /* [ns] time to establish a connection */
    int64_t away;                                     /* [ns] time after a cut without one */
    int64_t cut_at[ETHERNET_CUTS];                    /* [ns] times of cuts; 0: none */
    int64_t cut_behind[ETHERNET_ENDS][ETHERNET_CUTS]; /* [byte] received by this end until a cut,
                                                       * over all connections; 0: none */
};

/* What an end shows to the network. */
struct ethernet_seen {
    int32_t tx_words[BYTE_RING_WORDS]; /* ring of the bytes that it sends */
    int32_t tx_count, rx_taken;        /* counts of bytes put in there; taken from the network */
    bool wants;                        /* it wants a connection */
};

/* What the network shows to an end. */
struct ethernet_shown {
    int32_t rx_words[BYTE_RING_WORDS]; /* ring of the bytes that it receives */
    int32_t rx_count, tx_taken;        /* counts of bytes put in there; taken from the end */
};

struct ethernet {
    struct ethernet_config config;
    int32_t connection;                    /* number of the connection; 0 none */
    int32_t connections;                   /* number of connections so far */
    int64_t wanted;                        /* [ns] time since which both ends want one; -1 */
    int64_t blocked;                       /* [ns] time until which none comes after a cut */
    int64_t instant;                       /* [ns] latest instant; -1 before the first */
    uint32_t cuts, faults;                 /* faults: an end showed counts that contradict */
    struct ether_pipe pipe[ETHERNET_ENDS]; /* the pipe to each end */
    struct ethernet_shown shown[ETHERNET_ENDS];
};

/* Start without a connection. */
void ethernet_start(struct ethernet *e, const struct ethernet_config *c);

/* At the instant `now` [ns]: read both ends, connect, disconnect or cut, and carry bytes. The next
 * instant is at `next` [ns]. */
void ethernet_instant(struct ethernet *e, int64_t now, int64_t next,
                      const struct ethernet_seen seen[ETHERNET_ENDS]);

#endif
