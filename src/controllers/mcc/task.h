/* task - the IPO task: part program -> command ring -> interpolation points. */
#ifndef TASK_H
#define TASK_H

#include "mcc.h"

/* Codes of the library's group status that occur here. */
enum task_status { TASK_RUNNING, TASK_STOPPED, TASK_HOLD, TASK_DELAY, TASK_BLOCK_HOLD, TASK_WHEEL };

/* What a program is read against, whose text comes from s. */
struct program task_program(const struct mcc *m, const struct source *s);

/* Read the whole program as it would run from the last command's end; nothing moves. */
void task_check(const struct mcc *m, const struct source *s, struct fault_report *r);

/* The same for all faults and notes. */
void task_check_all(const struct mcc *m, const struct source *s, struct fault_list *all);

/* Start a program that task_check found good. Refused like a motion call. */
int task_start(struct mcc *m);

/* Origins of G54 (system 1) .. G59 (6) at the start of a program. [mm] Refused while one runs. */
int task_set_origin(struct mcc *m, int system, const double origin[AXES]);

/* Switches of the panel, from the next line on that is read: pass over lines that begin with /,
 * stop at M1. Both are off at first. */
void task_set_switches(struct mcc *m, bool block_delete, bool optional_stop);

/* Tools that a program begins with; M6 waits for task_continue, or is immediate (at first). */
void task_set_tools(struct mcc *m, const struct tool_table *tools, bool change_stops);

/* How programs are meant that are checked or started from now on. */
void task_set_dialect(struct mcc *m, const struct mcc_dialect *d);

/* Rest before each block: a line of the program, or a call of the API. The one with which a program
 * starts has leave. Switched off, a block that waits still needs task_continue. */
int task_set_single_block(struct mcc *m, bool on);

/* Go on behind M0 or M1, or with the next block. Refused unless the axes rest there and every point
 * has been written. */
int task_continue(struct mcc *m);

/* Hold or go on, and override (1 is 100 %), as a panel has them: what does not apply is refused. */
void task_operate(struct mcc *m, bool hold, double override);

/* One cycle: fill the point queue as far as commands reach. The text is the one that task_check
 * found good; NULL if no program runs. */
void task_run(struct mcc *m, const struct source *s);

/* The cycle in parts, for a PC on which interpreter and points are modules of their own. Is there a
 * command to make, a point to compute? */
bool task_can_read(const struct mcc *m);
bool task_can_point(const struct mcc *m);

/* Make the next command of the program. Not unless it can. */
void task_read(struct mcc *m, const struct source *s);

/* Make commands while there is room for them; how many. */
int task_read_all(struct mcc *m, const struct source *s);

/* Compute a point. Not unless it can. With a source commands are made in the place of those it
 * took, without (NULL) it takes what the ring has. Returns how many were made. */
int task_point(struct mcc *m, const struct source *s);

/* Behind the last point: where the next command begins, if all of them are done. */
void task_settle(struct mcc *m);

/* True while a card that gets no point would stand still in the middle of a motion. */
bool task_moving(const struct mcc *m);

enum task_status task_status(const struct mcc *m);

/* A key of a panel: it counts as pressed when it goes down, until somebody takes that. */
struct key {
    bool down;    /* when it was looked at last */
    bool pressed; /* since it was taken last */
};

static inline void key_look(struct key *k, bool down)
{
    k->pressed = k->pressed || (down && !k->down);
    k->down = down;
}

/* Has it been pressed? Once for all times that it was. */
static inline bool key_take(struct key *k)
{
    const bool pressed = k->pressed;

    k->pressed = false;
    return pressed;
}

#endif
