/* Encoder counters against A and B sampled at every clock. */
#include "check.h"
#include "encoder.h"

#include <math.h>
#include <stdlib.h>

enum { UNIT = 64 };     /* phases here are whole 64ths of a line, so that all sums are exact */

static int floor_mod(int64_t a, int b)
{
    int r = (int)(a % b);
    return r < 0 ? r + b : r;
}

/* The two signals of an ideal encoder at `num / den` 64ths of a line. */
static int signal_a(int64_t num, int64_t den)
{
    return floor_mod(num, (int)(den * UNIT)) < den * UNIT / 2;
}

static int signal_b(int64_t num, int64_t den)
{
    int64_t p = floor_mod(num, (int)(den * UNIT));
    return p >= den * UNIT / 4 && p < den * UNIT * 3 / 4;
}

struct decoder {
    int a, b;
    int64_t x1, x2, x4;
};

/* Decoders as in a data sheet. x4: all edges. x2: edges of A. x1: the edge of A while B is low. */
static void decode(struct decoder *d, int a, int b)
{
    if (a != d->a) {
        int up = a != b;    /* A rises with B low, or falls with B high */
        d->x4 += up ? 1 : -1;
        d->x2 += up ? 1 : -1;
        if (!b)
            d->x1 += up ? 1 : -1;
    } else if (b != d->b) {
        d->x4 += a == b ? 1 : -1;
    }
    d->a = a;
    d->b = b;
}

/* A path of straight pieces, sampled at each joint; A and B looked at every clock in between. */
static void against_brute_force(uint64_t seed, bool inverse, int index_lines)
{
    struct encoder e[3] = {0};
    struct encoder_config c[3] = {{1, inverse, index_lines}, {2, inverse, index_lines},
                                  {4, inverse, index_lines}};
    int sign = inverse ? -1 : 1;
    int64_t at = check_random(&seed, -5000, 5000);
    int64_t clock = check_random(&seed, 0, 1000);
    struct decoder d = {signal_a(at, 1), signal_b(at, 1), 0, 0, 0};
    for (int i = 0; i < 3; i++)
        CHECK_EQ(encoder_sample(&c[i], &e[i], (double)at / UNIT, clock), ENCODER_NONE);
    for (int piece = 0; piece < 300; piece++) {
        int64_t span = check_random(&seed, 200, 400);
        /* never more than one quarter line per clock, or A and B alone could not tell */
        int64_t to = at + check_random(&seed, -span * UNIT / 8, span * UNIT / 8);
        if (piece % 7 == 0)
            to = at - floor_mod(at, UNIT) + UNIT * (piece % 3 - 1);     /* exactly on an edge */
        if (piece % 11 == 0)
            to = at;
        int64_t pulses = 0, first = 0;
        for (int64_t n = 1; n <= span; n++) {
            int64_t num = at * span + (to - at) * n, before = num - (to - at);
            decode(&d, signal_a(num, span), signal_b(num, span));
            int64_t period = span * UNIT * index_lines;
            int64_t turns = (num - floor_mod(num, (int)period)) / period;
            int64_t turns_before = (before - floor_mod(before, (int)period)) / period;
            if (turns != turns_before && pulses++ == 0)
                first = clock + n;
        }
        int32_t seen = e[2].index_seen;
        for (int i = 0; i < 3; i++) {
            enum encoder_event event =
                encoder_sample(&c[i], &e[i], (double)to / UNIT, clock + span);
            CHECK_EQ(event, pulses > 0 ? ENCODER_INDEX : ENCODER_NONE);
            if (pulses > 0)
                CHECK_EQ(e[i].index_clock, first);
        }
        CHECK_EQ(e[2].index_seen - seen, pulses);
        CHECK_EQ(e[0].count, sign * d.x1);
        CHECK_EQ(e[1].count, sign * d.x2);
        CHECK_EQ(e[2].count, sign * d.x4);
        at = to;
        clock += span;
    }
}

