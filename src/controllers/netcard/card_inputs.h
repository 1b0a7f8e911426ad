/* card_inputs - sixteen programmable inputs on the external interrupt lines of the processor.
 *
 * Lines 0 to 4 have a vector each, 5 to 9 and 10 to 15 share one: seven vectors. A line keeps one
 * edge: one that comes while it is served is served next, a second one is lost. A shared vector
 * serves its lowest line first.
 *
 *     edge -> pending -> routine: the input has changed -> deaf for `debounce` -> level read again
 *
 * There is no filter. Pause and stop act at the first edge. Start, home and event act behind the
 * deaf time, if the level is still there: a spike does not start a machine. If at its end the
 * level is another one than the routine took, that is an edge again. Without a deaf time every
 * action acts at once. */
#ifndef CARD_INPUTS_H
#define CARD_INPUTS_H

#include <stdbool.h>
#include <stdint.h>

#include "card_settings.h"

enum { CARD_VECTORS = 7 };

struct card_input {
    enum card_action action;
    enum card_edge edge;
    int64_t debounce; /* [ns] 0 or more */
};

struct card_inputs_config {
    struct card_input line[CARD_INPUTS];
};

struct card_inputs {
    struct card_inputs_config config;
    uint32_t levels;              /* at the pins */
    uint32_t taken;               /* as the routines know them */
    uint32_t pending;             /* lines */
    uint32_t waiting;             /* lines whose action waits for the end of the deaf time */
    uint32_t ended;               /* lines whose deaf time is over, not served since */
    int64_t deaf[CARD_INPUTS];    /* [ns] until which the line is deaf; -1: it hears */
    int64_t edges, lost, ignored; /* edges in all; lost while one was pending; ignored while deaf */
};

/* What a routine has found. */
struct card_input_served {
    int line;                /* -1: no line of this vector was pending */
    enum card_action action; /* to be done now; CARD_NONE also for an edge without one */
};

/* Levels at power on: no edge. */
void card_inputs_start(struct card_inputs *c, const struct card_inputs_config *config,
                       uint32_t levels);

/* The levels at the pins from `now` on. Returns the vectors that are pending, a bit each. */
uint32_t card_inputs_set(struct card_inputs *c, uint32_t levels, int64_t now);

/* End of the next deaf time [ns]; INT64_MAX none. Then call card_inputs_advance, which returns
 * vectors as above: the level is read again in the line's own routine. */
int64_t card_inputs_next(const struct card_inputs *c);
uint32_t card_inputs_advance(struct card_inputs *c, int64_t now);

/* The routine of a vector: its lowest pending line is served. To be called again while
 * card_inputs_vectors has the vector. */
struct card_input_served card_inputs_serve(struct card_inputs *c, int vector, int64_t now);

/* Vectors with a pending line, a bit each; the vector of a line. */
uint32_t card_inputs_vectors(const struct card_inputs *c);
int card_inputs_vector(int line);

#endif
