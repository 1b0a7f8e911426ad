#include "encoder.h"

#include <math.h>

#include "encoder_filter.h"

const char *encoder_status_text(enum encoder_status status)
{
    switch (status) {
    case ENCODER_BAD_FORMAT: return "the encoder format is 0 to 3";
    case ENCODER_BAD_RATE:   return "an encoder multiplies by 0, 1, 2 or 4";
    case ENCODER_BAD_WIRING:
        return "the encoder wiring is a sum of 1, 2, 4, 8; pulse and direction cannot be swapped";
    case ENCODER_BAD_FILTER: return "the encoder filter is 0 to 65535 clocks";
    default:                 return "there is at least one line period between two index pulses";
    }
}

enum encoder_status encoder_check(const struct encoder_config *c)
{
    if ((int)c->format < ENCODER_AB || c->format > ENCODER_NONE)
        return ENCODER_BAD_FORMAT;
    if (c->rate != 0 && c->rate != 1 && c->rate != 2 && c->rate != 4)
        return ENCODER_BAD_RATE;
    if (c->wiring > 15 || (c->format == ENCODER_PULSE_DIRECTION && (c->wiring & LINES_SWAP)))
        return ENCODER_BAD_WIRING;
    if (c->filter < 0 || c->filter > ENCODER_FILTER_MAX)
        return ENCODER_BAD_FILTER;
    return c->index_lines < 1 ? ENCODER_BAD_INDEX : ENCODER_OK;
}

void encoder_reset(struct encoder *e, const struct encoder_config *c)
{
    *e = (struct encoder){ .config = *c, .index_first = -1 };
    encoder_decode(e);
}

/* Let the filter see the levels at the pins at once, without counting. */
static void settle(struct encoder *e)
{
    e->pins.quarter = e->seen = e->pins.end;
    e->lost = 0;
    const struct lines l = quadrature_lines(&e->pins);
    e->a.pin = e->a.level = l.a;
    e->b.pin = e->b.level = l.b;
    e->index.pin = e->index.level = encoder_index_high(e, e->pins.quarter);
    e->zero = encoder_counting_edges(e) - e->count;
}

void encoder_configure(struct encoder *e, const struct encoder_config *c)
{
    e->config = *c;
    encoder_decode(e);
    settle(e);
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
    e->reached = false; /* a new value is a new condition */
    return encoder_compare(e, clock);
}

static int64_t least(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/* Count without a filter. Edges before the next index or compare event are counted in one go; the
 * edge that may bring an event is counted by itself, at its clock. */
static int run_plain(struct encoder *e, int way, int64_t until)
{
    int events = 0;
    int64_t left = quadrature_until(&e->pins, way, until);
    while (left > 0) {
        int64_t free = least(encoder_edges_to_index(e, way), encoder_edges_to_compare(e, way)) - 1;
        int64_t step = free > 0 ? least(left, free) : 1;
        int64_t clock = free > 0 ? 0 : quadrature_nth(&e->pins, way, 1);
        e->pins.quarter += way * step;
        e->seen = e->pins.quarter;
        left -= step;
        if (free > 0)
            continue;
        e->count = encoder_counting_edges(e) - e->zero;
        events |= encoder_compare(e, clock);
        if (encoder_index_high(e, e->pins.quarter) != e->index.level)
            events |= encoder_show_index(e, !e->index.level, clock);
    }
    e->count = encoder_counting_edges(e) - e->zero;
    return events;
}

/* Count without a filter at more than one edge per clock: the count stays right, but index and
 * comparator are evaluated only once, at `until`. */
static int run_aliased(struct encoder *e, int way, int64_t until)
{
    int64_t n = quadrature_until(&e->pins, way, until);
    bool index = n >= encoder_edges_to_index(e, way);
    if (n == 0)
        return 0;
    e->too_fast = true;
    e->pins.quarter += way * n;
    e->seen = e->pins.quarter;
    e->count = encoder_counting_edges(e) - e->zero;
    e->index.level = encoder_index_high(e, e->pins.quarter);
    return encoder_compare(e, until) | (index ? encoder_index_pulse(e, until) : 0);
}

bool encoder_sample(struct encoder *e, double phase, int64_t clock)
{
    if (!(fabs(phase) <= QUADRATURE_PHASE_MAX))
        return false;
    const bool first = !e->pins.primed;
    quadrature_sample(&e->pins, phase, clock);
    e->walked = 0;
    e->index_first = -1;
    if (first || e->config.rate == 0 || e->config.format == ENCODER_NONE)
        settle(e); /* an input that is off follows the shaft without counting */
    return true;
}

bool encoder_unplugged(struct encoder *e, double phase, int64_t clock)
{
    if (!encoder_sample(e, phase, clock))
        return false;
    settle(e);
    return true;
}

int encoder_run_on(struct encoder *e, int64_t until)
{
    const struct quadrature *q = &e->pins;
    if (!q->primed)
        return 0;
    int way = q->end > q->quarter ? 1 : -1;
    bool aliased = 4.0 * fabs(q->to - q->from) > (double)(q->clock - q->from_clock);
    if (e->config.filter > 0)
        return aliased ? encoder_run_blind(e, way, until) : encoder_run_filtered(e, way, until);
    return aliased ? run_aliased(e, way, until) : run_plain(e, way, until);
}
