#include "encoder_count.h"

/* The lines as a function of phase, in quarters q = floor(4 phase): A and B as in lines.h; the
 * index is high in the first quarter of every index_lines.
 *
 * x4 counts every edge of A and B, x2 those of A, x1 the one of A that happens while B is low, at
 * the same place in both directions. A decoder that counted the rising edge both ways would drift
 * when the shaft trembles. So a counter is floor((q - shift) / share), turned round if the wiring
 * turns the direction round. Pulses count the same way: one per line period, halfway high, so that
 * x2 counts both edges of a pulse, and there is no x4. */

static int64_t modulo(int64_t a, int64_t b)
{
    return a - b * floor_divide(a, b);
}

bool encoder_index_high(const struct encoder *e, int64_t quarter)
{
    return modulo(quarter, 4 * (int64_t)e->config.index_lines) == 0;
}

/* Levels of the lines at the counter, behind the wiring: A in bit 0, B in bit 1. */
static int wired(uint32_t wiring, int quarter)
{
    struct lines l = lines_wired(lines_of_quarter(quarter), wiring);
    return l.a | l.b << 1;
}

void encoder_decode(struct encoder *e)
{
    static const int ORDER[] = { 3, 0, 2, 1 }; /* place of (A, B) in the forward sequence */
    const struct encoder_config *c = &e->config;
    e->sign = 1;
    e->shift = 0;
    if (c->format != ENCODER_AB) {
        uint32_t turn = c->format == ENCODER_CW_CCW ? LINES_SWAP : LINES_B_INVERSE;
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

int encoder_compare(struct encoder *e, int64_t clock)
{
    bool was = e->reached;
    e->reached = e->compare_on && e->count >= e->compare;
    if (!e->reached || was)
        return 0;
    e->compare_clock = clock;
    return ENCODER_COMPARE;
}

int64_t encoder_edges_to_index(const struct encoder *e, int way)
{
    int64_t turn = 4 * (int64_t)e->config.index_lines, place = modulo(e->pins.quarter, turn);
    return place == 0 ? 1 : way > 0 ? turn - place : place;
}

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

int encoder_index_pulse(struct encoder *e, int64_t clock)
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
    e->index.level = level;
    bool rises = (level != ((e->config.wiring & ENCODER_C_INVERSE) != 0)) != e->index_low;
    return rises ? encoder_index_pulse(e, clock) : 0;
}
