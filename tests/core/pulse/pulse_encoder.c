/* Encoder counters against a model that looks at the pins at every clock. */
#include "check.h"
#include "encoder.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { UNIT = 64 }; /* phases here are whole 64ths of a line, so that all sums are exact */

static int64_t floor_mod(int64_t a, int64_t b)
{
    int64_t r = a % b;
    return r < 0 ? r + b : r;
}

struct pins {
    int a, b, c;
};

/* The lines of an ideal encoder at `num / den` 64ths of a line, index in the first quarter. */
static struct pins source(int64_t num, int64_t den, int32_t index_lines)
{
    int64_t p = floor_mod(num, den * UNIT), turn = floor_mod(num, den * UNIT * index_lines);
    return (struct pins){ p < den * UNIT / 2, p >= den * UNIT / 4 && p < den * UNIT * 3 / 4,
                          turn < den * UNIT / 4 };
}

/* A shift register per pin: a level is taken when the last `filter` looks agree. */
struct filter {
    int level, last, stood;
};

static int filtered(struct filter *f, int pin, int clocks)
{
    if (f->stood >= clocks) /* it has stood the looks before this one */
        f->level = f->last;
    f->stood = pin == f->last ? f->stood + 1 : 1;
    f->last = pin;
    if (clocks == 0)
        f->level = pin;
    return f->level;
}

struct decoder {
    struct encoder_config c;
    bool low; /* the index is ON when low, behind the wiring */
    struct filter f[3];
    int a, b, index;
    int64_t x[5]; /* count at rate 1, 2, 4 */
    int64_t compare;
    int reached;
    int64_t compare_clock, index_clock, index_count;
    int32_t indices;
};

static void wire(const struct decoder *d, struct pins *p)
{
    const struct encoder_config *c = &d->c;
    p->a ^= (c->wiring & LINES_A_INVERSE) != 0;
    p->b ^= (c->wiring & LINES_B_INVERSE) != 0;
    p->c ^= (c->wiring & ENCODER_C_INVERSE) != 0;
    p->c ^= d->low;
    if (c->wiring & LINES_SWAP) {
        int a = p->a;
        p->a = p->b;
        p->b = a;
    }
}

/* Decoders as in a data sheet. x4: all edges. x2: edges of A. x1: the edge of A while B is low. */
static void count(struct decoder *d, int a, int b)
{
    if (a != d->a && b != d->b) {
        ; /* no step of the code */
    } else if (a != d->a) {
        int up = a != b; /* A rises with B low, or falls with B high */
        d->x[4] += up ? 1 : -1;
        d->x[2] += up ? 1 : -1;
        if (!b)
            d->x[1] += up ? 1 : -1;
    } else if (b != d->b) {
        d->x[4] += a == b ? 1 : -1;
    }
    d->a = a;
    d->b = b;
}

static void look(struct decoder *d, struct pins p, int64_t clock)
{
    wire(d, &p);
    int a = filtered(&d->f[0], p.a, d->c.filter), b = filtered(&d->f[1], p.b, d->c.filter);
    int index = filtered(&d->f[2], p.c, d->c.filter);
    count(d, a, b);
    int64_t now = d->x[d->c.rate];
    if (now >= d->compare && !d->reached)
        d->compare_clock = clock;
    d->reached = now >= d->compare;
    if (index && !d->index) {
        d->indices++;
        d->index_clock = clock;
        d->index_count = now;
    }
    d->index = index;
}

static void begin(struct decoder *d, const struct encoder_config *c, bool low, struct pins p)
{
    *d = (struct decoder){ .c = *c, .low = low, .compare_clock = -1, .index_clock = -1 };
    wire(d, &p);
    int pin[3] = { p.a, p.b, p.c };
    for (int i = 0; i < 3; i++)
        d->f[i] = (struct filter){ pin[i], pin[i], 1 << 20 };
    d->a = p.a;
    d->b = p.b;
    d->index = p.c;
}

