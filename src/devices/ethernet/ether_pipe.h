/* ether_pipe - one direction of a TCP connection over Ethernet: bytes arrive late, in order and
 * complete.
 *
 * Waiting bytes are sent in segments as soon as the line is free. A segment occupies the line for 8
 * (payload + overhead) / rate and then takes delay and jitter to arrive. A lost segment shows as a
 * stall: it arrives `stall` later, and the segments behind it wait for it. Times are integer ns.
 */
#ifndef ETHER_PIPE_H
#define ETHER_PIPE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { ETHER_BUFFER = 16384, ETHER_SEGMENTS = 64 };

struct ether_config {
    int64_t rate;          /* [bit/s] 1 .. 10^10 */
    int64_t delay, jitter; /* [ns] least delay; largest random addition, uniform from 0 */
    int64_t stall;         /* [ns] additional delay of a lost segment */
    int64_t loss;          /* [1e-6] probability that a segment is lost */
    int32_t segment;       /* [byte] largest payload of a segment, 1 .. 1460 */
    int32_t overhead;      /* [byte] headers and gap of each segment on the line */
};

struct ether_segment {
    int32_t bytes;   /* [byte] payload that has not left the pipe yet */
    int64_t arrival; /* [ns] its bytes leave then, or behind those of the segments ahead */
};

struct ether_pipe {
    uint64_t random;                 /* state of the random generator, never 0 */
    int64_t free;                    /* [ns] time from which the line is free */
    int32_t first, held, sent;       /* [byte] ring buffer: start, filling, part in segments */
    int32_t first_segment, segments; /* ring of the segments on their way: start, number */
    int64_t passed;                  /* [byte] that left the pipe, over all connections */
    uint32_t stalls;                 /* number of lost segments */
    struct ether_segment segment[ETHER_SEGMENTS];
    uint8_t byte[ETHER_BUFFER];
};

/* An empty pipe; equal seeds give equal jitter and losses. */
void ether_pipe_start(struct ether_pipe *p, uint64_t seed);

/* Drop all bytes that wait or are on their way, at the time `now` [ns]. */
void ether_pipe_clear(struct ether_pipe *p, int64_t now);

/* Number of bytes that the pipe still takes; put n bytes, at most that number, in. */
size_t ether_pipe_room(const struct ether_pipe *p);
void ether_pipe_put(struct ether_pipe *p, const uint8_t *bytes, size_t n);

/* Send the segments that can start on the line before `next` [ns]. */
void ether_pipe_send(struct ether_pipe *p, const struct ether_config *c, int64_t now, int64_t next);

/* Take out up to `most` bytes that have arrived by `now` [ns]. Returns their number. */
size_t ether_pipe_get(struct ether_pipe *p, int64_t now, uint8_t *bytes, size_t most);

#endif
