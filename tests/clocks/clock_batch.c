/* Cards' clocks and tasks' times in one call, for tests/helpers/clock_runs.py. */
#include "cyclic.h"
#include "dda.h"
#include "encoder.h"
#include "fifo.h"
#include "fpga_link.h"
#include "kernel.h"
#include "latency.h"

/* Tick of each pulse of a command > 0. */
void clock_batch_ticks(int32_t command, int32_t ticks, int32_t *tick)
{
    for (int32_t j = 1; j <= command; j++)
        tick[j - 1] = (int32_t)dda_edge_tick(command, ticks, j);
}

/* Clock of each of n pulses in a slot of the FPGA card. */
void clock_batch_slot(int32_t n, int32_t slot_clocks, int32_t *clock)
{
    for (int32_t j = 0; j < n; j++)
        clock[j] = fpga_slot_clock(j, n, slot_clocks);
}

/* Counts of an encoder, four a line period, that turns from `from` to `to` in so many clocks and
 * then stands for as many; whether the counter told that edges were lost. */
int64_t clock_batch_counts(int32_t filter, double from, double to, int64_t clocks,
                           int32_t *too_fast)
{
    const struct encoder_config c = { ENCODER_AB, 4, 0, filter, 1000000 };
    struct encoder e;
    encoder_reset(&e, &c);
    encoder_sample(&e, from, 0);
    encoder_sample(&e, to, clocks);
    encoder_run(&e, clocks);
    encoder_sample(&e, to, 2 * clocks);
    encoder_run(&e, 2 * clocks);
    *too_fast = e.too_fast;
    return e.count;
}

/* A host that answers each minimum-stock interrupt `late` clocks after it with `batch` commands.
 * The stock behind each boundary, every `period` clocks; returns the number of empty ones. */
int64_t clock_batch_stock(int32_t minimum, int32_t batch, int64_t period, int64_t late,
                          int64_t boundaries, int32_t *stock)
{
    enum { DEPTH = 63 };
    struct fifo f;
    int32_t entry[DEPTH], taken;
    int64_t due = INT64_MAX, dry = 0;
    fifo_reset(&f, DEPTH);
    for (int32_t i = 0; i < minimum + batch; i++)
        fifo_push(&f, entry, 1);
    fifo_fell(&f, minimum);
    for (int64_t k = 0; k < boundaries; k++) {
        while (due < k * period) {
            for (int32_t i = 0; i < batch; i++)
                fifo_push(&f, entry, 1);
            fifo_fell(&f, minimum);
            due = f.stock <= minimum ? due + late : INT64_MAX;
        }
        dry += !fifo_pop(&f, entry, &taken);
        if (fifo_fell(&f, minimum))
            due = k * period + late;
        stock[k] = f.stock;
    }
    return dry;
}

/* Waits of interrupts. [clocks] */
void clock_batch_waits(double least, double mean, double most, double rare, uint64_t seed,
                       int64_t count, int64_t *wait)
{
    const struct latency l = { least, mean, most, rare };
    for (int64_t i = 0; i < count; i++)
        wait[i] = latency_draw(&l, &seed);
}

/* Cyclic tasks with constant times up to a clock: longest response, missed deadlines and processor
 * time of each; the task that ran in each of the first `seen` clocks, -1 none. */
void clock_batch_cyclic(const struct cyclic_config *c, const int64_t *time, int64_t until,
                        int64_t seen, int64_t *response, int64_t *missed, int64_t *busy,
                        int32_t *running)
{
    struct cyclic s;
    struct cyclic_report r = { 0 };
    cyclic_start(&s, c);
    for (int64_t clock = 0; clock < until;) {
        clock = clock < seen ? clock + 1 : until;
        for (struct cyclic_event e; (e = cyclic_next(&s, clock)).what != CYCLIC_NONE;) {
            if (e.what == CYCLIC_BEGIN)
                cyclic_begin(&s, e.task, s.task[e.task].due, time[e.task]);
            else
                cyclic_end(&s, e.task);
        }
        if (clock <= seen)
            running[clock - 1] = s.running;
    }
    cyclic_tell(&s, &r);
    for (int i = 0; i < c->tasks; i++) {
        response[i] = r.task[i].response;
        missed[i] = r.task[i].missed;
        busy[i] = r.task[i].busy;
    }
}

enum { STEPS = 8 };
enum step_what { COMPUTE, TAKE, GIVE, MARK, UNTIL, END };

/* What a context does, again and again: computes for `value`, takes or gives the semaphore `value`,
 * marks an event, delays until `value` ticks later, ends with a yield or without. */
struct step {
    int64_t what, value;
};

static void answer(struct kernel *k, int context, const struct step *s, int64_t *previous)
{
    switch ((enum step_what)s->what) {
    case COMPUTE: kernel_compute(k, s->value); break;
    case TAKE:    kernel_take(k, (int)s->value); break;
    case GIVE:    kernel_give(k, (int)s->value); break;
    case MARK:    kernel_mark(k, context, (int32_t)s->value); break;
    case UNTIL:   kernel_delay_until(k, previous, s->value); break;
    case END:     kernel_end_interrupt(k, s->value != 0); break;
    }
}

static int64_t read_log(const struct kernel *k, int64_t seen, int64_t most,
                        struct kernel_event *event)
{
    for (; seen < k->events && seen < most; seen++)
        event[seen] = k->log[seen % KERNEL_LOG];
    return seen;
}

/* Tasks and interrupts of a kernel, each with `count` steps, up to a clock; interrupts that become
 * pending at rising clocks. The log's events; returns how many, and the overhead. */
int64_t clock_batch_kernel(const struct kernel_config *c, const int32_t *count,
                           const struct step (*step)[STEPS], int64_t pends, const int64_t *clock,
                           const int32_t *interrupt, int64_t until, int64_t most,
                           struct kernel_event *event, int64_t *overhead)
{
    static struct kernel k;
    int32_t at[KERNEL_TASKS + KERNEL_INTERRUPTS] = { 0 };
    int64_t previous[KERNEL_TASKS] = { 0 }, seen = 0;
    if (kernel_start(&k, c))
        return -1;
    for (int64_t n = 0; k.processor.clock < until;) {
        const int64_t to = n < pends && clock[n] < until ? clock[n] : until;
        for (int who; (who = kernel_next(&k, to)) >= 0;) {
            const struct step *s = &step[who][at[who]];
            at[who] = (at[who] + 1) % count[who];
            answer(&k, who, s, &previous[who < KERNEL_TASKS ? who : 0]);
            seen = read_log(&k, seen, most, event);
        }
        for (; n < pends && clock[n] <= to; n++)
            kernel_pend(&k, interrupt[n], clock[n]);
    }
    *overhead = kernel_overhead(&k);
    return read_log(&k, seen, most, event);
}
