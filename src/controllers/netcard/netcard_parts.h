/* netcard_parts - what netcard.c and the files of its tasks share. */
#ifndef NETCARD_PARTS_H
#define NETCARD_PARTS_H

#include "netcard.h"

/* Answer of a task: it goes on at `step` when it has had so many cycles, so much time, this
 * semaphore. */
void card_work(struct netcard *c, int context, int64_t cycles, int step);
void card_spend(struct netcard *c, int context, int64_t ns, int step);
void card_take(struct netcard *c, enum netcard_task task, int semaphore, int step);
int64_t card_cycles_ns(int64_t cycles);

/* So many cycles, and a frame of five words on the bus to the FPGA. [ns] */
int64_t card_frame_ns(const struct netcard *c, int64_t cycles);

/* What one context does next; each gives the kernel one answer. */
void card_parse(struct netcard *c);
void card_store(struct netcard *c);
void card_home(struct netcard *c);
void card_stop(struct netcard *c);
void card_pause(struct netcard *c);
void card_run(struct netcard *c);
void card_interrupt(struct netcard *c, int interrupt);

/* A command by the table of the policy. Returns the semaphore to be given; -1 none. NET_CODES:
 * a RESET that is answered when the drives' error clear is over. */
int card_order(struct netcard *c, enum card_command command, uint32_t axes, enum net_code *code);

/* Rest: READY or EMPTY, as the flash has it. */
void card_rest(struct netcard *c);

/* The job's rest event, if it is owed. */
void card_put_rest(struct netcard *c);

/* The way of the axes to position 0, where a job begins: the tool's (Z, U) first, then X and Y
 * together, each within its own speed and acceleration. Whether they stand elsewhere; false: they
 * cannot move with these settings; whether all frames are given; the next one. */
bool card_approach_due(const struct netcard *c);
bool card_approach_begin(struct netcard *c);
bool card_approach_given(const struct netcard *c);
struct frame card_approach_next(struct netcard *c);

/* FAULT at once: no more pulses, the job and homing are over. */
void card_fault(struct netcard *c, enum net_code error);

/* The link: a message for the card; the semaphore to be given, -1 none. What the store has come to
 * is told. STATUS. */
int card_message(struct netcard *c);
void card_tell_store(struct netcard *c);
void card_tell_status(struct netcard *c);

/* Time that each task, and all interrupts together, have had the processor. [ns] */
void card_busy(const struct netcard *c, int64_t busy[CARD_LOADS]);

/* The player is advanced to now, what it tells is kept for its interrupt. */
void card_advance_player(struct netcard *c);

static inline bool card_literal(const struct netcard *c)
{
    return c->settings.policy == CARD_LITERAL;
}

static inline int64_t card_clock(const struct netcard *c)
{
    return c->now / PLAYER_CLOCK_NS;
}

static inline void card_pend(struct netcard *c, int interrupt)
{
    kernel_pend(&c->kernel, interrupt, c->now - c->boot);
}

#endif
