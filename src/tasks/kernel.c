#include "kernel_parts.h"

#include <string.h>

enum {
    SELF = KERNEL_TASKS + KERNEL_INTERRUPTS,    /* the kernel's own place on the processor */
    LEVEL_MAX = 255, INTERRUPT_BASE = 2000
};

static bool valid(const struct kernel_config *c)
{
    bool ok = c->tasks >= 0 && c->tasks <= KERNEL_TASKS && c->tick >= 0 && c->tick_time >= 0 &&
              c->switch_time >= 0 && c->entry_time >= 0;

    for (int i = 0; i < KERNEL_TASKS; i++) {
        ok = ok && c->priority[i] >= 0 && c->priority[i] <= KERNEL_PRIORITY_MAX;
    }
    for (int i = 0; i < KERNEL_INTERRUPTS; i++) {
        ok = ok && c->level[i] >= 0 && c->level[i] <= LEVEL_MAX;
    }
    return ok;
}

enum kernel_status kernel_start(struct kernel *k, const struct kernel_config *config)
{
    if (!valid(config)) {
        return KERNEL_RANGE;
    }
    memset(k, 0, sizeof *k);
    k->config = *config;
    k->current = k->asked = -1;
    k->next_tick = config->tick > 0 ? config->tick : INT64_MAX;
    processor_start(&k->processor, PROCESSOR_TASKS);
    for (int i = 0; i < KERNEL_TASKS; i++) {
        k->processor.task[i].priority = config->priority[i];
        k->task[i].wait = i < config->tasks ? KERNEL_READY : KERNEL_ABSENT;
        if (i < config->tasks) {
            processor_wake(&k->processor, i, ++k->turns);
        }
    }
    for (int i = 0; i < KERNEL_INTERRUPTS; i++) {
        k->processor.task[KERNEL_TASKS + i].priority = INTERRUPT_BASE - config->level[i];
        k->pending[i] = INT64_MAX;
    }
    k->processor.task[SELF].priority = INT32_MAX;
    return KERNEL_OK;
}

void kernel_note(struct kernel *k, enum kernel_what what, int32_t number, int32_t value)
{
    k->log[k->events++ % KERNEL_LOG] = (struct kernel_event){ k->processor.clock, what, number,
                                                              value };
}

void kernel_mark(struct kernel *k, int32_t number, int32_t value)
{
    kernel_note(k, KERNEL_MARK, number, value);
}

enum kernel_status kernel_pend(struct kernel *k, int interrupt, int64_t clock)
{
    if (interrupt < 0 || interrupt >= KERNEL_INTERRUPTS) {
        return KERNEL_RANGE;
    }
    if (k->pending[interrupt] == INT64_MAX) {
        k->pending[interrupt] = clock;
    }
    return KERNEL_OK;
}

/* The kernel needs so much time before anything goes on. */
static void spend(struct kernel *k, int64_t time)
{
    if (time > 0) {
        processor_wake(&k->processor, SELF, 0);
        processor_compute(&k->processor, SELF, time);
    }
}

void kernel_choose(struct kernel *k)
{
    k->chooses = true;
    k->processor.running = -1;
}

/* Tasks that an interrupt has woken can be seen. */
static void reveal(struct kernel *k)
{
    for (int i = 0; i < k->config.tasks; i++) {
        if (k->task[i].hidden) {
            k->task[i].hidden = false;
            processor_wake(&k->processor, i, k->task[i].turn);
        }
    }
    k->chooses = false;
}

void kernel_wake(struct kernel *k, int task, bool hidden)
{
    struct kernel_task *t = &k->task[task];

    t->wait = KERNEL_READY;
    t->hidden = hidden;
    t->turn = ++k->turns;
    if (!hidden) {
        processor_wake(&k->processor, task, t->turn);
    }
}

static bool in_interrupt(const struct kernel *k)
{
    const int first = processor_first(&k->processor);
    return first >= KERNEL_TASKS && first < SELF;
}

