#include "encoder_parts.h"

#include <math.h>

/* The lines as a function of phase, in quarters q = floor(4 phase): A is high in q mod 4 = 0, 1,
 * B in 1, 2, so A leads going up; the index is high in the first quarter of every index_lines.
 *
 * x4 counts every edge of A and B, x2 those of A, x1 the one of A that happens while B is low, at
 * the same place in both directions: a decoder that counted the rising edge both ways would drift
 * when the shaft trembles. So a counter is floor((q - shift) / share), turned round if the wiring
 * turns the direction round. Pulses count the same way: one per line period, halfway high, so that
 * x2 counts both edges of a pulse, and there is no x4. */

static int64_t floor_divide(int64_t a, int64_t b)
{
    return a / b - (a % b < 0);
}

static int64_t modulo(int64_t a, int64_t b)
{
    return a - b * floor_divide(a, b);
}

bool encoder_a_high(int64_t quarter)
{
    return (quarter & 2) == 0;
}

bool encoder_b_high(int64_t quarter)
{
    return ((quarter + 1) & 2) != 0;
}

bool encoder_index_high(const struct encoder *e, int64_t quarter)
{
    return modulo(quarter, 4 * (int64_t)e->config.index_lines) == 0;
}

enum encoder_status encoder_check(const struct encoder_config *c)
{
    if ((int)c->format < ENCODER_AB || c->format > ENCODER_NONE)
        return ENCODER_BAD_FORMAT;
    if (c->rate != 0 && c->rate != 1 && c->rate != 2 && c->rate != 4)
        return ENCODER_BAD_RATE;
    if (c->wiring > 15 || (c->format == ENCODER_PULSE_DIRECTION && (c->wiring & ENCODER_SWAP)))
        return ENCODER_BAD_WIRING;
    if (c->filter < 0 || c->filter > ENCODER_FILTER_MAX)
        return ENCODER_BAD_FILTER;
    return c->index_lines < 1 ? ENCODER_BAD_INDEX : ENCODER_OK;
}

/* Lines A and B after inversion and swap: bit 0 and 1. */
static int wired(uint32_t wiring, int quarter)
{
    int a = encoder_a_high(quarter) != ((wiring & ENCODER_A_INVERSE) != 0);
    int b = encoder_b_high(quarter) != ((wiring & ENCODER_B_INVERSE) != 0);
    return wiring & ENCODER_SWAP ? b | a << 1 : a | b << 1;
}

/* What the wiring does to direction and place of the counting edges. */
static void decode(struct encoder *e)
{
    static const int ORDER[] = {3, 0, 2, 1};    /* place of (A, B) in the forward sequence */
    const struct encoder_config *c = &e->config;
    e->sign = 1;
    e->shift = 0;
    if (c->format != ENCODER_AB) {
        uint32_t turn = c->format == ENCODER_CW_CCW ? ENCODER_SWAP : ENCODER_B_INVERSE;
        e->sign = c->wiring & turn ? -1 : 1;
        e->share = c->rate == 1 ? 4 : 2;
        return;
    }
    e->share = c->rate == 0 ? 4 : 4 / c->rate;
    if (modulo(ORDER[wired(c->wiring, 1)] - ORDER[wired(c->wiring, 0)], 4) != 1)
        e->sign = -1;
    for (int q = 3; q >= 0 && c->rate < 4; q--) {
        int before = wired(c->wiring, (q + 3) % 4), after = wired(c->wiring, q);
        bool a_edge = ((before ^ after) & 1) != 0, b_low = (after & 2) == 0;
        if (a_edge && (c->rate == 2 || b_low))
            e->shift = q;
    }
}

void encoder_reset(struct encoder *e, const struct encoder_config *c)
{
    *e = (struct encoder){.config = *c, .index_first = -1};
    decode(e);
}

int64_t encoder_counting_edges(const struct encoder *e)
{
    return e->sign * floor_divide(e->seen - e->shift, e->share);
}

/* The pins as they stand are what is seen. */
static void settle(struct encoder *e)
{
    e->raw = e->seen = e->raw_end;
    e->lost = 0;
    e->line[A].pin = e->line[A].level = encoder_a_high(e->raw);
    e->line[B].pin = e->line[B].level = encoder_b_high(e->raw);
    e->line[C].pin = e->line[C].level = encoder_index_high(e, e->raw);
    e->zero = encoder_counting_edges(e) - e->count;
}

void encoder_configure(struct encoder *e, const struct encoder_config *c)
{
    e->config = *c;
    decode(e);
    settle(e);
}

int encoder_compare(struct encoder *e, int64_t clock)
{
    bool was = e->reached;
    e->reached = e->compare_on && e->count >= e->compare;
    if (!e->reached || was)
        return 0;
    e->compare_clock = clock;
    return ENCODER_COMPARE;
}

int encoder_clear(struct encoder *e, int64_t clock)
{
    e->zero = encoder_counting_edges(e);
    e->count = 0;
    e->too_fast = false;
    return encoder_compare(e, clock);
}

int encoder_set_compare(struct encoder *e, bool on, int32_t value, int64_t clock)
{
    if (on == e->compare_on && value == e->compare)
        return 0;
    e->compare_on = on;
    e->compare = value;
    e->reached = false;     /* a new value is a new condition */
    return encoder_compare(e, clock);
}

int64_t encoder_edge(double from, double to, int64_t span, double edge)
{
    /* Compare products, not quotients: (to - from) n against (edge - from) span. */
    double way = fabs(to - from);
    double need = fabs(edge - from) * (double)span;
    bool up = to > from;
    int64_t n = (int64_t)(need / way);  /* never beyond: rounding can only reach the next whole */
    while (up ? way * (double)n < need : way * (double)n <= need)
        n++;
    return n < 1 ? 1 : n > span ? span : n;
}

