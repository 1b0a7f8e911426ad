/* lookahead_tool - the tool follows the planned motion of a chain, through the mean. */
#include "lookahead.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

static void begin_mean(struct lookahead *t, struct lookahead_mean *m, double dt)
{
    const double taps = round(t->smooth / dt);
    t->taps = taps < 1.0 ? 1 : taps > LOOKAHEAD_MEAN - 1 ? LOOKAHEAD_MEAN - 1 : (int32_t)taps;
    memset(m->sample, 0, sizeof m->sample);
}

/* Mean of the latest samples, of which `way` is the newest. */
static double mean_of(struct lookahead *t, struct lookahead_mean *m, double way)
{
    const int32_t oldest = (t->next + LOOKAHEAD_MEAN - t->taps) % LOOKAHEAD_MEAN;
    const int32_t newest = (t->next + LOOKAHEAD_MEAN - 1) % LOOKAHEAD_MEAN;

    t->still = way == m->sample[newest] ? t->still + 1 : 0;
    t->sum += way - m->sample[oldest];
    m->sample[t->next] = way;
    t->next = (t->next + 1) % LOOKAHEAD_MEAN;
    if (t->next == 0) {
        /* The sum is made anew, so that rounding does not gather in it. */
        t->zero = way;
        t->sum = 0.0;
        for (int32_t i = 0; i < t->taps; i++) {
            t->sum += m->sample[LOOKAHEAD_MEAN - 1 - i] - t->zero;
        }
    }
    return t->still >= t->taps ? way : el_min(t->zero + t->sum / t->taps, way);
}

void lookahead_go(struct lookahead *t, const struct ring *r, double way)
{
    t->way = way;
    t->out_s = way - t->out_base;
    while (t->out < t->at && t->out_s >= ring_peek(r, t->out)->command.path.length) {
        const double length = ring_peek(r, t->out)->command.path.length;
        t->out_base += length;
        t->out_s -= length;
        t->out++;
    }
}

void lookahead_sample(struct lookahead *t, struct lookahead_mean *m, struct ring *r, double dt)
{
    const double out = t->way;
    double way = t->base + t->s;

    if (t->taps == 0) {
        begin_mean(t, m, dt);
    }
    t->out_v = t->v;
    if (t->taps > 1) {
        way = el_max(out, mean_of(t, m, way));
        t->out_v = (way - out) / dt;
    }
    lookahead_go(t, r, way);
}

const struct command *lookahead_begun(struct lookahead *t, const struct ring *r)
{
    const int32_t last = lookahead_at_end(t, r) && t->taps <= 1 ? t->at : t->out;
    return t->begun <= last ? &ring_peek(r, t->begun++)->command : NULL;
}

void lookahead_drop(struct lookahead *t, struct ring *r)
{
    /* The corner at the start of a command needs the one before. */
    const int32_t gone = t->out_s > lookahead_half(t, r, t->out) ? t->out : t->out - 1;

    for (int32_t i = 0; i < gone; i++) {
        ring_pop(r);
        t->out--;
        t->at--;
        t->joined--;
        t->planned--;
        t->begun--;
    }
}

bool lookahead_rests(const struct lookahead *t)
{
    return t->v == 0.0 && t->way >= t->base + t->s;
}

bool lookahead_done(const struct lookahead *t)
{
    return lookahead_rests(t) && t->base + t->s >= t->end;
}

void lookahead_place(const struct lookahead *t, const struct ring *r, double point[AXES],
                     double velocity[AXES])
{
    const struct ring_entry *n = ring_peek(r, t->out);
    const double left = el_max(0.0, n->command.path.length - t->out_s);
    double slope[AXES];

    if (t->out_s < lookahead_half(t, r, t->out)) {
        corner_at(&n->corner, &ring_peek(r, t->out - 1)->command.path, &n->command.path, t->out_s,
                  point, slope);
    } else if (left < lookahead_half(t, r, t->out + 1)) {
        const struct ring_entry *b = ring_peek(r, t->out + 1);
        corner_at(&b->corner, &n->command.path, &b->command.path, -left, point, slope);
    } else {
        path_at(&n->command.path, t->out_s, point, slope);
    }
    for (int k = 0; k < AXES; k++) {
        velocity[k] = t->out_v * slope[k];
    }
}