static int64_t next_place(uint64_t *seed, int piece, int64_t at, int64_t fastest)
{
    int64_t way = check_random(seed, -fastest, fastest);
    if (piece % 3 == 0)
        way = fastest - check_random(seed, 0, fastest / 8); /* near the limit of the filter */
    if (piece % 7 == 0)
        way = check_random(seed, -UNIT / 2, UNIT / 2); /* trembling */
    if (piece % 13 == 0)
        way = -floor_mod(at, UNIT) + UNIT * (piece % 3 - 1); /* exactly on an edge */
    if (piece % 11 == 0)
        way = 0;
    if (llabs(way) > fastest)
        way = fastest;
    return at + way;
}

/* A path of straight pieces, sampled at each joint; the pins looked at every clock in between. */
static void against_brute_force(uint64_t seed, const struct encoder_config *c, bool overload)
{
    struct encoder e;
    struct decoder d;
    encoder_reset(&e, c);
    e.index_low = seed % 2;
    int64_t at = check_random(&seed, -5000, 5000), clock = check_random(&seed, 0, 1000);
    begin(&d, c, e.index_low, source(at, 1, c->index_lines));
    encoder_sample(&e, (double)at / UNIT, clock);
    d.compare = check_random(&seed, 1, 300);
    encoder_set_compare(&e, true, (int32_t)d.compare, clock);
    int64_t lost_before = 0;
    for (int piece = 0; piece < 200; piece++) {
        int64_t span = check_random(&seed, 200, 400);
        int64_t half = c->filter > 2 ? c->filter : 2; /* [clocks] shortest half line period */
        int64_t fastest = span * UNIT / 2 / half * (overload ? 3 : 1);
        fastest = fastest < span * UNIT / 4 ? fastest : span * UNIT / 4; /* an edge a clock */
        int64_t to = next_place(&seed, piece, at, fastest);
        int32_t indices = d.indices, seen = e.index_seen;
        int64_t compared = d.compare_clock;
        for (int64_t n = 1; n <= span; n++)
            look(&d, source(at * span + (to - at) * n, span, c->index_lines), clock + n);
        CHECK(encoder_sample(&e, (double)to / UNIT, clock + span));
        int events = encoder_run(&e, clock + check_random(&seed, 1, span));
        events |= encoder_run(&e, clock + span);
        CHECK_EQ(e.count, d.x[c->rate]);
        CHECK_EQ(e.index_seen - seen, d.indices - indices);
        CHECK_EQ((events & ENCODER_INDEX) != 0, d.indices != indices);
        if (d.indices > 0) {
            CHECK_EQ(e.index_clock, d.index_clock);
            CHECK_EQ(e.index_count, d.index_count);
        }
        CHECK_EQ((events & ENCODER_COMPARE) != 0, d.compare_clock != compared);
        if (d.compare_clock >= 0)
            CHECK_EQ(e.compare_clock, d.compare_clock);
        CHECK_EQ(e.reached, d.reached);
        if (!overload)
            CHECK(!e.too_fast);
        lost_before += e.too_fast;
        at = to;
        clock += span;
        if (check_failures > 20)
            return;
    }
    CHECK(!overload || lost_before > 0);
}

static int go(struct encoder *e, double phase, int64_t clock)
{
    CHECK(encoder_sample(e, phase, clock));
    return encoder_run(e, clock);
}

static void start_rate_and_range(void)
{
    struct encoder e, before;
    encoder_reset(&e, &(struct encoder_config){ ENCODER_AB, 4, 0, 0, 10 });
    CHECK_EQ(go(&e, -3.3, 0), 0); /* floor(-13.2) = -14 */
    CHECK_EQ(e.count, 0);
    CHECK_EQ(go(&e, 1e15, 4000), ENCODER_INDEX);
    CHECK_EQ(e.count, 4000000000000000 + 14);
    CHECK(e.too_fast);
    before = e;
    CHECK(!encoder_sample(&e, 2e15, 8000));
    CHECK(!encoder_sample(&e, NAN, 8000));
    CHECK(!encoder_sample(&e, -INFINITY, 8000));
    CHECK(memcmp(&e, &before, sizeof e) == 0);
    go(&e, -1e15, 12000);
    CHECK_EQ(e.count, -4000000000000000 + 14);
    encoder_clear(&e, 12000);
    CHECK(!e.too_fast);
    go(&e, -1e15 + 1.0, 16000);
    CHECK_EQ(e.count, 4);
    for (int i = 0; i < 2; i++) {
        struct encoder_config c = { i ? ENCODER_NONE : ENCODER_AB, i ? 4 : 0, 0, 0, 10 };
        encoder_reset(&e, &c);
        go(&e, 0.0, 0);
        CHECK_EQ(go(&e, 1000.0, 40000), 0);
        CHECK_EQ(e.count, 0);
    }
}

