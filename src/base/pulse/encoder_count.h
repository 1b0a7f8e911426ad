/* Count, index and comparator of an encoder counter; encoder.h says how it is used. */
#ifndef ENCODER_COUNT_H
#define ENCODER_COUNT_H

#include <stdbool.h>
#include <stdint.h>

#include "floor_divide.h"
#include "quadrature.h"

enum { ENCODER_FILTER_MAX = 65535 };

enum encoder_format {
    ENCODER_AB,              /* two lines in quadrature */
    ENCODER_CW_CCW,          /* a pulse a line period, on A forward, on B backward */
    ENCODER_PULSE_DIRECTION, /* a pulse a line period on A, direction on B */
    ENCODER_NONE,            /* not connected */
};

/* Bit of `wiring` beside those of lines.h. */
enum { ENCODER_C_INVERSE = 8 };

struct encoder_config {
    enum encoder_format format;
    int32_t rate; /* 0, 1, 2 or 4 counts per line period; 0 switches the input off */
    uint32_t wiring;
    int32_t filter;      /* [clocks] a level must stand to be seen; 0: no filter */
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

/* A line behind the filter. */
struct encoder_line {
    bool level;   /* seen */
    bool pin;     /* at the pin */
    int64_t edge; /* [clock] the pin changed last */
};

struct encoder {
    struct encoder_config config;
    int32_t sign;  /* +1, or -1 if the wiring turns the direction round */
    int32_t shift; /* quarter line periods from phase 0 to an edge that counts */
    int32_t share; /* quarter line periods per count */

    struct quadrature pins;          /* edges at the pins, as far as worked off */
    int64_t seen;                    /* quarter behind the filter, less edges lost there */
    int64_t lost;                    /* [edges] whole line periods */
    int32_t walked;                  /* edges taken one by one since the latest sample */
    struct encoder_line a, b, index; /* as the counter sees them */

    bool index_low; /* the index is ON at the other level than the wiring says */
    int64_t zero;   /* edges that count, up to where the counter is zero */
    int64_t count;  /* [counts]; the register shows the low 32 bits */
    bool too_fast;  /* edges were lost in the filter; stays until cleared */

    int32_t index_seen;  /* index pulses so far */
    int64_t index_first; /* [clock] of the first since the latest sample, -1 if none came */
    int64_t index_clock; /* [clock] of the latest */
    int64_t index_count; /* [counts] the counter's value at that clock */

    bool compare_on;
    int32_t compare;       /* [counts] */
    bool reached;          /* compare_on and count >= compare */
    int64_t compare_clock; /* [clock] at which it was reached last */
};

/* Events, as bits. */
enum { ENCODER_INDEX = 1, ENCODER_COMPARE = 2 };

/* What the wiring does to direction and place of the counting edges. */
void encoder_decode(struct encoder *e);

/* Edges that count, from phase 0 to what is seen. */
static inline int64_t encoder_counting_edges(const struct encoder *e)
{
    return e->sign * floor_divide(e->seen - e->shift, e->share);
}

/* Level of the index line in a quarter of a line period. */
bool encoder_index_high(const struct encoder *e, int64_t quarter);

/* Edges from here to a change of the index line, to a change of the comparator; `way` is +1 or
 * -1. */
int64_t encoder_edges_to_index(const struct encoder *e, int way);
int64_t encoder_edges_to_compare(const struct encoder *e, int way);

/* Look at the comparator; show a level of the index line; an index pulse. All return events. */
int encoder_compare(struct encoder *e, int64_t clock);
int encoder_show_index(struct encoder *e, bool level, int64_t clock);
int encoder_index_pulse(struct encoder *e, int64_t clock);

#endif
