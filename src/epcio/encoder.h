/* Encoder counter: sampled line phase in; counts, index pulses and compare events out. */
#ifndef ENCODER_H
#define ENCODER_H

#include <stdbool.h>
#include <stdint.h>

/* Largest |phase|: four times it is still a whole number exactly in a double [line periods]. */
#define ENCODER_PHASE_MAX 1125899906842624.0 /* 2^50 */

enum { ENCODER_FILTER_MAX = 65535, ENCODER_LINES = 3 };

enum encoder_format {
    ENCODER_AB,                 /* two lines in quadrature */
    ENCODER_CW_CCW,             /* a pulse a line period, on A forward, on B backward */
    ENCODER_PULSE_DIRECTION,    /* a pulse a line period on A, direction on B */
    ENCODER_NONE,               /* not connected */
};

/* Bits of `wiring`; inversion comes before the swap. */
enum { ENCODER_A_INVERSE = 1, ENCODER_B_INVERSE = 2, ENCODER_SWAP = 4, ENCODER_C_INVERSE = 8 };

struct encoder_config {
    enum encoder_format format;
    int32_t  rate;          /* 0, 1, 2 or 4 counts per line period; 0 switches the input off */
    uint32_t wiring;
    int32_t  filter;        /* [clocks] a level must stand to be seen; 0: no filter */
    int32_t  index_lines;   /* [line periods] between two index pulses, >= 1 */
};

enum encoder_status {
    ENCODER_OK,
    ENCODER_BAD_FORMAT,     /* no such format */
    ENCODER_BAD_RATE,       /* not 0, 1, 2 or 4 */
    ENCODER_BAD_WIRING,     /* no such bit, or pulse and direction swapped */
    ENCODER_BAD_FILTER,     /* not 0 .. 65535 */
    ENCODER_BAD_INDEX,      /* less than a line period between two index pulses */
};

struct encoder {
    struct encoder_config config;
    int32_t sign;               /* +1, or -1 if the wiring turns the direction round */
    int32_t shift;              /* quarter line periods from phase 0 to an edge that counts */
    int32_t share;              /* quarter line periods per count */

    bool    primed;             /* there was a first sample */
    double  from, to;           /* [line periods] phase at the two latest samples */
    int64_t from_clock, clock;  /* [clock] of these */
    int64_t raw_end;            /* floor(4 to) */
    int64_t raw;                /* quadrature edges at the pins, as far as worked off */
    int64_t seen;               /* the same behind the filter, less those lost there */
    int64_t lost;               /* [edges] whole line periods */
    int32_t walked;             /* edges taken one by one since the latest sample */
    struct encoder_line {       /* A, B and index behind the filter */
        bool    level;          /* seen */
        bool    pin;            /* at the pin */
        int64_t edge;           /* [clock] the pin changed last */
    } line[ENCODER_LINES];

    bool    index_low;          /* the index is ON at the other level than the wiring says */
    int64_t zero;               /* edges that count, up to where the counter is zero */
    int64_t count;              /* [counts]; the register shows the low 32 bits */
    bool    too_fast;           /* edges were lost in the filter; stays until cleared */

    int32_t index_seen;         /* index pulses so far */
    int64_t index_first;        /* [clock] of the first since the latest sample, -1 if none came */
    int64_t index_clock;        /* [clock] of the latest */
    int64_t index_count;        /* [counts] the counter's value at that clock */

    bool    compare_on;
    int32_t compare;            /* [counts] */
    bool    reached;            /* compare_on and count >= compare */
    int64_t compare_clock;      /* [clock] at which it was reached last */
};

/* Events of encoder_run(), as bits. */
enum { ENCODER_INDEX = 1, ENCODER_COMPARE = 2 };

enum encoder_status encoder_check(const struct encoder_config *c);

/* Counter at zero; the next sample is the first. The configuration must have been checked. */
void encoder_reset(struct encoder *e, const struct encoder_config *c);

/* Another configuration, checked; the counter keeps its value, the lines as they stand are seen. */
void encoder_configure(struct encoder *e, const struct encoder_config *c);

/* The phase at `clock` is known; it moved there on a straight line from the sample before. The
 * first sample only sets the lines. False, and nothing changed, if it is no number or too large. */
bool encoder_sample(struct encoder *e, double phase, int64_t clock);

/* Work off what happened up to and including `until`, at most the clock of the latest sample; to
 * that clock before the next sample comes. Returns events. */
int encoder_run(struct encoder *e, int64_t until);

/* Set the counter to zero where it stands, and take back `too_fast`. Returns events: a compare
 * value of zero or less may be reached by it. */
int encoder_clear(struct encoder *e, int64_t clock);

/* Switch the comparator and set its value [counts]; the event comes when the condition
 * count >= value becomes true, by counting or by this write. Returns events. */
int encoder_set_compare(struct encoder *e, bool on, int32_t value, int64_t clock);

/* The phase moves on a straight line from `from` at clock 0 to `to` at clock `span`: first clock,
 * in 1 .. span, at which it has passed `edge`: >= edge on the way up, < edge on the way down. The
 * edge must lie between them. All phases in line periods. */
int64_t encoder_edge(double from, double to, int64_t span, double edge);

#endif
