#include "encoder.h"

#include <math.h>

/* Ideal quadrature: A is high in [0, 1/2) of a line period, B in [1/4, 3/4), so A leads going up.
 * x4 counts every edge of A and B (phase = m/4), x2 the edges of A (m/2), x1 the rising edge of A
 * going up and the same edge, then falling, going down (whole m): a decoder that counted the rising
 * edge both ways would drift when the shaft trembles. So a counter is floor(rate * phase). */

static int64_t floor_divide(int64_t a, int64_t b)
{
    return a / b - (a % b < 0);
}

static int64_t floor_counts(int32_t rate, int64_t quarter)
{
    return rate == 0 ? 0 : floor_divide(quarter, 4 / rate);
}

static int64_t signed_counts(const struct encoder_config *c, int64_t counts)
{
    return c->inverse ? -counts : counts;
}

static void latch_index(const struct encoder_config *c, struct encoder *e, double phase,
                        int64_t clock, int64_t turn, int64_t new_turn)
{
    /* first pulse met: the next multiple going up, the one just above `turn` going down */
    int64_t line = (new_turn > turn ? turn + 1 : turn) * c->index_lines;
    int64_t many = new_turn > turn ? new_turn - turn : turn - new_turn;
    e->index_seen = (int32_t)((uint32_t)e->index_seen + (uint32_t)many);
    e->index_clock = e->clock + encoder_edge(e->phase, phase, clock - e->clock, (double)line);
    e->index_count = signed_counts(c, c->rate * line - e->origin);
}

enum encoder_event encoder_sample(const struct encoder_config *c, struct encoder *e, double phase,
                                  int64_t clock)
{
    if (!(fabs(phase) <= ENCODER_PHASE_MAX))
        return ENCODER_BAD_PHASE;
    if (c->rate == 0)
        return ENCODER_NONE;
    enum encoder_event event = ENCODER_NONE;
    int64_t quarter = (int64_t)floor(4.0 * phase);
    if (!e->primed) {
        e->primed = true;
        e->origin = floor_counts(c->rate, quarter);
    } else if (quarter != e->quarter) {
        int64_t turn = floor_divide(floor_divide(e->quarter, 4), c->index_lines);
        int64_t new_turn = floor_divide(floor_divide(quarter, 4), c->index_lines);
        if (new_turn != turn) {
            latch_index(c, e, phase, clock, turn, new_turn);
            event = ENCODER_INDEX;
        }
        e->count = signed_counts(c, floor_counts(c->rate, quarter) - e->origin);
    }
    e->quarter = quarter;
    e->phase = phase;
    e->clock = clock;
    return event;
}

void encoder_clear(const struct encoder_config *c, struct encoder *e)
{
    e->origin = floor_counts(c->rate, e->quarter);
    e->count = 0;
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
