/* remote_io - the card's remote I/O: a master that exchanges inputs and outputs with one set of
 * three slaves, 64 inputs and 64 outputs each, in turn over a serial line, with retries. */
#ifndef REMOTE_IO_H
#define REMOTE_IO_H

#include <stdbool.h>
#include <stdint.h>

enum {
    REMOTE_IO_SLAVES = 3,
    REMOTE_IO_PORTS = 4, /* ports of a slave, 16 bits in and 16 bits out each */
    REMOTE_IO_EDGES = 4, /* inputs of a slave that can interrupt: port 0, bits 0 .. 3 */
    REMOTE_IO_RETRY_MAX = 255,
};

/* Edge at which an input fires. */
enum remote_io_edge {
    REMOTE_IO_RISE,
    REMOTE_IO_FALL,
    REMOTE_IO_BOTH,
};

/* Bits of remote_io_finish(), in the order of the interrupt latch. */
enum remote_io_event {
    REMOTE_IO_EVENT_DI = 0,         /* 4 bits per slave: its first four inputs */
    REMOTE_IO_EVENT_FAIL = 12,      /* a slave that was ready no longer answers */
    REMOTE_IO_EVENT_NOT_READY = 13, /* a slave has not answered since it was enabled */
};

/* Fixed at power on. */
struct remote_io_config {
    int32_t time; /* [clocks] duration of an exchange, >= 1 */
};

/* Registers of the host. They may change at any clock. A change of `on` or `enabled` takes effect
 * with remote_io_update(); `out` and `retry_limit` are sent as they are when an exchange begins;
 * `edge` and, for the master's own count of failures, `retry_limit` are read when it ends. */
struct remote_io_control {
    bool on;             /* the set is scanned */
    uint32_t enabled;    /* bits 0 .. 2: slaves of the scan */
    int32_t retry_limit; /* number of failures in a row that are tolerated, 0 .. 255 */
    enum remote_io_edge edge[REMOTE_IO_SLAVES][REMOTE_IO_EDGES];
    uint16_t out[REMOTE_IO_SLAVES][REMOTE_IO_PORTS];
};

/* Inputs at the terminals of the slaves. Bits beyond the last slave are ignored. */
struct remote_io_lines {
    uint32_t connected; /* bits 0 .. 2: the slave hears and answers */
    uint16_t in[REMOTE_IO_SLAVES][REMOTE_IO_PORTS];
};

/* All zero is the state after power on: off. */
struct remote_io {
    uint16_t in[REMOTE_IO_SLAVES][REMOTE_IO_PORTS]; /* inputs of the latest good exchange */
    uint32_t ready;                                 /* slaves of the scan that answer, a bit each */
    int32_t errors[REMOTE_IO_SLAVES];   /* failed exchanges since enabled; stays at 2^31 - 1 */
    int32_t in_a_row[REMOTE_IO_SLAVES]; /* of these since the latest good one; stays likewise */
    int32_t exchanges;                  /* exchanges since power on; 0 follows 2^31 - 1 */

    uint32_t scanned;  /* slaves of the scan, a bit each */
    uint32_t answered; /* slaves that had a good exchange since they were enabled */
    uint32_t told;     /* slaves whose NOT_READY has fired since they were enabled */

    bool busy;                         /* an exchange is under way; the next members are of it: */
    bool heard;                        /* its slave was connected when it began */
    int32_t slave;                     /* 0 .. 2, also of the latest exchange */
    int64_t due;                       /* [clock] of its end */
    int32_t limit;                     /* retry limit that it carries */
    uint16_t sampled[REMOTE_IO_PORTS]; /* inputs that it carries */
    uint16_t sent[REMOTE_IO_PORTS];    /* outputs that it carries */

    uint16_t received[REMOTE_IO_SLAVES][REMOTE_IO_PORTS]; /* outputs that a slave received last */
    int32_t received_limit[REMOTE_IO_SLAVES];             /* retry limit received with them */
    int64_t received_clock[REMOTE_IO_SLAVES];             /* [clock] of that */
};

enum remote_io_status {
    REMOTE_IO_OK,
    REMOTE_IO_BAD_TIME,    /* below 1 clock */
    REMOTE_IO_BAD_ENABLED, /* enabled has a bit above 2 */
    REMOTE_IO_BAD_RETRY,   /* not 0 .. 255 */
    REMOTE_IO_BAD_EDGE,    /* not a remote_io_edge */
};

/* Order at one clock: the exchange ends and takes effect, its events fire, the next one begins with
 * the lines and registers as given then; after that comes what the host writes at that clock. The
 * outputs at a clock are those after all of this. */

/* REMOTE_IO_OK, or the first error in the order of remote_io_status; members are checked also while
 * the set is off. The other functions take only what passed these checks. */
enum remote_io_status remote_io_check_config(const struct remote_io_config *c);
enum remote_io_status remote_io_check_control(const struct remote_io_control *set);

/* Text for a status: a sentence without a full stop. */
const char *remote_io_status_text(enum remote_io_status status);

/* The host has written the control at `clock`. The scan is `enabled` if `on`, else empty.
 * A slave that comes into the scan begins anew: not ready, no errors, no failures in a row; the
 * first good exchange then fires no input. A slave that leaves it is not ready at once, its counts
 * and inputs stay to be read. If the slave of the exchange under way leaves, the exchange is
 * dropped (no effect on either side, not counted) and the next slave's begins at this clock. An
 * idle master begins at this clock with the lowest slave. If the scan is the same as before,
 * nothing changes. */
void remote_io_update(const struct remote_io_config *c, const struct remote_io_control *set,
                      const struct remote_io_lines *lines, struct remote_io *io, int64_t clock);

/* Clock at which the exchange under way ends; INT64_MAX if there is none. */
int64_t remote_io_due(const struct remote_io *io);

/* At the clock remote_io_due(): end the exchange, return the events in the bits of remote_io_event,
 * and begin that of the next slave, ascending and wrapping. One exchange takes config.time, so n
 * slaves are scanned in n * time. Not busy: 0, nothing changes.
 *
 * An exchange is good if its slave was connected when it began; inputs and outputs are those of
 * that clock, and both sides get them now. An input fires if it differs from the latest good
 * exchange in the direction chosen now, also if the slave was cut off in between.
 * A failed exchange counts. If more than retry_limit (that of now) have failed in a row, a slave
 * that is ready becomes not ready and FAIL fires; one that has not answered since it was enabled
 * fires NOT_READY, once. The master's inputs hold. The first good exchange makes it ready again. */
uint32_t remote_io_finish(const struct remote_io_config *c, const struct remote_io_control *set,
                          const struct remote_io_lines *lines, struct remote_io *io);

/* Outputs at the terminals of slave 0 .. 2 at `clock`, up to which time has passed. They hold the
 * outputs received last for less than (retry limit + 1) * 3 * time clocks after the end of the
 * latest good exchange, with the retry limit that it carried. Then they are 0 (safe state) until
 * the next good exchange, whatever the reason: a cut line, a disabled slave, the set off. */
void remote_io_outputs(const struct remote_io_config *c, const struct remote_io *io, int64_t clock,
                       int slave, uint16_t port[REMOTE_IO_PORTS]);

#endif
