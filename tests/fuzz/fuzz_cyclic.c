/* Bytes as cycles and events of tasks: small ones against a processor that is ticked clock by
 * clock; any others by what must hold of each event: the most urgent task has the processor,
 * every run gets its time, no request is lost but to one that waits. */
#include "../core/tasks/cyclic_ticks.h"
#include "fuzz.h"

const int fuzz_count = 15000;

enum { CLOCKS = 600, STEPS = 400 };

static struct log ticked, asked;

struct bytes {
    const uint8_t *at, *end;
};

static int64_t byte(struct bytes *b)
{
    return b->at < b->end ? *b->at++ : 0;
}

/* Mostly small; up to the longest that the scheduler promises. */
static int64_t clocks(struct bytes *b)
{
    const int64_t low = byte(b), high = byte(b);
    return low < 0xc0 ? low : low == 0xff ? CYCLIC_LONGEST - high : (high + 1) << (low & 0x3f) % 53;
}

static void small(struct bytes *b)
{
    struct set q = { .woken = (int)(byte(b) & 1) };
    uint64_t seed = (uint64_t)byte(b) + 1;
    int64_t at = 0;

    for (int i = 0; i < N; i++) {
        q.c.priority[i] = (int32_t)(byte(b) % 5);
        q.c.cycle[i] = i ? byte(b) % 64 : 0;
        q.c.offset[i] = i ? byte(b) % 32 : 0;
        q.time[i] = byte(b) % 24;
    }
    while (q.wakes < WAKES && b->at < b->end) {
        at += 1 + byte(b) % 128;
        q.wake[q.wakes++] = at;
    }
    brute(&q, CLOCKS, &ticked);
    scheduled(&q, CLOCKS, &seed, &asked);
    HOLDS(check_failures == 0);
    HOLDS(memcmp(&ticked, &asked, sizeof asked) == 0);
}

/* --- Any numbers. ----------------------------------------------------------------------------- */
struct run {
    int64_t given, busy;  /* time it was told to need, that of the task before it */
    int64_t begun, wakes; /* runs begun; requests that could not be lost */
};

static struct cyclic_config set;
static struct cyclic s;
static struct run run[N];

/* A task may have the processor before another one has begun. */
static bool ready(int i)
{
    const struct cyclic_task *m = &s.task[i];
    return m->active || (m->asked && m->ready <= s.processor.clock);
}

static void begin(struct bytes *b, int i)
{
    const int64_t time = clocks(b);

    HOLDS(!s.task[i].active && s.task[i].asked && s.task[i].ready <= s.processor.clock);
    for (int k = 0; k < N; k++) {
        /* an event of this very clock comes after what has begun without it */
        const bool fresh = s.task[k].woken && s.task[k].ready == s.processor.clock;
        HOLDS(!ready(k) || fresh || set.priority[i] <= set.priority[k]);
        HOLDS(!s.task[k].active || s.processor.task[k].left > 0);
    }
    cyclic_begin(&s, i, s.task[i].due, time);
    run[i] = (struct run){ time, s.processor.task[i].busy, run[i].begun + 1, run[i].wakes };
}

static void end(struct bytes *b, int i)
{
    HOLDS(s.task[i].active && s.processor.task[i].left == 0);
    HOLDS(s.processor.task[i].busy - run[i].busy == run[i].given);
    if (byte(b) == 0x80) {
        const int64_t more = clocks(b);
        cyclic_more(&s, i, more);
        run[i].given += more;
    } else {
        cyclic_end(&s, i);
        HOLDS(s.task[i].use.response >= run[i].given);
    }
}

/* A timer has asked so often by now, whose requests were met, wait or were lost behind one. */
static void count(void)
{
    struct cyclic_report r = { .clock = 0 };

    cyclic_tell(&s, &r);
    for (int i = 0; i < N; i++) {
        const struct cyclic_task *m = &s.task[i];
        const struct cyclic_use *u = &r.task[i];
        const int64_t cycle = set.cycle[i];
        HOLDS(u->runs + m->active == run[i].begun);
        HOLDS(s.processor.task[i].left >= 0 && u->busy >= 0);
        HOLDS(u->latency >= 0 && u->response >= 0);
        if (cycle > 0) {
            const int64_t times = (m->next - set.offset[i]) / cycle;
            HOLDS(m->next >= r.clock && m->next - r.clock <= cycle + set.offset[i]);
            HOLDS(times <= run[i].begun + m->asked + u->missed + run[i].wakes);
            HOLDS(run[i].begun + m->asked <= times + run[i].wakes);
        } else {
            HOLDS(m->next == INT64_MAX && u->missed == 0);
            HOLDS(run[i].begun + m->asked == run[i].wakes);
        }
    }
    HOLDS(r.all.busy + s.processor.idle == s.processor.clock);
}

/* So many clocks on, but a few hundred of the shortest cycles at most: each costs its time. */
static int64_t later(int64_t way)
{
    for (int i = 0; i < N; i++) {
        const int64_t cycle = set.cycle[i];
        way = cycle > 0 && cycle < way / 300 ? 300 * cycle : way;
    }
    return way < CYCLIC_LONGEST - s.processor.clock ? s.processor.clock + way : CYCLIC_LONGEST;
}

static void any(struct bytes *b)
{
    struct cyclic_config c = { .tasks = N };

    for (int i = 0; i < N; i++) {
        c.priority[i] = (int32_t)byte(b) - 128;
        c.cycle[i] = clocks(b);
        c.offset[i] = clocks(b);
    }
    set = c;
    cyclic_start(&s, &set);
    memset(run, 0, sizeof run);
    for (int step = 0; step < STEPS && b->at < b->end; step++) {
        const int64_t until = later(clocks(b)), before = s.processor.clock;
        const int i = (int)(byte(b) % 8);
        if (i < N && !s.task[i].asked) {
            cyclic_wake(&s, i, s.processor.clock, s.processor.clock);
            run[i].wakes++;
        }
        struct cyclic_event e = { CYCLIC_NONE, -1 };
        for (int n = 0; n < 50; n++) {
            e = cyclic_next(&s, until);
            HOLDS(s.processor.clock >= before && s.processor.clock <= until);
            if (e.what == CYCLIC_NONE) {
                HOLDS(s.processor.clock == until);
                break;
            }
            HOLDS(e.task >= 0 && e.task < N);
            if (e.what == CYCLIC_BEGIN) {
                begin(b, e.task);
            } else {
                end(b, e.task);
            }
        }
        if (e.what == CYCLIC_NONE) {
            count();
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct bytes b = { data, data + size };

    if (byte(&b) & 1) {
        small(&b);
    } else {
        any(&b);
    }
    return 0;
}
