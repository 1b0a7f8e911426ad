/* The kernel's rules one by one. */
#include "check.h"

#include <string.h>

#include "kernel.h"

static struct kernel k;

static int next(int64_t until)
{
    return kernel_next(&k, until);
}

/* An interrupt wakes a more urgent task: at its end if it yields, else at the next tick. */
static void forgotten_yield(void)
{
    const struct kernel_config c = { .tasks = 2, .priority = { 5, 1 }, .tick = 1000 };
    for (int yield = 0; yield < 2; yield++) {
        kernel_start(&k, &c);
        CHECK_EQ(next(1), 0);
        kernel_take(&k, 0);
        CHECK_EQ(next(1), 1);
        kernel_compute(&k, 5000);
        kernel_pend(&k, 0, 300);
        CHECK_EQ(next(5000), KERNEL_TASKS);
        CHECK_EQ(k.processor.clock, 300);
        kernel_compute(&k, 40);
        CHECK_EQ(next(5000), KERNEL_TASKS);
        kernel_give(&k, 0);
        CHECK_EQ(next(5000), KERNEL_TASKS);
        kernel_end_interrupt(&k, yield);
        CHECK_EQ(next(5000), 0);
        CHECK_EQ(k.processor.clock, yield ? 340 : 1000);
    }
}

/* A delay of n ends at the n-th tick: after n - 1 to n periods. */
static void delays(void)
{
    const struct kernel_config c = { .tasks = 1, .tick = 100 };
    for (int64_t start = 0; start <= 250; start++) {
        kernel_start(&k, &c);
        CHECK_EQ(next(1), 0);
        kernel_compute(&k, start);
        CHECK_EQ(next(1000), 0);
        kernel_delay(&k, 3);
        CHECK_EQ(next(1000), 0);
        CHECK_EQ(k.processor.clock, (start > 0 ? (start - 1) / 100 : 0) * 100 + 300);
    }
}

/* Equals take turns at the tick, each a tick long; the last one is the first. */
static void turns(void)
{
    const struct kernel_config c = { .tasks = 3, .priority = { 2, 2, 1 }, .tick = 10 };
    kernel_start(&k, &c);
    for (int i = 0; i < 2; i++) {
        const int task = next(1000);
        CHECK_EQ(task, 1 - i);
        kernel_compute(&k, 1000000);
    }
    CHECK_EQ(next(1000), -1);
    CHECK_EQ(kernel_busy(&k, 0), 500);
    CHECK_EQ(kernel_busy(&k, 1), 500);
    CHECK_EQ(kernel_busy(&k, 2), 0);
}

/* What a task holds is its state, the count of a semaphore until then the semaphore's. */
static void given_not_handed_over(void)
{
    const struct kernel_config c = { .tasks = 2, .priority = { 1, 5 } };
    kernel_start(&k, &c);
    CHECK_EQ(next(1), 1);
    kernel_take(&k, 0);
    CHECK_EQ(next(1), 0);
    kernel_compute(&k, 100);
    kernel_pend(&k, 0, 50);
    CHECK_EQ(next(200), KERNEL_TASKS);
    CHECK_EQ(kernel_give(&k, 0), KERNEL_OK);
    CHECK_EQ(next(200), KERNEL_TASKS);
    CHECK_EQ(kernel_give(&k, 0), KERNEL_WAS_FULL); /* the woken task has not run */
    CHECK_EQ(kernel_end_interrupt(&k, true), KERNEL_OK);
    CHECK_EQ(next(200), 1);
    CHECK_EQ(kernel_result(&k), KERNEL_OK);
    CHECK_EQ(k.queue[0].count, 0);
}

/* A sender whose time is over fails even if there is room when it looks, as xQueueSend does: it
 * looks no last time, a receiver does. */
