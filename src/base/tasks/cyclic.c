#include "cyclic.h"

#include <string.h>

void cyclic_start(struct cyclic *s, const struct cyclic_config *config)
{
    memset(s, 0, sizeof *s);
    processor_start(&s->processor, config->tasks);
    s->running = -1;
    for (int i = 0; i < config->tasks; i++) {
        s->processor.task[i].priority = ~config->priority[i]; /* its order, the other way round */
        s->task[i].cycle = config->cycle[i];
        s->task[i].next = config->cycle[i] > 0 ? config->offset[i] : INT64_MAX;
    }
}

void cyclic_wake(struct cyclic *s, int task, int64_t due, int64_t ready)
{
    struct cyclic_task *t = &s->task[task];

    t->asked = t->woken = true;
    t->due = due;
    t->ready = ready;
}

/* Release runs of the timers whose cycle begins now, and count the deadlines missed by that. */
static void ask(struct cyclic *s)
{
    for (int i = 0; i < s->processor.tasks; i++) {
        struct cyclic_task *t = &s->task[i];
        if (t->next > s->processor.clock) {
            continue;
        }
        s->changes++;
        t->use.missed += (t->active && !t->event) || (t->asked && !t->woken);
        t->due = t->asked && t->due < t->next ? t->due : t->next;
        t->ready = t->asked && t->ready < t->next ? t->ready : t->next;
        t->asked = true;
        t->woken = false;
        t->next += t->cycle;
    }
}

/* Make the runs ready that wait and may begin now; with `interrupts` also those that an event woke
 * for this very clock. Returns true if one of these was left out. */
static bool release(struct cyclic *s, bool interrupts)
{
    const int64_t clock = s->processor.clock;
    bool out = false;

    for (int i = 0; i < s->processor.tasks; i++) {
        const struct cyclic_task *t = &s->task[i];
        if (t->active) {
            continue;
        }
        const bool may = t->asked && t->ready <= clock;
        const bool fresh = may && t->woken && t->ready == clock && !interrupts;
        out = out || fresh;
        if (may && !fresh) {
            processor_wake(&s->processor, i, t->due);
        } else {
            processor_block(&s->processor, i);
        }
    }
    return out;
}

/* Let the processor work up to the next clock at which a run may become ready, at most `until`. */
static void pass(struct cyclic *s, int64_t until)
{
    for (int i = 0; i < s->processor.tasks; i++) {
        const struct cyclic_task *t = &s->task[i];
        until = t->next < until ? t->next : until;
        until = t->asked && t->ready > s->processor.clock && t->ready < until ? t->ready : until;
    }
    s->changes += s->processor.running >= 0;
    processor_pass(&s->processor, until);
    s->running = s->processor.running;
}

/* Whether no task runs, waits or is due before `until`. */
static bool idle(const struct cyclic *s, int64_t until)
{
    bool busy = false;
    int64_t next = INT64_MAX;

    for (int i = 0; i < s->processor.tasks; i++) {
        const struct cyclic_task *t = &s->task[i];
        busy |= t->asked | t->active;
        next = t->next < next ? t->next : next;
    }
    return !busy && next >= until;
}

struct cyclic_event cyclic_next(struct cyclic *s, int64_t until)
{
    if (s->processor.clock < until && idle(s, until)) {
        s->running = s->processor.running = -1;
        processor_pass(&s->processor, until);
    }
    while (s->processor.clock < until) {
        const int over = processor_over(&s->processor);
        if (over >= 0) {
            return (struct cyclic_event){ CYCLIC_END, over };
        }
        ask(s);
        const bool interrupts = release(s, false);
        int first = processor_dispatch(&s->processor);
        if (first < 0 && interrupts) {
            release(s, true);
            first = processor_dispatch(&s->processor);
        }
        if (first >= 0) {
            return (struct cyclic_event){ CYCLIC_BEGIN, first };
        }
        pass(s, until);
    }
    return (struct cyclic_event){ CYCLIC_NONE, -1 };
}

static void at_least(int64_t *longest, int64_t clocks)
{
    *longest = clocks > *longest ? clocks : *longest;
}

void cyclic_begin(struct cyclic *s, int task, int64_t due, int64_t clocks)
{
    struct cyclic_task *t = &s->task[task];

    s->changes++;
    t->asked = false;
    t->active = true;
    t->event = t->woken;
    t->from = due;
    s->processor.task[task].turn = INT64_MIN; /* from now on before tasks of equal priority */
    processor_compute(&s->processor, task, clocks);
    at_least(&t->use.latency, s->processor.clock - due);
}

void cyclic_more(struct cyclic *s, int task, int64_t clocks)
{
    processor_compute(&s->processor, task, clocks);
}

void cyclic_end(struct cyclic *s, int task)
{
    struct cyclic_task *t = &s->task[task];

    s->changes++;
    processor_block(&s->processor, task);
    t->active = false;
    t->use.runs++;
    at_least(&t->use.response, s->processor.clock - t->from);
}

void cyclic_tell(const struct cyclic *s, struct cyclic_report *r)
{
    r->clock = s->processor.clock;
    r->running = s->running;
    if (r->changes == s->changes) {
        return;
    }
    r->changes = s->changes;
    r->all = (struct cyclic_use){ 0 };
    for (int i = 0; i < s->processor.tasks; i++) {
        struct cyclic_use *u = &r->task[i];
        *u = s->task[i].use;
        u->busy = s->processor.task[i].busy;
        r->all.runs += u->runs;
        r->all.missed += u->missed;
        r->all.busy += u->busy;
        at_least(&r->all.latency, u->latency);
        at_least(&r->all.response, u->response);
    }
}
