/* Encoders of the model, what latches them, local inputs: pins are looked at every clock. */
#include "tick_state.h"

/* Encoders. */

struct pins {
    bool a, b, c;
};

static int64_t rest(int64_t a, int64_t b)
{
    int64_t r = a % b;
    return r < 0 ? r + b : r;
}

/* The pins of an ideal encoder at num / den 64ths of a line, and the wiring behind them. */
static struct pins pins_at(const struct counter *e, int64_t num, int64_t den)
{
    int64_t line = den * TICK_UNIT, p = rest(num, line);
    struct pins pin = { p < line / 2, p >= line / 4 && p < line * 3 / 4,
                        rest(num, line * e->index_lines) < line / 4 };
    pin.a = pin.a != ((e->wiring & 1) != 0);
    pin.b = pin.b != ((e->wiring & 2) != 0);
    pin.c = pin.c != ((e->wiring & 8) != 0);
    if (e->wiring & 4)
        return (struct pins){ pin.b, pin.a, pin.c };
    return pin;
}

/* A level is passed if it was found at the last `filter` looks before this one. */
static bool pass(struct line *l, bool pin, int64_t filter)
{
    uint64_t all = (UINT64_C(1) << filter) - 1, looks = l->looks & all;
    if (filter == 0)
        l->level = pin;
    else if (looks == all || looks == 0)
        l->level = looks == all;
    l->looks = l->looks << 1 | pin;
    return l->level;
}

/* Counts of a step from (a, b) to (c, d). Rate 4: all edges; 2: edges of A; 1: the edge of A while
 * B is low. Both lines at once is no step of the code. */
static int decode(int64_t rate, const bool was[2], const bool is[2])
{
    if ((was[0] != is[0]) == (was[1] != is[1]))
        return 0;
    if (was[0] != is[0])
        return rate == 1 && is[1] ? 0 : is[0] != is[1] ? 1 : -1;
    return rate < 4 ? 0 : is[0] == is[1] ? 1 : -1;
}

static void compare(struct counter *e, int64_t clock)
{
    bool was = e->reached;
    e->reached = e->compare_on && e->count >= e->compare;
    if (!e->reached || was)
        return;
    e->compare_clock = clock;
    e->met = true;
}

static void look(struct counter *e, struct pins pin, int64_t clock)
{
    const bool pins_before[2] = { e->a.looks & 1, e->b.looks & 1 }, pins[2] = { pin.a, pin.b };
    const bool before[2] = { e->a.level, e->b.level };
    const bool now[2] = { pass(&e->a, pin.a, e->filter), pass(&e->b, pin.b, e->filter) };
    bool index_before = e->c.level, index = pass(&e->c, pin.c, e->filter);
    int edge = decode(4, pins_before, pins);
    e->count += decode(e->rate, before, now);
    compare(e, clock);
    e->behind += edge - decode(4, before, now);
    if (edge != 0 && llabs(e->behind) > 2) { /* at most one of A and one of B can wait */
        e->behind += e->behind > 0 ? -4 : 4;
        e->too_fast = true;
    }
    e->index_now = index && !index_before;
    if (!e->index_now)
        return;
    e->index_seen++;
    e->index_clock = clock;
    e->index_count = e->count;
    if (e->index_first < 0)
        e->index_first = clock;
}

/* The pins as they stand are what is seen, and have stood for ever. */
static void settle(struct counter *e)
{
    struct pins pin = pins_at(e, e->to, 1);
    e->a = (struct line){ pin.a, pin.a ? UINT64_MAX : 0 };
    e->b = (struct line){ pin.b, pin.b ? UINT64_MAX : 0 };
    e->c = (struct line){ pin.c, pin.c ? UINT64_MAX : 0 };
    e->behind = 0;
}

static void keep(struct tick *m, int64_t sources)
{
    for (int i = 0; i < TICK_ENCODERS; i++) {
        struct latched *l = &m->latch[i];
        if (!m->encoder[i].wired || !l->armed || (l->source & sources) == 0)
            continue;
        l->value = m->encoder[i].count;
        l->clock = m->clock;
        l->armed = l->keep_last;
        l->hit = true;
    }
}

