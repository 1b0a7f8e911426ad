/* Timer and watchdog: exact clocks, the window of a refresh, a model that counts every clock. */
#include <string.h>

#include "check.h"
#include "timer.h"

static void exact_clocks(void)
{
    struct timer t = { 0 };
    CHECK_EQ(timer_due(&t), INT64_MAX);
    timer_fire(&t); /* off: nothing */
    CHECK_EQ(t.count, 0);
    CHECK_EQ(timer_set(&t, true, 100000, 7), TIMER_OK); /* 2.5 ms */
    for (int n = 1; n <= 3; n++) {
        CHECK_EQ(timer_due(&t), 7 + n * 100000);
        timer_fire(&t);
        CHECK_EQ(t.count, n);
    }
    CHECK_EQ(timer_set(&t, true, 100000, 300010), TIMER_OK); /* the same: it runs on */
    CHECK_EQ(timer_due(&t), 400007);
    CHECK_EQ(timer_set(&t, true, 50, 300011), TIMER_OK); /* a new period: afresh */
    CHECK_EQ(timer_due(&t), 300061);
    CHECK_EQ(timer_set(&t, false, 50, 300020), TIMER_OK);
    CHECK_EQ(timer_due(&t), INT64_MAX);
    CHECK_EQ(timer_set(&t, false, TIMER_PERIOD_MAX, 300021), TIMER_OK); /* kept for later */
    CHECK_EQ(timer_set(&t, true, TIMER_PERIOD_MAX, 300022), TIMER_OK);
    CHECK_EQ(timer_due(&t), 300022 + 4294967295);
    timer_fire(&t);
    timer_fire(&t);
    CHECK_EQ(timer_due(&t), 300022 + 3 * 4294967295);
    CHECK_EQ(t.count, 5);
}

/* Refused settings, on and off, change nothing; both ends of each range are taken. */
static void ranges(void)
{
    const int64_t bad_period[] = { 0, -1, TIMER_PERIOD_MAX + 1, INT64_MIN, INT64_MAX };
    const int32_t bad_value[] = { 0, -1, 65536, INT32_MIN, INT32_MAX };
    struct timer t = { 0 }, t0;
    struct watchdog w = { 0 }, w0;
    CHECK_EQ(timer_set(&t, true, 1, 3), TIMER_OK);
    CHECK_EQ(timer_set(&t, true, 4294967295, 3), TIMER_OK);
    CHECK_EQ(watchdog_set(&w, true, 1, 1), TIMER_OK);
    CHECK_EQ(watchdog_set(&w, true, 65535, 4294967295), TIMER_OK);
    CHECK(!watchdog_timer_fired(&w, 3));
    for (int i = 0; i < 5; i++)
        for (int on = 0; on < 2; on++) {
            t0 = t;
            w0 = w;
            CHECK_EQ(timer_set(&t, on, bad_period[i], 9), TIMER_BAD_PERIOD);
            CHECK_EQ(watchdog_set(&w, on, bad_value[i], 1), TIMER_BAD_VALUE);
            CHECK_EQ(watchdog_set(&w, on, bad_value[i], bad_period[i]), TIMER_BAD_VALUE);
            CHECK_EQ(watchdog_set(&w, on, 1, bad_period[i]), TIMER_BAD_RESET);
            CHECK_EQ(memcmp(&t, &t0, sizeof t), 0);
            CHECK_EQ(memcmp(&w, &w0, sizeof w), 0);
        }
    for (int64_t n = 2; n < 65535; n++)
        CHECK(!watchdog_timer_fired(&w, n));
    CHECK(watchdog_timer_fired(&w, 65535));
    CHECK_EQ(watchdog_due(&w), 65535 + 4294967295);
}

