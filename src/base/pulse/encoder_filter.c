#include "encoder_filter.h"

#include <math.h>

/* The filter passes a line's edge `filter` clocks later if the line has not changed again before. A
 * and B change at alternate edges, so all edges pass while two quarters of a line period take
 * `filter` clocks or more. */

static int64_t least(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/* A pin changes. If the filter has not passed the change before yet, it never will. */
static void pin_edge(struct encoder_line *l, int64_t clock)
{
    l->pin = !l->pin;
    l->edge = clock;
}

/* The next edge at the pins, before the filter. */
static void raw_edge(struct encoder *e, int way, int64_t clock)
{
    int64_t upper = way > 0 ? e->pins.quarter + 1 : e->pins.quarter;
    pin_edge(upper & 1 ? &e->b : &e->a, clock);
    e->pins.quarter += way;
    e->walked++;
    if (encoder_index_high(e, e->pins.quarter) != e->index.pin)
        pin_edge(&e->index, clock);
}

/* [clock] at which the filter passes a line's latest edge; INT64_MAX if it has passed already. */
static int64_t sight(const struct encoder *e, const struct encoder_line *l)
{
    return l->pin != l->level ? l->edge + e->config.filter : INT64_MAX;
}

/* The lines whose filter time ends at `clock` change behind the filter. If A and B change at once,
 * that is no step of the quadrature code and does not count. */
static int see(struct encoder *e, int64_t clock)
{
    bool a = sight(e, &e->a) == clock, b = sight(e, &e->b) == clock;
    bool index = sight(e, &e->index) == clock;
    int events = 0;
    if (a && b) {
        int64_t before = encoder_counting_edges(e);
        e->seen += 2;
        e->zero += encoder_counting_edges(e) - before;
        e->too_fast = true;
    } else if (a || b) {
        bool rises = a ? e->a.pin : e->b.pin;
        bool up = a ? rises != e->b.level : rises == e->a.level;
        e->seen += up ? 1 : -1;
    }
    if (a)
        e->a.level = e->a.pin;
    if (b)
        e->b.level = e->b.pin;
    if (a || b) {
        e->count = encoder_counting_edges(e) - e->zero;
        events |= encoder_compare(e, clock);
    }
    if (index)
        events |= encoder_show_index(e, e->index.pin, clock);
    return events;
}

/* At a constant speed the filter passes either all edges or none, so edges need not be walked one
 * by one. Skip whole line periods, up to a few edges before the end of the `left` edges or before
 * an index or compare event.
 * CCN 17: all edges or none are skipped, and each way leaves the last two to be seen. */
static void skip(struct encoder *e, int way, int64_t left)
{
    enum { MARGIN = 8, SETTLED = 4 };
    if (e->walked < SETTLED || e->index.pin || e->index.level)
        return; /* edges at another speed may still wait in the filter */
    const struct quadrature *q = &e->pins;
    double half = 0.5 * (double)(q->clock - q->from_clock) / fabs(q->to - q->from); /* [clocks] */
    bool all = half >= e->config.filter;
    bool none = half <= e->config.filter - 1;
    if (all)
        left = least(left, least(encoder_edges_to_index(e, way), encoder_edges_to_compare(e, way)));
    int64_t many = (left - MARGIN) & ~(int64_t)3;
    int64_t waiting = way * (q->quarter - e->seen - e->lost);
    if (encoder_index_high(e, e->pins.quarter + way * many))
        many -= 4;
    if (many < 4 || !(all || none) || (all && waiting < 0))
        return;
    e->pins.quarter += way * many;
    for (int n = -1; n <= 0; n++) { /* the two edges just passed */
        int64_t upper = way > 0 ? e->pins.quarter + n : e->pins.quarter - n + 1;
        struct encoder_line *l = upper & 1 ? &e->b : &e->a;
        l->edge = quadrature_clock(&e->pins, upper);
        if (all)
            l->level = !l->pin; /* both edges are still in the filter */
    }
    if (all)
        e->seen += way * (many + waiting - 2);
    else
        e->lost += way * many;
    e->too_fast = e->too_fast || !all;
    e->count = encoder_counting_edges(e) - e->zero;
    e->walked = 0;
}

/* At more than one edge per clock no level lasts long enough to pass; at `until` the filter times
 * of all lines start anew. */
int encoder_run_blind(struct encoder *e, int way, int64_t until)
{
    int64_t n = quadrature_until(&e->pins, way, until);
    if (n == 0)
        return 0;
    e->too_fast = true;
    e->pins.quarter += way * n;
    const struct lines l = quadrature_lines(&e->pins);
    e->a.pin = l.a;
    e->b.pin = l.b;
    e->index.pin = encoder_index_high(e, e->pins.quarter);
    e->a.edge = e->b.edge = e->index.edge = until;
    e->lost = (e->pins.quarter - e->seen) & ~(int64_t)3;
    return 0;
}

/* At most one edge of A and one of B can be in the filter: if the counter is three edges behind the
 * pins, a line period is lost. */
static void note_loss(struct encoder *e)
{
    int64_t behind = e->pins.quarter - e->seen - e->lost;
    if (behind > 2 || behind < -2) {
        e->too_fast = true;
        e->lost += behind > 0 ? 4 : -4;
    }
}

int encoder_run_filtered(struct encoder *e, int way, int64_t until)
{
    int events = 0;
    int64_t left = quadrature_until(&e->pins, way, until);
    for (;;) {
        int64_t due = least(least(sight(e, &e->a), sight(e, &e->b)), sight(e, &e->index));
        int64_t next = left > 0 ? quadrature_nth(&e->pins, way, 1) : INT64_MAX;
        if (least(due, next) > until)
            return events;
        if (due <= next) {
            events |= see(e, due);
            continue;
        }
        raw_edge(e, way, next);
        left--;
        note_loss(e);
        int64_t before = e->pins.quarter;
        skip(e, way, left);
        left -= way * (e->pins.quarter - before);
    }
}
