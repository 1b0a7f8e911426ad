/* card_inputs - the network card's sixteen programmable inputs, on the external interrupt lines of
 * its processor: what each edge at a pin makes the card do.
 *
 * Lines 0 to 4 have an interrupt vector each, lines 5 to 9 share one, and lines 10 to 15: seven
 * vectors. A line keeps one edge: an edge that comes while another is served is served next, a
 * second one is lost. A shared vector serves its lowest line first.
 *
 *     edge -> pending -> routine: the input has changed -> deaf for `debounce` -> level read again
 *
 * There is no filter. Pause and stop act at the first edge. Start, home and event act after the
 * deaf time, if the level is still there: so a spike does not start a machine. If the level at the
 * end of the deaf time differs from the one the routine took, that is an edge again. Without a
 * deaf time every action acts at once. */
#ifndef CARD_INPUTS_H
#define CARD_INPUTS_H

#include <stdbool.h>
#include <stdint.h>

#include "card_settings.h"

enum { CARD_VECTORS = 7 };

struct card_input {
    enum card_action action;
    enum card_edge edge;
    int64_t debounce; /* [ns] deaf time after an edge, 0 or more */
};

struct card_inputs_config {
    struct card_input line[CARD_INPUTS];
};

struct card_inputs {
    struct card_inputs_config config;
    uint32_t levels;              /* levels at the pins, a bit each line, as all masks here */
    uint32_t taken;               /* levels that the routines took last */
    uint32_t pending;             /* lines with an edge that waits for its routine */
    uint32_t waiting;             /* lines whose action waits for the end of the deaf time */
    uint32_t ended;               /* lines whose deaf time is over and that were not served since */
    uint32_t deaf;                /* lines that do not hear, */
    int64_t hears[CARD_INPUTS];   /* [ns] and the time from which each hears again */
    int64_t edges, lost, ignored; /* all edges; lost while one was pending; ignored while deaf */
};

/* What an interrupt routine has found. */
struct card_input_served {
    int line;                /* -1: no line of this vector was pending */
    enum card_action action; /* what is to be done now; CARD_NONE also for an edge without action */
};

/* Power on, with these levels at the pins, which are no edges. */
void card_inputs_start(struct card_inputs *c, const struct card_inputs_config *config,
                       uint32_t levels);

/* Set the levels at the pins from `now` [ns] on. Returns the pending vectors, a bit each. */
uint32_t card_inputs_set(struct card_inputs *c, uint32_t levels, int64_t now);

/* End of the next deaf time [ns]; INT64_MAX: there is none. Call card_inputs_advance at that
 * time: it returns the pending vectors as above, for the level is read again in the line's own
 * routine. */
int64_t card_inputs_next(const struct card_inputs *c);
uint32_t card_inputs_advance(struct card_inputs *c, int64_t now);

/* The routine of a vector, which serves its lowest pending line. Call it again while
 * card_inputs_vectors has the vector. */
struct card_input_served card_inputs_serve(struct card_inputs *c, int vector, int64_t now);

/* Vectors with a pending line, a bit each; the vector of a line. */
uint32_t card_inputs_vectors(const struct card_inputs *c);
int card_inputs_vector(int line);

#endif
