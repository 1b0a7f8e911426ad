/* timer - the card's timer, which interrupts periodically, and the watchdog, which it drives: the
 * watchdog resets the outputs if the host does not refresh it within a number of timer periods. */
#ifndef TIMER_H
#define TIMER_H

#include <stdbool.h>
#include <stdint.h>

/* Longest period of timer and reset [clocks]: 32-bit registers, 107 s. */
#define TIMER_PERIOD_MAX INT64_C(4294967295)

enum { WATCHDOG_VALUE_MAX = 65535 }; /* 16-bit register */

/* All zero is the state after power on: off. */
struct timer {
    bool on;
    int64_t period; /* [clocks] */
    int64_t start;  /* [clock] of the latest firing; before the first one, of the start */
    int64_t count;  /* number of firings since power on */
};

/* All zero is the state after power on: off. */
struct watchdog {
    bool on;
    bool expired;         /* it has expired; until the host refreshes it or switches it off */
    bool resetting;       /* it has expired and the reset period runs */
    int32_t value;        /* [timer firings] without a refresh after which it expires */
    int32_t count;        /* [timer firings] since the latest refresh; stops at `value` */
    int64_t reset_period; /* [clocks] duration of the reset */
    int64_t end;          /* [clock] of the end of the reset period, if resetting */
};

enum timer_status {
    TIMER_OK,
    TIMER_BAD_PERIOD, /* not 1 .. 2^32 - 1 clocks */
    TIMER_BAD_VALUE,  /* watchdog: not 1 .. 65535 timer firings */
    TIMER_BAD_RESET,  /* watchdog: reset period not 1 .. 2^32 - 1 clocks */
};

/* What a status but 0 says, in a sentence without a full stop. */
const char *timer_status_text(enum timer_status status);

/* Order at one clock: the reset period ends and the timer fires (either first, the result is the
 * same), the watchdog counts the firing, then comes what the host does at that clock. */

/* Set the timer. Switched on at `clock`, it fires at clock + n * period, n = 1, 2, ...; a new
 * period while on starts it afresh at `clock`. The same values again change nothing. Off, it keeps
 * a new period for later. A bad period is refused, also with `on` false, and changes nothing. */
enum timer_status timer_set(struct timer *t, bool on, int64_t period, int64_t clock);

/* Clock of the next firing; INT64_MAX while off. */
int64_t timer_due(const struct timer *t);

/* Fire; call it once at each clock timer_due(). Off: nothing happens. */
void timer_fire(struct timer *t);

/* Set the watchdog: it expires at the value-th timer firing without a refresh, and then resets for
 * `reset_period` clocks. It counts nothing but firings: with the timer off it never expires, and a
 * restart of the timer delays the next firing but keeps the count.
 * A new value while on counts anew, a new reset period holds from the next expiry on; neither ends
 * `expired` nor moves the end of a reset period that runs. Off clears all at once, also in the
 * reset period. The same values again change nothing. The first of value and reset period that is
 * bad is refused, also with `on` false, and nothing changes. */
enum timer_status watchdog_set(struct watchdog *w, bool on, int32_t value, int64_t reset_period);

/* The host refreshes the watchdog: it counts anew, and `expired` ends. A refresh in the reset
 * period does nothing and must be repeated after it; one at the clock of its end acts. While the
 * timer runs undisturbed, expiry comes more than value - 1 and at most `value` timer periods after
 * a refresh. A refresh at the very clock of expiry is late, because the firing comes first. */
void watchdog_refresh(struct watchdog *w);

/* The timer fired at `clock`: count it. True if the watchdog expires now; the reset period begins.
 * Off or expired already: false, nothing counted. */
bool watchdog_timer_fired(struct watchdog *w, int64_t clock);

/* Clock at which the reset period ends, reset_period after expiry; INT64_MAX if none runs. */
int64_t watchdog_due(const struct watchdog *w);

/* End the reset period; call it at the clock watchdog_due(). `expired` stays. */
void watchdog_end(struct watchdog *w);

#endif