/* A signal far beyond the filter costs a few edges, not millions, and is told. */
/* Pulled out in motion and put back three turns later: the counts of the way between are lost, and
 * the index stays where it is on the shaft. */
static void plug_out_and_in(void)
{
    struct encoder e;
    const struct encoder_config c = { .rate = 4, .index_lines = 100 };
    encoder_reset(&e, &c);
    CHECK_EQ(go(&e, 0.5, 0), 0);
    CHECK_EQ(go(&e, 10.5, 4000), 0);
    CHECK_EQ(e.count, 40);
    for (int i = 1; i <= 30; i++) { /* over three marks */
        CHECK(encoder_unplugged(&e, 10.5 + 10.0 * i, 4000 + 4000 * i));
        CHECK_EQ(encoder_run(&e, 4000 + 4000 * i), 0);
        CHECK_EQ(e.count, 40);
    }
    CHECK_EQ(e.index_seen, 0);
    CHECK(!encoder_unplugged(&e, NAN, 128000));
    CHECK_EQ(go(&e, 390.5, 128000), 0);
    CHECK_EQ(e.count, 40 + 320);
    CHECK_EQ(go(&e, 410.5, 132000), ENCODER_INDEX); /* at 400 lines of the shaft */
    CHECK_EQ(e.index_count, 40 + 320 + 38);
}

static void overload_ends(void)
{
    struct encoder e;
    encoder_reset(&e, &(struct encoder_config){ ENCODER_AB, 4, 0, 40, 2500 });
    go(&e, 0.0, 0);
    go(&e, 1e15, 4000);
    CHECK(e.too_fast);
    CHECK(llabs(e.count) < 10);
    for (int i = 0; i < 100; i++)
        go(&e, (double)(i + 1) * 0.5 + 1e15, 4000 + 400 * (i + 1));
    CHECK(llabs(e.count - 200) < 14);
    for (int i = 1; i <= 10; i++) /* ten lines a sample, which the filter lets pass */
        go(&e, 10.0 * i + 50.0 + 1e15, 44000 + 4000 * i);
    CHECK(llabs(e.count - 600) < 14);
    CHECK(e.too_fast); /* until it is cleared */
}

/* Swap turns the direction round; so does one inverted line, and two leave it. */
static void wiring_and_formats(void)
{
    static const struct {
        enum encoder_format format;
        uint32_t wiring;
        int32_t rate;
        int want;
    } ROW[] = {
        { ENCODER_AB, 0, 4, 40 },
        { ENCODER_AB, LINES_SWAP, 4, -40 },
        { ENCODER_AB, LINES_A_INVERSE, 4, -40 },
        { ENCODER_AB, LINES_A_INVERSE | LINES_B_INVERSE, 4, 40 },
        { ENCODER_CW_CCW, 0, 1, 10 },
        { ENCODER_CW_CCW, LINES_SWAP, 1, -10 },
        { ENCODER_CW_CCW, LINES_A_INVERSE, 2, 20 },
        { ENCODER_PULSE_DIRECTION, 0, 4, 20 },
        { ENCODER_PULSE_DIRECTION, LINES_B_INVERSE, 1, -10 },
    };
    for (size_t i = 0; i < sizeof ROW / sizeof ROW[0]; i++) {
        struct encoder_config c = { ROW[i].format, ROW[i].rate, ROW[i].wiring, 0, 100 };
        struct encoder e;
        CHECK_EQ(encoder_check(&c), ENCODER_OK);
        encoder_reset(&e, &c);
        go(&e, 0.1, 0);
        go(&e, 10.1, 4000);
        CHECK_EQ(e.count, ROW[i].want);
        go(&e, 0.1, 8000);
        CHECK_EQ(e.count, 0);
    }
}

