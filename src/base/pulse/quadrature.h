/* Lines in quadrature that follow a motion: from a phase given at instants to the clock of every
 * edge. Between two instants the phase moves on a straight line. */
#ifndef QUADRATURE_H
#define QUADRATURE_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "lines.h"

/* Largest |phase|: its quarters are whole numbers in a double, with room for one more
 * [line periods]. */
#define QUADRATURE_PHASE_MAX 1125899906842624.0 /* 2^50 */

enum quadrature_status {
    QUADRATURE_OK = 0,
    QUADRATURE_BAD_PHASE = -1, /* no number, or larger than QUADRATURE_PHASE_MAX */
    QUADRATURE_TOO_FAST = -2,  /* more than one edge per clock */
};

struct quadrature {
    bool primed;               /* there was a first sample */
    double from, to;           /* [line periods] phase at the two latest instants */
    int64_t from_clock, clock; /* [clock] of these instants */
    int64_t quarter;           /* as the lines are: the edges up to here have been passed */
    int64_t end;               /* floor(4 to): the quarter at `clock` */
    int64_t start;             /* quarter at the first sample */
};

/* What is wrong with a sample at `clock`, later than the latest. */
enum quadrature_status quadrature_check(const struct quadrature *q, double phase, int64_t clock);

/* The phase at `clock`, no QUADRATURE_BAD_PHASE; the first sample sets the lines without an edge.
 * In line, for it is called for each counter at each instant. */
static inline void quadrature_sample(struct quadrature *q, double phase, int64_t clock)
{
    const int64_t quarter = (int64_t)floor(4.0 * phase);
    q->from = q->to;
    q->from_clock = q->clock;
    q->to = phase;
    q->clock = clock;
    q->end = quarter;
    if (!q->primed) {
        q->primed = true;
        q->from = phase;
        q->from_clock = clock;
        q->quarter = quarter;
        q->start = quarter;
    }
}

/* [clock] of the next edge: the first clock at which it has passed; INT64_MAX if there is none. */
int64_t quadrature_next(const struct quadrature *q);

/* Pass that edge; +1 up, -1 down. */
int quadrature_pass(struct quadrature *q);

/* The lines as they are. */
struct lines quadrature_lines(const struct quadrature *q);

/* Edges since the first sample, up minus down. */
int64_t quadrature_edges(const struct quadrature *q);

/* [clock] at which the edge between quarters `upper` - 1 and `upper` was passed; it lies between
 * the two latest instants. */
int64_t quadrature_clock(const struct quadrature *q, int64_t upper);

/* [clock] of the n-th edge from here, n = 1 for the next; n < 1 for those behind. `way` is +1 up,
 * -1 down. */
int64_t quadrature_nth(const struct quadrature *q, int way, int64_t n);

/* Edges from here to `until`, included. */
int64_t quadrature_until(const struct quadrature *q, int way, int64_t until);

#endif
