/* card_cable - for the tests: a network card and the server's end on one cable, which carries a
 * limited number of bytes in each step of time. */
#ifndef CARD_CABLE_H
#define CARD_CABLE_H

#include "card_bench.h"
#include "net_host.h"

static struct netcard c;
static struct net_host host;
static bool linked;
static struct {
    uint8_t byte[4096];
    size_t count;
} waiting; /* bytes that the card has not taken yet */

/* Connect or disconnect, depending on both ends and on whether the cable is plugged in. */
static inline void cable_plug(bool wants)
{
    if (wants == linked) {
        return;
    }
    linked = wants;
    waiting.count = 0;
    netcard_connected(&c, linked);
    if (linked) {
        net_host_connected(&host, c.now);
    } else {
        net_host_cut(&host);
    }
}

/* Carry bytes to the server and let it send what is due of its job. */
static inline void cable_up(const uint8_t *job, size_t line)
{
    static uint8_t bytes[4096];

    net_host_bytes(&host, bytes, netcard_send(&c, bytes, line), c.now);
    net_host_tick(&host, job, c.now);
}

/* Carry bytes to the card. Returns the number that it has taken. */
static inline size_t cable_down(size_t line)
{
    const size_t left = sizeof waiting.byte - waiting.count;

    waiting.count += net_host_out(&host, waiting.byte + waiting.count, left < line ? left : line);
    const size_t taken = netcard_receive(&c, waiting.byte, waiting.count);
    memmove(waiting.byte, waiting.byte + taken, waiting.count - taken);
    waiting.count -= taken;
    return taken;
}

#endif
