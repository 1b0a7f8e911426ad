#include "remote_io.h"

#include <string.h>

enum remote_io_status remote_io_check_config(const struct remote_io_config *c)
{
    return c->time < 1 ? REMOTE_IO_BAD_TIME : REMOTE_IO_OK;
}

enum remote_io_status remote_io_check_control(const struct remote_io_control *set)
{
    if (set->enabled >> REMOTE_IO_SLAVES != 0)
        return REMOTE_IO_BAD_ENABLED;
    if (set->retry_limit < 0 || set->retry_limit > REMOTE_IO_RETRY_MAX)
        return REMOTE_IO_BAD_RETRY;
    for (int i = 0; i < REMOTE_IO_SLAVES; i++)
        for (int k = 0; k < REMOTE_IO_EDGES; k++)
            if (set->edge[i][k] != REMOTE_IO_RISE && set->edge[i][k] != REMOTE_IO_FALL
                && set->edge[i][k] != REMOTE_IO_BOTH)
                return REMOTE_IO_BAD_EDGE;
    return REMOTE_IO_OK;
}

const char *remote_io_status_text(enum remote_io_status status)
{
    switch (status) {
    case REMOTE_IO_OK:          return "ok";
    case REMOTE_IO_BAD_TIME:    return "a remote exchange takes one clock or more";
    case REMOTE_IO_BAD_ENABLED: return "a set has 3 remote slaves";
    case REMOTE_IO_BAD_RETRY:   return "the retry limit is 0 to 255";
    case REMOTE_IO_BAD_EDGE:    return "an edge is rising (0), falling (1) or both (2)";
    default:                    return "unknown status";
    }
}

/* Next slave of the scan above `after`, wrapping around to `after`; the scan must not be empty. */
static int next_slave(uint32_t scanned, int after)
{
    int i = after;
    do
        i = i + 1 < REMOTE_IO_SLAVES ? i + 1 : 0;
    while (!(scanned >> i & 1));
    return i;
}

/* Begin the exchange of the slave whose turn comes after `after`. */
static void begin(const struct remote_io_config *c, const struct remote_io_control *set,
                  const struct remote_io_lines *lines, struct remote_io *io, int after,
                  int64_t clock)
{
    io->busy = io->scanned != 0;
    if (!io->busy)
        return;
    io->slave = next_slave(io->scanned, after);
    io->heard = lines->connected >> io->slave & 1;
    io->due = clock + c->time;
    io->limit = set->retry_limit;
    memcpy(io->sampled, lines->in[io->slave], sizeof io->sampled);
    memcpy(io->sent, set->out[io->slave], sizeof io->sent);
}

void remote_io_update(const struct remote_io_config *c, const struct remote_io_control *set,
                      const struct remote_io_lines *lines, struct remote_io *io, int64_t clock)
{
    uint32_t scan = set->on ? set->enabled : 0, anew = scan & ~io->scanned;
    for (int i = 0; i < REMOTE_IO_SLAVES; i++)
        if (anew >> i & 1) {
            io->errors[i] = 0;
            io->in_a_row[i] = 0;
        }
    io->scanned = scan;
    io->ready &= scan & ~anew;
    io->answered &= scan & ~anew;
    io->told &= scan & ~anew;
    if (!io->busy)
        begin(c, set, lines, io, REMOTE_IO_SLAVES - 1, clock);
    else if (!(scan >> io->slave & 1))
        begin(c, set, lines, io, io->slave, clock);
}

int64_t remote_io_due(const struct remote_io *io)
{
    return io->busy ? io->due : INT64_MAX;
}

/* Inputs that fire when they change from `before` to `now`, bit k for input k. */
static uint32_t fired(const enum remote_io_edge edge[REMOTE_IO_EDGES], uint32_t before,
                      uint32_t now)
{
    uint32_t changed = (before ^ now) & ((1u << REMOTE_IO_EDGES) - 1), bits = 0;
    if (changed == 0)
        return 0;
    for (int k = 0; k < REMOTE_IO_EDGES; k++)
        if (edge[k] != (now >> k & 1 ? REMOTE_IO_FALL : REMOTE_IO_RISE))
            bits |= 1u << k;
    return changed & bits;
}

static uint32_t succeed(const struct remote_io_control *set, struct remote_io *io)
{
    int i = io->slave;
    uint32_t bit = 1u << i;
    uint32_t bits = io->answered & bit ? fired(set->edge[i], io->in[i][0], io->sampled[0]) : 0;
    memcpy(io->in[i], io->sampled, sizeof io->sampled);
    io->in_a_row[i] = 0;
    io->answered |= bit;
    io->ready |= bit;
    memcpy(io->received[i], io->sent, sizeof io->sent);
    io->received_limit[i] = io->limit;
    io->received_clock[i] = io->due;
    return bits << (REMOTE_IO_EVENT_DI + REMOTE_IO_EDGES * i);
}

static void count(int32_t *n)
{
    *n += *n < INT32_MAX;
}

static uint32_t fail(const struct remote_io_control *set, struct remote_io *io)
{
    int i = io->slave;
    uint32_t bit = 1u << i;
    count(&io->errors[i]);
    count(&io->in_a_row[i]);
    if (io->in_a_row[i] <= set->retry_limit)
        return 0;
    if (io->ready & bit) {
        io->ready &= ~bit;
        return 1u << REMOTE_IO_EVENT_FAIL;
    }
    if ((io->answered | io->told) & bit)
        return 0;
    io->told |= bit;
    return 1u << REMOTE_IO_EVENT_NOT_READY;
}

uint32_t remote_io_finish(const struct remote_io_config *c, const struct remote_io_control *set,
                          const struct remote_io_lines *lines, struct remote_io *io)
{
    if (!io->busy)
        return 0;
    io->exchanges = io->exchanges == INT32_MAX ? 0 : io->exchanges + 1;
    uint32_t events = io->heard ? succeed(set, io) : fail(set, io);
    begin(c, set, lines, io, io->slave, io->due);
    return events;
}

void remote_io_outputs(const struct remote_io_config *c, const struct remote_io *io, int64_t clock,
                       int slave, uint16_t port[REMOTE_IO_PORTS])
{
    int64_t hold = ((int64_t)io->received_limit[slave] + 1) * REMOTE_IO_SLAVES * c->time;
    bool holds = clock - io->received_clock[slave] < hold;
    for (int i = 0; i < REMOTE_IO_PORTS; i++)
        port[i] = holds ? io->received[slave][i] : 0;
}