/* One expiry by hand: timer of 10 clocks, value 3, reset for 25 clocks. */
static void life_of_a_watchdog(void)
{
    struct watchdog w = { 0 };
    CHECK(!watchdog_timer_fired(&w, 10)); /* off: counts nothing */
    watchdog_set(&w, true, 3, 25);
    CHECK(!watchdog_timer_fired(&w, 20));
    CHECK(!watchdog_timer_fired(&w, 30));
    watchdog_refresh(&w);
    CHECK(!watchdog_timer_fired(&w, 40));
    CHECK(!watchdog_timer_fired(&w, 50));
    CHECK_EQ(watchdog_due(&w), INT64_MAX);
    watchdog_set(&w, true, 3, 26); /* a new reset period keeps the count */
    CHECK(watchdog_timer_fired(&w, 60));
    CHECK(w.expired && w.resetting);
    watchdog_refresh(&w);         /* at the clock of expiry: late */
    watchdog_set(&w, true, 2, 5); /* neither ends nor moves anything */
    CHECK(w.expired && w.resetting);
    CHECK_EQ(watchdog_due(&w), 86);
    CHECK(!watchdog_timer_fired(&w, 70));
    watchdog_end(&w);
    CHECK(w.expired && !w.resetting); /* latched */
    CHECK_EQ(watchdog_due(&w), INT64_MAX);
    CHECK(!watchdog_timer_fired(&w, 90)); /* expires once */
    watchdog_refresh(&w);
    CHECK(!w.expired);
    CHECK(!watchdog_timer_fired(&w, 100)); /* counts anew, to the new value */
    CHECK(watchdog_timer_fired(&w, 110));
    CHECK_EQ(watchdog_due(&w), 115);
    watchdog_set(&w, false, 2, 5); /* off clears all in the reset period */
    CHECK(!w.expired && !w.resetting);
    CHECK_EQ(watchdog_due(&w), INT64_MAX);
    watchdog_set(&w, true, 2, 5);
    CHECK(!watchdog_timer_fired(&w, 120));
    CHECK(watchdog_timer_fired(&w, 130));
}

/* Refreshed at each clock in turn: expires value timer firings later, by formula. */
static void refresh_window(int64_t period, int32_t value)
{
    for (int64_t at = 0; at < value * period; at++) {
        struct timer t = { 0 };
        struct watchdog w = { 0 };
        timer_set(&t, true, period, 0);
        watchdog_set(&w, true, value, 1);
        while (timer_due(&t) <= at) {
            CHECK(!watchdog_timer_fired(&w, timer_due(&t)));
            timer_fire(&t);
        }
        watchdog_refresh(&w);
        while (!watchdog_timer_fired(&w, timer_due(&t)))
            timer_fire(&t);
        int64_t expiry = timer_due(&t);
        CHECK_EQ(expiry, (at / period + value) * period);
        CHECK(expiry - at > (value - 1) * period && expiry - at <= value * period);
        CHECK_EQ(watchdog_due(&w), expiry + 1);
    }
}

/* Both, counted down clock by clock. */
struct model {
    bool timer_on, dog_on, expired;
    int64_t period, to_fire, fired; /* [clocks] [clocks] [firings] */
    int64_t reset_period, to_end;   /* [clocks]; to_end 0: no reset period runs */
    int32_t value, to_expire;       /* [firings] */
};

/* One clock passes; true if the watchdog expires. */
static bool model_tick(struct model *m)
{
    if (m->to_end > 0)
        m->to_end--;
    if (!m->timer_on)
        return false;
    m->to_fire--;
    if (m->to_fire > 0)
        return false;
    m->to_fire = m->period;
    m->fired++;
    if (!m->dog_on || m->expired)
        return false;
    m->to_expire--;
    if (m->to_expire > 0)
        return false;
    m->expired = true;
    m->to_end = m->reset_period;
    return true;
}

static void model_set_timer(struct model *m, bool on, int64_t period)
{
    if (on && !m->timer_on)
        m->to_fire = period;
    if (on && m->timer_on && period != m->period)
        m->to_fire = period;
    m->timer_on = on;
    m->period = period;
}

