#include "timer.h"

static bool period_fits(int64_t period)
{
    return period >= 1 && period <= TIMER_PERIOD_MAX;
}

const char *timer_status_text(enum timer_status status)
{
    switch (status) {
    case TIMER_BAD_PERIOD: return "the timer period is 1 to 4294967295 clocks";
    case TIMER_BAD_VALUE:  return "the watchdog waits 1 to 65535 timer periods";
    default:               return "the watchdog resets for 1 to 4294967295 clocks";
    }
}

enum timer_status timer_set(struct timer *t, bool on, int64_t period, int64_t clock)
{
    if (!period_fits(period))
        return TIMER_BAD_PERIOD;
    if (on && (!t->on || period != t->period))
        t->start = clock;
    t->on = on;
    t->period = period;
    return TIMER_OK;
}

int64_t timer_due(const struct timer *t)
{
    return t->on ? t->start + t->period : INT64_MAX;
}

void timer_fire(struct timer *t)
{
    if (!t->on)
        return;
    t->start += t->period;
    t->count++;
}

enum timer_status watchdog_set(struct watchdog *w, bool on, int32_t value, int64_t reset_period)
{
    if (value < 1 || value > WATCHDOG_VALUE_MAX)
        return TIMER_BAD_VALUE;
    if (!period_fits(reset_period))
        return TIMER_BAD_RESET;
    if (!on || value != w->value)
        w->count = 0;
    if (!on) {
        w->expired = false;
        w->resetting = false;
    }
    w->on = on;
    w->value = value;
    w->reset_period = reset_period;
    return TIMER_OK;
}

void watchdog_refresh(struct watchdog *w)
{
    if (w->resetting)
        return;
    w->expired = false;
    w->count = 0;
}

bool watchdog_timer_fired(struct watchdog *w, int64_t clock)
{
    if (!w->on || w->expired)
        return false;
    w->count++;
    if (w->count < w->value)
        return false;
    w->expired = true;
    w->resetting = true;
    w->end = clock + w->reset_period;
    return true;
}

int64_t watchdog_due(const struct watchdog *w)
{
    return w->resetting ? w->end : INT64_MAX;
}

void watchdog_end(struct watchdog *w)
{
    w->resetting = false;
}
