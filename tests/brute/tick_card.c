/* The card by counting: every 25 ns each part does what its data sheet says, and nothing is known
 * ahead. Order at one clock: DDA and its boundary; end of the watchdog's reset, timer; arriving
 * transactions; encoder edges and what they latch; at an instant the local inputs. */
#include "tick_state.h"

/* Interrupts. */

static void pull(struct tick *m, int64_t clock)
{
    bool up = false;
    for (int p = 0; p < TICK_PAGES; p++)
        for (int b = 0; b < TICK_BITS; b++)
            up = up || (m->pending[p][b] > 0 && (m->mask[p] >> b & 1) != 0);
    if (up && !m->line) {
        m->irq_seq++;
        m->irq_clock = clock;
    }
    m->line = up;
}

/* Sources are told in the order of tick_sample(), those of encoders with a clock that has passed.
 * The line's clock is that of the earliest. */
void tick_fire(struct tick *m, int page, int bit, int64_t clock)
{
    m->fired[page][bit]++;
    if (m->pending[page][bit] < 2)
        m->pending[page][bit]++;
    bool was = m->line;
    pull(m, clock);
    if (was && (m->mask[page] >> bit & 1) != 0 && clock < m->irq_clock)
        m->irq_clock = clock;
}

int64_t tick_set_mask(void *card, const int64_t *mask)
{
    struct tick *m = card;
    memcpy(m->mask, mask, sizeof m->mask);
    pull(m, m->clock);
    return TICK_OK;
}

int64_t tick_acknowledge(void *card, const int64_t *flags, const int64_t *mask)
{
    struct tick *m = card;
    for (int p = 0; p < TICK_PAGES; p++)
        for (int b = 0; b < TICK_BITS; b++)
            if ((flags[p] >> b & 1) != 0 && m->pending[p][b] > 0)
                m->pending[p][b]--;
    m->line = false;
    return tick_set_mask(m, mask);
}

/* Timer and watchdog. */

static void timer_clock(struct tick *m)
{
    if (m->resetting && --m->dog_left == 0)
        m->resetting = false;
    if (!m->timer_on || ++m->timer_now < m->timer_period)
        return;
    m->timer_now = 0;
    m->timer_count++;
    tick_fire(m, PAGE_LIO, TIMER_BIT, m->clock);
    if (!m->dog_on || m->expired || ++m->dog_count < m->dog_value)
        return;
    m->expired = m->resetting = true;
    m->dog_left = m->dog_reset;
    tick_clear(m);
}

int64_t tick_set_timer(void *card, int64_t on, int64_t period)
{
    struct tick *m = card;
    if (!on || !m->timer_on || period != m->timer_period)
        m->timer_now = 0;
    m->timer_on = on != 0;
    m->timer_period = period;
    return TICK_OK;
}

int64_t tick_set_watchdog(void *card, int64_t on, int64_t value, int64_t reset)
{
    struct tick *m = card;
    if (!on || value != m->dog_value)
        m->dog_count = 0;
    if (!on)
        m->expired = m->resetting = false;
    m->dog_on = on != 0;
    m->dog_value = value;
    m->dog_reset = reset;
    return TICK_OK;
}

int64_t tick_refresh_watchdog(void *card)
{
    struct tick *m = card;
    if (!m->resetting) {
        m->expired = false;
        m->dog_count = 0;
    }
    return TICK_OK;
}

/* Error counters. */

void tick_control(void *card)
{
    struct tick *m = card;
    for (int i = 0; i < TICK_LOOPS; i++) {
        struct loop *p = &m->loop[i];
        int64_t away = (i == 6 ? m->told : m->pulses[i]) - m->encoder[i].count;
        if (i < 6 && !m->active[i])
            continue;
        if (p->wanted && !p->on)
            p->zero = away;
        p->on = p->wanted;
        p->error = p->on ? away - p->zero : 0;
        if (llabs(p->error) > INT32_MAX)
            p->error = p->error < 0 ? -INT32_MAX : INT32_MAX;
        bool was_over = p->over;
        p->over = p->on && llabs(p->error) >= m->limit;
        if (p->over && !was_over)
            tick_fire(m, PAGE_PCL, i, m->clock);
    }
}

int64_t tick_clear_loops(void *card, int64_t loops)
{
    struct tick *m = card;
    for (int i = 0; i < TICK_LOOPS; i++)
        if (loops >> i & 1)
            m->loop[i] = (struct loop){ .wanted = m->loop[i].wanted };
    return TICK_OK;
}

int64_t tick_set_loops(void *card, int64_t loops)
{
    struct tick *m = card;
    for (int i = 0; i < TICK_LOOPS; i++)
        m->loop[i].wanted = (loops >> i & 1) != 0;
    return TICK_OK;
}

int64_t tick_set_command(void *card, int64_t command)
{
    ((struct tick *)card)->told = command;
    return TICK_OK;
}

/* Time. */

void tick_sample(void *card, int64_t clock, const int64_t *phase, const int64_t *inputs)
{
    struct tick *m = card;
    int64_t span = clock - m->clock;
    for (int i = 0; i < TICK_ENCODERS; i++) {
        m->encoder[i].from = m->encoder[i].to;
        m->encoder[i].to = phase[i];
    }
    for (int64_t n = 1; n <= span; n++) {
        m->clock++;
        if (m->run && m->gate && !m->expired)
            tick_dda_clock(m);
        timer_clock(m);
        tick_arrive(m);
        tick_encoder_clock(m, n, span);
    }
    tick_sample_local(m, inputs);
    for (int i = 0; i < TICK_ENCODERS; i++)
        tick_tell_encoder(m, i);
}

