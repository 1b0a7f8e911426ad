/* task_programs - random programs of tasks and interrupts, and tokens of what happens in them, for
 * comparing this kernel with the FreeRTOS kernel, on which they were recorded.
 *
 * A task does its actions over and over, an interrupt its own once each time. Tokens: @c the clock
 * is c; >t task t gets the processor; !i interrupt i begins; c.a=r action a of context c (t0 .. a
 * task, i0 .. an interrupt) has ended with result r; :v it has the value v.
 */
#ifndef TASK_PROGRAMS_H
#define TASK_PROGRAMS_H

#include <stdarg.h>
#include <stdbool.h>
#include <string.h>

#include "check.h"

enum what {
    COMPUTE,
    GIVE,
    TAKE,
    SEND,
    RECEIVE,
    DELAY,
    DELAY_UNTIL,
    PRIORITY,
    NOTIFY,
    NOTIFY_TAKE,
    NOTIFY_WAIT,
    END
};
enum { PROGRAMS = 5000, TASKS = 6, INTERRUPTS = 3, ACTIONS = 8, PENDS = 40 };

/* Queues: three binary semaphores, one that counts to 3 from 1 on, two mutexes, queues of two items
 * and of one. */
enum { BINARY = 0, COUNTING = 3, MUTEX = 4, QUEUE = 6, QUEUES = 8, COUNTS_TO = 3, COUNTS_FROM = 1 };

/* A time to wait that never ends. */
#define FOR_EVER (-1)

/* on: semaphore, queue or task. value: time, priority, value sent, bits, ticks of a delay. */
struct action {
    enum what what;
    int on, value, ticks, other;
};

struct program {
    int tasks, priority[TASKS];
    struct action action[TASKS + INTERRUPTS][ACTIONS];
    int actions[TASKS + INTERRUPTS];
    struct pend {
        int64_t clock;
        int interrupt;
    } pend[PENDS]; /* rising clocks */
    int pends;
    int64_t tick, tick_time, switch_time, entry_time, end;
};

/* Features that a program may use. */
enum {
    EQUALS = 1,
    FORGETS = 2,
    CROWDS = 4,
    MUTEXES = 8,
    QUEUED = 16,
    TIMEOUTS = 32,
    NOTIFIES = 64,
    PRIORITIES = 128,
    COSTS = 256
};

static inline int draw(uint64_t *seed, int low, int high)
{
    return (int)check_random(seed, low, high);
}

static inline int some_ticks(uint64_t *seed, int features)
{
    return features & TIMEOUTS && draw(seed, 0, 2) ? draw(seed, 0, 4) : FOR_EVER;
}

/* Draw an action that a task or an interrupt may do. */
static inline struct action some_action(uint64_t *seed, int features, bool interrupt, int tasks)
{
    struct action a = { COMPUTE, 0, 0, 0, 0 };
    const bool queued = features & QUEUED;

    for (;;) {
        a.what = (enum what)draw(seed, COMPUTE, NOTIFY_WAIT);
        a.on = draw(seed, 0, features & CROWDS ? 0 : COUNTING - 1);
        a.value = draw(seed, 0, 12);
        a.ticks = interrupt ? 0 : some_ticks(seed, features);
        a.other = draw(seed, 0, 3);
        if (a.what == COMPUTE) {
            return a;
        }
        if (a.what == GIVE || (a.what == TAKE && !interrupt)) {
            const int kind = draw(seed, 0, 3);
            a.on = kind == 0 && queued                             ? COUNTING
                   : kind == 1 && features & MUTEXES && !interrupt ? draw(seed, MUTEX, QUEUE - 1)
                                                                   : a.on;
            return a;
        }
        if ((a.what == SEND || a.what == RECEIVE) && queued) {
            a.on = draw(seed, QUEUE, features & CROWDS ? QUEUE : QUEUES - 1);
            return a;
        }
        if (a.what == NOTIFY && features & NOTIFIES) {
            a.on = draw(seed, 0, tasks - 1);
            a.other = draw(seed, 0, 4);
            return a;
        }
        if (interrupt) {
            continue;
        }
        if (a.what == DELAY) {
            a.value = draw(seed, 0, 3);
            return a;
        }
        if (a.what == DELAY_UNTIL) {
            a.value = draw(seed, 1, 3);
            return a;
        }
        if (a.what == PRIORITY && features & PRIORITIES) {
            a.on = draw(seed, 0, tasks - 1);
            a.value = draw(seed, 0, 4);
            return a;
        }
        if ((a.what == NOTIFY_TAKE || a.what == NOTIFY_WAIT) && features & NOTIFIES) {
            return a;
        }
    }
}

/* Put a take and a give of a mutex around other actions. With changing priorities the holder lowers
 * its own, perhaps below one that it was lent, and waits for another semaphore. */