/* The interrupt to begin now: pending, and more urgent than what is served; -1 none. */
static int due_interrupt(const struct kernel *k)
{
    const int served = processor_first(&k->processor);
    const int32_t floor = served >= KERNEL_TASKS ? k->processor.task[served].priority
                                                 : KERNEL_PRIORITY_MAX;
    int best = -1;

    for (int i = 0; i < KERNEL_INTERRUPTS; i++) {
        const int32_t priority = k->processor.task[KERNEL_TASKS + i].priority;
        if (k->pending[i] <= k->processor.clock && priority > floor &&
            (best < 0 || priority > k->processor.task[KERNEL_TASKS + best].priority)) {
            best = i;
        }
    }
    return best;
}

static void begin_interrupt(struct kernel *k, int interrupt)
{
    k->pending[interrupt] = INT64_MAX;
    processor_wake(&k->processor, KERNEL_TASKS + interrupt, 0);
    kernel_note(k, KERNEL_INTERRUPT, interrupt, 0);
    spend(k, k->config.entry_time);
}

static void tick(struct kernel *k)
{
    k->ticks++;
    k->next_tick = (k->processor.clock / k->config.tick + 1) * k->config.tick;
    for (int i = 0; i < k->config.tasks; i++) {
        if (k->task[i].wait == KERNEL_DELAYED && k->task[i].ticks <= k->ticks) {
            kernel_wake(k, i, false);
        }
    }
    if (k->current >= 0 && k->processor.task[k->current].ready) {   /* its equals have their turn */
        k->processor.task[k->current].turn = ++k->turns;
    }
    kernel_choose(k);
    spend(k, k->config.tick_time);
}

/* Another task than before gets the processor. */
static void switch_to(struct kernel *k, int task)
{
    k->current = task;
    if (task >= 0) {
        kernel_note(k, KERNEL_RUNS, task, 0);
        spend(k, k->config.switch_time);
    }
}

/* What begins at this clock beside the tasks; false: nothing. */
static bool begin(struct kernel *k)
{
    if (k->processor.task[SELF].ready) {
        return false;
    }
    const int interrupt = due_interrupt(k);
    if (interrupt >= 0) {
        begin_interrupt(k, interrupt);
        return true;
    }
    if (in_interrupt(k)) {
        return false;
    }
    if (k->next_tick <= k->processor.clock) {
        tick(k);
        return true;
    }
    if (k->chooses) {
        reveal(k);
    }
    const int first = processor_first(&k->processor);
    if (first != k->current) {
        switch_to(k, first);
        return true;
    }
    return false;
}

/* The next clock at which something may begin, up to `until`. */
static int64_t horizon(const struct kernel *k, int64_t until)
{
    const int64_t clock = k->processor.clock;
    int64_t to = k->next_tick > clock && k->next_tick < until ? k->next_tick : until;

    for (int i = 0; i < KERNEL_INTERRUPTS; i++) {
        to = k->pending[i] > clock && k->pending[i] < to ? k->pending[i] : to;
    }
    return to;
}

int kernel_next(struct kernel *k, int64_t until)
{
    struct processor *p = &k->processor;

    for (k->asked = -1; p->clock < until;) {
        int over = processor_over(p);
        if (over < 0 && !begin(k)) {
            over = processor_dispatch(p);
            if (over < 0) {
                processor_pass(p, horizon(k, until));
            }
        }
        if (over == SELF) {
            processor_block(p, SELF);
            p->running = -1;
        } else if (over >= 0) {
            return k->asked = over;
        }
    }
    return -1;
}

int64_t kernel_busy(const struct kernel *k, int context)
{
    return k->processor.task[context].busy;
}

int64_t kernel_idle(const struct kernel *k)
{
    return k->processor.idle;
}

int64_t kernel_overhead(const struct kernel *k)
{
    return k->processor.task[SELF].busy;
}
