/* encoder_count - types of the encoder counter, and how it turns seen edges into count, index
 * pulses and compare events. encoder.h has the functions for users; those below are for the files
 * encoder.c and encoder_filter.c. */
#ifndef ENCODER_COUNT_H
#define ENCODER_COUNT_H

#include <stdbool.h>
#include <stdint.h>

#include "floor_divide.h"
#include "quadrature.h"

enum { ENCODER_FILTER_MAX = 65535 }; /* [clocks] */

enum encoder_format {
    ENCODER_AB,              /* two lines in quadrature */
    ENCODER_CW_CCW,          /* one pulse per line period, on A forward, on B backward */
    ENCODER_PULSE_DIRECTION, /* one pulse per line period on A, direction on B */
    ENCODER_NONE,            /* not connected */
};

/* Bit of `wiring` beside those of lines.h: the index line C is inverted. */
enum { ENCODER_C_INVERSE = 8 };

struct encoder_config {
    enum encoder_format format;
    int32_t rate;        /* 0, 1, 2 or 4 counts per line period; 0 switches the input off */
    uint32_t wiring;     /* bits of lines.h and ENCODER_C_INVERSE */
    int32_t filter;      /* [clocks] a level must last to be seen; 0: no filter */
    int32_t index_lines; /* [line periods] between two index pulses, >= 1 */
};

enum encoder_status {
    ENCODER_OK,
    ENCODER_BAD_FORMAT, /* no such format */
    ENCODER_BAD_RATE,   /* not 0, 1, 2 or 4 */
    ENCODER_BAD_WIRING, /* no such bit, or pulse and direction swapped */
    ENCODER_BAD_FILTER, /* not 0 .. 65535 */
    ENCODER_BAD_INDEX,  /* less than a line period between two index pulses */
};

/* A line before and behind the digital filter. */
struct encoder_line {
    bool level;   /* level behind the filter, which the counter sees */
    bool pin;     /* level at the pin */
    int64_t edge; /* [clock] of the latest change at the pin */
};

struct encoder {
    struct encoder_config config;
    int32_t sign;  /* +1, or -1 if the wiring turns the direction round */
    int32_t shift; /* [quarters of a line period] from phase 0 to the first edge that counts */
    int32_t share; /* [quarters of a line period] per count */

    struct quadrature pins;          /* phase and edges at the pins, up to the latest run */
    int64_t seen;                    /* quarter that the counter has seen behind the filter */
    int64_t lost;                    /* [edges] lost in the filter, whole line periods */
    int32_t walked;                  /* edges taken one by one since the latest sample */
    struct encoder_line a, b, index; /* the lines A, B and C */

    bool index_low; /* the index is on at the level opposite to the one that the wiring says */
    int64_t zero;   /* counting edges from phase 0 to where the counter is zero */
    int64_t count;  /* [counts]; the register shows the low 32 bits */
    bool too_fast;  /* edges were lost in the filter; stays until cleared */

    int32_t index_seen;  /* index pulses so far */
    int64_t index_first; /* [clock] of the first index pulse since the latest sample; -1 none */
    int64_t index_clock; /* [clock] of the latest index pulse */
    int64_t index_count; /* [counts] the counter's value at that clock */

    bool compare_on;       /* the comparator is on */
    int32_t compare;       /* [counts] compare value */
    bool reached;          /* compare_on and count >= compare */
    int64_t compare_clock; /* [clock] at which `reached` became true last */
};

/* Bits of the events that functions return: an index pulse came; the compare value was reached. */
enum { ENCODER_INDEX = 1, ENCODER_COMPARE = 2 };

/* Set sign, shift and share from format, rate and wiring. */
void encoder_decode(struct encoder *e);

/* Signed number of counting edges from phase 0 to the quarter that is seen. */
static inline int64_t encoder_counting_edges(const struct encoder *e)
{
    return e->sign * floor_divide(e->seen - e->shift, e->share);
}

/* Level of the index line, before wiring, in a quarter of a line period. */
bool encoder_index_high(const struct encoder *e, int64_t quarter);

/* Number of edges until the index line changes, until the comparator's condition changes; `way` is
 * the sign of the motion, +1 or -1. INT64_MAX if it never will. */
int64_t encoder_edges_to_index(const struct encoder *e, int way);
int64_t encoder_edges_to_compare(const struct encoder *e, int way);

/* Evaluate the comparator; take a new level of the index line; record an index pulse with its count
 * and clock. All return events. */
int encoder_compare(struct encoder *e, int64_t clock);
int encoder_show_index(struct encoder *e, bool level, int64_t clock);
int encoder_index_pulse(struct encoder *e, int64_t clock);

#endif
