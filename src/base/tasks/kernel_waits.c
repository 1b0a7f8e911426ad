/* Semaphores, mutexes and queues: the calls that may wait. */
#include "kernel_parts.h"

static bool is(const struct kernel *k, int queue, enum kernel_kind kind)
{
    return k->config.queue[queue].kind == kind;
}

/* Wake the first task that waits for a queue, to send or to take. Returns whether there is one. */
static bool release(struct kernel *k, int queue, bool sends)
{
    const int task = kernel_first_waiting(k, queue, sends);

    if (task >= 0) {
        kernel_woke(k, kernel_wake(k, task));
    }
    return task >= 0;
}

static void put(struct kernel *k, int queue, int32_t value)
{
    struct kernel_queue *q = &k->queue[queue];

    if (is(k, queue, KERNEL_QUEUE)) {
        q->item[(q->first + q->count) % KERNEL_ITEMS] = value;
    }
    q->count++;
    kernel_note(k, KERNEL_GIVEN, queue, k->asked);
}

static int32_t get(struct kernel *k, int queue)
{
    struct kernel_queue *q = &k->queue[queue];
    const int32_t value = q->item[q->first];

    if (is(k, queue, KERNEL_QUEUE)) {
        q->first = (q->first + 1) % KERNEL_ITEMS;
    }
    q->count--;
    kernel_note(k, KERNEL_TAKEN, queue, k->asked);
    return value;
}

/* Do what the call asks for if that is possible now: there is room, or something to take. */
static bool attempt(struct kernel *k, struct kernel_task *t)
{
    struct kernel_queue *q = &k->queue[t->queue];

    if (t->call == KERNEL_SENDS ? q->count == q->length : q->count == 0) {
        return false;
    }
    if (t->call == KERNEL_SENDS) {
        put(k, t->queue, t->value);
        release(k, t->queue, false);
        return true;
    }
    const int32_t value = get(k, t->queue);
    if (is(k, t->queue, KERNEL_MUTEX)) {
        q->holder = k->asked;
        t->held++;
    }
    if (t->call == KERNEL_RECEIVES) {
        t->value = value;
        release(k, t->queue, true);
    }
    return true;
}

/* Whether the time to wait is over; if not, what is left of it counts from now on. */
static bool expired(const struct kernel *k, struct kernel_task *t)
{
    const int64_t passed = k->ticks - t->since;

    if (t->ticks != KERNEL_FOREVER && passed >= t->ticks) {
        t->ticks = 0;
        return true;
    }
    t->ticks -= t->ticks == KERNEL_FOREVER ? 0 : passed;
    t->since = k->ticks;
    return false;
}

/* Before a task waits for a mutex: raise the holder to its priority. Returns whether the holder has
 * a lent priority that may have to be taken back. */
static bool lend(struct kernel *k, int holder)
{
    const int32_t priority = k->task[k->asked].priority;

    if (holder < 0) {
        return false;
    }
    if (k->task[holder].priority < priority) {
        k->task[holder].rank = priority;
        kernel_change(k, holder, priority);
        return true;
    }
    return k->task[holder].base < priority;
}

/* A task has waited for a mutex in vain: if the holder has only this mutex, its priority becomes
 * its own or that of the next waiting task, whichever is higher. */
static void take_back(struct kernel *k, int queue)
{
    const int holder = k->queue[queue].holder, next = kernel_first_waiting(k, queue, false);

    if (holder < 0 || k->task[holder].held != 1) {
        return;
    }
    const int32_t base = k->task[holder].base, most = next < 0 ? 0 : k->task[next].rank;
    const int32_t priority = base < most ? most : base;
    if (k->task[holder].priority != priority) {
        k->task[holder].rank = priority;
        kernel_change(k, holder, priority);
    }
}

static void end(struct kernel_task *t, enum kernel_status result)
{
    t->call = KERNEL_NO_CALL;
    t->result = result;
}

/* One attempt of a call: it ends, or blocks, or lets a more urgent task run before its last
 * attempt. */
static void look(struct kernel *k, struct kernel_task *t)
{
    const bool sends = t->call == KERNEL_SENDS;

    if (t->expired && (sends || k->queue[t->queue].count == 0)) {
        if (t->lent) {
            take_back(k, t->queue);
        }
        end(t, KERNEL_IN_VAIN);
    } else if (attempt(k, t)) {
        end(t, KERNEL_OK);
    } else if (t->ticks == 0) {
        end(t, KERNEL_IN_VAIN);
    } else if (expired(k, t)) {
        t->expired = true;
        if (!kernel_pay(k)) {
            look(k, t);
        }
    } else {
        if (is(k, t->queue, KERNEL_MUTEX)) {
            t->lent = lend(k, k->queue[t->queue].holder);
        }
        kernel_wait(k);
        kernel_block(k, t->ticks);
        kernel_yield(k);
    }
}