static inline void hold(uint64_t *seed, struct program *p, int task, int features)
{
    const int first = draw(seed, 0, ACTIONS - 6), mutex = draw(seed, MUTEX, QUEUE - 1);
    struct action *a = p->action[task] + first;

    a[0] = (struct action){ TAKE, mutex, 0, some_ticks(seed, features), 0 };
    if (features & PRIORITIES) {
        a[1] = (struct action){ COMPUTE, 0, draw(seed, 0, 30), 0, 0 };
        a[2] = (struct action){ PRIORITY, task, draw(seed, 0, 3), 0, 0 };
        a[3] = (struct action){ TAKE, BINARY, 0, some_ticks(seed, features), 0 };
    }
    a[draw(seed, features & PRIORITIES ? 4 : 1, ACTIONS - 2 - first)] =
        (struct action){ GIVE, mutex, 0, 0, 0 };
}

static inline void distinct(uint64_t *seed, struct program *p)
{
    for (int i = 0; i < p->tasks; i++) { /* 1 .. tasks in some order */
        const int other = draw(seed, 0, i);
        p->priority[i] = p->priority[other];
        p->priority[other] = i + 1;
    }
}

static inline struct program task_program(int number)
{
    static const int FEATURES[10] = { 0,
                                      EQUALS | PRIORITIES,
                                      FORGETS,
                                      EQUALS | CROWDS | FORGETS | TIMEOUTS,
                                      EQUALS | MUTEXES | TIMEOUTS,
                                      EQUALS | MUTEXES | TIMEOUTS | PRIORITIES | CROWDS,
                                      EQUALS | QUEUED | TIMEOUTS | FORGETS,
                                      EQUALS | QUEUED | CROWDS | TIMEOUTS | FORGETS | COSTS,
                                      EQUALS | NOTIFIES | TIMEOUTS | FORGETS | PRIORITIES,
                                      EQUALS | FORGETS | CROWDS | MUTEXES | QUEUED | TIMEOUTS
                                          | NOTIFIES | PRIORITIES | COSTS };
    const int features = FEATURES[number % 10];
    uint64_t seed = (uint64_t)(number + 1) * 0x9e3779b97f4a7c15u;
    struct program p;

    memset(&p, 0, sizeof p);
    p.tasks = draw(&seed, 2, TASKS);
    p.tick = 20;
    p.end = 1000;
    if (features & COSTS) {
        p.tick_time = draw(&seed, 0, 2);
        p.switch_time = draw(&seed, 0, 6);
        p.entry_time = draw(&seed, 0, 2);
    }
    for (int i = 0; i < p.tasks; i++) {
        p.priority[i] = draw(&seed, 0, 3);
    }
    if (!(features & EQUALS)) {
        distinct(&seed, &p);
    }
    for (int i = 0; i < TASKS + INTERRUPTS; i++) {
        const bool interrupt = i >= TASKS, holds = !interrupt && features & MUTEXES;
        const int n = p.actions[i] = holds ? ACTIONS : draw(&seed, 2, interrupt ? 4 : ACTIONS);
        for (int j = 0; j < n - 1; j++) {
            p.action[i][j] = some_action(&seed, features, interrupt, p.tasks);
        }
        if (holds && draw(&seed, 0, 3)) {
            hold(&seed, &p, i, features);
        }
        p.action[i][n - 1] = (struct action){ COMPUTE, 0, draw(&seed, 1, 9), 0, 0 };
        if (interrupt) {
            p.action[i][n - 1] =
                (struct action){ END, 0, features & FORGETS ? draw(&seed, 0, 1) : 1, 0, 0 };
        }
    }
    p.pends = draw(&seed, 0, PENDS);
    for (int64_t i = 0, clock = 0; i < p.pends; i++) {
        clock += draw(&seed, 1, 50);
        p.pend[i].clock = clock;
        p.pend[i].interrupt = draw(&seed, 0, INTERRUPTS - 1);
    }
    return p;
}

/* --- Tokens. --- */

enum { TEXT = 40000 };
static struct {
    char text[TEXT];
    int length;
    uint32_t hash;
    int64_t clock;
    int tokens;
} said;

static inline void say_anew(void)
{
    memset(&said, 0, sizeof said);
    said.hash = 2166136261u; /* FNV-1a */
    said.clock = -1;
}

static inline void say_text(const char *text)
{
    for (; *text && said.length < TEXT - 1; text++) {
        said.text[said.length++] = *text;
        said.hash = (said.hash ^ (unsigned char)*text) * 16777619u;
    }
}

static inline void say(int64_t clock, const char *format, ...)
{
    char token[64];
    va_list list;

    if (clock != said.clock) {
        snprintf(token, sizeof token, "@%lld ", (long long)clock);
        said.clock = clock;
        say_text(token);
    }
    va_start(list, format);
    vsnprintf(token, sizeof token, format, list);
    va_end(list);
    say_text(token);
    said.tokens++;
}

/* An action has ended. */
static inline void say_end(int64_t clock, int context, int at, int result, const int64_t *value)
{
    say(clock, "%c%d.%d=%d", context < TASKS ? 't' : 'i', context % TASKS, at, result);
    if (value) {
        char token[32];
        snprintf(token, sizeof token, ":%lld", (long long)*value);
        say_text(token);
    }
    say_text(" ");
}

#endif