/* The clock of a quadrature edge between two samples, found by looking at every clock. */
static void edge_clocks(uint64_t seed)
{
    for (int trial = 0; trial < 3000; trial++) {
        int64_t span = check_random(&seed, 1, 5000);
        int64_t from = check_random(&seed, -2000, 2000), to = check_random(&seed, -2000, 2000);
        int64_t edge = check_random(&seed, -125, 125) * (UNIT / 4);
        if (to > from ? edge <= from || edge > to : edge > from || edge <= to)
            continue;
        int64_t n = 1;
        while (to > from ? from * span + (to - from) * n < edge * span
                         : from * span + (to - from) * n >= edge * span)
            n++;
        CHECK_EQ(encoder_edge((double)from / UNIT, (double)to / UNIT, span, (double)edge / UNIT),
                 n);
    }
}

static void start_rate_and_range(void)
{
    struct encoder_config c = {4, false, 10};
    struct encoder e = {0};
    CHECK_EQ(encoder_sample(&c, &e, -3.3, 0), ENCODER_NONE);    /* floor(-13.2) = -14 */
    CHECK_EQ(e.count, 0);
    encoder_sample(&c, &e, 1e15, 4000);
    CHECK_EQ(e.count, 4000000000000000 + 14);
    CHECK_EQ(encoder_sample(&c, &e, 2e15, 8000), ENCODER_BAD_PHASE);
    CHECK_EQ(encoder_sample(&c, &e, NAN, 8000), ENCODER_BAD_PHASE);
    CHECK_EQ(encoder_sample(&c, &e, -INFINITY, 8000), ENCODER_BAD_PHASE);
    CHECK_EQ(e.count, 4000000000000000 + 14);
    CHECK_EQ(encoder_sample(&c, &e, -1e15, 12000), ENCODER_INDEX);
    CHECK_EQ(e.count, -4000000000000000 + 14);
    encoder_clear(&c, &e);
    encoder_sample(&c, &e, -1e15 + 1.0, 16000);
    CHECK_EQ(e.count, 4);
    struct encoder off = {0};
    c.rate = 0;
    encoder_sample(&c, &off, 0.0, 0);
    CHECK_EQ(encoder_sample(&c, &off, 1000.0, 4000), ENCODER_NONE);
    CHECK_EQ(off.count, 0);
}

/* The counter's value at the index is the same from both sides and both directions. */
static void index_latch(void)
{
    for (int inverse = 0; inverse < 2; inverse++) {
        struct encoder_config c = {4, inverse, 100};
        struct encoder e = {0};
        int sign = inverse ? -1 : 1;
        encoder_sample(&c, &e, 90.5, 0);
        CHECK_EQ(encoder_sample(&c, &e, 110.5, 4000), ENCODER_INDEX);
        CHECK_EQ(e.index_count, sign * 38);
        CHECK_EQ(e.index_clock, 1900);
        CHECK_EQ(encoder_sample(&c, &e, 90.5, 8000), ENCODER_INDEX);
        CHECK_EQ(e.index_count, sign * 38);
        CHECK_EQ(e.index_clock, 4000 + 2101);   /* first clock below 100 */
        CHECK_EQ(e.index_seen, 2);
        CHECK_EQ(encoder_sample(&c, &e, 390.5, 8300), ENCODER_INDEX);
        CHECK_EQ(e.index_seen, 5);
        CHECK_EQ(e.index_count, sign * 38);     /* the first of the three */
        CHECK_EQ(e.index_clock, 8010);          /* 1 line per clock, 9.5 lines away */
    }
}

int main(void)
{
    for (uint64_t seed = 1; seed <= 4; seed++) {
        against_brute_force(seed * 104729, false, (int)seed * 3);
        against_brute_force(seed * 130363, true, 1);
    }
    edge_clocks(4711);
    start_rate_and_range();
    index_latch();
    return check_result();
}
