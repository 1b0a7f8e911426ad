/* Bytes as modules, cycles and events of the scheduler: small ones against a processor that is
 * ticked clock by clock; any others by what must hold of each event: the most urgent module has the
 * processor, every run gets its time, no request is lost but to one that waits. */
#include "../core/sched_ticks.h"
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
    return low < 0xc0 ? low : low == 0xff ? SCHED_LONGEST - high : (high + 1) << (low & 0x3f) % 53;
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
    int64_t given, busy;    /* time it was told to need, that of the module before it */
    int64_t begun, wakes;   /* runs begun; requests that could not be lost */
};

static struct sched s;
static struct run run[N];

/* A module may have the processor before another one has begun. */
static bool ready(int i)
{
    const struct sched_module *m = &s.module[i];
    return m->active || (m->asked && m->ready <= s.clock);
}

static void begin(struct bytes *b, int i)
{
    const int64_t time = clocks(b);

    HOLDS(!s.module[i].active && s.module[i].asked && s.module[i].ready <= s.clock);
    for (int k = 0; k < N; k++) {
        /* an event of this very clock comes after what has begun without it */
        const bool fresh = s.module[k].woken && s.module[k].ready == s.clock;
        HOLDS(!ready(k) || fresh || s.config.priority[i] <= s.config.priority[k]);
        HOLDS(!s.module[k].active || s.module[k].left > 0);
    }
    sched_begin(&s, i, s.module[i].due, time);
    run[i] = (struct run){ time, s.module[i].busy, run[i].begun + 1, run[i].wakes };
}

static void end(struct bytes *b, int i)
{
    HOLDS(s.module[i].active && s.module[i].left == 0);
    HOLDS(s.module[i].busy - run[i].busy == run[i].given);
    if (byte(b) == 0x80) {
        const int64_t more = clocks(b);
        sched_more(&s, i, more);
        run[i].given += more;
    } else {
        sched_end(&s, i);
        HOLDS(s.module[i].response >= run[i].given);
    }
}

/* A timer has asked so often by now, whose requests were met, wait or were lost behind one. */
static void count(void)
{
    int64_t busy = 0;

    for (int i = 0; i < N; i++) {
        const struct sched_module *m = &s.module[i];
        const int64_t cycle = s.config.cycle[i];
        busy += m->busy;
        HOLDS(m->runs + m->active == run[i].begun);
        HOLDS(m->left >= 0 && m->busy >= 0 && m->latency >= 0 && m->response >= 0);
        if (cycle > 0) {
            const int64_t times = (m->next - s.config.offset[i]) / cycle;
            HOLDS(m->next >= s.clock && m->next - s.clock <= cycle + s.config.offset[i]);
            HOLDS(times <= run[i].begun + m->asked + m->missed + run[i].wakes);
            HOLDS(run[i].begun + m->asked <= times + run[i].wakes);
        } else {
            HOLDS(m->next == INT64_MAX && m->missed == 0);
            HOLDS(run[i].begun + m->asked == run[i].wakes);
        }
    }
    HOLDS(busy <= s.clock);
}

/* So many clocks on, but a few hundred of the shortest cycles at most: each costs its time. */
static int64_t later(int64_t way)
{
    for (int i = 0; i < N; i++) {
        const int64_t cycle = s.config.cycle[i];
        way = cycle > 0 && cycle < way / 300 ? 300 * cycle : way;
    }
    return way < SCHED_LONGEST - s.clock ? s.clock + way : SCHED_LONGEST;
}

static void any(struct bytes *b)
{
    struct sched_config c = { .priority = { 0 } };

    for (int i = 0; i < N; i++) {
        c.priority[i] = (int32_t)byte(b) - 128;
        c.cycle[i] = clocks(b);
        c.offset[i] = clocks(b);
    }
    sched_start(&s, &c);
    memset(run, 0, sizeof run);
    for (int step = 0; step < STEPS && b->at < b->end; step++) {
        const int64_t until = later(clocks(b)), before = s.clock;
        const int i = (int)(byte(b) % 8);
        if (i < N && !s.module[i].asked) {
            sched_wake(&s, i, s.clock, s.clock);
            run[i].wakes++;
        }
        struct sched_event e = { SCHED_NONE, -1 };
        for (int n = 0; n < 50; n++) {
            e = sched_next(&s, until);
            HOLDS(s.clock >= before && s.clock <= until);
            if (e.what == SCHED_NONE) {
                HOLDS(s.clock == until);
                break;
            }
            HOLDS(e.module >= 0 && e.module < N);
            if (e.what == SCHED_BEGIN) {
                begin(b, e.module);
            } else {
                end(b, e.module);
            }
        }
        if (e.what == SCHED_NONE) {
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
