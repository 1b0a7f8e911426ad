#include "analyser.h"

#include <string.h>

/* SplitMix64 (Steele, Lea, Flood 2014). */
static uint64_t next(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

/* Schedule a channel's next edge, one pause after the clock `from`. */
static void schedule(struct analyser *a, int i, int64_t from)
{
    struct analyser_channel *c = &a->channel[i];
    const uint64_t width = (uint64_t)(a->config.most[i] - a->config.least[i]) + 1;
    c->waits = false;
    c->edge = from + a->config.least[i] + (int64_t)(next(&c->random) % width);
}

void analyser_reset(struct analyser *a, const struct analyser_config *config)
{
    memset(a, 0, sizeof *a);
    a->config = *config;
    for (int i = 0; i < ANALYSER_CHANNELS; i++) {
        uint64_t seed = ((uint64_t)(uint32_t)config->seed << 32) + (uint64_t)i;
        a->channel[i].random = next(&seed);
        schedule(a, i, config->period);
    }
}

static void measure(struct analyser_channel *c, int64_t reaction)
{
    c->latest = reaction;
    c->least = c->responses && c->least < reaction ? c->least : reaction;
    c->most = c->responses && c->most > reaction ? c->most : reaction;
    c->sum += reaction;
    c->responses++;
}

/* Whether the edge that waits is answered or timed out at this instant; then *event is filled
 * in. */
static bool done(struct analyser *a, int i, int64_t instant, bool response, double clock,
                 struct analyser_event *event)
{
    struct analyser_channel *c = &a->channel[i];
    const bool answered = response == c->level && clock >= (double)c->edge;
    if (!answered && instant - c->edge <= a->config.timeout[i])
        return false;
    *event = (struct analyser_event){ i, c->edge, answered ? (int64_t)clock : -1 };
    if (answered)
        measure(c, (int64_t)clock - c->edge);
    else
        c->timeouts++;
    return true;
}

int32_t analyser_instant(struct analyser *a, int64_t instant, uint32_t response,
                         const double clock[ANALYSER_CHANNELS],
                         struct analyser_event event[ANALYSER_CHANNELS])
{
    const int64_t period = a->config.period;
    const uint32_t changed = response ^ a->response;
    int32_t n = 0;
    a->response = response;
    for (int i = 0; i < ANALYSER_CHANNELS; i++) {
        if (!(a->config.enabled >> i & 1))
            continue;
        struct analyser_channel *c = &a->channel[i];
        const int32_t answers = c->responses;
        if (c->waits && done(a, i, instant, response >> i & 1, clock[i], &event[n])) {
            schedule(a, i, instant + period);
            n++;
        }
        c->strays += (changed >> i & 1) && c->responses == answers;
        if (!c->waits && c->edge <= instant + 2 * period) {
            c->waits = true;
            c->level = !c->level;
            c->shown = c->edge;
            c->edges++;
            a->levels ^= (uint32_t)1 << i;
        }
    }
    return n;
}
