/* The kernel against a model that looks at everything at every clock. */
#include "check.h"

#include <string.h>

#include "kernel.h"

static struct kernel k;

/* --- Scripts: what a task or interrupt does, over and over; an interrupt once each time. --- */
enum what { COMPUTE, GIVE, TAKE, DELAY, PRIORITY, END };
struct action { enum what what; int32_t value, other; };
enum { ACTIONS = 6, SCRIPTS = KERNEL_TASKS + KERNEL_INTERRUPTS, MARKS = 60000, PENDS = 40 };
struct set {
    struct kernel_config c;
    struct action script[SCRIPTS][ACTIONS];
    int length[SCRIPTS];
    struct { int64_t clock; int interrupt; } pend[PENDS];   /* rising */
    int pends;
};

/* What is compared: at this clock the context does its next action. */
struct mark { int64_t clock; int context, at; };
struct trace { int n; struct mark m[MARKS]; int64_t busy[SCRIPTS], idle; };

static void mark(struct trace *t, int64_t clock, int context, int at)
{
    if (t->n < MARKS) {
        t->m[t->n++] = (struct mark){ clock, context, at };
    }
}

static void answer(const struct action *a)
{
    switch (a->what) {
    case COMPUTE:
        CHECK_EQ(kernel_compute(&k, a->value), KERNEL_OK);
        break;
    case GIVE:
        CHECK(kernel_give(&k, a->value) >= KERNEL_WAS_FULL);
        break;
    case TAKE:
        CHECK_EQ(kernel_take(&k, a->value), KERNEL_OK);
        break;
    case DELAY:
        CHECK_EQ(kernel_delay(&k, a->value), KERNEL_OK);
        break;
    case PRIORITY:
        CHECK_EQ(kernel_set_priority(&k, a->other, a->value), KERNEL_OK);
        break;
    default:
        CHECK_EQ(kernel_end_interrupt(&k, a->value), KERNEL_OK);
    }
}

/* The scripts on the kernel, asked in steps of random length. The first pends are told at once, a
 * second one of an interrupt when the first has begun. */
static void scheduled(const struct set *q, int64_t clocks, uint64_t *seed, struct trace *t)
{
    int at[SCRIPTS] = { 0 }, next = 0;
    memset(t, 0, sizeof *t);
    CHECK_EQ(kernel_start(&k, &q->c), KERNEL_OK);
    for (int64_t until = 0; k.processor.clock < clocks;) {
        until += check_random(seed, 1, 30);
        until = until < clocks ? until : clocks;
        const int64_t stop = next < q->pends && q->pend[next].clock < until
                           ? q->pend[next].clock : until;
        for (int c; (c = kernel_next(&k, stop)) >= 0;) {
            mark(t, k.processor.clock, c, at[c]);
            answer(&q->script[c][at[c]]);
            at[c] = (at[c] + 1) % q->length[c];
        }
        for (; next < q->pends && q->pend[next].clock <= stop; next++) {
            CHECK_EQ(kernel_pend(&k, q->pend[next].interrupt, q->pend[next].clock), KERNEL_OK);
        }
        until = stop;
    }
    for (int i = 0; i < SCRIPTS; i++) {
        t->busy[i] = kernel_busy(&k, i);
    }
    t->idle = kernel_idle(&k);
    CHECK_EQ(kernel_overhead(&k), 0);
}

/* --- The model: lists in the order of waiting and of being ready, one clock after another. --- */
struct one { bool ready, hidden, delayed; int takes, priority, left; int64_t ends; };
static struct {
    struct one c[SCRIPTS];
    int at[SCRIPTS];
    int ready[SCRIPTS], readies, waits[SCRIPTS], waiting;   /* tasks in order */
    int stack[KERNEL_INTERRUPTS], depth;                    /* interrupts under way */
    bool full[KERNEL_SEMAPHORES], pending[KERNEL_INTERRUPTS];
    int64_t ticks;
    bool tick;                      /* one is pending */
    bool choosing;                  /* as soon as no interrupt is under way */
    int on;                         /* that goes on without the kernel's choice; -1 none */
} b;

