#include "kernel_parts.h"

/* The ready task of this priority that the kernel has chosen last; -1 none: the first is next. */
static int hand(const struct kernel *k, int32_t priority)
{
    for (int i = 0; i <= KERNEL_IDLE; i++) {
        const struct kernel_task *t = &k->task[i];
        if (kernel_is_ready(k, i) && t->chosen && t->priority == priority) {
            return i;
        }
    }
    return -1;
}

void kernel_ready(struct kernel *k, int task)
{
    struct kernel_task *t = &k->task[task];
    const int before = hand(k, t->priority);

    t->turn = ++k->turns;
    if (before >= 0) {
        t->turn = k->task[before].turn;
        for (int i = 0; i <= KERNEL_IDLE; i++) {
            k->task[i].turn += kernel_is_ready(k, i) && k->task[i].turn >= t->turn;
        }
    }
    k->ready |= 1u << task;
    t->chosen = false;
}

void kernel_unready(struct kernel *k, int task)
{
    struct kernel_task *t = &k->task[task];
    struct kernel_task *before = NULL;

    for (int i = 0; t->chosen && i <= KERNEL_IDLE; i++) { /* the one before is chosen */
        struct kernel_task *o = &k->task[i];
        if (kernel_is_ready(k, i) && o->priority == t->priority && o->turn < t->turn
            && (!before || o->turn > before->turn)) {
            before = o;
        }
    }
    if (before) {
        before->chosen = true;
    }
    k->ready &= ~(1u << task);
    t->chosen = false;
}

int kernel_equals(const struct kernel *k, int32_t priority)
{
    int n = 0;

    for (int i = 0; i <= KERNEL_IDLE; i++) {
        n += kernel_is_ready(k, i) && k->task[i].priority == priority;
    }
    return n;
}

int kernel_choose(struct kernel *k)
{
    int32_t priority = 0;
    int first = -1, next = -1;

    for (int i = 0; i <= KERNEL_IDLE; i++) {
        const struct kernel_task *t = &k->task[i];
        priority = kernel_is_ready(k, i) && t->priority > priority ? t->priority : priority;
    }
    const int before = hand(k, priority);
    for (int i = 0; i <= KERNEL_IDLE; i++) {
        const struct kernel_task *t = &k->task[i];
        if (!kernel_is_ready(k, i) || t->priority != priority) {
            continue;
        }
        first = first < 0 || t->turn < k->task[first].turn ? i : first;
        if (before >= 0 && t->turn > k->task[before].turn
            && (next < 0 || t->turn < k->task[next].turn)) {
            next = i;
        }
    }
    next = next < 0 ? first : next;
    if (before >= 0) {
        k->task[before].chosen = false;
    }
    k->task[next].chosen = true;
    return next;
}

void kernel_block(struct kernel *k, int64_t ticks)
{
    struct kernel_task *t = &k->task[k->current];

    kernel_unready(k, k->current);
    t->wake = ticks < INT64_MAX - k->ticks ? k->ticks + ticks : INT64_MAX;
    t->order = ++k->turns;
}

static bool waits_there(const struct kernel_task *t, int queue, bool sends)
{
    return t->waits && t->queue == queue && (t->call == KERNEL_SENDS) == sends;
}

int kernel_first_waiting(const struct kernel *k, int queue, bool sends)
{
    int first = -1;

    for (int i = 0; i < k->config.tasks; i++) {
        const struct kernel_task *t = &k->task[i];
        if (waits_there(t, queue, sends) && (first < 0 || t->place < k->task[first].place)) {
            first = i;
        }
    }
    return first;
}

void kernel_wait(struct kernel *k)
{
    struct kernel_task *t = &k->task[k->current];
    int behind = -1; /* the first waiting task with a lower rank: this one goes before it */

    for (int i = 0; i < k->config.tasks; i++) {
        const struct kernel_task *o = &k->task[i];
        if (waits_there(o, t->queue, t->call == KERNEL_SENDS) && o->rank < t->rank
            && (behind < 0 || o->place < k->task[behind].place)) {
            behind = i;
        }
    }
    t->place = ++k->turns;
    if (behind >= 0) {
        t->place = k->task[behind].place;
        for (int i = 0; i < k->config.tasks; i++) {
            k->task[i].place += k->task[i].waits && k->task[i].place >= t->place;
        }
    }
    t->waits = true;
}

bool kernel_wake(struct kernel *k, int task)
{
    struct kernel_task *t = &k->task[task];

    if (kernel_is_ready(k, task)) {
        kernel_unready(k, task);
    }
    t->waits = false;
    t->wake = INT64_MAX;
    kernel_ready(k, task);
    return t->priority > k->task[kernel_current(k)].priority;
}

void kernel_change(struct kernel *k, int task, int32_t priority)
{
    struct kernel_task *t = &k->task[task];
    const bool ready = kernel_is_ready(k, task);

    if (ready) {
        kernel_unready(k, task);
    }
    t->priority = priority;
    if (ready) {
        kernel_ready(k, task);
    }
    kernel_note(k, KERNEL_PRIORITY, task, priority);
}
