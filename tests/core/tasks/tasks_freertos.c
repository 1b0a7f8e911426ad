/* The kernel against the FreeRTOS kernel V11.1.0: 5000 random programs, the same tokens. The real
 * one's hashes are in freertos_hashes.h; the README of the core says how they were recorded. */
#include "task_programs.h"

#include <stdlib.h>

#include "freertos_hashes.h"
#include "freertos_tokens.h"
#include "kernel.h"

static struct kernel k;
static struct program p;
static struct {
    int at[TASKS + INTERRUPTS];     /* action of each context, */
    bool acts[TASKS + INTERRUPTS];  /* under way, */
    int result[TASKS + INTERRUPTS]; /* and what it said at once */
    int64_t previous[TASKS];        /* tick of delay_until */
    int64_t seen;                   /* events of the log that are told */
} s;

static void read_log(void)
{
    CHECK(k.events - s.seen <= KERNEL_LOG);
    for (; s.seen < k.events; s.seen++) {
        const struct kernel_event *e = &k.log[s.seen % KERNEL_LOG];
        if (e->what == KERNEL_RUNS) {
            say(e->clock, ">%d ", e->number);
        } else if (e->what == KERNEL_INTERRUPT) {
            say(e->clock, "!%d ", e->number);
        }
    }
}

static int64_t ticks(const struct action *a)
{
    return a->ticks == FOR_EVER ? KERNEL_FOREVER : a->ticks;
}

static bool own_mutex(int context, const struct action *a)
{
    return a->what == TAKE && a->on >= MUTEX && k.queue[a->on].holder == context;
}

static enum kernel_status act(int context, const struct action *a)
{
    static const enum kernel_notify WHAT[] = { KERNEL_WAKES, KERNEL_SETS_BITS, KERNEL_ADDS_ONE,
                                               KERNEL_WRITES, KERNEL_WRITES_FIRST };
    switch (a->what) {
    case COMPUTE: return kernel_compute(&k, a->value);
    case GIVE:    return kernel_give(&k, a->on);
    case TAKE:
        return own_mutex(context, a) ? KERNEL_NOT_ALLOWED : kernel_take_within(&k, a->on, ticks(a));
    case SEND:        return kernel_send(&k, a->on, a->value, ticks(a));
    case RECEIVE:     return kernel_receive(&k, a->on, ticks(a));
    case DELAY:       return kernel_delay(&k, a->value);
    case DELAY_UNTIL: return kernel_delay_until(&k, &s.previous[context], a->value);
    case PRIORITY:    return kernel_set_priority(&k, a->on, a->value);
    case NOTIFY:      return kernel_notify(&k, a->on, WHAT[a->other], (uint32_t)a->value);
    case NOTIFY_TAKE: return kernel_notify_take(&k, a->other & 1, ticks(a));
    case NOTIFY_WAIT:
        return kernel_notify_wait(&k, (uint32_t)a->other, (uint32_t)a->value, ticks(a));
    default: return kernel_end_interrupt(&k, a->value);
    }
}

/* The action that has ended; what the context does next. */
static void answer(int context)
{
    const int i = context < KERNEL_TASKS ? context : TASKS + context - KERNEL_TASKS;
    const struct action *a = &p.action[i][s.at[i]];

    if (s.acts[i]) {
        const bool waits = a->what == TAKE || a->what == SEND || a->what == RECEIVE
                           || a->what == NOTIFY_TAKE || a->what == NOTIFY_WAIT;
        const int result =
            waits && i < TASKS && s.result[i] == KERNEL_OK ? kernel_result(&k) : s.result[i];
        const int64_t value = (uint32_t)kernel_value(&k);
        const bool shown = a->what >= NOTIFY_TAKE || (a->what == RECEIVE && result == KERNEL_OK);
        say_end(k.processor.clock, i, s.at[i], result, shown ? &value : NULL);
        s.at[i] = (s.at[i] + 1) % p.actions[i];
        a = &p.action[i][s.at[i]];
    }
    s.result[i] = act(context, a);
    s.acts[i] = a->what != END;
    s.at[i] = a->what == END ? 0 : s.at[i];
}

static void start(void)
{
    struct kernel_config c = { .tasks = p.tasks,
                               .tick = p.tick,
                               .tick_time = p.tick_time,
                               .switch_time = p.switch_time,
                               .entry_time = p.entry_time };
    for (int i = 0; i < p.tasks; i++) {
        c.priority[i] = p.priority[i];
    }
    for (int i = 0; i < KERNEL_INTERRUPTS; i++) {
        c.level[i] = i;
    }
    c.queue[COUNTING] = (struct kernel_queue_config){ KERNEL_COUNTING, COUNTS_TO, COUNTS_FROM };
    c.queue[MUTEX].kind = c.queue[MUTEX + 1].kind = KERNEL_MUTEX;
    c.queue[QUEUE] = (struct kernel_queue_config){ KERNEL_QUEUE, 2, 0 };
    c.queue[QUEUE + 1] = (struct kernel_queue_config){ KERNEL_QUEUE, 1, 0 };
    memset(&s, 0, sizeof s);
    say_anew();
    CHECK_EQ(kernel_start(&k, &c), KERNEL_OK);
    read_log();
}

/* The time is divided at random. An interrupt is told when its clock has come. */
static void play(int number, uint64_t *seed)
{
    int next = 0;

    p = task_program(number);
    start();
    for (int64_t until = 0; k.processor.clock < p.end;) {
        until += check_random(seed, 1, 60);
        if (next < p.pends && p.pend[next].clock < until) {
            until = p.pend[next].clock;
        }
        until = until < p.end ? until : p.end;
        for (int c; (c = kernel_next(&k, until)) >= 0; read_log()) {
            read_log();
            answer(c);
        }
        read_log();
        for (; next < p.pends && p.pend[next].clock <= until; next++) {
            kernel_pend(&k, p.pend[next].interrupt, p.pend[next].clock);
        }
    }
}

static bool hash_is(const char *recorded)
{
    char text[9];

    snprintf(text, sizeof text, "%08x", (unsigned)said.hash);
    return memcmp(text, recorded, 8) == 0;
}

static void all_tokens(const char *const *piece)
{
    int at = 0;

    for (; *piece; at += (int)strlen(*piece++)) {
        if (strncmp(said.text + at, *piece, strlen(*piece)) != 0) {
            printf("%.90s\non FreeRTOS:\n%s\n", said.text + at, *piece);
            check_failures++;
            return;
        }
    }
    CHECK_EQ(at, said.length);
}

/* All time is somebody's. */
static void times(void)
{
    int64_t all = kernel_idle(&k) + kernel_overhead(&k);

    for (int i = 0; i < KERNEL_TASKS + KERNEL_INTERRUPTS; i++) {
        all += kernel_busy(&k, i);
    }
    CHECK_EQ(all, p.end);
}

static void as_recorded(void)
{
    uint64_t seed = 11;
    int differ = 0;

    for (int i = 0; i < PROGRAMS; i++) {
        play(i, &seed);
        times();
        if (!hash_is(HASHES[i / HASHES_A_ROW] + 8 * (i % HASHES_A_ROW)) && ++differ <= 10) {
            printf("program %d differs\n", i);
        }
        if (i < (int)(sizeof TOKENS / sizeof *TOKENS)) {
            all_tokens(TOKENS[i]);
        }
    }
    CHECK_EQ(differ, 0);
}

int main(int count, char **arguments)
{
    if (count > 1) {
        uint64_t seed = 11;
        play(atoi(arguments[1]), &seed);
        printf("%s\n", said.text);
        return 0;
    }
    as_recorded();
    return check_result();
}