static void last_look(void)
{
    for (int sends = 0; sends < 2; sends++) {
        struct kernel_config c = { .tasks = 2,
                                   .priority = { 2, 5 },
                                   .tick = 100,
                                   .switch_time = 20,
                                   .queue[0] = { KERNEL_QUEUE, 1, 0 } };
        kernel_start(&k, &c);
        CHECK_EQ(next(50), 1);
        kernel_take(&k, 1); /* woken without a yield, below */
        CHECK_EQ(next(50), 0);
        if (sends) {
            CHECK_EQ(kernel_send(&k, 0, 7, 0), KERNEL_OK);
            CHECK_EQ(next(50), 0);
        }
        CHECK_EQ(sends ? kernel_send(&k, 0, 8, 1) : kernel_receive(&k, 0, 1), KERNEL_OK);
        kernel_pend(&k, 0, 110); /* in the switch to the task: its time is over */
        CHECK_EQ(next(200), KERNEL_TASKS);
        CHECK_EQ(k.processor.clock, 120);
        CHECK_EQ(kernel_give(&k, 1), KERNEL_OK);
        CHECK_EQ(next(200), KERNEL_TASKS);
        CHECK_EQ(kernel_end_interrupt(&k, false), KERNEL_OK);
        CHECK_EQ(next(200), 1); /* what is owed comes before the last look */
        CHECK_EQ(sends ? kernel_receive(&k, 0, 0) : kernel_send(&k, 0, 9, 0), KERNEL_OK);
        CHECK_EQ(next(200), 1);
        CHECK_EQ(kernel_value(&k), sends ? 7 : 9);
        kernel_take(&k, 1);
        CHECK_EQ(next(300), 0);
        CHECK_EQ(kernel_result(&k), sends ? KERNEL_IN_VAIN : KERNEL_OK);
    }
}

/* Entry, switch and tick take their time, and all time is somebody's. */
static void overhead(void)
{
    const struct kernel_config c = { .tasks = 2,
                                     .priority = { 5, 1 },
                                     .tick = 1000000,
                                     .tick_time = 1000,
                                     .switch_time = 2500,
                                     .entry_time = 100,
                                     .kernel_level = 5,
                                     .level = { 5, 4 } };
    int64_t sum = 0;
    kernel_start(&k, &c);
    CHECK_EQ(next(1), -1); /* the switch to the first task */
    CHECK_EQ(next(10000), 0);
    CHECK_EQ(k.processor.clock, 2500);
    kernel_take(&k, 3);
    CHECK_EQ(next(10000), 1);
    CHECK_EQ(k.processor.clock, 5000);
    kernel_compute(&k, 3000000);
    kernel_pend(&k, 0, 20000);
    CHECK_EQ(next(30000), KERNEL_TASKS);
    CHECK_EQ(k.processor.clock, 20100);
    CHECK_EQ(kernel_give(&k, 3), KERNEL_OK);
    CHECK_EQ(next(30000), KERNEL_TASKS);
    CHECK_EQ(kernel_end_interrupt(&k, true), KERNEL_OK);
    CHECK_EQ(next(30000), 0);
    CHECK_EQ(k.processor.clock, 22600); /* from the pin to the task: 2.6 us */
    kernel_take(&k, 3);
    kernel_pend(&k, 1, 50000);
    CHECK_EQ(next(60000), KERNEL_TASKS + 1);
    CHECK_EQ(kernel_give(&k, 3), KERNEL_NOT_ALLOWED); /* more urgent than the kernel's level */
    CHECK_EQ(kernel_take(&k, 3), KERNEL_NOT_ALLOWED);
    CHECK_EQ(kernel_delay(&k, 1), KERNEL_NOT_ALLOWED);
    CHECK_EQ(kernel_set_priority(&k, 0, 1), KERNEL_NOT_ALLOWED);
    CHECK_EQ(kernel_end_interrupt(&k, false), KERNEL_OK);
    CHECK_EQ(next(2500000), -1);
    for (int i = 0; i < KERNEL_TASKS + KERNEL_INTERRUPTS; i++) {
        sum += kernel_busy(&k, i);
    }
    CHECK_EQ(sum + kernel_idle(&k) + kernel_overhead(&k), 2500000);
    CHECK_EQ(kernel_overhead(&k), 4 * 2500 + 2 * 100 + 2 * 1000);
    CHECK_EQ(kernel_idle(&k), 0);
}

