/* net_alive - is the other end still there? A second without a byte from it asks for a PING; the
 * link is down a second behind the third that had no answer. */
#ifndef NET_ALIVE_H
#define NET_ALIVE_H

#include <stdint.h>

#define NET_PING_NS INT64_C(1000000000)
enum { NET_PINGS = 3 };

struct net_alive {
    int64_t due;   /* [ns] next deadline */
    int32_t pings; /* since it was heard */
};

enum net_alive_event { NET_QUIET, NET_ASK, NET_GONE };

void net_alive_heard(struct net_alive *a, int64_t now);

/* What is to be done at `now`; call again until it is NET_QUIET or NET_GONE. */
enum net_alive_event net_alive_tick(struct net_alive *a, int64_t now);

#endif
