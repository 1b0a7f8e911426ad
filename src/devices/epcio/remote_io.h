/* Remote I/O master: one set of three slaves of 64 inputs and 64 outputs, scanned in turn. */
#ifndef REMOTE_IO_H
#define REMOTE_IO_H

#include <stdbool.h>
#include <stdint.h>

enum {
    REMOTE_IO_SLAVES = 3,
    REMOTE_IO_PORTS = 4, /* of a slave, 16 bit in and 16 bit out each */
    REMOTE_IO_EDGES = 4, /* inputs of a slave that interrupt: port 0, bits 0 .. 3 */
    REMOTE_IO_RETRY_MAX = 255,
};

/* Change of level that fires. */
enum remote_io_edge {
    REMOTE_IO_RISE,
    REMOTE_IO_FALL,
    REMOTE_IO_BOTH,
};

/* Bits of remote_io_finish(), in the order of the interrupt latch. */
enum remote_io_event {
    REMOTE_IO_EVENT_DI = 0,         /* 4 a slave: its first four inputs */
    REMOTE_IO_EVENT_FAIL = 12,      /* a slave that was ready is so no more */
    REMOTE_IO_EVENT_NOT_READY = 13, /* a slave has not answered since it was enabled */
};

/* Fixed at power on. */
struct remote_io_config {
    int32_t time; /* [clocks] of one exchange, >= 1 */
};

/* Registers of the host. They may change at any clock. A change of `on` or `enabled` takes effect
 * with remote_io_update(); `out` and `retry_limit` are sent as they are when an exchange begins;
 * `edge` and, for the master's own count, `retry_limit` are looked at when it ends. */
struct remote_io_control {
    bool on;             /* the set is scanned */
    uint32_t enabled;    /* bits 0 .. 2: slaves of the scan */
    int32_t retry_limit; /* 0 .. 255 failures in a row that are forgiven */
    enum remote_io_edge edge[REMOTE_IO_SLAVES][REMOTE_IO_EDGES];
    uint16_t out[REMOTE_IO_SLAVES][REMOTE_IO_PORTS];
};

/* The field: what the slaves see at their terminals. Bits beyond the last slave are ignored. */
struct remote_io_lines {
    uint32_t connected; /* bits 0 .. 2: the slave hears and answers */
    uint16_t in[REMOTE_IO_SLAVES][REMOTE_IO_PORTS];
};

/* All zero is the state after power on: off. */
struct remote_io {
    uint16_t in[REMOTE_IO_SLAVES][REMOTE_IO_PORTS]; /* of the latest good exchange, ever */
    uint32_t ready;                                 /* slaves of the scan that answer */
    int32_t errors[REMOTE_IO_SLAVES];   /* failed exchanges since enabled; stays at 2^31 - 1 */
    int32_t in_a_row[REMOTE_IO_SLAVES]; /* since the latest good one; stays at 2^31 - 1 */
    int32_t exchanges;                  /* ended since power on; 0 after 2^31 - 1 */

    uint32_t scanned;  /* slaves of the scan */
    uint32_t answered; /* had a good exchange since they were enabled */
    uint32_t told;     /* NOT_READY has fired since they were enabled */

    bool busy;                         /* an exchange is under way: */
    bool heard;                        /* its slave was connected when it began */
    int32_t slave;                     /* 0 .. 2, kept for the turn after it */
    int64_t due;                       /* [clock] of its end */
    int32_t limit;                     /* retry limit it carries */
    uint16_t sampled[REMOTE_IO_PORTS]; /* inputs it carries */
    uint16_t sent[REMOTE_IO_PORTS];    /* outputs it carries */

    uint16_t received[REMOTE_IO_SLAVES][REMOTE_IO_PORTS]; /* outputs the slave got last */
    int32_t received_limit[REMOTE_IO_SLAVES];             /* with this retry limit */
    int64_t received_clock[REMOTE_IO_SLAVES];             /* [clock] at this clock */
};

enum remote_io_status {
    REMOTE_IO_OK,
    REMOTE_IO_BAD_TIME,    /* below 1 clock */
    REMOTE_IO_BAD_ENABLED, /* a bit above 2 */
    REMOTE_IO_BAD_RETRY,   /* not 0 .. 255 */
    REMOTE_IO_BAD_EDGE,    /* no remote_io_edge */
};

/* Order at one clock: the exchange ends and takes effect, its events fire, the next one begins with
 * the lines and registers as given then; after that comes what the host writes at that clock. The
 * outputs at a clock are those after all of this. */

/* Say what is wrong, the first in the order of remote_io_status. Every member must be right, also
 * while the set is off. The other functions take only what was found right here. */
enum remote_io_status remote_io_check_config(const struct remote_io_config *c);
enum remote_io_status remote_io_check_control(const struct remote_io_control *set);

/* What a status says, in a sentence without a full stop. */
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

/* Outputs at the terminals of slave 0 .. 2 at `clock`, when everything up to it is done. They hold
 * what was received last for less than (retry limit + 1) * 3 * time clocks after the end of the
 * latest good exchange, with the retry limit it carried. From then on they are 0 until the next
 * good exchange, whatever silenced the master: a cut line, a disabled slave, the set off. */
void remote_io_outputs(const struct remote_io_config *c, const struct remote_io *io, int64_t clock,
                       int slave, uint16_t port[REMOTE_IO_PORTS]);

#endif