/* An interrupt that waits is one, whatever comes meanwhile; while it is served it comes again. */
static void pending_once(void)
{
    const struct kernel_config c = { .tasks = 0 };
    kernel_start(&k, &c);
    kernel_pend(&k, 0, 300);
    kernel_pend(&k, 0, 500);
    CHECK_EQ(next(1000), KERNEL_TASKS);
    CHECK_EQ(k.processor.clock, 300);
    kernel_compute(&k, 50);
    kernel_pend(&k, 0, 320);
    kernel_pend(&k, 0, 330);
    CHECK_EQ(next(1000), KERNEL_TASKS);
    kernel_end_interrupt(&k, false);
    CHECK_EQ(next(1000), KERNEL_TASKS);
    CHECK_EQ(k.processor.clock, 350);
    kernel_end_interrupt(&k, false);
    CHECK_EQ(next(1000), -1);
}

/* What is out of range is refused and changes nothing. */
static void refused(void)
{
    const struct kernel_config good = {
        .tasks = 2,
        .priority = { 5, 1 },
        .queue = { [1] = { KERNEL_MUTEX, 0, 0 }, [2] = { KERNEL_QUEUE, KERNEL_ITEMS, 0 } }
    };
    struct kernel_config bad[10];
    struct kernel before;
    int64_t previous = 0;
    for (int i = 0; i < 10; i++) {
        bad[i] = good;
    }
    bad[0].tasks = KERNEL_TASKS + 1;
    bad[1].priority[1] = 1001;
    bad[2].level[7] = 256;
    bad[3].tick = -1;
    bad[4].switch_time = -1;
    bad[5].priority[14] = -1;
    bad[6].queue[0].count = 2;
    bad[7].queue[0] = (struct kernel_queue_config){ KERNEL_COUNTING, 3, 4 };
    bad[8].queue[2].length = KERNEL_ITEMS + 1;
    bad[9].queue[15].kind = KERNEL_KINDS;
    CHECK_EQ(kernel_start(&k, &good), KERNEL_OK);
    CHECK_EQ(kernel_compute(&k, 5), KERNEL_NOT_ALLOWED); /* nobody is asked */
    CHECK_EQ(kernel_send(&k, 2, 5, 0), KERNEL_NOT_ALLOWED);
    CHECK_EQ(kernel_notify(&k, 0, KERNEL_WAKES, 0), KERNEL_NOT_ALLOWED);
    CHECK_EQ(next(10), 0);
    before = k;
    for (int i = 0; i < 10; i++) {
        CHECK_EQ(kernel_start(&k, &bad[i]), KERNEL_RANGE);
    }
    CHECK_EQ(kernel_compute(&k, -1), KERNEL_RANGE);
    CHECK_EQ(kernel_give(&k, KERNEL_QUEUES), KERNEL_RANGE);
    CHECK_EQ(kernel_give(&k, 2), KERNEL_RANGE); /* a queue is no semaphore, */
    CHECK_EQ(kernel_take(&k, 2), KERNEL_RANGE);
    CHECK_EQ(kernel_send(&k, 0, 1, 0), KERNEL_RANGE); /* nor the other way round */
    CHECK_EQ(kernel_receive(&k, 1, 0), KERNEL_RANGE);
    CHECK_EQ(kernel_take(&k, -1), KERNEL_RANGE);
    CHECK_EQ(kernel_take_within(&k, 0, -1), KERNEL_RANGE);
    CHECK_EQ(kernel_send(&k, 2, 1, -1), KERNEL_RANGE);
    CHECK_EQ(kernel_delay(&k, -1), KERNEL_RANGE);
    CHECK_EQ(kernel_delay_until(&k, &previous, -1), KERNEL_RANGE);
    CHECK_EQ(kernel_notify(&k, 2, KERNEL_WAKES, 0), KERNEL_RANGE);
    CHECK_EQ(kernel_notify(&k, 1, KERNEL_NOTIFIES, 0), KERNEL_RANGE);
    CHECK_EQ(kernel_notify_take(&k, true, -1), KERNEL_RANGE);
    CHECK_EQ(kernel_notify_wait(&k, 0, 0, -1), KERNEL_RANGE);
    CHECK_EQ(kernel_set_priority(&k, 2, 1), KERNEL_RANGE);
    CHECK_EQ(kernel_set_priority(&k, 0, -1), KERNEL_RANGE);
    CHECK_EQ(kernel_end_interrupt(&k, true), KERNEL_NOT_ALLOWED);
    CHECK_EQ(kernel_pend(&k, KERNEL_INTERRUPTS, 0), KERNEL_RANGE);
    CHECK(!memcmp(&before, &k, sizeof k));
    CHECK_EQ(previous, 0);
}

