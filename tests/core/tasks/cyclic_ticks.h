/* cyclic_ticks - for the tests of the cyclic tasks: a reference scheduler that is stepped clock by
 * clock, and the same set of tasks run by the core. */
#ifndef CYCLIC_TICKS_H
#define CYCLIC_TICKS_H

#include <string.h>

#include "check.h"
#include "cyclic.h"

enum { N = 5, LONGEST = 4000, WAKES = 60, LOG = 20000 };

/* A set of tasks with fixed execution times, and the clocks of events. */
struct set {
    struct cyclic_config c;
    int64_t time[N];
    int wakes;
    int woken;           /* task that events wake: 0, or 1, which has a timer, too */
    int64_t wake[WAKES]; /* [clock] of the events, rising */
};

/* An entry of the log: a run begins or ends. */
struct entry {
    int64_t clock;
    int task;
    enum cyclic_what what;
};
struct log {
    int n;
    struct entry e[LOG];
    int missed[N];
    int64_t busy[N], response[N];
};

static void note(struct log *l, int64_t clock, int task, enum cyclic_what what)
{
    if (l->n < LOG) {
        l->e[l->n++] = (struct entry){ clock, task, what };
    }
}

/* --- The reference scheduler, stepped clock by clock. ---------------------------------------- */
struct tick {
    bool waits, begun, event, run_event;
    int64_t since, from, left;
};

/* The task that has the processor, of those that are ready; -1 none. */
static int choose(const struct set *q, const struct tick t[N], int64_t clock, bool interrupts)
{
    int best = -1;
    int64_t rank[4], least[4] = { 0 };
    for (int i = 0; i < N; i++) {
        const bool fresh = t[i].event && t[i].since == clock;
        if (!t[i].begun && !(t[i].waits && (interrupts || !fresh))) {
            continue;
        }
        rank[0] = q->c.priority[i];
        rank[1] = !t[i].begun;
        rank[2] = t[i].begun ? 0 : t[i].since;
        rank[3] = i;
        int k = 0;
        while (best >= 0 && k < 3 && rank[k] == least[k]) {
            k++;
        }
        if (best < 0 || rank[k] < least[k]) {
            best = i;
            memcpy(least, rank, sizeof least);
        }
    }
    return best;
}

static void finish(struct log *l, struct tick t[N], int64_t clock)
{
    for (int i = 0; i < N; i++) {
        if (t[i].begun && t[i].left == 0) {
            t[i].begun = false;
            note(l, clock, i, CYCLIC_END);
            l->response[i] =
                clock - t[i].from > l->response[i] ? clock - t[i].from : l->response[i];
        }
    }
}

static inline void brute(const struct set *q, int64_t clocks, struct log *l)
{
    struct tick t[N] = { { 0 } };
    memset(l, 0, sizeof *l);
    int next_wake = 0;
    for (int64_t clock = 0; clock < clocks; clock++) {
        finish(l, t, clock);
        for (int i = 0; i < N; i++) {
            const int64_t in = clock - q->c.offset[i];
            if (q->c.cycle[i] && in >= 0 && in % q->c.cycle[i] == 0) {
                l->missed[i] += (t[i].begun && !t[i].run_event) || (t[i].waits && !t[i].event);
                t[i].since = t[i].waits ? t[i].since : clock;
                t[i].waits = true;
                t[i].event = false;
            }
        }
        for (; next_wake < q->wakes && q->wake[next_wake] <= clock; next_wake++) {
            struct tick *w = &t[q->woken];
            w->since = w->waits ? w->since : clock;
            w->event = w->waits ? w->event : true;
            w->waits = true;
        }
        for (int interrupts = 0; interrupts < 2; interrupts++) {
            int i;
            while ((i = choose(q, t, clock, interrupts)) >= 0 && !t[i].begun) {
                t[i] = (struct tick){
                    .begun = true, .run_event = t[i].event, .from = t[i].since, .left = q->time[i]
                };
                note(l, clock, i, CYCLIC_BEGIN);
                finish(l, t, clock);
                interrupts = 0;
            }
        }
        const int running = choose(q, t, clock, true);
        if (running >= 0) {
            t[running].left--;
            l->busy[running]++;
        }
    }
}

/* Announce the next event of a task without a timer, at a clock to come. */
static int wake_ahead(const struct set *q, struct cyclic *s, int wake)
{
    if (wake < q->wakes && !s->task[0].asked) {
        cyclic_wake(s, 0, q->wake[wake], q->wake[wake]);
        wake++;
    }
    /* Interrupts that come while one waits are one with it. */
    while (wake < q->wakes && s->task[0].asked && q->wake[wake] <= s->processor.clock) {
        wake++;
    }
    return wake;
}

/* Announce an event of a task with a timer, at its clock. */
static int wake_now(const struct set *q, struct cyclic *s, int wake)
{
    for (; wake < q->wakes && q->wake[wake] <= s->processor.clock; wake++) {
        if (!s->task[1].asked) {
            cyclic_wake(s, 1, s->processor.clock, s->processor.clock);
        }
    }
    return wake;
}

/* --- The core's scheduler, advanced in steps of random length. -------------------------------- */
static inline void scheduled(const struct set *q, int64_t clocks, uint64_t *seed, struct log *l)
{
    struct cyclic s;
    struct cyclic_config config = q->c;
    int wake = 0;
    memset(l, 0, sizeof *l);
    config.tasks = N;
    cyclic_start(&s, &config);
    for (int64_t until = 0; s.processor.clock < clocks;) {
        until = until + check_random(seed, 1, 50);
        until = until < clocks ? until : clocks;
        for (;;) {
            wake = q->woken ? wake_now(q, &s, wake) : wake_ahead(q, &s, wake);
            const bool soon = q->woken && wake < q->wakes && q->wake[wake] < until;
            const struct cyclic_event e = cyclic_next(&s, soon ? q->wake[wake] : until);
            if (e.what == CYCLIC_NONE && soon) {
                continue;
            }
            if (e.what == CYCLIC_NONE) {
                break;
            }
            note(l, s.processor.clock, e.task, e.what);
            if (e.what == CYCLIC_END) {
                cyclic_end(&s, e.task);
                continue;
            }
            if (e.task == 0 && !q->woken) {
                while (wake < q->wakes && q->wake[wake] <= s.processor.clock) {
                    wake++;
                }
            }
            cyclic_begin(&s, e.task, s.task[e.task].due, q->time[e.task]);
        }
    }
    for (int i = 0; i < N; i++) {
        l->missed[i] = s.task[i].use.missed;
        l->busy[i] = s.processor.task[i].busy;
        l->response[i] = s.task[i].use.response;
    }
}

#endif
