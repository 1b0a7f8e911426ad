/* ether_pipe - a byte stream one way over Ethernet, as TCP shows it: late, in order, complete.
 *
 * Bytes that wait go out in segments as soon as the line is free; each takes 8 (payload + overhead)
 * / rate on the line, then delay and jitter to arrive. A lost segment is seen as a stall: it comes
 * `stall` later, and what was sent behind it waits for it. Times are integer ns.
 */
#ifndef ETHER_PIPE_H
#define ETHER_PIPE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { ETHER_BUFFER = 16384, ETHER_SEGMENTS = 64 };

struct ether_config {
    int64_t rate;          /* [bit/s] 1 .. 10^10 */
    int64_t delay, jitter; /* [ns] least delay, what may come on top (uniform) */
    int64_t stall;         /* [ns] what a lost segment costs */
    int64_t loss;          /* segments lost of a million */
    int32_t segment;       /* [byte] most payload, 1 .. 1460 */
    int32_t overhead;      /* [byte] of each on the line */
};

struct ether_segment {
    int32_t bytes;
    int64_t arrival; /* [ns] it waits for those ahead of it all the same */
};

struct ether_pipe {
    uint64_t random;           /* never 0 */
    int64_t free;              /* [ns] the line is */
    int32_t first, held, sent; /* bytes of the buffer: held, of which in segments */
    int32_t first_segment, segments;
    int64_t passed; /* [byte] that left it, over all connections */
    uint32_t stalls;
    struct ether_segment segment[ETHER_SEGMENTS];
    uint8_t byte[ETHER_BUFFER];
};

void ether_pipe_start(struct ether_pipe *p, uint64_t seed);

/* Bytes on their way are gone. */
void ether_pipe_clear(struct ether_pipe *p, int64_t now);

/* Room for bytes to be sent. */
size_t ether_pipe_room(const struct ether_pipe *p);
void ether_pipe_put(struct ether_pipe *p, const uint8_t *bytes, size_t n); /* n <= room */

/* Let segments start that can before `next`. */
void ether_pipe_send(struct ether_pipe *p, const struct ether_config *c, int64_t now, int64_t next);

/* Move bytes out that have arrived; returns how many. */
size_t ether_pipe_get(struct ether_pipe *p, int64_t now, uint8_t *bytes, size_t most);

#endif
