/* task_scheme - the source document's scheme of the network card's tasks, and the packets that come
 * for them, for comparing this kernel with the FreeRTOS kernel, on which it was recorded.
 *
 * Each packet is an interrupt that gives BYTES to the parser, which gives the semaphore of the
 * packet's task. Home works with a lower priority; pause holds the processor until it is released;
 * stop works one unit, run a job of some. Tokens: rN unit N of all work was one of run, p pause,
 * h home, s stop; !x a packet x; >t task t gets the processor; 5>2 home's priority.
 */
#ifndef TASK_SCHEME_H
#define TASK_SCHEME_H

#include <stdarg.h>
#include <stdbool.h>
#include <string.h>

#include "check.h"

enum task { PARSE, HOME, STOP, PAUSE, RUN, TASKS };
enum { BYTES = TASKS, SEMAPHORES, UNIT = 1000, LATEST = 100000, UNITS = 60, PACKETS = 6 };
static const char *const NAME[] = { "parse", "home", "stop", "pause", "run" };
static const char LETTER[] = "-hspr";
static const int PRIORITY[] = { 6, 5, 4, 3, 1 };

/* Packets at rising clocks, the first at 10. */
struct scenario {
    const char *name;
    struct {
        int64_t clock;
        enum task task;
    } packet[PACKETS];
    int packets, home_units, home_priority, job_units;
    int64_t released, tick;
};

static const struct scenario SCENARIO[] = {
    { "home_during_run", { { 10, RUN }, { 3500, HOME } }, 2, 6, 2, UNITS, 0, 0 },
    { "home_during_pause",
      { { 10, RUN }, { 3500, PAUSE }, { 5800, HOME } },
      3,
      6,
      2,
      UNITS,
      46000,
      0 },
    { "start_twice_then_stop",
      { { 10, RUN }, { 3500, RUN }, { 6500, STOP } },
      3,
      6,
      2,
      UNITS,
      0,
      0 },
    { "pause_while_idle", { { 10, STOP }, { 2500, PAUSE } }, 2, 6, 2, UNITS, 6000, 0 },
    { "two_starts_while_homing", { { 10, HOME }, { 2500, RUN }, { 4500, RUN } }, 3, 8, 2, 5, 0, 0 },
    { "two_starts_during_the_job",
      { { 10, RUN }, { 2500, RUN }, { 3500, RUN } },
      3,
      8,
      2,
      5,
      0,
      0 },
    { "three_homes", { { 10, HOME }, { 2500, HOME }, { 4500, HOME } }, 3, 6, 2, 5, 0, 0 },
    { "two_homes_while_paused",
      { { 10, PAUSE }, { 2500, STOP }, { 4500, HOME }, { 5500, HOME } },
      4,
      3,
      2,
      5,
      9000,
      0 },
    { "two_pauses_while_stopping",
      { { 10, STOP }, { 300, PAUSE }, { 500, PAUSE } },
      3,
      6,
      2,
      5,
      3000,
      0 },
    { "start_and_stop_while_homing",
      { { 10, HOME }, { 2500, RUN }, { 4500, STOP }, { 6500, RUN } },
      4,
      8,
      2,
      5,
      0,
      0 },
    { "stop_during_home", { { 10, RUN }, { 3500, HOME }, { 5500, STOP } }, 3, 6, 2, UNITS, 0, 0 },
    { "pause_during_home",
      { { 10, RUN }, { 3500, HOME }, { 5500, PAUSE } },
      3,
      6,
      2,
      UNITS,
      8000,
      0 },
    { "pause_and_stop_at_once",
      { { 10, RUN }, { 3500, PAUSE }, { 3500, STOP } },
      3,
      6,
      2,
      UNITS,
      0,
      0 },
    { "stop_and_home_at_once",
      { { 10, RUN }, { 3500, STOP }, { 3500, HOME } },
      3,
      6,
      2,
      UNITS,
      0,
      0 },
    { "four_starts",
      { { 10, RUN }, { 1500, RUN }, { 2500, RUN }, { 3500, RUN } },
      4,
      6,
      2,
      5,
      0,
      0 },
    { "two_pauses", { { 10, RUN }, { 3500, PAUSE }, { 5500, PAUSE } }, 3, 6, 2, UNITS, 8000, 0 },
    { "home_as_urgent_as_run", { { 10, RUN }, { 3500, HOME } }, 2, 6, 1, UNITS, 0, 5200 }
};
enum { SCENARIOS = sizeof SCENARIO / sizeof *SCENARIO };

static struct {
    char text[2048];
    int units, arrived, taken; /* units done; packets that came, that the parser has taken */
} scheme;

static inline void say(const char *format, ...)
{
    const size_t n = strlen(scheme.text);
    va_list list;

    va_start(list, format);
    vsnprintf(scheme.text + n, sizeof scheme.text - n, format, list);
    va_end(list);
}

/* Say the interrupts of the packets that come up to this clock. */
static inline void say_packets(const struct scenario *s, int64_t clock)
{
    for (; scheme.arrived < s->packets && s->packet[scheme.arrived].clock <= clock;
         scheme.arrived++) {
        say("!%s ", NAME[s->packet[scheme.arrived].task]);
    }
}

static inline void say_unit(enum task task)
{
    say("%c%d ", LETTER[task], ++scheme.units);
}

static inline void say_priority(const struct scenario *s, bool active)
{
    say(active ? "5>%d " : "%d>5 ", s->home_priority);
}

#endif
