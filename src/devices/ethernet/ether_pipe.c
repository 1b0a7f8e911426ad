#include "ether_pipe.h"

#include <string.h>

/* A random number, uniform in 0 .. most (xorshift64). */
static int64_t draw(uint64_t *random, int64_t most)
{
    *random ^= *random << 13;
    *random ^= *random >> 7;
    *random ^= *random << 17;
    return (int64_t)(*random % ((uint64_t)most + 1));
}

void ether_pipe_start(struct ether_pipe *p, uint64_t seed)
{
    memset(p, 0, sizeof *p);
    p->random = seed * UINT64_C(0x9E3779B97F4A7C15) | 1;
}

void ether_pipe_clear(struct ether_pipe *p, int64_t now)
{
    p->free = now;
    p->first = p->held = p->sent = p->first_segment = p->segments = 0;
}

size_t ether_pipe_room(const struct ether_pipe *p)
{
    return (size_t)(ETHER_BUFFER - p->held);
}

void ether_pipe_put(struct ether_pipe *p, const uint8_t *bytes, size_t n)
{
    for (size_t i = 0; i < n; i++)
        p->byte[((size_t)p->first + (size_t)p->held + i) % ETHER_BUFFER] = bytes[i];
    p->held += (int32_t)n;
}

void ether_pipe_send(struct ether_pipe *p, const struct ether_config *c, int64_t now, int64_t next)
{
    enum { MILLION = 1000000 };
    p->free = p->free > now ? p->free : now;
    while (p->sent < p->held && p->segments < ETHER_SEGMENTS && p->free < next) {
        const int32_t wait = p->held - p->sent;
        const int32_t bytes = wait < c->segment ? wait : c->segment;
        const int64_t bits = INT64_C(8) * (bytes + c->overhead);
        p->free += (bits * 1000000000 + c->rate - 1) / c->rate;
        int64_t arrival = p->free + c->delay + draw(&p->random, c->jitter);
        if (draw(&p->random, MILLION - 1) < c->loss) {
            arrival += c->stall;
            p->stalls++;
        }
        p->segment[(p->first_segment + p->segments) % ETHER_SEGMENTS] =
            (struct ether_segment){ bytes, arrival };
        p->segments++;
        p->sent += bytes;
    }
}

size_t ether_pipe_get(struct ether_pipe *p, int64_t now, uint8_t *bytes, size_t most)
{
    size_t n = 0;
    while (n < most && p->segments > 0 && p->segment[p->first_segment].arrival <= now) {
        struct ether_segment *s = &p->segment[p->first_segment];
        bytes[n++] = p->byte[p->first];
        p->first = (p->first + 1) % ETHER_BUFFER;
        p->held--;
        p->sent--;
        if (--s->bytes == 0) {
            p->first_segment = (p->first_segment + 1) % ETHER_SEGMENTS;
            p->segments--;
        }
    }
    p->passed += (int64_t)n;
    return n;
}
