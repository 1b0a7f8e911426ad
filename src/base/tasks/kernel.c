#include "kernel_parts.h"

#include <string.h>

enum {
    SELF = KERNEL_TASKS + KERNEL_INTERRUPTS, /* the kernel's own place on the processor */
    LEVEL_MAX = 255,
    INTERRUPT_BASE = 2000
};

static bool queue_valid(const struct kernel_queue_config *q)
{
    const int32_t most = q->kind == KERNEL_COUNTING ? INT32_MAX
                         : q->kind == KERNEL_QUEUE  ? KERNEL_ITEMS
                                                    : 0;
    const int32_t count = q->kind == KERNEL_COUNTING ? q->length : q->kind == KERNEL_BINARY;

    return q->kind >= KERNEL_BINARY && q->kind < KERNEL_KINDS
           && (most == 0 || (q->length >= 1 && q->length <= most)) && q->count >= 0
           && q->count <= count;
}

static bool valid(const struct kernel_config *c)
{
    bool ok = c->tasks >= 0 && c->tasks <= KERNEL_TASKS && c->tick >= 0 && c->tick_time >= 0
              && c->switch_time >= 0 && c->entry_time >= 0;

    for (int i = 0; i < KERNEL_TASKS; i++) {
        ok = ok && c->priority[i] >= 0 && c->priority[i] <= KERNEL_PRIORITY_MAX;
    }
    for (int i = 0; i < KERNEL_INTERRUPTS; i++) {
        ok = ok && c->level[i] >= 0 && c->level[i] <= LEVEL_MAX;
    }
    for (int i = 0; i < KERNEL_QUEUES; i++) {
        ok = ok && queue_valid(&c->queue[i]);
    }
    return ok;
}

/* The kernel itself takes the processor for a time: overhead. */
static void spend(struct kernel *k, int64_t time)
{
    if (time > 0) {
        processor_wake(&k->processor, SELF, 0);
        processor_compute(&k->processor, SELF, time);
    }
}

/* Give the processor to another task. */
static void switch_to(struct kernel *k, int task)
{
    if (k->current >= 0) {
        processor_block(&k->processor, k->current);
    }
    k->current = task == KERNEL_IDLE ? -1 : task;
    if (task != KERNEL_IDLE) {
        k->processor.ready |= (uint32_t)1 << task;
        kernel_note(k, KERNEL_RUNS, task, 0);
        spend(k, k->config.switch_time);
    }
}

/* Make all tasks ready, the idle one behind them. The last of the most urgent tasks runs first. */
static void start_tasks(struct kernel *k)
{
    int first = KERNEL_IDLE;

    for (int i = 0; i <= KERNEL_IDLE; i++) {
        struct kernel_task *t = &k->task[i];
        if (i < KERNEL_IDLE) {
            t->priority = t->base = t->rank = k->config.priority[i];
        }
        t->wake = INT64_MAX;
        if (i < k->config.tasks || i == KERNEL_IDLE) {
            kernel_ready(k, i);
            first = t->priority >= k->task[first].priority ? i : first;
        }
    }
    k->current = -1;
    k->first = first == KERNEL_IDLE ? -1 : first;
}

enum kernel_status kernel_start(struct kernel *k, const struct kernel_config *config)
{
    if (!valid(config)) {
        return KERNEL_RANGE;
    }
    memset(k, 0, sizeof *k);
    k->config = *config;
    k->asked = -1;
    k->next_tick = config->tick > 0 ? config->tick : INT64_MAX;
    processor_start(&k->processor, PROCESSOR_TASKS);
    for (int i = 0; i < KERNEL_INTERRUPTS; i++) {
        k->processor.task[KERNEL_TASKS + i].priority = INTERRUPT_BASE - config->level[i];
    }
    k->processor.task[SELF].priority = INT32_MAX;
    for (int i = 0; i < KERNEL_QUEUES; i++) {
        const struct kernel_queue_config *q = &config->queue[i];
        const bool counts = q->kind == KERNEL_COUNTING || q->kind == KERNEL_QUEUE;
        k->queue[i] = (struct kernel_queue){ .length = counts ? q->length : 1,
                                             .holder = -1,
                                             .count = q->kind == KERNEL_MUTEX ? 1 : q->count };
    }
    start_tasks(k);
    return KERNEL_OK;
}

