/* quadrature - clock of every edge of the lines A and B that follow a motion. The caller gives the
 * phase [line periods] at instants; between two instants it moves on a straight line. A quarter is
 * the number floor(4 phase); each step of it is one edge of A or B. */
#ifndef QUADRATURE_H
#define QUADRATURE_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "lines.h"

/* Largest |phase| [line periods]: 4 phase and the next whole number are exact as doubles. */
#define QUADRATURE_PHASE_MAX 1125899906842624.0 /* 2^50 */

enum quadrature_status {
    QUADRATURE_OK = 0,
    QUADRATURE_BAD_PHASE = -1, /* not a number, or larger than QUADRATURE_PHASE_MAX */
    QUADRATURE_TOO_FAST = -2,  /* more than one edge per clock */
};

struct quadrature {
    bool primed;               /* the first sample has come */
    double from, to;           /* [line periods] phase at the two latest instants */
    int64_t from_clock, clock; /* [clock] of these instants */
    int64_t quarter;           /* quarter of the lines now: edges up to it have been passed */
    int64_t end;               /* quarter at `clock`, floor(4 to) */
    int64_t start;             /* quarter at the first sample */
};

/* Whether a phase at `clock`, later than the latest instant, can be taken; else what is wrong. */
enum quadrature_status quadrature_check(const struct quadrature *q, double phase, int64_t clock);

/* Take the phase at `clock`, which must not be QUADRATURE_BAD_PHASE. The first sample sets the
 * lines without an edge. Inline, because it is called for each counter at each instant. */
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

/* Pass that edge. Returns its direction, +1 up or -1 down. */
int quadrature_pass(struct quadrature *q);

/* Levels of the lines now, before wiring. */
struct lines quadrature_lines(const struct quadrature *q);

/* Number of edges passed since the first sample, up minus down. */
int64_t quadrature_edges(const struct quadrature *q);

/* [clock] at which the edge between the quarters `upper` - 1 and `upper` is passed; it must lie
 * between the two latest instants. */
int64_t quadrature_clock(const struct quadrature *q, int64_t upper);

/* [clock] of the n-th edge from here: n = 1 is the next, n < 1 are passed ones. `way` is the sign
 * of the motion, +1 up, -1 down. */
int64_t quadrature_nth(const struct quadrature *q, int way, int64_t n);

/* Number of edges from here up to and including the clock `until`; `way` as above. */
int64_t quadrature_until(const struct quadrature *q, int way, int64_t until);

#endif