static void model_set_dog(struct model *m, bool on, int32_t value, int64_t reset_period)
{
    if (on && !m->dog_on)
        m->to_expire = value;
    if (on && m->dog_on && value != m->value)
        m->to_expire = value;
    if (!on) {
        m->expired = false;
        m->to_end = 0;
    }
    m->dog_on = on;
    m->value = value;
    m->reset_period = reset_period;
}

static void host(struct model *m, struct timer *t, struct watchdog *w, uint64_t *seed,
                 int64_t clock)
{
    bool on = check_random(seed, 0, 4) > 0;
    int64_t period = check_random(seed, 1, 9), reset = check_random(seed, 1, 60);
    int32_t value = (int32_t)check_random(seed, 1, 5);
    switch (check_random(seed, 0, 150)) {
    case 0:
        model_set_timer(m, on, period);
        CHECK_EQ(timer_set(t, on, period, clock), TIMER_OK);
        break;
    case 1:
        model_set_dog(m, on, value, reset);
        CHECK_EQ(watchdog_set(w, on, value, reset), TIMER_OK);
        break;
    case 2: /* level registers written again */
        CHECK_EQ(timer_set(t, m->timer_on, m->period, clock), TIMER_OK);
        CHECK_EQ(watchdog_set(w, m->dog_on, m->value, m->reset_period), TIMER_OK);
        break;
    case 3:
        model_set_dog(m, m->dog_on, m->value, reset);
        CHECK_EQ(watchdog_set(w, m->dog_on, m->value, reset), TIMER_OK);
        break;
    case 4:
    case 5:
    case 6:
    case 7:
    case 8:
    case 9:
    case 10:
    case 11:
        if (m->to_end == 0) {
            m->expired = false;
            m->to_expire = m->value;
        }
        watchdog_refresh(w);
        break;
    default: break;
    }
}

/* The card jumps from event to event; the order of the two kinds at one clock is free. */
static void against_model(uint64_t seed, int *expiries, int *together)
{
    bool end_first = seed % 2 == 0;
    struct model m = { .period = 5, .value = 2, .reset_period = 10 };
    struct timer t = { 0 };
    struct watchdog w = { 0 };
    timer_set(&t, false, m.period, 0);
    watchdog_set(&w, false, m.value, m.reset_period);
    for (int64_t clock = 1; clock <= 5000; clock++) {
        bool expires = model_tick(&m), expired = false;
        *together += watchdog_due(&w) == clock && timer_due(&t) == clock;
        if (end_first && watchdog_due(&w) == clock)
            watchdog_end(&w);
        if (timer_due(&t) == clock) {
            timer_fire(&t);
            expired = watchdog_timer_fired(&w, clock);
        }
        if (!end_first && watchdog_due(&w) == clock)
            watchdog_end(&w);
        CHECK_EQ(expired, expires);
        *expiries += expires;
        host(&m, &t, &w, &seed, clock);
        CHECK_EQ(timer_due(&t), m.timer_on ? clock + m.to_fire : INT64_MAX);
        CHECK_EQ(t.count, m.fired);
        CHECK_EQ(watchdog_due(&w), m.to_end > 0 ? clock + m.to_end : INT64_MAX);
        CHECK_EQ(w.expired, m.expired);
        CHECK_EQ(w.resetting, m.to_end > 0);
        if (m.dog_on && !m.expired)
            CHECK_EQ(w.count, m.value - m.to_expire);
    }
}

int main(void)
{
    int expiries = 0, together = 0;
    exact_clocks();
    ranges();
    life_of_a_watchdog();
    for (int64_t period = 1; period <= 6; period++)
        for (int32_t value = 1; value <= 5; value++)
            refresh_window(period, value);
    for (uint64_t seed = 1; seed <= 100; seed++)
        against_model(seed * 32452843, &expiries, &together);
    CHECK(expiries > 1000); /* the scenarios reach what they are about */
    CHECK(together > 100);
    return check_result();
}
