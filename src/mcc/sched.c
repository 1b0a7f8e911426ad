#include "sched.h"

#include <string.h>

void sched_start(struct sched *s, const struct sched_config *config)
{
    memset(s, 0, sizeof *s);
    s->config = *config;
    s->running = -1;
    for (int i = 0; i < SCHED_MODULES; i++) {
        s->module[i].next = config->cycle[i] > 0 ? config->offset[i] : INT64_MAX;
    }
}

void sched_wake(struct sched *s, int module, int64_t due, int64_t ready)
{
    struct sched_module *m = &s->module[module];

    m->asked = m->woken = true;
    m->due = due;
    m->ready = ready;
}

/* The timers whose cycle begins now. */
static void ask(struct sched *s)
{
    for (int i = 0; i < SCHED_MODULES; i++) {
        struct sched_module *m = &s->module[i];
        if (m->next > s->clock) {
            continue;
        }
        m->missed += (m->active && !m->event) || (m->asked && !m->woken);
        m->due = m->asked && m->due < m->next ? m->due : m->next;
        m->ready = m->asked && m->ready < m->next ? m->ready : m->next;
        m->asked = true;
        m->woken = false;
        m->next += s->config.cycle[i];
    }
}

/* Could it have the processor now; of this clock's interrupts too? */
static bool wants(const struct sched *s, const struct sched_module *m, bool interrupts)
{
    const bool new = m->woken && m->ready == s->clock;
    return m->active || (m->asked && m->ready <= s->clock && (interrupts || !new));
}

/* Of two that want it, a having the lower number: does b go before a? */
static bool before(const struct sched *s, int a, int b)
{
    const struct sched_module *x = &s->module[a], *y = &s->module[b];

    if (s->config.priority[a] != s->config.priority[b]) {
        return s->config.priority[b] < s->config.priority[a];
    }
    return x->active || y->active ? y->active : y->due < x->due;
}

static int most_urgent(const struct sched *s, bool interrupts)
{
    int best = -1;

    for (int i = 0; i < SCHED_MODULES; i++) {
        if (wants(s, &s->module[i], interrupts) && (best < 0 || before(s, best, i))) {
            best = i;
        }
    }
    return best;
}

/* The processor works on a module (-1: none) up to the next clock at which something may happen. */
static void pass(struct sched *s, int module, int64_t until)
{
    int64_t to = until;

    for (int i = 0; i < SCHED_MODULES; i++) {
        const struct sched_module *m = &s->module[i];
        to = m->next < to ? m->next : to;
        to = m->asked && m->ready > s->clock && m->ready < to ? m->ready : to;
    }
    if (module >= 0) {
        struct sched_module *m = &s->module[module];
        to = m->left < to - s->clock ? s->clock + m->left : to;
        m->left -= to - s->clock;
        m->busy += to - s->clock;
    }
    s->running = module;
    s->clock = to;
}

struct sched_event sched_next(struct sched *s, int64_t until)
{
    while (s->clock < until) {
        for (int i = 0; i < SCHED_MODULES; i++) {
            if (s->module[i].active && s->module[i].left == 0) {
                return (struct sched_event){ SCHED_END, i };
            }
        }
        ask(s);
        int module = most_urgent(s, false);
        if (module < 0 || s->module[module].active) {
            module = most_urgent(s, true);
        }
        if (module >= 0 && !s->module[module].active) {
            return (struct sched_event){ SCHED_BEGIN, module };
        }
        pass(s, module, until);
    }
    return (struct sched_event){ SCHED_NONE, -1 };
}

static void at_least(int64_t *longest, int64_t clocks)
{
    *longest = clocks > *longest ? clocks : *longest;
}

void sched_begin(struct sched *s, int module, int64_t due, int64_t clocks)
{
    struct sched_module *m = &s->module[module];

    m->asked = false;
    m->active = true;
    m->event = m->woken;
    m->from = due;
    m->left = clocks;
    at_least(&m->latency, s->clock - due);
}

void sched_more(struct sched *s, int module, int64_t clocks)
{
    s->module[module].left = clocks;
}

void sched_end(struct sched *s, int module)
{
    struct sched_module *m = &s->module[module];

    m->active = false;
    m->runs++;
    at_least(&m->response, s->clock - m->from);
}

struct sched_module sched_all(const struct sched *s)
{
    struct sched_module all = { .runs = 0 };

    for (int i = 0; i < SCHED_MODULES; i++) {
        const struct sched_module *m = &s->module[i];
        all.runs += m->runs;
        all.missed += m->missed;
        all.busy += m->busy;
        at_least(&all.latency, m->latency);
        at_least(&all.response, m->response);
    }
    return all;
}
