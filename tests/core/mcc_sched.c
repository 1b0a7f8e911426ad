/* The modules' schedule against a processor that is ticked clock by clock, and against theory. */
#include "mcc_check.h"
#include "sched.h"

enum { N = SCHED_MODULES, LONGEST = 4000, WAKES = 60, LOG = 20000 };

/* Modules with fixed times; the times of woken ones too. */
struct set {
    struct sched_config c;
    int64_t time[N];
    int wakes;
    int woken;              /* module that is woken: 0, or 1, which has a timer too, */
    int64_t wake[WAKES];    /* and may begin at these clocks, rising */
};

/* What happens: a run begins or ends. */
struct entry { int64_t clock; int module; enum sched_what what; };
struct log { int n; struct entry e[LOG]; int missed[N]; int64_t busy[N], response[N]; };

static void note(struct log *l, int64_t clock, int module, enum sched_what what)
{
    if (l->n < LOG) {
        l->e[l->n++] = (struct entry){ clock, module, what };
    }
}

/* --- A processor that looks at everything at every clock. ----------------------------------- */
struct tick { bool waits, begun, event, run_event; int64_t since, from, left; };

/* The one of the modules allowed that goes first, or -1. */
static int choose(const struct set *q, const struct tick t[N], int64_t clock, bool interrupts)
{
    int best = -1;
    int64_t rank[4], least[4] = { 0 };
    for (int i = 0; i < N; i++) {
        const bool fresh = t[i].event && t[i].since == clock;
        if (!t[i].begun && !(t[i].waits && (interrupts || !fresh))) {
            continue;
        }
        rank[0] = q->c.priority[i];
        rank[1] = !t[i].begun;
        rank[2] = t[i].begun ? 0 : t[i].since;
        rank[3] = i;
        int k = 0;
        while (best >= 0 && k < 3 && rank[k] == least[k]) {
            k++;
        }
        if (best < 0 || rank[k] < least[k]) {
            best = i;
            memcpy(least, rank, sizeof least);
        }
    }
    return best;
}

static void finish(struct log *l, struct tick t[N], int64_t clock)
{
    for (int i = 0; i < N; i++) {
        if (t[i].begun && t[i].left == 0) {
            t[i].begun = false;
            note(l, clock, i, SCHED_END);
            l->response[i] = clock - t[i].from > l->response[i] ? clock - t[i].from
                                                                : l->response[i];
        }
    }
}

static void brute(const struct set *q, int64_t clocks, struct log *l)
{
    struct tick t[N] = { { 0 } };
    memset(l, 0, sizeof *l);
    int next_wake = 0;
    for (int64_t clock = 0; clock < clocks; clock++) {
        finish(l, t, clock);
        for (int i = 0; i < N; i++) {
            const int64_t in = clock - q->c.offset[i];
            if (q->c.cycle[i] && in >= 0 && in % q->c.cycle[i] == 0) {
                l->missed[i] += (t[i].begun && !t[i].run_event) || (t[i].waits && !t[i].event);
                t[i].since = t[i].waits ? t[i].since : clock;
                t[i].waits = true;
                t[i].event = false;
            }
        }
        for (; next_wake < q->wakes && q->wake[next_wake] <= clock; next_wake++) {
            struct tick *w = &t[q->woken];
            w->since = w->waits ? w->since : clock;
            w->event = w->waits ? w->event : true;
            w->waits = true;
        }
        for (int interrupts = 0; interrupts < 2; interrupts++) {
            int i;
            while ((i = choose(q, t, clock, interrupts)) >= 0 && !t[i].begun) {
                t[i] = (struct tick){ .begun = true, .run_event = t[i].event,
                                      .from = t[i].since, .left = q->time[i] };
                note(l, clock, i, SCHED_BEGIN);
                finish(l, t, clock);
                interrupts = 0;
            }
        }
        const int running = choose(q, t, clock, true);
        if (running >= 0) {
            t[running].left--;
            l->busy[running]++;
        }
    }
}

/* The next wake of a module without a timer, for a clock to come. */
static int wake_ahead(const struct set *q, struct sched *s, int wake)
{
    if (wake < q->wakes && !s->module[0].asked) {
        sched_wake(s, 0, q->wake[wake], q->wake[wake]);
        wake++;
    }
    /* Interrupts that come while one waits are one with it. */
    while (wake < q->wakes && s->module[0].asked && q->wake[wake] <= s->clock) {
        wake++;
    }
    return wake;
}

/* One of a module with a timer, at its clock. */
static int wake_now(const struct set *q, struct sched *s, int wake)
{
    for (; wake < q->wakes && q->wake[wake] <= s->clock; wake++) {
        if (!s->module[1].asked) {
            sched_wake(s, 1, s->clock, s->clock);
        }
    }
    return wake;
}

/* --- The scheduler, asked in steps of random length. ------------------------------------------ */
static void scheduled(const struct set *q, int64_t clocks, uint64_t *seed, struct log *l)
{
    struct sched s;
    int wake = 0;
    memset(l, 0, sizeof *l);
    sched_start(&s, &q->c);
    for (int64_t until = 0; s.clock < clocks;) {
        until = until + check_random(seed, 1, 50);
        until = until < clocks ? until : clocks;
        for (;;) {
            wake = q->woken ? wake_now(q, &s, wake) : wake_ahead(q, &s, wake);
            const bool soon = q->woken && wake < q->wakes && q->wake[wake] < until;
            const struct sched_event e = sched_next(&s, soon ? q->wake[wake] : until);
            if (e.what == SCHED_NONE && soon) {
                continue;
            }
            if (e.what == SCHED_NONE) {
                break;
            }
            note(l, s.clock, e.module, e.what);
            if (e.what == SCHED_END) {
                sched_end(&s, e.module);
                continue;
            }
            if (e.module == 0 && !q->woken) {
                while (wake < q->wakes && q->wake[wake] <= s.clock) {
                    wake++;
                }
            }
            sched_begin(&s, e.module, s.module[e.module].due, q->time[e.module]);
        }
    }
    for (int i = 0; i < N; i++) {
        l->missed[i] = s.module[i].missed;
        l->busy[i] = s.module[i].busy;
        l->response[i] = s.module[i].response;
    }
}

