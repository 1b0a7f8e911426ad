#include "quadrature.h"

#include <math.h>

enum quadrature_status quadrature_check(const struct quadrature *q, double phase, int64_t clock)
{
    if (!(fabs(phase) <= QUADRATURE_PHASE_MAX))
        return QUADRATURE_BAD_PHASE;
    const int64_t way = (int64_t)floor(4.0 * phase) - q->end;
    const bool fast = q->primed && (way < 0 ? -way : way) > clock - q->clock;
    return fast ? QUADRATURE_TOO_FAST : QUADRATURE_OK;
}

/* First clock, in 1 .. span, at which a phase that moves on a straight line from `from` at clock 0
 * to `to` at clock `span` has passed `edge`, a phase between them. Going up, the edge itself
 * belongs to the quarter above; going down, it must be left behind. */
static int64_t passed(double from, double to, int64_t span, double edge)
{
    /* Compare products, not quotients: (to - from) n against (edge - from) span. */
    const double way = fabs(to - from);
    const double need = fabs(edge - from) * (double)span;
    const bool up = to > from;
    int64_t n = (int64_t)(need / way); /* rounding can at most reach the next whole number */
    while (up ? way * (double)n < need : way * (double)n <= need)
        n++;
    return n < 1 ? 1 : n > span ? span : n;
}

int64_t quadrature_clock(const struct quadrature *q, int64_t upper)
{
    return q->from_clock + passed(q->from, q->to, q->clock - q->from_clock, 0.25 * (double)upper);
}

int64_t quadrature_nth(const struct quadrature *q, int way, int64_t n)
{
    return quadrature_clock(q, way > 0 ? q->quarter + n : q->quarter - n + 1);
}

int64_t quadrature_next(const struct quadrature *q)
{
    return q->quarter == q->end ? INT64_MAX : quadrature_nth(q, q->end > q->quarter ? 1 : -1, 1);
}

int quadrature_pass(struct quadrature *q)
{
    const int way = q->end > q->quarter ? 1 : -1;
    q->quarter += way;
    return way;
}

struct lines quadrature_lines(const struct quadrature *q)
{
    return lines_of_quarter(q->quarter);
}

int64_t quadrature_edges(const struct quadrature *q)
{
    return q->quarter - q->start;
}

int64_t quadrature_until(const struct quadrature *q, int way, int64_t until)
{
    const int64_t all = way * (q->end - q->quarter);
    if (until >= q->clock || all == 0)
        return all;
    const double share = (double)(until - q->from_clock) / (double)(q->clock - q->from_clock);
    const int64_t there = (int64_t)floor(4.0 * (q->from + (q->to - q->from) * share));
    int64_t n = way * (there - q->quarter);
    n = n < 0 ? 0 : n > all ? all : n;
    while (n < all && quadrature_nth(q, way, n + 1) <= until)
        n++;
    while (n > 0 && quadrature_nth(q, way, n) > until)
        n--;
    return n;
}
