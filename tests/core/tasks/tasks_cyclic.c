/* Tasks with a cycle, and woken ones, against a processor that is ticked clock by clock, and
 * against theory. */
#include "check.h"
#include "cyclic_ticks.h"

static struct set random_set(uint64_t *seed)
{
    struct set q = { .wakes = (int)check_random(seed, 0, WAKES),
                     .woken = (int)check_random(seed, 0, 1) };
    for (int i = 0; i < N; i++) {
        static const int32_t numbers[] = { INT32_MIN, -1, 0, INT32_MAX };
        q.c.priority[i] = numbers[check_random(seed, 0, 3)];
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
    for (int i = 0; i < 2000 && !check_failures; i++) {
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

/* Longest response of a task by response time analysis (Joseph and Pandya 1986), all tasks due
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
                break; /* a lower one may be helped by a run that was lost */
            }
            CHECK_EQ(one.missed[k], 0);
            CHECK_EQ(one.response[k], r);
            tight += r > q.time[k] * 2;
        }
    }
    CHECK(tight > 1000 && broken > 300);
}

/* One clock decides: at a time of T - C2 the slower task just makes it. */
static void the_last_clock(void)
{
    struct set q = { .c = { .priority = { 0, 1, 2, 3, 4 }, .cycle = { 0, 100, 200, 0 } },
                     .time = { 0, 30, 140, 0 } };
    uint64_t seed = 5;
    CHECK_EQ(analysis(&(struct set){ .c = { .priority = { 0, 1, 2, 3, 4 },
                                            .cycle = { 1000, 100, 200, 1000, 1000 } },
                                     .time = { 0, 30, 140, 0 } },
                      2),
             200);
    scheduled(&q, 4000, &seed, &one);
    CHECK(one.missed[2] == 0 && one.response[2] == 200);
    q.time[2]++;
    scheduled(&q, 4000, &seed, &one);
    CHECK(one.missed[2] > 0 && one.missed[1] == 0);
}

/* Tasks without time are done at once, in the order of their priority. */
static void no_time(void)
{
    const struct set q = { .c = { .priority = { 4, 3, 2, 1, 5 }, .cycle = { 0, 10, 10, 10 } },
                           .wakes = 1,
                           .wake = { 20 } };
    uint64_t seed = 6;
    scheduled(&q, 21, &seed, &one);
    CHECK_EQ(one.n, 2 * (3 * 3 + 1));
    for (int i = 0; i < one.n; i++) {
        CHECK_EQ(one.e[i].clock, 10 * (i / 6 < 3 ? i / 6 : 2));
        CHECK_EQ(one.e[i].task, i < 18 ? 3 - i % 6 / 2 : 0);
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