static void list_remove(int *list, int *n, int x)
{
    int m = 0;
    for (int i = 0; i < *n; i++) {
        if (list[i] != x) {
            list[m++] = list[i];
        }
    }
    *n = m;
}

static void list_last(int *list, int *n, int x)
{
    list_remove(list, n, x);
    list[(*n)++] = x;
}

static int brute_choose(void)
{
    int best = -1;
    if (b.depth) {
        return b.stack[b.depth - 1];
    }
    for (int i = 0; i < KERNEL_TASKS; i++) {
        b.c[i].hidden = b.c[i].hidden && !b.choosing;
    }
    b.choosing = false;
    for (int i = 0; i < b.readies; i++) {
        const struct one *x = &b.c[b.ready[i]];
        if (x->ready && !x->hidden && (best < 0 || x->priority > b.c[best].priority)) {
            best = b.ready[i];
        }
    }
    return best;
}

static void reveal(void)
{
    b.choosing = true;
    b.on = -1;
}

static void ready(int task, bool hidden)
{
    b.c[task].ready = true;
    b.c[task].hidden = hidden;
    b.c[task].left = 0;
    list_last(b.ready, &b.readies, task);
}

static void brute_give(int context, int semaphore)
{
    int best = -1;
    if (b.full[semaphore]) {
        return;
    }
    for (int i = 0; i < b.waiting; i++) {
        const int t = b.waits[i];
        if (b.c[t].takes == semaphore && (best < 0 || b.c[t].priority > b.c[best].priority)) {
            best = t;
        }
    }
    if (best < 0) {
        b.full[semaphore] = true;
        return;
    }
    list_remove(b.waits, &b.waiting, best);
    ready(best, context >= KERNEL_TASKS);
    if (context < KERNEL_TASKS) {
        reveal();
    }
}

static void brute_block(int task)
{
    b.c[task].ready = false;
    list_remove(b.ready, &b.readies, task);
    reveal();
}

static void brute_act(const struct set *q, int c)
{
    const struct action *a = &q->script[c][b.at[c]];
    struct one *x = &b.c[c];
    b.at[c] = (b.at[c] + 1) % q->length[c];
    b.on = c;
    if (a->what == COMPUTE) {
        x->left = a->value;
    } else if (a->what == GIVE) {
        brute_give(c, a->value);
    } else if (a->what == TAKE && b.full[a->value]) {
        b.full[a->value] = false;
    } else if (a->what == TAKE) {
        x->takes = a->value;
        list_last(b.waits, &b.waiting, c);
        brute_block(c);
    } else if (a->what == DELAY && a->value == 0) {
        list_last(b.ready, &b.readies, c);
        reveal();
    } else if (a->what == DELAY) {
        x->delayed = true;
        x->ends = b.ticks + a->value;
        brute_block(c);
    } else if (a->what == PRIORITY && b.c[a->other].priority != a->value) {
        b.c[a->other].priority = a->value;
        if (b.c[a->other].ready) {
            list_last(b.ready, &b.readies, a->other);
        }
        reveal();
    } else if (a->what == END) {
        b.depth--;
        b.on = -1;
        if (a->value) {
            reveal();
        }
    }
}

/* The most urgent interrupt that may begin. */
static int brute_interrupt(const struct set *q)
{
    int best = -1;
    for (int i = 0; i < KERNEL_INTERRUPTS; i++) {
        const int32_t level = q->c.level[i];
        const bool goes = !b.depth || level < q->c.level[b.stack[b.depth - 1] - KERNEL_TASKS];
        if (b.pending[i] && goes && (best < 0 || level < q->c.level[best])) {
            best = i;
        }
    }
    return best;
}

static void brute_tick(const struct set *q, int *current)
{
    if (b.depth || !b.tick) {
        return;
    }
    b.tick = false;
    b.ticks++;
    for (int i = 0; i < q->c.tasks; i++) {
        if (b.c[i].delayed && b.c[i].ends <= b.ticks) {
            b.c[i].delayed = false;
            ready(i, false);
        }
    }
    if (*current >= 0 && b.c[*current].ready && !b.c[*current].hidden) {
        list_last(b.ready, &b.readies, *current);
    }
    reveal();
}

