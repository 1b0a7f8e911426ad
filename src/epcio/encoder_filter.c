#include "encoder_parts.h"

#include <math.h>

/* A line is seen `filter` clocks after its edge if it has not changed again before. A and B change
 * at alternate edges, so all edges pass while two quarters take `filter` clocks or more. */

static int64_t least(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/* A pin changes. If the change before was not seen yet, it never will be. */
static void pin_edge(struct encoder_line *l, int64_t clock)
{
    l->pin = !l->pin;
    l->edge = clock;
}

static void raw_edge(struct encoder *e, int way, int64_t clock)
{
    int64_t upper = way > 0 ? e->raw + 1 : e->raw;
    pin_edge(&e->line[upper & 1 ? B : A], clock);
    e->raw += way;
    e->walked++;
    if (encoder_index_high(e, e->raw) != e->line[C].pin)
        pin_edge(&e->line[C], clock);
}

/* [clock] at which a line's latest edge is seen; INT64_MAX if there is nothing to see. */
static int64_t sight(const struct encoder *e, int line)
{
    const struct encoder_line *l = &e->line[line];
    return l->pin != l->level ? l->edge + e->config.filter : INT64_MAX;
}

/* Lines change behind the filter at `clock`. Both at once is no step of the code: no count. */
static int see(struct encoder *e, int64_t clock)
{
    bool a = sight(e, A) == clock, b = sight(e, B) == clock, index = sight(e, C) == clock;
    int events = 0;
    if (a && b) {
        int64_t before = encoder_counting_edges(e);
        e->seen += 2;
        e->zero += encoder_counting_edges(e) - before;
        e->too_fast = true;
    } else if (a || b) {
        bool rises = a ? e->line[A].pin : e->line[B].pin;
        bool up = a ? rises != e->line[B].level : rises == e->line[A].level;
        e->seen += up ? 1 : -1;
    }
    for (int i = A; i <= B; i++)
        if (i == A ? a : b)
            e->line[i].level = e->line[i].pin;
    if (a || b) {
        e->count = encoder_counting_edges(e) - e->zero;
        events |= encoder_compare(e, clock);
    }
    if (index)
        events |= encoder_show_index(e, e->line[C].pin, clock);
    return events;
}

/* Many like edges in a row need not be walked: either all are seen or none. Whole line periods are
 * skipped, up to a few edges before the end or before one that means something if it is seen. */
static void skip(struct encoder *e, int way, int64_t left)
{
    enum { MARGIN = 8, SETTLED = 4 };
    if (e->walked < SETTLED || e->line[C].pin || e->line[C].level)
        return;     /* what came before may still stand in the filter */
    double half = 0.5 * (double)(e->clock - e->from_clock) / fabs(e->to - e->from);  /* [clocks] */
    bool all = half >= e->config.filter;
    bool none = half <= e->config.filter - 1;
    if (all)
        left = least(left, least(encoder_edges_to_index(e, way), encoder_edges_to_compare(e, way)));
    int64_t many = (left - MARGIN) & ~(int64_t)3, waiting = way * (e->raw - e->seen - e->lost);
    if (encoder_index_high(e, e->raw + way * many))
        many -= 4;
    if (many < 4 || !(all || none) || (all && waiting < 0))
        return;
    e->raw += way * many;
    for (int n = -1; n <= 0; n++) {         /* the two edges just passed */
        int64_t upper = way > 0 ? e->raw + n : e->raw - n + 1;
        struct encoder_line *l = &e->line[upper & 1 ? B : A];
        l->edge = encoder_edge_clock(e, upper);
        if (all)
            l->level = !l->pin;             /* both still to be seen */
    }
    if (all)
        e->seen += way * (many + waiting - 2);
    else
        e->lost += way * many;
    e->too_fast = e->too_fast || !all;
    e->count = encoder_counting_edges(e) - e->zero;
    e->walked = 0;
}

/* More than an edge a clock: nothing stands long enough to be seen, and the pins start anew. */
int encoder_run_blind(struct encoder *e, int way, int64_t until)
{
    int64_t n = encoder_edges_until(e, way, until);
    if (n == 0)
        return 0;
    e->too_fast = true;
    e->raw += way * n;
    e->line[A].pin = encoder_a_high(e->raw);
    e->line[B].pin = encoder_b_high(e->raw);
    e->line[C].pin = encoder_index_high(e, e->raw);
    for (int i = A; i <= C; i++)
        e->line[i].edge = until;
    e->lost = (e->raw - e->seen) & ~(int64_t)3;
    return 0;
}

/* At most one edge of A and one of B wait to be seen: with three behind, a line period is lost. */
static void note_loss(struct encoder *e)
{
    int64_t behind = e->raw - e->seen - e->lost;
    if (behind > 2 || behind < -2) {
        e->too_fast = true;
        e->lost += behind > 0 ? 4 : -4;
    }
}

int encoder_run_filtered(struct encoder *e, int way, int64_t until)
{
    int events = 0;
    int64_t left = encoder_edges_until(e, way, until);
    for (;;) {
        int64_t due = least(least(sight(e, A), sight(e, B)), sight(e, C));
        int64_t next = left > 0 ? encoder_nth_clock(e, way, 1) : INT64_MAX;
        if (least(due, next) > until)
            return events;
        if (due <= next) {
            events |= see(e, due);
            continue;
        }
        raw_edge(e, way, next);
        left--;
        note_loss(e);
        int64_t before = e->raw;
        skip(e, way, left);
        left -= way * (e->raw - before);
    }
}