void *tick_create(const int64_t *setup, const int64_t *phase)
{
    struct tick *m = calloc(1, sizeof *m);
    if (m == NULL)
        return NULL;
    m->run = m->gate = true;
    m->length = m->next_length = 12;
    m->divider = m->next_divider = 10;
    m->limit = setup[1];
    for (int i = 0; i < TICK_AXES; i++) {
        m->active[i] = (setup[0] >> i & 1) != 0;
        m->accumulator[i] = 1 << (m->length - 1);
    }
    for (int i = 0; i < TICK_ENCODERS; i++) {
        m->encoder[i].wired = i >= TICK_AXES || m->active[i];
        m->encoder[i].index_first = -1;
        m->encoder[i].to = phase[i];
        tick_set_encoder(m, i, setup + 2 + 4 * i);
    }
    return m;
}

void tick_free(void *card)
{
    free(card);
}

static void reset_local(struct tick *m)
{
    static const int64_t RESET[LDIS + DFIS + 3] = { [LDIS + DFIS + 2] = 1 };
    tick_set_local(m, RESET);
    tick_set_timer(m, 0, 1);
    tick_set_watchdog(m, 0, 1, 1);
}

int64_t tick_reset_module(void *card, int64_t module)
{
    enum { DDA = 1, ENC = 2, LIO = 6, PCL = 7, PERI = 9, ALL = 10 };
    struct tick *m = card;
    if (module == ALL) { /* first, so that emptying the FIFOs pulls nothing */
        memset(m->mask, 0, sizeof m->mask);
        m->line = false;
    }
    if (module == DDA || module == ALL) {
        tick_clear(m);
        tick_ask_time(m, 12, 10);
    }
    if (module == ENC || module == PERI || module == ALL)
        tick_reset_encoders(m);
    if (module == LIO || module == PERI || module == ALL)
        reset_local(m);
    if (module == PCL || module == ALL)
        memset(m->loop, 0, sizeof m->loop);
    if (module == ALL) {
        memset(m->pending, 0, sizeof m->pending);
        memset(m->mask, 0, sizeof m->mask);
        m->line = false;
    }
    return TICK_OK;
}

/* What can be seen. */

void tick_fired(const void *card, int64_t *fired)
{
    memcpy(fired, ((const struct tick *)card)->fired, sizeof((const struct tick *)card)->fired);
}

void tick_emptied(const void *card, int64_t *pulses)
{
    const struct tick *m = card;
    memcpy(pulses, m->emptied, sizeof m->emptied);
}

static void view_counters(const struct tick *m, struct view *v)
{
    for (int i = 0; i < TICK_ENCODERS; i++) {
        const struct counter *e = &m->encoder[i];
        const struct latched *l = &m->latch[i];
        v->count[i] = e->count;
        v->too_fast[i] = e->too_fast;
        v->index_seen[i] = e->index_seen;
        v->index_clock[i] = e->index_clock;
        v->index_count[i] = e->index_count;
        v->reached[i] = e->reached;
        v->compare_clock[i] = e->compare_clock;
        v->latch_armed[i] = l->armed;
        v->latch_seen[i] = l->seen;
        v->latch_value[i] = l->value;
        v->latch_clock[i] = l->clock;
    }
}

static void view_axes(const struct tick *m, struct view *v)
{
    for (int i = 0; i < TICK_AXES; i++) {
        v->before[i] = m->before[i];
        v->command[i] = m->command[i];
        v->pulses[i] = m->pulses[i];
        v->underflows[i] = m->underflows[i];
        v->stock[i] = m->fifo[i].stock;
        for (int k = 0; k < m->fifo[i].stock; k++)
            v->queue[TICK_DEPTH * i + k] = m->fifo[i].command[k];
    }
    for (int i = 0; i < TICK_LOOPS; i++) {
        v->error[i] = m->loop[i].error;
        v->over[i] = m->loop[i].over;
    }
}

void tick_view(const void *card, struct view *v)
{
    const struct tick *m = card;
    memset(v, 0, sizeof *v);
    *v->clock = m->clock;
    *v->length = m->length;
    *v->divider = m->divider;
    *v->next_length = m->next_length;
    *v->next_divider = m->next_divider;
    *v->minimum = m->minimum;
    *v->overflows = m->overflows;
    *v->on_the_way = m->on_the_way;
    *v->cmd_ack = m->cmd_ack;
    *v->frames_taken = m->frames_taken;
    *v->frames_refused = m->frames_refused;
    memcpy(v->refusal, m->refusal, sizeof v->refusal);
    view_axes(m, v);
    view_counters(m, v);
    *v->inputs = m->inputs;
    *v->off = m->expired || !m->gate || (m->stop && m->stop_enable);
    *v->timer_count = m->timer_count;
    *v->timer_now = m->timer_now;
    *v->expired = m->expired;
    *v->resetting = m->resetting;
    *v->watchdog_count = m->dog_count;
    for (int p = 0; p < TICK_PAGES; p++) {
        for (int b = 0; b < TICK_BITS; b++) {
            v->flags[p] |= (int64_t)(m->pending[p][b] > 0) << b;
            v->again[p] |= (int64_t)(m->pending[p][b] > 1) << b;
        }
        v->mask[p] = m->mask[p];
    }
    *v->line = m->line;
    *v->irq_seq = m->irq_seq;
    *v->irq_clock = m->irq_clock;
}