/* An interrupt does not wait, has no mutex and no delay. */
static void of_an_interrupt(void)
{
    const struct kernel_config c = {
        .queue = { [1] = { KERNEL_MUTEX, 0, 0 }, [2] = { KERNEL_QUEUE, 1, 0 } }
    };
    int64_t previous = 0;
    kernel_start(&k, &c);
    kernel_pend(&k, 0, 0);
    CHECK_EQ(next(10), KERNEL_TASKS);
    CHECK_EQ(kernel_take_within(&k, 0, 0), KERNEL_NOT_ALLOWED);
    CHECK_EQ(kernel_give(&k, 1), KERNEL_NOT_ALLOWED);
    CHECK_EQ(kernel_send(&k, 2, 5, 1), KERNEL_NOT_ALLOWED);
    CHECK_EQ(kernel_receive(&k, 2, KERNEL_FOREVER), KERNEL_NOT_ALLOWED);
    CHECK_EQ(kernel_delay_until(&k, &previous, 1), KERNEL_NOT_ALLOWED);
    CHECK_EQ(kernel_notify_take(&k, true, 0), KERNEL_NOT_ALLOWED);
    CHECK_EQ(kernel_notify_wait(&k, 0, 0, 0), KERNEL_NOT_ALLOWED);
    CHECK_EQ(kernel_send(&k, 2, 5, 0), KERNEL_OK);
    CHECK_EQ(next(10), KERNEL_TASKS);
    CHECK_EQ(kernel_send(&k, 2, 6, 0), KERNEL_IN_VAIN);
    CHECK_EQ(kernel_receive(&k, 2, 0), KERNEL_OK);
    CHECK_EQ(next(10), KERNEL_TASKS);
    CHECK_EQ(kernel_value(&k), 5);
    CHECK_EQ(kernel_receive(&k, 2, 0), KERNEL_IN_VAIN);
}

/* The mutex of another task is not given. */
static void mutex_of_another(void)
{
    const struct kernel_config c = {
        .tasks = 2, .priority = { 1, 2 }, .queue[0] = { KERNEL_MUTEX, 0, 0 }, .tick = 10
    };
    kernel_start(&k, &c);
    CHECK_EQ(next(5), 1);
    CHECK_EQ(kernel_take(&k, 0), KERNEL_OK);
    CHECK_EQ(next(5), 1);
    CHECK_EQ(kernel_delay(&k, 1), KERNEL_OK);
    CHECK_EQ(next(5), 0);
    CHECK_EQ(kernel_give(&k, 0), KERNEL_NOT_ALLOWED);
    CHECK_EQ(k.queue[0].holder, 1);
}

int main(void)
{
    forgotten_yield();
    delays();
    turns();
    given_not_handed_over();
    last_look();
    overhead();
    pending_once();
    refused();
    of_an_interrupt();
    mutex_of_another();
    return check_result();
}
