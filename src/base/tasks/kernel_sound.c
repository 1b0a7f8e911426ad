#include "kernel_parts.h"

/* Clocks and counts are below this: sums of two of them are numbers. */
static const int64_t LARGEST = (int64_t)1 << 61;

static bool between(int64_t value, int64_t low, int64_t high)
{
    return value >= low && value <= high;
}

static bool config_sound(const struct kernel_config *c)
{
    return between(c->tick, 0, LARGEST) && between(c->tick_time, 0, LARGEST) &&
           between(c->switch_time, 0, LARGEST) && between(c->entry_time, 0, LARGEST);
}

static bool task_sound(const struct kernel *k, const struct kernel_task *t, bool used)
{
    return between(t->priority, 0, KERNEL_PRIORITY_MAX) &&
           between(t->base, 0, KERNEL_PRIORITY_MAX) && between(t->rank, 0, KERNEL_PRIORITY_MAX) &&
           between(t->turn, 0, LARGEST) &&
           between(t->place, 0, LARGEST) && between(t->queue, 0, KERNEL_QUEUES - 1) &&
           t->call < KERNEL_CALLS && t->notified < KERNEL_NOTIFY_STATES && t->wake >= 0 &&
           t->ticks >= 0 && between(t->result, KERNEL_IN_VAIN, KERNEL_OK) &&
           between(t->since, 0, k->ticks) && between(t->held, 0, INT32_MAX - 1) &&
           (used || (!t->ready && !t->waits && t->wake == INT64_MAX));
}

static bool queue_sound(const struct kernel_queue_config *c, const struct kernel_queue *q,
                        int tasks)
{
    return c->kind < KERNEL_KINDS && between(q->count, 0, q->length) &&
           between(q->first, 0, KERNEL_ITEMS - 1) && between(q->holder, -1, tasks - 1) &&
           (c->kind != KERNEL_QUEUE || q->length <= KERNEL_ITEMS);
}

/* Who has the processor, who is asked, and that the idle task can have it. */
static bool current_sound(const struct kernel *k, int tasks, int interrupts)
{
    const struct kernel_task *idle = &k->task[KERNEL_IDLE];
    bool ok = between(k->current, -1, tasks - 1) && between(k->first, -1, tasks - 1) &&
              between(k->asked, -1, KERNEL_TASKS + interrupts - 1) &&
              (k->asked < 0 || k->asked >= KERNEL_TASKS || k->asked == k->current) &&
              idle->ready && idle->priority == 0 && !idle->waits && idle->call == KERNEL_NO_CALL;

    for (int i = 0; i < KERNEL_TASKS; i++) {
        ok = ok && k->processor.task[i].ready == (i == k->current);
    }
    return ok;
}

bool kernel_sound(const struct kernel *k, int tasks, int interrupts)
{
    const struct processor *p = &k->processor;
    bool ok = k->config.tasks == tasks && p->tasks == PROCESSOR_TASKS && config_sound(&k->config) &&
              between(p->running, -1, PROCESSOR_TASKS - 1) && current_sound(k, tasks, interrupts) &&
              between(p->clock, 0, LARGEST) && between(k->turns, 0, LARGEST) &&
              between(k->ticks, 0, LARGEST) && between(k->events, 0, LARGEST) &&
              between(p->idle, 0, p->clock) &&
              (k->config.tick == 0 ? k->next_tick == INT64_MAX
                                   : between(k->next_tick, 0, p->clock + k->config.tick));

    for (int i = 0; i < PROCESSOR_TASKS; i++) {
        const struct processor_task *t = &p->task[i];
        const bool used = i < tasks || between(i, KERNEL_TASKS, KERNEL_TASKS + interrupts - 1) ||
                          i == PROCESSOR_TASKS - 1;
        ok = ok && between(t->left, 0, LARGEST) && between(t->busy, 0, p->clock) &&
             (used || !t->ready);
    }
    for (int i = 0; i <= KERNEL_IDLE; i++) {
        ok = ok && task_sound(k, &k->task[i], i < tasks || i == KERNEL_IDLE);
    }
    for (int i = 0; i < KERNEL_QUEUES; i++) {
        ok = ok && queue_sound(&k->config.queue[i], &k->queue[i], tasks);
    }
    for (int i = interrupts; i < KERNEL_INTERRUPTS; i++) {
        ok = ok && k->pending[i] == INT64_MAX;
    }
    return ok;
}
