#include "net_alive.h"

void net_alive_heard(struct net_alive *a, int64_t now)
{
    a->due = now + NET_PING_NS;
    a->pings = 0;
}

enum net_alive_event net_alive_tick(struct net_alive *a, int64_t now)
{
    if (now < a->due)
        return NET_QUIET;
    if (a->pings >= NET_PINGS)
        return NET_GONE;
    a->pings++;
    a->due += NET_PING_NS;
    return NET_ASK;
}
