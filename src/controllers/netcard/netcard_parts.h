/* netcard_parts - what netcard.c and the files of its tasks share: the steps of each task, and the
 * functions by which tasks, interrupts and commands act on the card. */
#ifndef NETCARD_PARTS_H
#define NETCARD_PARTS_H

#include "netcard.h"

/* The answer of a task or interrupt (context) to the kernel: it goes on at `step` when it has had
 * so many processor cycles, so much time [ns], or this semaphore. */
void card_work(struct netcard *c, int context, int64_t cycles, int step);
void card_spend(struct netcard *c, int context, int64_t ns, int step);
void card_take(struct netcard *c, enum netcard_task task, int semaphore, int step);
int64_t card_cycles_ns(int64_t cycles);

/* Time of so many cycles, and of writing a frame of five words to the FPGA. [ns] */
int64_t card_frame_ns(const struct netcard *c, int64_t cycles);

/* The next step of a task or an interrupt; each gives the kernel one answer. home, stop, pause and
 * run act by the table of card_state.h; literal_task is one of them as the document has it. */
void card_parse(struct netcard *c);
void card_store(struct netcard *c);
void card_home(struct netcard *c);
void card_stop(struct netcard *c);
void card_pause(struct netcard *c);
void card_run(struct netcard *c);
void literal_task(struct netcard *c, enum netcard_task task);
void card_interrupt(struct netcard *c, int interrupt);

/* Where a task goes on, as c->step holds it. */
enum card_run_step {
    RUN_WAIT,
    RUN_BEGIN,
    RUN_HEADER,
    RUN_NEXT,
    RUN_PAGE,
    RUN_WRITTEN,
    RUN_FULL,
    RUN_LAST,
    RUN_ARRIVED
};
enum card_home_step {
    HOME_WAIT,
    HOME_LOOK,
    HOME_LOWERED,
    HOME_STILL,
    HOME_CLEARED,
    HOME_STEP,
    HOME_LAST,
    HOME_RAISE
};
enum card_turn_step { TURN_WAIT, TURN_LOOK, TURN_ACT, TURN_RELEASE, TURN_RELEASE_HOME };

/* Act on a command by the rules of the policy. Returns the semaphore to be given, -1: none; *code
 * is the answer, NET_CODES for a RESET that is answered when the drives' error clear is over. */
int card_order(struct netcard *c, enum card_command command, uint32_t axes, enum net_code *code);
int literal_order(struct netcard *c, enum card_command command, uint32_t axes);

/* Enter the state of rest: READY, or EMPTY if there is no job in the flash. */
void card_rest(struct netcard *c);

/* Put out the rest event of the job, if it is owed. */
void card_put_rest(struct netcard *c);

/* The approach of the axes to position 0, where a job begins: the tool's (Z, U) first, then X and Y
 * together, each within its own speed and acceleration. card_approach_due: the axes stand
 * elsewhere. card_approach_begin: false if they cannot move with these settings.
 * card_approach_next: the next frame; the last one leads to APPROACH_THERE. */
bool card_approach_due(const struct netcard *c);
bool card_approach_begin(struct netcard *c);
struct frame card_approach_next(struct netcard *c);

/* The job of the run task: true if there is one; if the player has been let go; if frames are still
 * to be read; if the job is to be given up. */
bool card_job_under_way(const struct netcard *c);
bool card_job_let_go(const struct netcard *c);
bool card_job_reads(const struct netcard *c);
bool card_job_given_up(const struct netcard *c);

/* Ask run to give its job up, if there is one. Note that run has given it up or ended it. */
void card_job_give_up(struct netcard *c);
void card_job_leave(struct netcard *c);

/* Begin the job in the flash by asking for its header. Then: true if the header that has come is
 * good; if a page is; if the FPGA takes the job, whose frames are given from now on. */
void card_job_begin(struct netcard *c);
bool card_job_header(struct netcard *c);
bool card_job_page(struct netcard *c);
bool card_job_play(struct netcard *c);

/* Decode the next frame of the job; false: it leads out of the range of positions. Write a frame
 * into the FIFO. */
bool card_job_frame(struct netcard *c, struct frame *to);
void card_job_push(struct netcard *c, const struct frame *frame);

/* What comes after a frame: nothing more, sleep as the FIFO is full, or the page or frame that has
 * been begun. Before run sleeps, the storage task has its turn if it waits for a full FIFO. */
enum card_job_next { JOB_NEXT_NONE, JOB_NEXT_FULL, JOB_NEXT_COMES };
enum card_job_next card_job_next(struct netcard *c);
void card_job_slept(struct netcard *c);

/* Homing, in the order of its steps: lower the priority of the task; clear the FIFO; begin the
 * search; true if the FIFO has frames enough; write the next frame, with which the player is let go
 * if `goes`. Then true if all origins were found, else the state is FAULT; raise the priority
 * again. */
void card_home_lower(struct netcard *c);
void card_home_clear(struct netcard *c);
void card_home_begin(struct netcard *c);
bool card_home_full(const struct netcard *c);
void card_home_frame(struct netcard *c, bool goes);
bool card_home_found(struct netcard *c);
void card_home_raise(struct netcard *c);

/* Enter FAULT at once: no more pulses come, and job and homing are over. */
void card_fault(struct netcard *c, enum net_code error);

/* The link: act on a message for the card, and return the semaphore to be given, -1: none; tell the
 * PC what the store has come to; send a STATUS. */
int card_message(struct netcard *c);
void card_tell_store(struct netcard *c);
void card_tell_status(struct netcard *c);

/* Processor time that each task, and all interrupts together, have had. [ns] */
void card_busy(const struct netcard *c, int64_t busy[CARD_LOADS]);

/* Advance the player to c->now, and keep for its interrupt what it tells. */
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
