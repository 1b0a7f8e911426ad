#include "scale.h"

#include <math.h>

enum scale_status scale_sample(struct scale *s, double phase, int64_t clock)
{
    if (!(fabs(phase) <= SCALE_PHASE_MAX))
        return SCALE_BAD_PHASE;
    const int64_t quarter = (int64_t)floor(4.0 * phase);
    if (!s->primed) {
        *s = (struct scale){.primed = true, .from = phase, .to = phase, .from_clock = clock,
                            .clock = clock, .quarter = quarter, .end = quarter, .start = quarter};
        return SCALE_OK;
    }
    const int64_t way = quarter - s->end;
    if ((way < 0 ? -way : way) > clock - s->clock)
        return SCALE_TOO_FAST;
    s->from = s->to;
    s->from_clock = s->clock;
    s->to = phase;
    s->clock = clock;
    s->end = quarter;
    return SCALE_OK;
}

int64_t scale_next(const struct scale *s)
{
    if (s->quarter == s->end)
        return INT64_MAX;
    const bool up = s->end > s->quarter;
    const int64_t span = s->clock - s->from_clock;
    const double edge = 0.25 * (double)(up ? s->quarter + 1 : s->quarter);
    /* Going up the edge itself belongs to the quarter above; going down it must be left behind.
     * Compare products, not quotients: (to - from) n against (edge - from) span. */
    const double way = fabs(s->to - s->from);
    const double need = fabs(edge - s->from) * (double)span;
    int64_t n = (int64_t)(need / way);
    while (up ? way * (double)n < need : way * (double)n <= need)
        n++;
    return s->from_clock + (n < 1 ? 1 : n > span ? span : n);
}

int scale_pass(struct scale *s)
{
    const int way = s->end > s->quarter ? 1 : -1;
    s->quarter += way;
    return way;
}

bool scale_a(const struct scale *s)
{
    return (s->quarter & 2) == 0;
}

bool scale_b(const struct scale *s)
{
    return ((s->quarter + 1) & 2) != 0;
}

int64_t scale_edges(const struct scale *s)
{
    return s->quarter - s->start;
}
