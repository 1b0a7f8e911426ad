#include "ethernet.h"

#include <string.h>

void ethernet_start(struct ethernet *e, const struct ethernet_config *c)
{
    memset(e, 0, sizeof *e);
    e->config = *c;
    e->wanted = e->instant = -1;
    for (int i = 0; i < ETHERNET_ENDS; i++)
        ether_pipe_start(&e->pipe[i], 2 * c->seed + (uint64_t)i + 1);
}

static void disconnect(struct ethernet *e, int64_t now)
{
    e->connection = 0;
    e->wanted = -1;
    for (int i = 0; i < ETHERNET_ENDS; i++) {
        ether_pipe_clear(&e->pipe[i], now);
        e->shown[i].rx_count = e->shown[i].tx_taken = 0;
    }
}

static void cut(struct ethernet *e, int64_t now)
{
    e->cuts++;
    e->blocked = now + e->config.away;
    disconnect(e, now);
}

/* Whether a cut is due: its time has come since the latest instant, or an end has received its
 * number of bytes. The latter comes an instant later, so that the end has seen the last byte. */
static bool cut_is_due(const struct ethernet *e, int64_t now)
{
    const struct ethernet_config *c = &e->config;
    for (int k = 0; k < ETHERNET_CUTS; k++) {
        if (c->cut_at[k] > e->instant && c->cut_at[k] <= now && c->cut_at[k] > 0)
            return true;
        for (int i = 0; i < ETHERNET_ENDS && e->connection; i++) {
            if (e->pipe[i].passed == c->cut_behind[i][k] && e->shown[i].rx_count > 0)
                return true;
        }
    }
    return false;
}

/* Number of bytes that may still go to this end before a cut. */
static size_t before_cut(const struct ethernet *e, int end)
{
    int64_t most = BYTE_RING_BYTES;
    for (int k = 0; k < ETHERNET_CUTS; k++) {
        const int64_t left = e->config.cut_behind[end][k] - e->pipe[end].passed;
        most = left > 0 && left < most ? left : most;
    }
    return (size_t)most;
}

/* Take bytes from an end into the pipe to the other one, as many as there is room for. */
static void take(struct ethernet *e, int end, const struct ethernet_seen *seen)
{
    struct ethernet_shown *shown = &e->shown[end];
    struct ether_pipe *pipe = &e->pipe[1 - end];
    uint8_t bytes[BYTE_RING_BYTES];
    const size_t n = byte_ring_look(seen->tx_words, seen->tx_count, shown->tx_taken, bytes,
                                    ether_pipe_room(pipe));
    ether_pipe_put(pipe, bytes, n);
    shown->tx_taken = byte_ring_on(shown->tx_taken, n);
}

static void give(struct ethernet *e, int end, const struct ethernet_seen *seen, int64_t now)
{
    struct ethernet_shown *shown = &e->shown[end];
    uint8_t bytes[BYTE_RING_BYTES];
    const size_t room = BYTE_RING_BYTES - (size_t)byte_ring_held(shown->rx_count, seen->rx_taken);
    const size_t most = before_cut(e, end);
    const size_t n = ether_pipe_get(&e->pipe[end], now, bytes, room < most ? room : most);
    byte_ring_put(shown->rx_words, &shown->rx_count, seen->rx_taken, bytes, n);
}

static void carry(struct ethernet *e, int64_t now, int64_t next,
                  const struct ethernet_seen seen[ETHERNET_ENDS])
{
    for (int i = 0; i < ETHERNET_ENDS; i++)
        take(e, i, &seen[i]);
    for (int i = 0; i < ETHERNET_ENDS; i++) {
        ether_pipe_send(&e->pipe[i], &e->config.pipe, now, next);
        give(e, i, &seen[i], now);
    }
}

static bool counts_hold(const struct ethernet *e, const struct ethernet_seen *seen)
{
    for (int i = 0; i < ETHERNET_ENDS; i++) {
        if (byte_ring_held(seen[i].tx_count, e->shown[i].tx_taken) < 0
            || byte_ring_held(e->shown[i].rx_count, seen[i].rx_taken) < 0)
            return false;
    }
    return true;
}

/* Whether both ends want a connection and have reset their counts after the one before. */
static bool both_ready(const struct ethernet_seen seen[ETHERNET_ENDS])
{
    bool ready = true;
    for (int i = 0; i < ETHERNET_ENDS; i++)
        ready = ready && seen[i].wants && seen[i].tx_count == 0 && seen[i].rx_taken == 0;
    return ready;
}

static void call(struct ethernet *e, int64_t now, const struct ethernet_seen seen[ETHERNET_ENDS])
{
    if (!both_ready(seen) || now < e->blocked || e->connections == INT32_MAX) {
        e->wanted = -1;
        return;
    }
    e->wanted = e->wanted < 0 ? now : e->wanted;
    if (now - e->wanted < e->config.connect)
        return;
    e->connection = ++e->connections;
}

void ethernet_instant(struct ethernet *e, int64_t now, int64_t next,
                      const struct ethernet_seen seen[ETHERNET_ENDS])
{
    if (cut_is_due(e, now)) {
        cut(e, now);
    } else if (!e->connection) {
        call(e, now, seen);
    } else if (!seen[ETHERNET_CARD].wants || !seen[ETHERNET_HOST].wants) {
        disconnect(e, now);
    } else if (!counts_hold(e, seen)) {
        e->faults++;
        disconnect(e, now);
    } else {
        carry(e, now, next, seen);
    }
    e->instant = now;
}