/* [clock] at which the edge between quarters `upper` - 1 and `upper` was passed. */
int64_t encoder_edge_clock(const struct encoder *e, int64_t upper)
{
    return e->from_clock +
           encoder_edge(e->from, e->to, e->clock - e->from_clock, 0.25 * (double)upper);
}

/* [clock] of the n-th edge from here, n = 1 for the next; n < 1 for those behind. */
int64_t encoder_nth_clock(const struct encoder *e, int way, int64_t n)
{
    return encoder_edge_clock(e, way > 0 ? e->raw + n : e->raw - n + 1);
}

/* Edges from here to `until`. */
int64_t encoder_edges_until(const struct encoder *e, int way, int64_t until)
{
    int64_t all = way * (e->raw_end - e->raw);
    if (until >= e->clock || all == 0)
        return all;
    double share = (double)(until - e->from_clock) / (double)(e->clock - e->from_clock);
    int64_t there = (int64_t)floor(4.0 * (e->from + (e->to - e->from) * share));
    int64_t n = way * (there - e->raw);
    n = n < 0 ? 0 : n > all ? all : n;
    while (n < all && encoder_nth_clock(e, way, n + 1) <= until)
        n++;
    while (n > 0 && encoder_nth_clock(e, way, n) > until)
        n--;
    return n;
}

/* Edges from `quarter` until the index line changes. */
int64_t encoder_edges_to_index(const struct encoder *e, int way)
{
    int64_t turn = 4 * (int64_t)e->config.index_lines, place = modulo(e->raw, turn);
    return place == 0 ? 1 : way > 0 ? turn - place : place;
}

/* Edges until the comparator may change. */
int64_t encoder_edges_to_compare(const struct encoder *e, int way)
{
    if (!e->compare_on)
        return INT64_MAX;
    /* first quarter above the place where count >= compare changes */
    int64_t k = e->compare + e->zero;
    int64_t place = (e->sign > 0 ? k : 1 - k) * e->share + e->shift;
    int64_t n = way > 0 ? place - e->seen : e->seen - place + 1;
    return n > 0 ? n : INT64_MAX;
}

static int64_t least(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

static int index_pulse(struct encoder *e, int64_t clock)
{
    if (e->index_first < 0)
        e->index_first = clock;
    e->index_seen = (int32_t)((uint32_t)e->index_seen + 1u);
    e->index_clock = clock;
    e->index_count = e->count;
    return ENCODER_INDEX;
}

int encoder_show_index(struct encoder *e, bool level, int64_t clock)
{
    e->line[C].level = level;
    bool rises = (level != ((e->config.wiring & ENCODER_C_INVERSE) != 0)) != e->index_low;
    return rises ? index_pulse(e, clock) : 0;
}

/* Without a filter: in one go as far as nothing can happen, then an edge that may matter. */
static int run_plain(struct encoder *e, int way, int64_t until)
{
    int events = 0;
    int64_t left = encoder_edges_until(e, way, until);
    while (left > 0) {
        int64_t free = least(encoder_edges_to_index(e, way), encoder_edges_to_compare(e, way)) - 1;
        int64_t step = free > 0 ? least(left, free) : 1;
        int64_t clock = free > 0 ? 0 : encoder_nth_clock(e, way, 1);
        e->raw += way * step;
        e->seen = e->raw;
        left -= step;
        if (free > 0)
            continue;
        e->count = encoder_counting_edges(e) - e->zero;
        events |= encoder_compare(e, clock);
        if (encoder_index_high(e, e->raw) != e->line[C].level)
            events |= encoder_show_index(e, !e->line[C].level, clock);
    }
    e->count = encoder_counting_edges(e) - e->zero;
    return events;
}

/* More than an edge a clock: the count is kept; index and compare are looked at in the end only. */
static int run_aliased(struct encoder *e, int way, int64_t until)
{
    int64_t n = encoder_edges_until(e, way, until);
    bool index = n >= encoder_edges_to_index(e, way);
    if (n == 0)
        return 0;
    e->too_fast = true;
    e->raw += way * n;
    e->seen = e->raw;
    e->count = encoder_counting_edges(e) - e->zero;
    e->line[C].level = encoder_index_high(e, e->raw);
    return encoder_compare(e, until) | (index ? index_pulse(e, until) : 0);
}

bool encoder_sample(struct encoder *e, double phase, int64_t clock)
{
    if (!(fabs(phase) <= ENCODER_PHASE_MAX))
        return false;
    e->from = e->primed ? e->to : phase;
    e->from_clock = e->primed ? e->clock : clock;
    e->to = phase;
    e->clock = clock;
    e->raw_end = (int64_t)floor(4.0 * phase);
    e->walked = 0;
    e->index_first = -1;
    if (!e->primed || e->config.rate == 0 || e->config.format == ENCODER_NONE)
        settle(e);      /* an input that is off follows the shaft without counting */
    e->primed = true;
    return true;
}

int encoder_run(struct encoder *e, int64_t until)
{
    if (!e->primed)
        return 0;
    int way = e->raw_end > e->raw ? 1 : -1;
    bool aliased = 4.0 * fabs(e->to - e->from) > (double)(e->clock - e->from_clock);
    if (e->config.filter > 0)
        return aliased ? encoder_run_blind(e, way, until) : encoder_run_filtered(e, way, until);
    if (e->raw == e->raw_end)
        return 0;
    return aliased ? run_aliased(e, way, until) : run_plain(e, way, until);
}