void kernel_go_on(struct kernel *k, int task)
{
    k->asked = task;
    if (k->task[task].call >= KERNEL_NOTIFY_TAKES) {
        kernel_notify_end(&k->task[task]);
    } else {
        look(k, &k->task[task]);
    }
    k->asked = -1;
}

/* Begin a call of the task that is asked. */
static enum kernel_status call(struct kernel *k, enum kernel_call what, int queue, int32_t value,
                               int64_t ticks)
{
    struct kernel_task *t = &k->task[k->asked];

    t->call = what;
    t->queue = queue;
    t->value = value;
    t->ticks = ticks;
    t->since = k->ticks;
    t->lent = t->expired = false;
    t->result = KERNEL_OK;
    look(k, t);
    kernel_answered(k);
    return (enum kernel_status)t->result;
}

/* The holder gives a mutex. Returns whether it loses a lent priority by that. */
static bool give_back(struct kernel *k, int mutex)
{
    struct kernel_task *t = &k->task[k->asked];

    k->queue[mutex].holder = -1;
    t->held--;
    if (t->priority == t->base || t->held > 0) {
        return false;
    }
    t->rank = t->base;
    kernel_change(k, k->asked, t->base);
    return true;
}

static bool of_kind(int queue, bool queues, const struct kernel *k)
{
    return queue >= 0 && queue < KERNEL_QUEUES && is(k, queue, KERNEL_QUEUE) == queues;
}

enum kernel_status kernel_give(struct kernel *k, int semaphore)
{
    const enum kernel_status may = kernel_may_call(k, 0);

    if (may || !of_kind(semaphore, false, k)) {
        return may ? may : KERNEL_RANGE;
    }
    const bool mutex = is(k, semaphore, KERNEL_MUTEX);
    struct kernel_queue *q = &k->queue[semaphore];
    if (mutex && (!kernel_task_asked(k) || (q->count == 0 && q->holder != k->asked))) {
        return KERNEL_NOT_ALLOWED;
    }
    if (q->count == q->length) {
        kernel_note(k, KERNEL_FULL, semaphore, k->asked);
        return KERNEL_WAS_FULL;
    }
    const bool lower = mutex && give_back(k, semaphore);
    put(k, semaphore, 0);
    if (!release(k, semaphore, false) && lower) {
        kernel_yield(k);
    }
    return kernel_answered(k);
}

enum kernel_status kernel_take_within(struct kernel *k, int semaphore, int64_t ticks)
{
    if (!kernel_task_asked(k)) {
        return KERNEL_NOT_ALLOWED;
    }
    if (ticks < 0 || !of_kind(semaphore, false, k)) {
        return KERNEL_RANGE;
    }
    return call(k, KERNEL_TAKES, semaphore, 0, ticks);
}

enum kernel_status kernel_take(struct kernel *k, int semaphore)
{
    return kernel_take_within(k, semaphore, KERNEL_FOREVER);
}

enum kernel_status kernel_send(struct kernel *k, int queue, int32_t value, int64_t ticks)
{
    const enum kernel_status may = kernel_may_call(k, ticks);

    if (may || !of_kind(queue, true, k)) {
        return may ? may : KERNEL_RANGE;
    }
    if (kernel_task_asked(k)) {
        return call(k, KERNEL_SENDS, queue, value, ticks);
    }
    if (k->queue[queue].count == k->queue[queue].length) {
        return KERNEL_IN_VAIN;
    }
    put(k, queue, value);
    release(k, queue, false);
    return kernel_answered(k);
}

enum kernel_status kernel_receive(struct kernel *k, int queue, int64_t ticks)
{
    const enum kernel_status may = kernel_may_call(k, ticks);

    if (may || !of_kind(queue, true, k)) {
        return may ? may : KERNEL_RANGE;
    }
    if (kernel_task_asked(k)) {
        return call(k, KERNEL_RECEIVES, queue, 0, ticks);
    }
    if (k->queue[queue].count == 0) {
        return KERNEL_IN_VAIN;
    }
    k->received = get(k, queue);
    release(k, queue, true);
    return kernel_answered(k);
}