static struct set random_set(uint64_t *seed)
{
    struct set q = { .wakes = (int)check_random(seed, 0, WAKES),
                     .woken = (int)check_random(seed, 0, 1) };
    for (int i = 0; i < N; i++) {
        q.c.priority[i] = (int32_t)check_random(seed, 1, 4);
        q.c.cycle[i] = i ? check_random(seed, 5, 60) : 0;
        q.c.offset[i] = i ? check_random(seed, 0, 20) : 0;
        q.time[i] = check_random(seed, 0, 3) ? check_random(seed, 0, 15) : 0;
    }
    int64_t at = 0;
    for (int i = 0; i < q.wakes; i++) {
        at += check_random(seed, 1, 100);
        q.wake[i] = at;
    }
    return q;
}

static struct log one, two;

static void against_brute_force(void)
{
    uint64_t seed = 3;
    long long events = 0, missed = 0;
    for (int i = 0; i < 3000 && !check_failures; i++) {
        const struct set q = random_set(&seed);
        brute(&q, LONGEST, &one);
        scheduled(&q, LONGEST, &seed, &two);
        CHECK_EQ(one.n, two.n);
        CHECK(!memcmp(&one, &two, sizeof one));
        events += one.n;
        missed += one.missed[1] + one.missed[2] + one.missed[3];
    }
    CHECK(events > 500000 && missed > 5000);
}

/* Longest response of a module by response time analysis (Joseph and Pandya 1986), all modules due
 * together at first: R = C_i + sum over the more urgent ones of ceil(R / T_j) C_j; -1 if R > T. */
static int64_t analysis(const struct set *q, int i)
{
    int64_t r = q->time[i];
    for (;;) {
        int64_t sum = q->time[i];
        for (int j = 0; j < N; j++) {
            if (q->c.priority[j] < q->c.priority[i]) {
                sum += (r + q->c.cycle[j] - 1) / q->c.cycle[j] * q->time[j];
            }
        }
        if (sum == r || sum > q->c.cycle[i]) {
            return sum == r && r <= q->c.cycle[i] ? r : -1;
        }
        r = sum;
    }
}

/* Rate monotonic sets: the longest response is the analysis', to the clock, and a deadline is
 * missed where the analysis finds no response within the cycle, and nowhere else. */
static void against_theory(void)
{
    uint64_t seed = 4;
    int tight = 0, broken = 0;
    for (int i = 0; i < 3000; i++) {
        struct set q = { .wakes = 0 };
        for (int k = 0; k < N; k++) {
            q.c.priority[k] = k;
            q.c.cycle[k] = (k ? q.c.cycle[k - 1] : 1000) + check_random(&seed, 100, 20000);
            q.time[k] = check_random(&seed, 1, q.c.cycle[k] * 3 / 8);
        }
        scheduled(&q, q.c.cycle[N - 1] * 4, &seed, &one);
        for (int k = 0; k < N; k++) {
            const int64_t r = analysis(&q, k);
            if (r < 0) {
                CHECK(one.missed[k] > 0);
                broken++;
                break;          /* a lower one may be helped by a run that was lost */
            }
            CHECK_EQ(one.missed[k], 0);
            CHECK_EQ(one.response[k], r);
            tight += r > q.time[k] * 2;
        }
    }
    CHECK(tight > 1000 && broken > 300);
}

/* One clock decides: at a time of T - C2 the slower module just makes it. */
static void the_last_clock(void)
{
    struct set q = { .c = { .priority = { 0, 1, 2, 3 }, .cycle = { 0, 100, 200, 0 } },
                     .time = { 0, 30, 140, 0 } };
    uint64_t seed = 5;
    CHECK_EQ(analysis(&(struct set){ .c = { .priority = { 0, 1, 2, 3 },
                                            .cycle = { 1000, 100, 200, 1000 } },
                                     .time = { 0, 30, 140, 0 } }, 2), 200);
    scheduled(&q, 4000, &seed, &one);
    CHECK(one.missed[2] == 0 && one.response[2] == 200);
    q.time[2]++;
    scheduled(&q, 4000, &seed, &one);
    CHECK(one.missed[2] > 0 && one.missed[1] == 0);
}

/* Modules without time are done at once, in the order of their priority. */
static void no_time(void)
{
    const struct set q = { .c = { .priority = { 4, 3, 2, 1 }, .cycle = { 0, 10, 10, 10 } },
                           .wakes = 1, .wake = { 20 } };
    uint64_t seed = 6;
    scheduled(&q, 21, &seed, &one);
    CHECK_EQ(one.n, 2 * (3 * 3 + 1));
    for (int i = 0; i < one.n; i++) {
        CHECK_EQ(one.e[i].clock, 10 * (i / 6 < 3 ? i / 6 : 2));
        CHECK_EQ(one.e[i].module, i < 18 ? 3 - i % 6 / 2 : 0);
    }
}

int main(void)
{
    against_brute_force();
    against_theory();
    the_last_clock();
    no_time();
    return check_result();
}
