/* Linear scale at the pins: from a phase given at instants to the clock of every edge.
 *
 * Between two instants the phase moves on a straight line. The scale's line A is high in the
 * quarters q mod 4 = 0, 1 of q = floor(4 phase), B in 1, 2: A leads going up. */
#ifndef SCALE_H
#define SCALE_H

#include <stdbool.h>
#include <stdint.h>

/* Largest phase whose quarters are whole numbers in a double, with room for one more [periods]. */
#define SCALE_PHASE_MAX 1125899906842624.0      /* 2^50 */

enum scale_status {
    SCALE_OK = 0,
    SCALE_BAD_PHASE = -1,       /* no number, or larger than SCALE_PHASE_MAX */
    SCALE_TOO_FAST = -2,        /* more than one edge per clock */
};

struct scale {
    bool    primed;             /* there was a first sample */
    double  from, to;           /* [line periods] at the two latest instants */
    int64_t from_clock, clock;  /* [clocks] of these instants */
    int64_t quarter;            /* as the pins are now */
    int64_t end;                /* quarter at `clock` */
    int64_t start;              /* quarter at the first sample */
};

/* The phase at `clock`, later than the latest; the first sample sets the lines without an edge.
 * A refused sample changes nothing. */
enum scale_status scale_sample(struct scale *s, double phase, int64_t clock);

/* [clock] of the next edge: the first clock at which it has passed; INT64_MAX if there is none. */
int64_t scale_next(const struct scale *s);

/* Pass that edge; +1 up, -1 down. */
int scale_pass(struct scale *s);

/* Lines of the scale as they are now. */
bool scale_a(const struct scale *s);
bool scale_b(const struct scale *s);

/* Edges since the first sample, up minus down. */
int64_t scale_edges(const struct scale *s);

#endif