/* Clock n of the `span` clocks between two instants. */
void tick_encoder_clock(struct tick *m, int64_t n, int64_t span)
{
    int64_t sources = 0;
    for (int i = 0; i < TICK_ENCODERS; i++) {
        struct counter *e = &m->encoder[i];
        if (!e->wired || e->rate == 0)
            continue;
        look(e, pins_at(e, e->from * span + (e->to - e->from) * n, span), m->clock);
        sources |= (int64_t)e->index_now << i;
    }
    if (sources != 0)
        keep(m, sources);
}

/* What a counter met since the latest instant is told at this one, each source once: an index with
 * its first clock, compare with its latest. */
void tick_tell_encoder(struct tick *m, int i)
{
    struct counter *e = &m->encoder[i];
    if (e->index_first >= 0)
        tick_fire(m, PAGE_ENC + i / 3, INDEX_BIT + i % 3, e->index_first);
    if (e->met)
        tick_fire(m, PAGE_ENC + i / 3, i % 3, e->compare_clock);
    e->index_first = -1;
    e->met = false;
    m->latch[i].seen += m->latch[i].hit;
    m->latch[i].hit = false;
}

int64_t tick_set_encoder(void *card, int64_t encoder, const int64_t *config)
{
    struct counter *e = &((struct tick *)card)->encoder[encoder];
    e->rate = config[0];
    e->wiring = config[1];
    e->filter = config[2];
    e->index_lines = config[3];
    settle(e);
    return TICK_OK;
}

int64_t tick_clear_encoders(void *card, int64_t encoders)
{
    struct tick *m = card;
    for (int i = 0; i < TICK_ENCODERS; i++) {
        if ((encoders >> i & 1) == 0)
            continue;
        m->encoder[i].count = 0;
        m->encoder[i].too_fast = false;
        compare(&m->encoder[i], m->clock);
        tick_tell_encoder(m, i);
    }
    return TICK_OK;
}

int64_t tick_set_compare(void *card, int64_t encoder, int64_t on, int64_t value)
{
    struct tick *m = card;
    struct counter *e = &m->encoder[encoder];
    if ((on != 0) == e->compare_on && value == e->compare)
        return TICK_OK;
    e->compare_on = on != 0;
    e->compare = value;
    e->reached = false;
    compare(e, m->clock);
    tick_tell_encoder(m, (int)encoder);
    return TICK_OK;
}

int64_t tick_set_latch(void *card, int64_t encoder, int64_t source, int64_t keep_last)
{
    struct latched *l = &((struct tick *)card)->latch[encoder];
    l->source = source;
    l->keep_last = keep_last != 0;
    l->armed = source != 0;
    return TICK_OK;
}

void tick_reset_encoders(struct tick *m)
{
    for (int i = 0; i < TICK_ENCODERS; i++) {
        m->encoder[i].compare_on = m->encoder[i].reached = false;
        m->encoder[i].compare = m->encoder[i].count = 0;
        m->encoder[i].too_fast = false;
        memset(&m->latch[i], 0, sizeof m->latch[i]);
    }
}

/* Local inputs. */

static bool input(const struct tick *m, const int64_t seen[5], int i)
{
    if (i < LDIS)
        return (seen[0] >> i & 1) != 0;
    int d = i - LDIS;
    if ((m->dedicated >> d & 1) == 0)
        return (seen[1] >> d & 1) != 0;
    return d == 6 ? seen[4] != 0 : ((seen[2] | seen[3]) >> d & 1) != 0;
}

void tick_sample_local(struct tick *m, const int64_t *inputs)
{
    int64_t triggers = 0;
    m->inputs = 0;
    for (int i = 0; i < LDIS + DFIS; i++) {
        bool was = input(m, m->seen, i), is = input(m, inputs, i);
        m->inputs |= (int64_t)is << i;
        if (was == is || m->edge[i] == (is ? FALL : RISE))
            continue;
        tick_fire(m, PAGE_LIO, i, m->clock);
        if (i < 2)
            triggers |= (int64_t)1 << (TICK_ENCODERS + i);
    }
    memcpy(m->seen, inputs, sizeof m->seen);
    m->stop = inputs[4] != 0;
    keep(m, triggers);
    if (m->stop && m->stop_enable)
        tick_clear(m);
}

int64_t tick_set_local(void *card, const int64_t *set)
{
    struct tick *m = card;
    memcpy(m->edge, set, sizeof m->edge);
    m->dedicated = set[15];
    m->stop_enable = set[16] != 0;
    m->gate = set[17] != 0;
    if (m->stop && m->stop_enable)
        tick_clear(m);
    return TICK_OK;
}