static void brute(const struct set *q, int64_t clocks, struct trace *t)
{
    int next = 0, current = -1;
    memset(t, 0, sizeof *t);
    memset(&b, 0, sizeof b);
    b.on = -1;
    for (int i = 0; i < q->c.tasks; i++) {
        b.c[i].priority = q->c.priority[i];
        ready(i, false);
    }
    for (int64_t clock = 0; clock < clocks; clock++) {
        b.tick = b.tick || (clock > 0 && q->c.tick && clock % q->c.tick == 0);
        for (; next < q->pends && q->pend[next].clock <= clock; next++) {
            b.pending[q->pend[next].interrupt] = true;
        }
        for (;;) {
            int c = b.on;
            while (c >= 0 && b.on == c && b.c[c].left == 0) {   /* what is over comes first */
                mark(t, clock, c, b.at[c]);
                brute_act(q, c);
            }
            const int i = brute_interrupt(q);
            if (i >= 0) {
                b.pending[i] = false;
                b.stack[b.depth++] = KERNEL_TASKS + i;
                b.c[KERNEL_TASKS + i].left = 0;
                b.on = -1;
                continue;
            }
            brute_tick(q, &current);
            c = brute_choose();
            current = b.depth ? current : c;
            if (c < 0 || b.c[c].left > 0) {
                b.on = c;
                break;
            }
            b.on = c;
        }
        if (b.on >= 0) {
            b.c[b.on].left--;
            t->busy[b.on]++;
        } else {
            t->idle++;
        }
    }
}

static struct action random_action(uint64_t *seed, bool interrupt)
{
    const int die = (int)check_random(seed, 0, interrupt ? 3 : 9);
    struct action a = { GIVE, (int32_t)check_random(seed, 0, 2), 0 };
    if (die == 0 || die >= 7) {
        a = (struct action){ COMPUTE, (int32_t)check_random(seed, 0, 12), 0 };
    } else if (!interrupt && (die == 2 || die == 3)) {
        a.what = TAKE;
    } else if (!interrupt && die == 4) {
        a = (struct action){ DELAY, (int32_t)check_random(seed, 0, 3), 0 };
    } else if (!interrupt && die == 5) {
        a = (struct action){ PRIORITY, (int32_t)check_random(seed, 1, 4),
                             (int32_t)check_random(seed, 0, 3) };
    }
    return a;
}

static struct set random_set(uint64_t *seed)
{
    struct set q = { .c = { .tasks = 4, .tick = check_random(seed, 0, 3) ? 20 : 0,
                            .kernel_level = 0 } };
    for (int i = 0; i < SCRIPTS; i++) {
        const bool interrupt = i >= KERNEL_TASKS;
        const int n = q.length[i] = (int)check_random(seed, 2, ACTIONS);
        for (int j = 0; j < n - 1; j++) {
            q.script[i][j] = random_action(seed, interrupt);
        }
        q.script[i][n - 1] = interrupt
            ? (struct action){ END, (int32_t)check_random(seed, 0, 1), 0 }
            : (struct action){ COMPUTE, (int32_t)check_random(seed, 1, 9), 0 };
    }
    for (int i = 0; i < 4; i++) {
        q.c.priority[i] = (int32_t)check_random(seed, 1, 3);
    }
    for (int i = 0; i < KERNEL_INTERRUPTS; i++) {
        q.c.level[i] = i;
    }
    int64_t clock = 0;
    q.pends = (int)check_random(seed, 0, PENDS);
    for (int i = 0; i < q.pends; i++) {
        clock += check_random(seed, 1, 40);
        q.pend[i].clock = clock;
        q.pend[i].interrupt = (int)check_random(seed, 0, 2);
    }
    return q;
}

static struct trace one, two;

static void against_brute_force(void)
{
    uint64_t seed = 11;
    long long marks = 0;
    for (int i = 0; i < 2000 && !check_failures; i++) {
        const struct set q = random_set(&seed);
        brute(&q, 1500, &one);
        scheduled(&q, 1500, &seed, &two);
        CHECK_EQ(one.n, two.n);
        CHECK(!memcmp(&one, &two, sizeof one));
        marks += one.n;
    }
    CHECK(marks > 250000);
}

int main(void)
{
    against_brute_force();
    return check_result();
}