void kernel_note(struct kernel *k, enum kernel_what what, int32_t number, int32_t value)
{
    k->log[k->events++ % KERNEL_LOG] =
        (struct kernel_event){ k->processor.clock, what, number, value };
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
    if (!(k->pending >> interrupt & 1)) {
        k->pending |= 1u << interrupt;
        k->pends[interrupt] = clock;
    }
    return KERNEL_OK;
}

void kernel_yield(struct kernel *k)
{
    k->chooses = true;
    k->processor.running = -1;
}

bool kernel_pay(struct kernel *k)
{
    if (k->owed) {
        kernel_yield(k);
    }
    return k->owed;
}

/* The interrupt to begin now: pending, and more urgent than the one that is served; -1 none. */
static int due_interrupt(const struct kernel *k, int served)
{
    const int32_t floor = served >= KERNEL_TASKS ? k->processor.task[served].priority : 0;
    int best = -1;

    for (int i = 0; k->pending >> i != 0; i++) {
        const int32_t priority = k->processor.task[KERNEL_TASKS + i].priority;
        if (k->pending >> i & 1 && k->pends[i] <= k->processor.clock && priority > floor
            && (best < 0 || priority > k->processor.task[KERNEL_TASKS + best].priority)) {
            best = i;
        }
    }
    return best;
}

static void begin_interrupt(struct kernel *k, int interrupt)
{
    k->pending &= ~(1u << interrupt);
    k->woken[interrupt] = false;
    processor_wake(&k->processor, KERNEL_TASKS + interrupt, 0);
    kernel_note(k, KERNEL_INTERRUPT, interrupt, 0);
    spend(k, k->config.entry_time);
}

/* The task to be woken next at this tick, whose delay or wait is over; -1 none. */
static int due_task(const struct kernel *k)
{
    int first = -1;

    for (int i = 0; i < k->config.tasks; i++) {
        const struct kernel_task *t = &k->task[i], *f = &k->task[first < 0 ? i : first];
        if (t->wake <= k->ticks
            && (first < 0 || t->wake < f->wake || (t->wake == f->wake && t->order < f->order))) {
            first = i;
        }
    }
    return first;
}

static void tick(struct kernel *k)
{
    bool chooses = k->owed;

    k->ticks++;
    k->next_tick = (k->processor.clock / k->config.tick + 1) * k->config.tick;
    for (int i; (i = due_task(k)) >= 0;) {
        chooses = kernel_wake(k, i) || chooses;
    }
    if (chooses || kernel_equals(k, k->task[kernel_current(k)].priority) > 1) {
        kernel_yield(k);
    }
    spend(k, k->config.tick_time);
}

static void choose(struct kernel *k)
{
    k->chooses = k->owed = false;
    const int task = kernel_choose(k);
    if (task != kernel_current(k)) {
        switch_to(k, task);
    }
}

/* Begin what is due at this clock before tasks go on: an interrupt, the choice of a task or the
 * tick. Returns false if nothing is due. */
static bool begin(struct kernel *k)
{
    if (processor_ready(&k->processor, SELF)) {
        return false;
    }
    if (k->first >= 0) { /* interrupts are masked until the first task runs */
        switch_to(k, k->first);
        k->first = -1;
        return true;
    }
    const int first = processor_first(&k->processor);
    const int interrupt = due_interrupt(k, first);
    if (interrupt >= 0) {
        begin_interrupt(k, interrupt);
        return true;
    }
    if (first >= KERNEL_TASKS) { /* an interrupt is served */
        return false;
    }
    if (k->chooses) {
        choose(k);
        return true;
    }
    if (k->next_tick <= k->processor.clock) {
        tick(k);
        return true;
    }
    if (k->current < 0 && k->ready != 1u << KERNEL_IDLE && kernel_equals(k, 0) > 1) {
        kernel_yield(k);
        return true;
    }
    return false;
}

/* The next clock at which an interrupt or the tick may begin, at most `until`. */
static int64_t horizon(const struct kernel *k, int64_t until)
{
    const int64_t clock = k->processor.clock;
    int64_t to = k->next_tick > clock && k->next_tick < until ? k->next_tick : until;

    for (int i = 0; k->pending >> i != 0; i++) {
        if (k->pending >> i & 1 && k->pends[i] > clock && k->pends[i] < to) {
            to = k->pends[i];
        }
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
        } else if (over >= 0 && over < KERNEL_TASKS && k->task[over].call != KERNEL_NO_CALL) {
            kernel_go_on(k, over);
        } else if (over >= 0) {
            return k->asked = over;
        }
    }
    return -1;
}

int32_t kernel_priority(const struct kernel *k, int task)
{
    return k->task[task].priority;
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
