/* net_alive - watches whether the other end of a link is still there: after a second without a byte
 * from it a PING is due; a second after the third PING without an answer the link is down. */
#ifndef NET_ALIVE_H
#define NET_ALIVE_H

#include <stdint.h>

#define NET_PING_NS INT64_C(1000000000)
enum { NET_PINGS = 3 };

struct net_alive {
    int64_t due;   /* [ns] time of the next PING, or of giving up */
    int32_t pings; /* number of PINGs since the latest byte */
};

/* Nothing to do; send a PING; the link is down. */
enum net_alive_event { NET_QUIET, NET_ASK, NET_GONE };

/* A byte has come from the other end at `now` [ns]. */
void net_alive_heard(struct net_alive *a, int64_t now);

/* What is to be done at `now` [ns]; call again until it is NET_QUIET or NET_GONE. */
enum net_alive_event net_alive_tick(struct net_alive *a, int64_t now);

#endif
