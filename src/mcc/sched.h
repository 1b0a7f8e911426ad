/* sched - the modules of the PC's software on one processor: who runs when.
 *
 * Fixed priorities, the lowest number first; a more urgent module interrupts a less urgent one at
 * once. A module is asked to run by its timer, at offset + k cycle, or is woken for a clock. At one
 * clock runs end first, then timers ask and what is most urgent begins; then interrupts are seen.
 * So a module whose timer and an interrupt fall on one clock has begun when the interrupt comes.
 * Among equal priorities what has begun goes on, then what was due first, then the lower number.
 *
 * One run waits while the module is busy; its timer asking once more is lost. A cycle that begins
 * while a run of the module is not finished is a missed deadline, that of the unfinished run, if
 * its timer asked for that: a run that an event woke has none. A cycle that begins while such a run
 * waits is one with it.
 *
 * The time of a run is what the caller says: sched_next tells that a run begins or that its time is
 * over, and the caller answers before it asks again.
 */
#ifndef SCHED_H
#define SCHED_H

#include <stdbool.h>
#include <stdint.h>

enum { SCHED_MODULES = 4 };

/* Longest time, offset, cycle, and last clock: more than a thousand years. */
#define SCHED_LONGEST ((int64_t)1 << 61)

struct sched_config {
    int32_t priority[SCHED_MODULES];
    int64_t cycle[SCHED_MODULES];   /* [clocks]; 0: woken only */
    int64_t offset[SCHED_MODULES];  /* [clocks] of the first cycle */
};

struct sched_module {
    int64_t next;       /* [clock] its timer asks again; INT64_MAX without a cycle */
    bool    asked;      /* a run waits */
    bool    woken;      /* not by its timer */
    int64_t ready;      /* [clock] at which the run that waits may begin, */
    int64_t due;        /* [clock] and from which its latency counts */
    bool    active;     /* a run has begun, not ended */
    bool    event;      /* that run was woken */
    int64_t from;       /* [clock] that run was due */
    int64_t left;       /* [clocks] it still needs */

    int32_t runs;       /* ended */
    int32_t missed;     /* deadlines */
    int64_t latency;    /* [clocks] longest, due to begin */
    int64_t response;   /* [clocks] longest, due to end */
    int64_t busy;       /* [clocks] it has had the processor */
};

struct sched {
    struct sched_config config;
    struct sched_module module[SCHED_MODULES];
    int64_t clock;      /* everything before it is done */
    int     running;    /* module that had the clock before; -1 none */
};

enum sched_what { SCHED_NONE, SCHED_BEGIN, SCHED_END };

struct sched_event {
    enum sched_what what;
    int module;
};

void sched_start(struct sched *s, const struct sched_config *config);

/* Ask for a run that was due at a clock and may begin at `ready`; takes the place of one that
 * waits. */
void sched_wake(struct sched *s, int module, int64_t due, int64_t ready);

/* Let time pass to the next event before `until`, at s->clock; SCHED_NONE: none, clock is until. */
struct sched_event sched_next(struct sched *s, int64_t until);

/* Answer to SCHED_BEGIN: the run was due at this clock and needs so many clocks. */
void sched_begin(struct sched *s, int module, int64_t due, int64_t clocks);

/* Answers to SCHED_END: the run needs more clocks; it has ended. */
void sched_more(struct sched *s, int module, int64_t clocks);
void sched_end(struct sched *s, int module);

/* Runs, missed deadlines and clocks of all modules together, the longest latency and response. */
struct sched_module sched_all(const struct sched *s);

#endif