static void compare_and_clear(void)
{
    struct encoder e;
    encoder_reset(&e, &(struct encoder_config){ ENCODER_AB, 4, 0, 0, 100 });
    go(&e, 0.0, 0);
    CHECK_EQ(encoder_set_compare(&e, true, 10, 0), 0);
    CHECK_EQ(go(&e, 2.75, 400), ENCODER_COMPARE); /* 11 counts: passed it */
    CHECK_EQ(e.compare_clock, 364);               /* ceil(400 * 2.5 / 2.75) */
    CHECK_EQ(go(&e, 5.0, 800), 0);                /* once */
    CHECK_EQ(go(&e, 1.0, 1200), 0);
    CHECK_EQ(go(&e, 2.5, 1600), ENCODER_COMPARE);                      /* reached again */
    CHECK_EQ(encoder_set_compare(&e, true, 5, 1600), ENCODER_COMPARE); /* by the write */
    CHECK_EQ(encoder_set_compare(&e, true, 5, 1600), 0);               /* the same write again */
    CHECK_EQ(encoder_set_compare(&e, false, 5, 1600), 0);
    CHECK_EQ(go(&e, 0.5, 2000), 0);
    CHECK_EQ(go(&e, 9.0, 2400), 0);
    CHECK_EQ(encoder_set_compare(&e, true, 0, 2400), ENCODER_COMPARE);
    CHECK_EQ(go(&e, -1.0, 3600), ENCODER_INDEX);
    CHECK_EQ(encoder_clear(&e, 3600), ENCODER_COMPARE); /* -4 becomes 0 */
}

static void refusals(void)
{
    struct encoder_config good = { ENCODER_AB, 4, 0, 0, 100 }, c = good;
    CHECK_EQ(encoder_check(&c), ENCODER_OK);
    c.format = (enum encoder_format)4;
    CHECK_EQ(encoder_check(&c), ENCODER_BAD_FORMAT);
    c.format = (enum encoder_format) - 1;
    CHECK_EQ(encoder_check(&c), ENCODER_BAD_FORMAT);
    c = good;
    c.rate = 3;
    CHECK_EQ(encoder_check(&c), ENCODER_BAD_RATE);
    c = good;
    c.wiring = 16;
    CHECK_EQ(encoder_check(&c), ENCODER_BAD_WIRING);
    c.format = ENCODER_PULSE_DIRECTION;
    c.wiring = LINES_SWAP;
    CHECK_EQ(encoder_check(&c), ENCODER_BAD_WIRING);
    c = good;
    c.filter = -1;
    CHECK_EQ(encoder_check(&c), ENCODER_BAD_FILTER);
    c.filter = ENCODER_FILTER_MAX + 1;
    CHECK_EQ(encoder_check(&c), ENCODER_BAD_FILTER);
    c = good;
    c.index_lines = 0;
    CHECK_EQ(encoder_check(&c), ENCODER_BAD_INDEX);
}

int main(void)
{
    static const int32_t RATE[] = { 1, 2, 4 }, FILTER[] = { 0, 1, 2, 3, 7, 20, 40, 100 };
    for (uint32_t wiring = 0; wiring < 16; wiring++)
        for (int i = 0; i < 8; i++) {
            struct encoder_config c = { ENCODER_AB, RATE[(wiring + (uint32_t)i) % 3], wiring,
                                        FILTER[i], 1 + i % 5 };
            against_brute_force(104729u * (wiring + 1u) + (unsigned)i, &c, false);
            if (c.filter > 2) /* below, an edge a clock is not too fast */
                against_brute_force(130363u * (wiring + 1u) + (unsigned)i, &c, true);
        }
    start_rate_and_range();
    plug_out_and_in();
    overload_ends();
    wiring_and_formats();
    compare_and_clear();
    refusals();
    return check_result();
}
